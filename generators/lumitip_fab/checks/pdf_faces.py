"""The fonts of a PDF's page: what its codes say, how wide they are, and whether it brings them."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pikepdf

_LETTER = re.compile(rb"<([0-9A-Fa-f]{2})>\s*<([0-9A-Fa-f]{4})>")
_FILES = ("/FontFile", "/FontFile2", "/FontFile3")
_USUAL_EM = 0.6  # of a letter whose width the file does not tell


@dataclass(frozen=True)
class Face:
    """A font with a letter for each byte."""

    name: str
    embedded: bool
    """Whether its outlines are in the file; else every printer takes its own."""
    letters: Mapping[int, str]
    """What each code says; of others Windows' Latin letters."""
    widths_em: Mapping[int, float]

    def text(self, codes: bytes) -> str:
        """What they say."""
        return "".join(self.letters.get(c) or bytes([c]).decode("cp1252") for c in codes)

    def width_em(self, codes: bytes) -> float:
        """How wide they are, in font sizes."""
        return sum(self.widths_em.get(code, _USUAL_EM) for code in codes)


def faces_of(page: pikepdf.Page) -> dict[str, Face]:
    """The fonts of a page, by the names that its operators use.

    Raises:
        ValueError: if one has more than a byte for each letter.
    """
    fonts: Any = page.resources.get("/Font", {})
    return {str(name): _face(fonts[name]) for name in fonts.keys()}  # noqa: SIM118


def _face(font: Any) -> Face:
    if str(font.Subtype) not in ("/TrueType", "/Type1"):
        raise ValueError(f"a font of kind {font.Subtype}, one byte for each letter is needed")
    outlines = font.get("/FontDescriptor", {})
    table = font.ToUnicode.read_bytes() if "/ToUnicode" in font else b""
    letters = {int(code, 16): chr(int(point, 16)) for code, point in _LETTER.findall(table)}
    widths = [float(width) / 1000 for width in font.get("/Widths", [])]
    first = int(font.get("/FirstChar", 0))
    return Face(
        name=str(font.BaseFont)[1:],
        embedded=any(kind in outlines for kind in _FILES),
        letters={code: letter for code, letter in letters.items() if letter != "\0"},
        widths_em=dict(enumerate(widths, first)),
    )


def lacking(faces: Mapping[str, Face]) -> list[str]:
    """Names of the fonts that are not embedded."""
    return sorted({face.name for face in faces.values() if not face.embedded})

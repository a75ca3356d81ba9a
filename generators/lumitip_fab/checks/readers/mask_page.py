"""Reading a mask's PDF: what its operators paint, in mm on the page, origin at the lower left, and
the fonts of its texts."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pikepdf
from numpy.typing import NDArray

from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.plain_pdf import require_plain

Points = NDArray[np.float64]

MM = 25.4 / 72
_BLACK = {"g": ((0.0,),), "rg": ((0.0, 0.0, 0.0),), "k": ((0.0, 0.0, 0.0, 1.0), (1.0,) * 4)}
_FILLS = {"f": False, "F": False, "f*": True, "b": False, "b*": True, "B": False, "B*": True}
_STROKES = ("S", "s", "b", "b*", "B", "B*")
_HIDING = ("Do", "INLINE IMAGE", "W", "W*", "sh")
_IDENTITY = np.eye(3)
_LETTER = re.compile(rb"<([0-9A-Fa-f]{2})>\s*<([0-9A-Fa-f]{4})>")
_FILES = ("/FontFile", "/FontFile2", "/FontFile3")
_USUAL_EM = 0.6  # of a letter whose width the file does not tell


class PageError(Exception):
    """A file is not what a mask may be; the message says why."""


@dataclass(frozen=True)
class Face:
    """A font with a letter for each byte."""

    name: str
    embedded: bool
    """Whether its outlines are in the file; else every printer takes its own."""
    letters: Mapping[int, str]
    """Character of each code; Windows-1252 for all others."""
    widths_em: Mapping[int, float]

    def text(self, codes: bytes) -> str:
        """The texts."""
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


@dataclass(frozen=True, eq=False)
class Subpath:
    """One run of a path."""

    corners: Points
    """On the curve, in order; a closed one does not repeat its first."""
    controls: Points
    """Control points of its cubics, two each."""
    closed: bool

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Least x, least y, greatest x, greatest y."""
        (left, low), (right, high) = self.corners.min(axis=0), self.corners.max(axis=0)
        return float(left), float(low), float(right), float(high)


@dataclass(frozen=True, eq=False)
class Painted:
    """A path with what was done to it."""

    subpaths: tuple[Subpath, ...]
    filled: bool
    black: bool
    """Whether the fill is full black."""
    even_odd: bool
    stroked: bool


@dataclass(frozen=True, eq=False)
class Page:
    """A page with everything on it."""

    size_mm: tuple[float, float]
    painted: tuple[Painted, ...]
    texts: Points
    """Corners of the boxes of all texts."""
    words: tuple[str, ...]
    """The texts."""
    lacking: tuple[str, ...]
    """Fonts that it does not bring."""

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Least and greatest x and y of everything painted."""
        runs = [s for p in self.painted for s in p.subpaths]
        every = np.concatenate(
            [self.texts, *(s.corners for s in runs), *(s.controls for s in runs)]
        )
        (left, low), (right, high) = every.min(axis=0), every.max(axis=0)
        return float(left), float(low), float(right), float(high)


def read_page(path: Path) -> Page:
    """Read the only page of a PDF.

    Raises:
        PageError: if it is missing, damaged, or not plain paths and text on one page.
    """
    try:
        with pikepdf.open(path) as pdf:
            if len(pdf.pages) != 1:
                raise PageError(f"{len(pdf.pages)} pages, one is needed")
            require_plain(pdf)
            page = pdf.pages[0]
            left, low, right, high = (float(v) * MM for v in page.mediabox)
            faces = faces_of(page)
            reader = _Reader(np.array([[MM, 0, -left], [0, MM, -low], [0, 0, 1]]), faces)
            for instruction in pikepdf.parse_content_stream(page):
                reader.take(str(instruction.operator), instruction.operands)
    except FileNotFoundError as error:
        raise PageError("no such file") from error
    except (OSError, pikepdf.PdfError, *MALFORMED) as error:
        raise PageError(f"cannot be read: {error!r:.200}") from error
    if not reader.painted:
        raise PageError("nothing is painted on it")
    texts = np.array(reader.texts).reshape(-1, 2)
    words, without = tuple(reader.words), tuple(lacking(faces))
    return Page((right - left, high - low), tuple(reader.painted), texts, words, without)


@dataclass
class _Reader:
    """Follows the operators, with the graphics state that matters."""

    matrix: Points
    faces: dict[str, Face]
    black: bool = True
    font: tuple[str, float] = ("", 0.0)
    """Name and size."""
    text_matrix: Points = field(default_factory=lambda: _IDENTITY)
    saved: list[tuple[Points, bool]] = field(default_factory=list)
    runs: list[list[Any]] = field(default_factory=list)
    painted: list[Painted] = field(default_factory=list)
    texts: list[Points] = field(default_factory=list)
    words: list[str] = field(default_factory=list)

    def take(self, operator: str, operands: Any) -> None:
        """Follow one operator."""
        if operator in ("m", "l", "c", "h", "re"):
            self._draw(operator, [float(v) for v in operands])
        elif operator in ("n", *_FILLS, *_STROKES):
            self._paint(operator)
        elif operator == "q":
            self.saved.append((self.matrix, self.black))
        elif operator == "Q":
            self.matrix, self.black = self.saved.pop()
        elif operator == "cm":
            self.matrix = self.matrix @ _matrix(operands)
        elif operator in _BLACK:
            self.black = tuple(float(v) for v in operands) in _BLACK[operator]
        elif operator in ("sc", "scn", "cs"):
            self.black = False
        elif operator in _HIDING:
            raise PageError(f"operator {operator}: pictures, shades and clips may hide apertures")
        else:
            self._text(operator, operands)

    def _draw(self, operator: str, values: list[float]) -> None:
        if operator == "m":
            self.runs.append([[tuple(values)], [], False])
        elif operator == "re":
            x, y, w, h = values
            self.runs.append([[(x, y), (x + w, y), (x + w, y + h), (x, y + h)], [], True])
        elif operator == "h":
            self.runs[-1][2] = True
        else:
            self.runs[-1][0].append(tuple(values[-2:]))
            self.runs[-1][1] += [tuple(values[i : i + 2]) for i in range(0, len(values) - 2, 2)]

    def _paint(self, operator: str) -> None:
        filled = operator in _FILLS
        if operator != "n":
            closing = operator in ("s", "b", "b*") or filled
            self.painted.append(
                Painted(
                    tuple(self._subpaths(closing)),
                    filled,
                    self.black and filled,
                    _FILLS.get(operator, False),
                    operator in _STROKES,
                )
            )
        self.runs = []

    def _subpaths(self, closing: bool) -> Iterator[Subpath]:
        for corners, controls, closed in self.runs:
            ends = corners[:-1] if len(corners) > 1 and corners[0] == corners[-1] else corners
            shut = closed or closing or len(ends) < len(corners)
            yield Subpath(self._on_page(ends), self._on_page(controls), shut)

    def _on_page(self, points: list[tuple[float, float]]) -> Points:
        return np.array(points).reshape(-1, 2) @ self.matrix[:2, :2].T + self.matrix[:2, 2]

    def _text(self, operator: str, operands: Any) -> None:
        if operator == "BT":
            self.text_matrix = _IDENTITY
        elif operator == "Tm":
            self.text_matrix = _matrix(operands)
        elif operator == "Tf":
            self.font = str(operands[0]), float(operands[1])
        elif operator == "Tj":
            name, size = self.font
            codes, face = bytes(operands[0]), self.faces[name]
            self.words.append(face.text(codes))
            width = face.width_em(codes) * size
            matrix = self.matrix @ self.text_matrix
            box = np.array([(0, 0), (width, 0), (width, size), (0, size)])
            self.texts.append(box @ matrix[:2, :2].T + matrix[:2, 2])
        elif operator in ("TJ", "'", '"', "Td", "TD"):
            raise PageError(f"operator {operator}: texts are placed one by one")


def _matrix(operands: Any) -> Points:
    a, b, c, d, e, f = (float(v) for v in operands)
    return np.array([[a, c, e], [b, d, f], [0, 0, 1]])

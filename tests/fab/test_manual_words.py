"""The words of the printed manual: none is so small that it cannot be read."""

import ctypes
import math
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from string import ascii_uppercase, digits

import pypdfium2
import pypdfium2.raw as pdfium
import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
PRESETS = sorted(file.stem for file in (ROOT / "design/presets").glob("*.toml"))
PARTS = "Parts of the emitter board"
DESIGNS = ["fingertip", *PRESETS]
LEAST_PT = 5.95  # 6 pt, rounded


def _letters(page: pypdfium2.PdfPage) -> Iterator[tuple[str, float]]:
    """Each letter, and the height of its font as printed (points)."""
    text, matrix = page.get_textpage(), pdfium.FS_MATRIX()
    for at in range(text.count_chars()):
        letter = chr(pdfium.FPDFText_GetUnicode(text, at))
        if not letter.isspace():
            pdfium.FPDFText_GetMatrix(text, at, ctypes.byref(matrix))
            size = pdfium.FPDFText_GetFontSize(text, at)
            yield letter, size * math.hypot(matrix.c, matrix.d)


@pytest.mark.parametrize("design", DESIGNS)
def test_every_word_is_six_points_high(built: Callable[[str], Path], design: str) -> None:
    """But references on the bodies of parts on the last pages: each is printed beside its part
    too, in lines."""
    small, references = defaultdict[tuple[int, float], str](str), ""
    with pypdfium2.PdfDocument(built(design) / "manual/manual.pdf") as document:
        for number, page in enumerate(document, 1):
            if PARTS in page.get_textpage().get_text_bounded():
                references = ascii_uppercase + digits
            for letter, size in _letters(page):
                if size < LEAST_PT and letter not in references:
                    small[number, round(size, 1)] += letter
    assert references
    assert small == {}

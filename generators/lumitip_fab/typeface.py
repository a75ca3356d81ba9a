"""The letters of every PDF: DejaVu Sans, embedded, so that they are the same on every printer.

Its licence allows that; matplotlib brings the files, and is not imported for them, which takes
half a second.
"""

from importlib.util import find_spec
from pathlib import Path

from reportlab.pdfbase.pdfmetrics import getRegisteredFontNames, registerFont, registerFontFamily
from reportlab.pdfbase.ttfonts import TTFont

from lumitip_fab.errors import BuildError

PLAIN, BOLD, CODE = "DejaVuSans", "DejaVuSans-Bold", "DejaVuSansMono"
_OBLIQUE, _BOLD_OBLIQUE = "DejaVuSans-Oblique", "DejaVuSans-BoldOblique"
OF_HELVETICA = {"Helvetica": (PLAIN, 0.88), "Helvetica-Bold": (BOLD, 0.84)}
"""The face for one of a drawing, and its size in that one's: the words take the same room."""


def load_typeface() -> None:
    """Make the faces known to reportlab, once in each process.

    Raises:
        BuildError: if matplotlib, which brings the files, is not installed whole.
    """
    if CODE in getRegisteredFontNames():
        return
    spec = find_spec("matplotlib")
    folder = Path(spec.origin or "").parent / "mpl-data/fonts/ttf" if spec else Path()
    for name in (PLAIN, BOLD, _OBLIQUE, _BOLD_OBLIQUE, CODE):
        path = folder / f"{name}.ttf"
        if not path.is_file():
            raise BuildError(f"{path}: no such file: pip install --force-reinstall matplotlib")
        registerFont(TTFont(name, str(path)))
    registerFontFamily(PLAIN, PLAIN, BOLD, _OBLIQUE, _BOLD_OBLIQUE)
    registerFontFamily(CODE, CODE, CODE, CODE, CODE)

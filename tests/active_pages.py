"""PDFs that do more than print: scripts, actions, attachments, notes over a page."""

from collections.abc import Callable
from pathlib import Path

import pikepdf
from pikepdf import Array, Dictionary, Name


def script(pdf: pikepdf.Pdf) -> None:
    pdf.Root.Names = Dictionary(JavaScript=Dictionary(Names=Array(["a", _alert()])))


def action_when_opened(pdf: pikepdf.Pdf) -> None:
    pdf.Root.OpenAction = _alert()


def action_of_a_page(pdf: pikepdf.Pdf) -> None:
    pdf.pages[0].AA = Dictionary(O=_alert())


def attachment(pdf: pikepdf.Pdf) -> None:
    pdf.attachments["more.exe"] = b"more"


def form(pdf: pikepdf.Pdf) -> None:
    pdf.Root.AcroForm = Dictionary(Fields=Array())


def note_over_the_page(pdf: pikepdf.Pdf) -> None:
    square = Dictionary(Type=Name.Annot, Subtype=Name.Square, Rect=Array([0, 0, 100, 100]))
    pdf.pages[0].Annots = Array([square])


def page_in_other_units(pdf: pikepdf.Pdf) -> None:
    pdf.pages[0].UserUnit = 2


ACTIVE = (
    script,
    action_when_opened,
    action_of_a_page,
    attachment,
    form,
    note_over_the_page,
    page_in_other_units,
)


def _alert() -> Dictionary:
    return Dictionary(S=Name.JavaScript, JS="app.alert(1)")


def added(file: str, change: Callable[[pikepdf.Pdf], None]) -> Callable[[Path], None]:
    """Change a PDF of a folder."""

    def damage(folder: Path) -> None:
        with pikepdf.open(folder / file, allow_overwriting_input=True) as pdf:
            change(pdf)
            pdf.save(folder / file)

    return damage

"""`manual/manual.html` and `manual.pdf`, which say the same."""

from lumitip_fab.design import Design
from lumitip_fab.docs.chapters import manual_text
from lumitip_fab.docs.page import html_page
from lumitip_fab.docs.sheet import pdf_sheets
from lumitip_fab.pipeline.artefact import Artefact, Files


def manual_files(design: Design, files: Files) -> tuple[Artefact, ...]:
    """The manual twice: to read on a screen, and to print."""
    text = manual_text(design, files)
    name = f"{design.title.name} {design.title.revision}: build manual"
    return (
        Artefact("manual/manual.html", html_page(name, text, files).encode(), frame=""),
        Artefact("manual/manual.pdf", pdf_sheets(name, text, files), frame=""),
    )

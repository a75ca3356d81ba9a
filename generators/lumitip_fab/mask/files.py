"""Every file of one finger's mask but its printed sheet, which is a part."""

from lumitip_fab.design import Design, Finger
from lumitip_fab.mask.artwork import PAPERS_MM, artwork_of
from lumitip_fab.mask.drawings import (
    cut_drawing,
    dxf_drawing,
    dxf_to_sensor,
    svg_drawing,
    svg_to_sensor,
)
from lumitip_fab.mask.note import wrapping_note
from lumitip_fab.mask.pdf import pdf_page, pdf_to_sensor
from lumitip_fab.pipeline.artefact import Artefact


def mask_files(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """The mask of a finger on paper, as a drawing, to cut from an opaque film, and the note on
    wrapping by its route."""
    mask, title = design.mask, design.title
    artwork = artwork_of(design, finger, mask)
    stem = f"mask/{finger.name}_mask"
    note = wrapping_note(artwork, design)
    return (
        *(
            Artefact(
                f"{stem}_{paper}.pdf",
                pdf_page(artwork, mask, title, paper),
                pdf_to_sensor(mask, paper),
            )
            for paper in PAPERS_MM
        ),
        Artefact(f"{stem}.svg", svg_drawing(artwork, mask, title), svg_to_sensor(mask)),
        Artefact(f"{stem}.dxf", dxf_drawing(artwork, mask), dxf_to_sensor()),
        Artefact(f"mask/{finger.name}_cut.dxf", cut_drawing(artwork, mask), dxf_to_sensor()),
        Artefact(f"mask/{finger.name}_wrapping.md", note, frame=""),
    )

"""Every file of one finger's mask."""

from lumitip_fab.design import (
    Finger,
    HeatStep,
    Interface,
    Mask,
    Mould,
    Mount,
    Outline,
    Stack,
    Tip,
    Title,
)
from lumitip_fab.mask.artwork import PAPERS_MM, make_artwork
from lumitip_fab.mask.drawings import dxf_drawing, dxf_to_sensor, svg_drawing, svg_to_sensor
from lumitip_fab.mask.note import wrapping_note
from lumitip_fab.mask.outline import Finished
from lumitip_fab.mask.pdf import pdf_page, pdf_to_sensor
from lumitip_fab.pipeline.artefact import Artefact


def mask_files(
    finger: Finger,
    outline: Outline,
    stack: Stack,
    tip: Tip,
    mould: Mould,
    mount: Mount,
    interfaces: tuple[Interface, ...],
    mask: Mask,
    heat: tuple[HeatStep, ...],
    title: Title,
) -> tuple[Artefact, ...]:
    """The mask on paper, as a drawing and for a cutter, and the note on wrapping.

    Args:
        finger: whose mask it is.
        outline: edge of its gripping face.
        stack: thickness of what is wrapped.
        tip: wedge of the plate.
        mould: for the taper of the silicone.
        mount: coupling, which the flaps keep clear of.
        interfaces: what holds a bendable plate, which they keep clear of too.
        mask: apertures, allowance, flaps, rulers.
        heat: how hot the film gets to fold, and what film and finger bear.
        title: of the design.
    """
    artwork = make_artwork(Finished(finger, outline, stack, tip, mould, mount, interfaces), mask)
    stem = f"mask/{finger.name}_mask"
    pages = (
        Artefact(
            f"{stem}_{paper}.pdf",
            pdf_page(artwork, mask, title, paper),
            pdf_to_sensor(mask, paper),
        )
        for paper in PAPERS_MM
    )
    return (
        *pages,
        Artefact(f"{stem}.svg", svg_drawing(artwork, mask, title), svg_to_sensor(mask)),
        Artefact(f"{stem}.dxf", dxf_drawing(artwork, mask), dxf_to_sensor()),
        Artefact(
            f"mask/{finger.name}_wrapping.md",
            wrapping_note(artwork, mask, stack, heat, title),
            frame="",
        ),
    )

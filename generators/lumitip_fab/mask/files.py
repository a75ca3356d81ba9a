"""Every file of one finger's mask but its printed sheet, which is a part: pages and drawings."""

from xml.sax.saxutils import escape

from lumitip_fab.design import Design, Finger, Mask
from lumitip_fab.mask.artwork import PAPERS_MM, Artwork, artwork_of
from lumitip_fab.mask.drawings import (
    cut_drawing,
    dxf_drawing,
    dxf_to_sensor,
    svg_drawing,
    svg_to_sensor,
)
from lumitip_fab.mask.flaps import BAND_MM
from lumitip_fab.mask.outline import FOOT_MM
from lumitip_fab.mask.pdf import pdf_page, pdf_to_sensor
from lumitip_fab.pipeline.artefact import Artefact, Facts
from lumitip_fab.text import data_file


def creasing_files(design: Design) -> tuple[Artefact, ...]:
    """The drawing of how a fold is creased with local heat; none of a sheet that is bent cold."""
    if design.mask.route == "tpu":
        return ()
    weakest = design.heat_steps["cure"].weakest
    drawing = data_file("mask/creasing.svg").format(
        soften_c=design.heat_steps["crease"].temperature_c,
        film="film, printed side down" if design.mask.route == "film" else "film, inside down",
        title=escape(weakest.title),
        limit_c=weakest.limit_c,
    )
    return (Artefact("mask/creasing.svg", drawing.encode(), frame=""),)


def mask_files(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """The mask of a finger on paper, as a drawing, to cut from a film, and for the manual."""
    mask, title = design.mask, design.title
    artwork = artwork_of(design, finger, mask)
    stem = f"mask/{finger.name}_mask"
    return (
        *(
            Artefact(
                f"{stem}_{paper}.pdf",
                pdf_page(artwork, mask, title, paper),
                pdf_to_sensor(mask, paper),
            )
            for paper in PAPERS_MM
        ),
        Artefact(
            f"{stem}.svg",
            svg_drawing(artwork, mask, title),
            svg_to_sensor(mask),
            facts=_facts(artwork, mask),
        ),
        Artefact(f"{stem}.dxf", dxf_drawing(artwork, mask), dxf_to_sensor()),
        Artefact(f"mask/{finger.name}_cut.dxf", cut_drawing(artwork, mask), dxf_to_sensor()),
        Artefact(
            f"manual/{finger.name}_mask.svg",
            svg_drawing(artwork, mask, title, words=False),
            frame="",
        ),
    )


def _facts(artwork: Artwork, mask: Mask) -> Facts:
    """Apertures, size over all flaps and each flap, for the note on wrapping and its drawing."""
    ends = [y for _, y in artwork.cut.corners]
    return {
        "apertures": len(artwork.apertures),
        "wide_mm": 2 * max(abs(x) for x, _ in artwork.cut.corners),
        "long_mm": max(ends) - min(ends),
        "band_mm": BAND_MM,
        "foot_mm": FOOT_MM,
        "flaps": [
            {
                "number": flap.number,
                "width_mm": flap.width_mm,
                "length_mm": flap.length_mm,
                "reach_mm": flap.reach_mm,
                "on_back": flap.on_back(mask.allowance_mm),
            }
            for flap in artwork.flaps
        ],
    }

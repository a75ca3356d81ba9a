"""Every file of one finger's mask but its printed sheet, which is a part: pages, drawings, and the
note on how to make it by its route and wrap the finger with it."""

from xml.sax.saxutils import escape

from lumitip_fab.design import Design, Finger
from lumitip_fab.design.making import HeatedPart
from lumitip_fab.mask.artwork import PAPERS_MM, Artwork, artwork_of
from lumitip_fab.mask.drawings import (
    cut_drawing,
    dxf_drawing,
    dxf_to_sensor,
    svg_drawing,
    svg_to_sensor,
)
from lumitip_fab.mask.flaps import BAND_MM, Flap
from lumitip_fab.mask.outline import FOOT_MM
from lumitip_fab.mask.pdf import pdf_page, pdf_to_sensor
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.text import as_written, data_file, passage

_TEXTS = "mask/wrapping.md"


def wrapping_note(artwork: Artwork, design: Design) -> bytes:
    """The bytes of the note, in Markdown, for the mask's route.

    Args:
        artwork: of this finger, for its flaps.
        design: for the mask, what it and the finger bear, and their heights.
    """
    mask, stack, title = design.mask, design.stack, design.title
    flaps = sorted(artwork.flaps, key=lambda flap: flap.number)
    shortened = [str(f.number) for f in flaps if f.length_mm < mask.flap_mm]
    shorter = (
        f"Flaps {', '.join(shortened)} are shorter than {mask.flap_mm:g} mm for that, or because\n"
        "neighbours would overlap where the outline bends inward."
        if shortened
        else f"All flaps are {mask.flap_mm:g} mm long."
    )
    across, up = mask.measured_ruler_mm
    ends = [y for _, y in artwork.cut.corners]
    what = "sheet" if mask.route == "tpu" else "film"
    text = (passage(_TEXTS, mask.route) + passage(_TEXTS, "table")).format(
        title=as_written(f"{title.name} {title.revision}"),
        name=artwork.name.lower(),
        NAME=artwork.name,
        material=mask.material,
        film_mm=stack.film_mm,
        across=across,
        up=up,
        count=len(artwork.apertures),
        hole_mm=mask.hole_mm,
        wide_mm=2 * max(abs(x) for x, _ in artwork.cut.corners),
        long_mm=max(ends) - min(ends),
        side_mm=stack.plate_mm + stack.cover_mm,
        band_mm=BAND_MM,
        infrared=_infrared(design),
        fold=passage(_TEXTS, "fold").format(last=len(flaps), what=what),
        table="\n".join(map(_row, flaps)),
        foot_mm=FOOT_MM,
        shorter=shorter,
        **(_printed(design) if mask.route == "tpu" else _creased(design)),
    )
    return text.encode()


def _infrared(design: Design) -> str:
    """How the mask's material is tested."""
    coupon, route = design.mask.coupon, design.mask.route
    size = f"{coupon.width_mm:.0f} x {coupon.length_mm:.0f} mm"
    piece = passage(_TEXTS, f"coupon_{route}").format(size=size)
    return passage(_TEXTS, "infrared").format(coupon=piece, other=passage(_TEXTS, f"other_{route}"))


def _weakest(design: Design) -> HeatedPart:
    """The part of a finger that bears the least heat."""
    return min(design.heat_steps["cure"].parts, key=lambda part: part.limit_c)


def creasing_files(design: Design) -> tuple[Artefact, ...]:
    """The drawing of how a fold is creased with local heat; none of a sheet that is bent cold."""
    if design.mask.route == "tpu":
        return ()
    weakest = _weakest(design)
    drawing = data_file("mask/creasing.svg").format(
        soften_c=design.heat_steps["crease"].temperature_c,
        film="film, printed side down" if design.mask.route == "film" else "film, inside down",
        part=weakest.name,
        material=escape(weakest.material),
        limit_c=weakest.limit_c,
    )
    return (Artefact("mask/creasing.svg", drawing.encode(), frame=""),)


def _creased(design: Design) -> dict[str, object]:
    """Figures of a film that is creased with heat."""
    weakest = _weakest(design)
    return {
        "crease": passage(_TEXTS, "crease").format(
            soften_c=design.heat_steps["crease"].temperature_c
        ),
        "weakest": f"{weakest.name} of {weakest.material}",
        "finger_c": weakest.limit_c,
    }


def _printed(design: Design) -> dict[str, object]:
    """Figures of a sheet from a 3D printer."""
    sheet = design.mask.sheet
    letter = ", and the first letter of the finger's name on the tip flap," * sheet.letter
    return {
        "layers": "one layer" if sheet.layers == 1 else f"{sheet.layers} layers",
        "layer_mm": sheet.layer_mm,
        "line_mm": sheet.line_mm,
        "settings": design.slicing.sheet.file,
        "known": (
            f"Grooves along the folds{letter}\n   are on the inside. Where a flap turns onto the "
            "back there is none:\n   bend it there over a steel ruler."
            if sheet.layers > 1
            else "A fold runs from one foot of its flap to the other. Bend it over a steel ruler."
        ),
    }


def _row(flap: Flap) -> str:
    return f"| {flap.number} | {flap.width_mm:.1f} | {flap.length_mm:.1f} | {flap.reach_mm:.1f} |"


def mask_files(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """The mask of a finger on paper, as a drawing, to cut from an opaque film, and the note on
    wrapping by its route."""
    mask, title = design.mask, design.title
    artwork = artwork_of(design, finger, mask)
    stem = f"mask/{finger.name}_mask"
    note = wrapping_note(artwork, design)
    flaps = [
        {"number": flap.number, "on_back": flap.on_back(mask.allowance_mm)}
        for flap in artwork.flaps
    ]
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
            facts={"flaps": flaps},
        ),
        Artefact(f"{stem}.dxf", dxf_drawing(artwork, mask), dxf_to_sensor()),
        Artefact(f"mask/{finger.name}_cut.dxf", cut_drawing(artwork, mask), dxf_to_sensor()),
        Artefact(f"mask/{finger.name}_wrapping.md", note, frame=""),
    )

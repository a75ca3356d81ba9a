"""The making of a mask by its route, and the wrapping of a finger with it: for the note beside each
mask and for the manual."""

import math
from typing import Any

from lumitip_fab.design import Design, Finger
from lumitip_fab.design.making import MaskShift
from lumitip_fab.docs.steps import WorkStep
from lumitip_fab.pipeline.artefact import Artefact, Facts, Files
from lumitip_fab.text import as_written, passage

_TEXTS = "docs/wrapping.md"
_TITLES = {
    "film": "printing and wrapping",
    "cut": "cutting and wrapping",
    "tpu": "printing and wrapping",
}
_CREASED = (("mask/creasing.svg", "A fold, creased on a bar"),)
_FOLDED = tuple(
    (f"manual/{name}_folded.svg", f"The {name} from behind: its flaps in the order of folding")
    for name in ("emitter", "receiver")
)
_LIP_END = "; dashed, where the silicone ends"
_BEYOND_MM, _BOND_MM = 1.0, 2.0
"""Of the tip's flap: from the lip of silicone to its bond, and what a bond needs at least."""
_STEPS = {
    "film": (
        ("Print the film", "film", ()),
        ("Test, cut and crease the film", "film_cut", _CREASED),
        ("Wrap the finger", "film_wrap", _FOLDED),
    ),
    "cut": (
        ("Cut the film", "cut", ()),
        ("Crease the folds", "cut_crease", _CREASED),
        ("Wrap the finger", "cut_wrap", _FOLDED),
    ),
    "tpu": (
        ("Print the sheets", "tpu", ()),
        ("Wrap the finger", "tpu_wrap", _FOLDED),
    ),
}
"""By the mask's route: title, passage and drawings of each step."""


def wrapping_files(design: Design, files: Files) -> tuple[Artefact, ...]:
    """The note of each finger."""
    return tuple(
        Artefact(
            f"mask/{finger.name}_wrapping.md",
            wrapping_note(design, finger, mask_facts(files, finger)).encode(),
            frame="",
        )
        for finger in design.fingers
    )


def mask_facts(files: Files, finger: Finger) -> Facts:
    """Apertures, size and flaps of a finger's mask."""
    return files.facts(f"mask/{finger.name}_mask.svg")


def wrapping_note(design: Design, finger: Finger, mask: Facts) -> str:
    """The note of a finger as Markdown.

    Args:
        design: for the mask, what it and the finger bear, and their heights.
        finger: for its name.
        mask: facts of its mask.
    """
    name = as_written(f"{design.title.name} {design.title.revision}")
    head = f"# {name}: {_TITLES[design.mask.route]} the {finger.name} mask"
    steps = wrapping_steps(design, mask, finger.name)
    return "\n\n".join([head, *(step.note() for step in steps), _flaps(design, mask)]) + "\n"


def wrapping_steps(design: Design, mask: Facts, name: str) -> list[WorkStep]:
    """The work in its order.

    Args:
        design: for the mask, what it and the finger bear, and their heights.
        mask: facts of a finger's mask.
        name: of the finger, as it stands in the names of the files.
    """
    values = _values(design, mask, name)
    return [
        WorkStep(
            title,
            passage(_TEXTS, text).format(**values) + _signs(design, text),
            tuple((path, caption + _lip_end(design, path)) for path, caption in drawings),
        )
        for title, text, drawings in _STEPS[design.mask.route]
    ]


def _signs(design: Design, text: str) -> str:
    what = _what(design)
    return passage(_TEXTS, "wrap_signs").format(what=what) if text.endswith("_wrap") else ""


def _lip_end(design: Design, drawing: str) -> str:
    """A drawing of the folded flaps shows where the skin ends on the back, if it does."""
    return _LIP_END if design.props and drawing.endswith("_folded.svg") else ""


def _lip(design: Design, facts: Facts) -> str:
    """Where the tip's flap is bonded beside a skin that is wrapped round the tip."""
    if not design.props:
        return ""
    lip_mm = design.mould.lip_length_mm(design.outline, design.tip)
    reach_mm = next(flap["reach_mm"] for flap in facts["flaps"] if flap["number"] == 1)
    name = "lip" if reach_mm >= lip_mm + _BEYOND_MM + _BOND_MM else "lip_only"
    return passage(_TEXTS, name).format(lip_mm=lip_mm, from_mm=math.ceil(lip_mm + _BEYOND_MM))


def _off(shift: MaskShift | None) -> str:
    """How far both masks may be off, of a design that it was computed for."""
    return "" if shift is None else passage(_TEXTS, "off").format(**vars(shift))


def _what(design: Design) -> str:
    return "sheet" if design.mask.route == "tpu" else "film"


def _values(design: Design, facts: Facts, name: str) -> dict[str, object]:
    mask, stack = design.mask, design.stack
    across, up = mask.measured_ruler_mm
    fold = passage(_TEXTS, "fold").format(last=len(facts["flaps"]), what=_what(design))
    return {
        "name": name,
        "material": mask.material,
        "film_mm": stack.film_mm,
        "across": across,
        "up": up,
        "count": facts["apertures"],
        "hole_mm": mask.sizes_text,
        "wide_mm": facts["wide_mm"],
        "long_mm": facts["long_mm"],
        "side_mm": stack.plate_mm + stack.cover_mm,
        "band_mm": facts["band_mm"],
        "infrared": _infrared(design),
        "fold": fold,
        "held": passage(_TEXTS, "held").format(tape=design.mould.tape),
        "lip": _lip(design, facts),
        "off": _off(mask.shift),
        "tape": design.mould.tape,
        **(_printed(design) if mask.route == "tpu" else _creased(design)),
    }


def _flaps(design: Design, facts: Facts) -> str:
    """The table of the flaps."""
    flaps: list[dict[str, Any]] = sorted(facts["flaps"], key=lambda flap: int(flap["number"]))
    most_mm = design.mask.flap_mm
    shortened = [str(flap["number"]) for flap in flaps if flap["length_mm"] < most_mm]
    shorter = (
        f"Flaps {', '.join(shortened)} are shorter than {most_mm:g} mm for that, or because\n"
        "neighbours would overlap where the outline bends inward."
        if shortened
        else f"All flaps are {most_mm:g} mm long."
    )
    rows = (
        f"| {flap['number']} | {flap['width_mm']:.1f} | {flap['length_mm']:.1f} "
        f"| {flap['reach_mm']:.1f} |"
        for flap in flaps
    )
    return passage(_TEXTS, "flaps").format(
        table="\n".join(rows), foot_mm=facts["foot_mm"], shorter=shorter
    )


def _infrared(design: Design) -> str:
    """How the mask's material is tested."""
    coupon, route = design.mask.coupon, design.mask.route
    size = f"{coupon.width_mm:.0f} x {coupon.length_mm:.0f} mm"
    piece = passage(_TEXTS, f"coupon_{route}").format(size=size)
    return passage(_TEXTS, "infrared").format(coupon=piece, other=passage(_TEXTS, f"other_{route}"))


def _creased(design: Design) -> dict[str, object]:
    """Figures of a film that is creased with heat."""
    weakest = design.heat_steps["cure"].weakest
    return {
        "crease": passage(_TEXTS, "crease").format(
            soften_c=design.heat_steps["crease"].temperature_c
        ),
        "weakest": weakest.title,
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

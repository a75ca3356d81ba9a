"""The note for the person who pours: amounts, and the work from the mould's print to the skin."""

from collections.abc import Mapping

from lumitip_fab.design import Clamp, Mould, Stack
from lumitip_fab.text import passage

_TEXTS = "parts/casting.md"


def silicone_mix(volume_ml: float, mould: Mould) -> dict[str, float]:
    """How much silicone to mix for a finger, with what stays in the cup; masses as weighed."""
    mix_ml = volume_ml * (1 + mould.waste_fraction)
    a, b = mould.mix_ratio
    mass_g = mix_ml * mould.density_g_ml
    return {
        "volume_ml": volume_ml,
        "mix_ml": mix_ml,
        "part_a_g": round(mass_g * a / (a + b), 2),
        "part_b_g": round(mass_g * b / (a + b), 2),
    }


def casting_note(
    finger: str,
    mix: Mapping[str, float],
    stack: Stack,
    mould: Mould,
    glue: str,
    keys: int,
    open_back: bool,
    clamps: tuple[Clamp, ...],
) -> str:
    """The note as Markdown.

    Args:
        finger: its name.
        mix: silicone that stays on it, and what to mix.
        stack: for the height of the stops.
        mould: its layers, the silicone, and how much is wasted.
        glue: title of what holds the board, or the interface.
        keys: how many holes beside the board are to be filled.
        open_back: whether windows or holes go through the plate.
        clamps: the printed clamp; none where tape holds the finger.
    """
    rim_mm = mould.floor_mm + stack.cover_mm
    bare = _text("bare", keys=keys) if keys else ""
    openings = "window" if stack.sunk else "window and every hole for thread"
    taped = _text("taped", tape=mould.tape, openings=openings, bare=bare) if open_back else ""
    held = _text(
        "in_pocket" if stack.sunk else "on_plate",
        glue=glue,
        glue_hard_h=mould.glue_hard_h,
        taped=taped,
    )
    layers = _text(
        "part" if mould.off_layer_mm else "whole",
        floor_mm=mould.floor_mm,
        recess="".join(_text("recess", depth_mm=mould.wall_mm) for _ in mould.inserts),
        rim_mm=rim_mm,
        off_mm=mould.off_layer_mm,
    )
    primed = "primed" if mould.primer else "unprimed"
    return _text(
        "note",
        finger=finger,
        letter=finger[0].upper(),
        letter_on="the back of its block" if stack.sunk else "its back",
        board=held,
        primed=_text(primed, primer=mould.primer, primer_dry_min=mould.primer_dry_min),
        inhibited_by=", ".join(mould.inhibited_by),
        waste=mould.waste_fraction,
        silicone=mould.silicone,
        **mix,
        cure_h=mould.cure_h,
        cure_c=mould.cure_c,
        layer_mm=mould.layer_mm,
        layers=layers,
        keys=_text("keyed", keys=keys) if keys else "",
        tip_mm=mould.tip_silicone_mm,
        **_inserted(mould),
        **_clamped(mould, clamps, stack.sunk),
    )


def _clamped(mould: Mould, clamps: tuple[Clamp, ...], rigid: bool) -> dict[str, str]:
    """How the finger is held down, and let go; the tip of a plate that bends by tape as well."""
    for clamp in clamps:
        pads_n = clamp.pads_n(clamp.thickness_mm)
        return {
            "screwed": _text("screwed", clamp=clamp) + "\n   ",
            "clamped": _text("clamped", pads_n=pads_n)
            + ("" if rigid else _text("tip_taped", tape=mould.tape)),
            "unclamped": _text("unclamped"),
        }
    held = _text("taped_down", tape=mould.tape)
    return {"screwed": "", "clamped": held, "unclamped": _text("untaped")}


def _inserted(mould: Mould) -> dict[str, str]:
    """How the smooth film is cut, laid into the mould and taken off; nothing without one."""
    for insert in mould.inserts:
        names = "insert", "laid", "peeled"
        texts = {name: _text(name, insert=insert) for name in names}
        return texts | {"laid": texts["laid"] + "\n   "}
    return {"insert": "", "laid": "", "peeled": ""}


def _text(name: str, /, **values: object) -> str:
    """A passage of the note with its values."""
    return passage(_TEXTS, name).format(**values)

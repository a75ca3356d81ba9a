"""The casting of the skin: amounts, and the steps from the board in its backing to the finger out
of its mould; for the note beside each mould and for the manual."""

import math
from collections.abc import Mapping

from lumitip_fab.design import Design, Finger, Mould, Mount
from lumitip_fab.docs.steps import WorkStep, numbered
from lumitip_fab.pipeline.artefact import Artefact, Files
from lumitip_fab.text import passage

_TEXTS = "docs/casting.md"


def casting_files(design: Design, files: Files) -> tuple[Artefact, ...]:
    """The note for the person who pours, for each finger; its facts are the masses."""
    return tuple(
        Artefact(
            f"mould/{finger.name}_casting.md",
            casting_note(design, finger, mix).encode(),
            frame="",
            facts=mix,
        )
        for finger in design.fingers
        for mix in [silicone_mix(volume_ml(finger, files), design.mould)]
    )


def volume_ml(finger: Finger, files: Files) -> float:
    """Silicone that stays on a finger."""
    return float(files.facts(f"mould/{finger.name}_mould.stl")["cast_ml"])


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


def casting_note(design: Design, finger: Finger, mix: Mapping[str, float]) -> str:
    """The note of a finger as Markdown, with what to mix."""
    steps = casting_steps(design, (finger,))
    moulds = _moulds(design, f"`{finger.name}_mould.3mf`") + " " + heights(design)
    parts = (f"# Casting the {finger.name} finger", amounts(design.mould, mix), moulds)
    return "\n\n".join([*parts, *(step.note() for step in steps)]) + "\n"


def amounts(mould: Mould, mix: Mapping[str, float]) -> str:
    """The table of what to weigh."""
    return _text(
        "amounts",
        waste=mould.waste_fraction,
        silicone=mould.silicone,
        cure_h=mould.cure_h,
        cure_c=mould.cure_c,
        **mix,
    )


def amounts_of_both(mould: Mould, mixes: Mapping[str, Mapping[str, float]]) -> str:
    """The table of what to weigh for each finger, by its name."""

    def each(figure: str, unit: str, bold: str = "") -> str:
        return " | ".join(f"{bold}{mix[figure]:.2f} {unit}{bold}" for mix in mixes.values())

    return _text(
        "weighed_both",
        names=" | ".join(mixes),
        volumes=each("volume_ml", "mL"),
        waste=mould.waste_fraction,
        mixes=each("mix_ml", "mL"),
        silicone=mould.silicone,
        parts_a=each("part_a_g", "g", "**"),
        parts_b=each("part_b_g", "g", "**"),
    )


def casting_steps(design: Design, fingers: tuple[Finger, ...], weighed: str = "") -> list[WorkStep]:
    """The work in its order.

    Args:
        design: for all that is used.
        fingers: that are made.
        weighed: table of what to weigh, where it does not stand before the steps.
    """
    mould = design.mould
    smooth = (
        WorkStep("Cut the smooth film", _text("insert", insert=insert, tape=mould.tape))
        for insert in mould.inserts
    )
    held = "Clamp it, and wait" if design.clamps else "Tape it down, and wait"
    on_it = (
        "The clamp on finger and mould; below, as its marks are looked at"
        if design.clamps
        else "The finger in its mould"
    )
    filled = "\n\n".join(filter(None, [weighed, _filled(design)]))
    return [
        _drawn("board", "Put the board in", _held(design, fingers), _board_caption(design)),
        _drawn("mould", "Try the mould", _fitted(design), "The mould from above, the tip up"),
        *smooth,
        _drawn("drop", "Try the silicone", _tried(design), "Where the drop goes"),
        _drawn("filled", "Fill the mould", filled, "The mould, cut along its middle"),
        _drawn(
            "lowered",
            "Lower the finger",
            _lowered(design),
            "The tip on its stop, the gripper end coming down; cut along the middle",
        ),
        _drawn("clamped", held, _clamped(design), on_it),
        _drawn("lifted", "Take the finger out", _out(design), "The gripper end comes first"),
    ]


def _drawn(drawing: str, title: str, text: str, caption: str) -> WorkStep:
    return WorkStep(title, text, ((f"manual/{drawing}.svg", caption),))


def _board_caption(design: Design) -> str:
    finds = "its holes go over the pins" if design.stack.sunk else "hole goes over hole"
    return f"The board above its place: {finds}"


def _moulds(design: Design, moulds: str) -> str:
    """How a mould is printed."""
    return _text("moulds", moulds=moulds, layer_mm=design.mould.layer_mm)


def heights(design: Design) -> str:
    """Heights of a mould that count, and the letter by which it is known."""
    mould = design.mould
    layers = _text(
        "part" if mould.off_layer_mm else "whole",
        floor_mm=mould.floor_mm,
        recess="".join(_text("recess", depth_mm=mould.wall_mm) for _ in mould.inserts),
        rim_mm=mould.stops_mm(design.stack.cover_mm),
        off_mm=mould.off_layer_mm,
    )
    letter_on = "the back of its block" if design.stack.sunk else "its back"
    return _text("heights", layers=layers, letter_on=letter_on)


def _held(design: Design, fingers: tuple[Finger, ...]) -> str:
    """How the board is fixed, and what is closed before silicone comes."""
    mould, sunk = design.mould, design.stack.sunk
    bare = _text("bare", keys=len(design.keys)) if design.keys else ""
    openings = "window" if sunk else "window and every hole for thread"
    taped, tape = "", ""
    if opened := [finger.name for finger in fingers if open_back(design, finger)]:
        number = 4 if sunk else 3
        close = "Close" if len(opened) == len(fingers) else f"On the {opened[0]}, close"
        taped = _text(
            "taped", number=number, close=close, tape=mould.tape, openings=openings, bare=bare
        )
        tape = f"{mould.tape}, "
    name = "pocket" if sunk else "plate"
    groove_mm = design.board.pocket_clearance_mm + design.board.roof_mm
    glue = {"glue": design.strength.glue, "glue_hard_h": mould.glue_hard_h, "groove_mm": groove_mm}
    glue |= {"rest_mm": rest_mm(design.mount)}
    return _text(name, taped=taped, tape=tape, **glue)


def rest_mm(mount: Mount) -> int:
    """Height of what a finger lies on, face up: more than its block stands out."""
    return 10 * math.ceil(mount.block_back_w_mm / 10)


def open_back(design: Design, finger: Finger) -> bool:
    """Whether windows or holes for a thread go through the plate."""
    return bool(design.interfaces) or any(relief.through for relief in finger.reliefs)


def _fitted(design: Design) -> str:
    """Finger and clamp, tried in the empty mould."""
    work, needs, good = [_text("cleaned")], "", "it lies on tip line and both pads"
    for clamp in design.clamps:
        work.append(_text("screwed", clamp=clamp))
        needs = f"the clamp, {clamp.screw.name} screws and nuts, a screwdriver, a spanner, "
        good += ", and the marks are in one line at four corners"
    work.append(_text("laid_dry"))
    work += [_text("clamped_dry") for _ in design.clamps]
    work.append(_text("lifted_dry"))
    high = _text("high_dry") if design.clamps else ""
    return _text("fitted", needs=needs, good=good, work=numbered(work), high=high)


def _tried(design: Design) -> str:
    mould, primed = design.mould, design.mould.primer != ""
    beside = ": plate, board and the glue round the board" if design.stack.sunk else ""
    for _ in design.props:
        lip_mm = mould.lip_length_mm(design.outline, design.tip)
        beside += ";" if beside else ":"
        beside += f" and a strip of {lip_mm + 1:.0f} mm along the tip's edge on its back"
    first = _text(
        "primed" if primed else "unprimed",
        primer=mould.primer,
        primer_dry_min=mould.primer_dry_min,
    )
    return _text(
        "tried",
        silicone=mould.silicone,
        inhibited_by=", ".join(mould.inhibited_by),
        trial_g=_trial(mould),
        rest_mm=rest_mm(design.mount),
        spot=f"{'across the glue round' if design.stack.sunk else 'beside'} the board",
        drying=f", twice {mould.primer_dry_min:g} min to dry" * primed,
        primer=f"{mould.primer}, a fine brush, " * primed,
        primed=first + "\n",
        film=", and one on a piece that is left over of the smooth film" if mould.inserts else "",
        peels=_text("peels") if mould.inserts else "",
        then="go on with 3" if primed else "cast",
        primed_all=_text("primed_all", beside=beside) if primed else "",
        longer="let the glue harden longer, " * design.stack.sunk,
        reprimed=", prime it, and try another drop" * primed,
        cure_h=mould.cure_h,
        cure_c=mould.cure_c,
    )


def _trial(mould: Mould) -> str:
    """Amounts for a few drops."""
    a, b = mould.trial_g
    return f"{a:g} g of part A with {b:g} g of part B, and stir it for three minutes"


def _filled(design: Design) -> str:
    pot_life_min = design.mould.pot_life_min
    pot = _text("pot_known" if pot_life_min else "pot_unknown", pot_life_min=pot_life_min)
    work = [_text("weighed", pot=pot), _text("wetted")]
    work += [_text("laid") for _ in design.mould.inserts]
    props = design.mould.props
    work += [_text("levelled") for _ in props[:1]]
    work += [_text("propped", prop=prop) for prop in props] or [_text("level")]
    work.append(_text("poured_all" if props else "poured"))
    needs = [f"`mould/{prop.name}.3mf`, printed, " for prop in design.props]
    needs += ["the smooth film, a plastic card, " for _ in design.mould.inserts]
    full = "the silicone bulges over the weir and the stops"
    if props:
        full = "the silicone covers the tip line, and comes near to both pads"
    return _text("filled", needs="".join(needs), work=numbered(work), full=full)


def _lowered(design: Design) -> str:
    keys = _text("keyed", keys=len(design.keys)) if design.keys else ""
    stick = "a wooden stick, " if design.keys else ""
    return _text(
        "lowered", keys=keys, stick=stick, covered=_text("covered") if design.props else ""
    )


def _clamped(design: Design) -> str:
    """How the finger is held down; the tip of a plate that bends by tape as well."""
    mould, bends = design.mould, not design.stack.sunk
    stands = "on its prop" if mould.props else "level"
    times = {"cure_h": mould.cure_h, "cure_c": mould.cure_c, "stands": stands}
    lip_mm = mould.lip_length_mm(design.outline, design.tip)
    dry = f", {lip_mm + 1:.0f} mm or more from its edge, off the silicone" if mould.props else ""
    tip = _text("tip_taped", tape=mould.tape, dry=dry) if bends else ""
    for clamp in design.clamps:
        pads_n = clamp.pads_n(clamp.thickness_mm)
        tape = f"{mould.tape}, " * bends
        return _text("clamped", clamp=clamp, pads_n=pads_n, tip_taped=tip, tape=tape, **times)
    return _text("taped_down", tape=mould.tape, tip_taped=tip, **times)


def _out(design: Design) -> str:
    mould, bends = design.mould, not design.stack.sunk
    held = ["the clamp with its nuts"] if design.clamps else []
    taped = bends or not design.clamps or any(open_back(design, f) for f in design.fingers)
    held += ["all tape"] * taped
    return _text(
        "out",
        cure_h=mould.cure_h,
        held=" and ".join(held),
        tip_mm=mould.tip_silicone_mm,
        wrapped=_text("wrapped", lip_mm=mould.lip_length_mm(design.outline, design.tip))
        if mould.props
        else "",
        peeled="".join(_text("peeled", insert=insert) for insert in mould.inserts),
        unheld="it was not primed there." if mould.primer else "it was not clean there.",
    )


def _text(name: str, /, **values: object) -> str:
    """A passage of the note with its values."""
    return passage(_TEXTS, name).format(**values)

"""Steps that heat something, and what their parts bear."""

from dataclasses import replace

from lumitip_fab.catalogue.materials import Laminate
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import is_flex
from lumitip_fab.derive.making.warmth import in_use_c, most_heat_w
from lumitip_fab.design import Electrical, HeatedPart, HeatStep, Mould, Outline, Slicing

JOINT_C = 250.0
"""A joint of lead-free solder, under an iron or in reflow. SAC305 melts at 217 to 220 °C."""
_REMEDY = {
    "solder": ("stack.pcb_mm", "a laminate in parts/laminates.toml that withstands soldering"),
    "cure": (
        "mould.silicone",
        "a silicone that cures at a lower temperature, or {other}",
    ),
    "crease": ("mask.film", "another film in parts/films.toml"),
    "use": (
        "emitter.max_heat_w",
        "{most_w:g} or less, a switch for the LEDs (emitter.switch), or {other}",
    ),
}
"""Field to refuse, and what to change, of each step."""
_OTHER = {
    "backing": "another filament (backing.material)",
    "glue": "another glue (backing.glue)",
    "insulation": "wires with another insulation, with its limit_c in parts/packs.toml",
    "primer": "another primer (mould.primer)",
    "tape": "another tape (mould.tape)",
    "thread": "another thread, with its limit_c in parts/packs.toml",
}
"""Other parts that can be chosen beside a silicone or a current."""
UNLOADED = ("primer", "tape")
"""Parts that bear nothing any more once the finger is in use."""


def derive_heat(
    config: Input,
    slicing: Slicing,
    mould: Mould,
    outline: Outline,
    figures: Electrical,
    faults: Diagnostics,
) -> tuple[HeatStep, ...]:
    """Soldering, curing, creasing unless a printed mask folds along its grooves, and use, in that
    order.

    Printing is none of them: it melts a filament, and heats no part that is already made.
    """
    p = config.parameters
    film, silicone = config.parts.mask.film, _silicone(config)
    printed = [("backing", slicing.backing.name), ("mould", slicing.mould.name)]
    if is_flex(p):
        printed.insert(1, ("interface", slicing.rigid.name))
    solder = HeatStep(
        "solder",
        "boards and wires, before a board goes into a printed part",
        JOINT_C,
        (replace(_board(config), limit_c=_laminate(config).solder_c),),
    )
    cure = HeatStep(
        "cure",
        "the finger in its mould",
        config.parts.mould.silicone.cure_c,
        (
            silicone,
            *(_printed(config, part, name) for part, name in printed),
            _board(config),
            *_joined(config),
            *_inserted(config, mould),
        ),
    )
    crease = HeatStep(
        "crease",
        "the film alone, over a metal edge",
        film.soften_c,
        (HeatedPart("film", config.title("mask.film"), film.limit_c),),
    )
    by_mask = HeatedPart("mask", p.mask.filament, config.parts.mask.filament.limit_c)
    use = HeatStep(
        "use",
        "the emitter's finger by its LEDs, in the still air of a room (an estimate)",
        in_use_c(figures, outline),
        (
            silicone,
            _printed(config, "backing", slicing.backing.name),
            _board(config),
            by_mask if p.mask.route == "tpu" else crease.parts[0],
            *(part for part in _joined(config) if part.name not in UNLOADED),
        ),
    )
    steps = (solder, cure, use) if p.mask.route == "tpu" else (solder, cure, crease, use)
    most_w = most_heat_w(figures, outline, use.limit_c)
    for step in steps:
        _refuse(step, config, faults, most_w)
    return steps


def _silicone(config: Input) -> HeatedPart:
    silicone = config.parts.mould.silicone
    return HeatedPart("silicone", config.title("mould.silicone"), silicone.limit_c)


def _printed(config: Input, part: str, filament: str) -> HeatedPart:
    return HeatedPart(part, filament, config.catalogue.filaments[filament].limit_c)


def _laminate(config: Input) -> Laminate:
    known = config.catalogue.laminates
    return known.flexible if is_flex(config.parameters) else known.rigid


def _board(config: Input) -> HeatedPart:
    kind = "polyimide" if is_flex(config.parameters) else "FR-4"
    return HeatedPart("board", kind, _laminate(config).limit_c)


def _joined(config: Input) -> tuple[HeatedPart, ...]:
    """Glue, primer, tape, wires and, on a bendable plate, the thread that holds the board."""
    backing, mould, packs = config.parts.backing, config.parts.mould, config.catalogue.packs
    names = {"insulation": "stranded wire"}
    if is_flex(config.parameters):
        names["thread"] = "waxed thread"
    known = [(part, name, packs[name]) for part, name in names.items() if name in packs]
    bought = [
        HeatedPart(part, pack.title or name, pack.limit_c)
        for part, name, pack in known
        if pack.limit_c is not None
    ]
    primed = mould.primer
    return (
        HeatedPart("glue", config.title("backing.glue"), backing.glue.limit_c),
        *([HeatedPart("primer", config.title("mould.primer"), primed.limit_c)] if primed else []),
        HeatedPart("tape", config.title("mould.tape"), mould.tape.limit_c),
        *bought,
    )


def _inserted(config: Input, mould: Mould) -> tuple[HeatedPart, ...]:
    """The film on the mould's floor."""
    film = config.parts.mould.insert
    return tuple(HeatedPart("insert", each.film, film.limit_c) for each in mould.inserts if film)


def _refuse(step: HeatStep, config: Input, faults: Diagnostics, most_w: float) -> None:
    """Refuse a step that heats a part beyond the limit of its material.

    Args:
        step: with its parts.
        config: for the value of the field to refuse.
        faults: where refusals are noted.
        most_w: heat of the LEDs that the finger bears in use.
    """
    field, remedy = _REMEDY[step.name]
    for part in step.parts:
        other = _OTHER.get(part.name, "a material that withstands it")
        faults.unless(
            step.temperature_c <= part.limit_c,
            "step_too_hot",
            field=field,
            step=step,
            part=part,
            remedy=remedy.format(other=other, most_w=most_w),
            value=config.value(field),
        )

"""Filaments and layers of the printed parts, and the steps that heat something."""

from dataclasses import replace

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import is_flex
from lumitip_fab.derive.making.warmth import in_use_c, most_heat_w
from lumitip_fab.design import Electrical, HeatedPart, HeatStep, Mould, Outline, Slicing
from lumitip_fab.design.making import Filament


def derive_slicing(config: Input, mould: Mould, faults: Diagnostics) -> Slicing:
    """Settings of the backing's filament, with the density of the spool at hand, of the one that
    everything else is printed from, of that one in the mould's layers, and of the mask's sheet."""
    p, known = config.parameters, config.catalogue.filaments
    name = p.backing.material
    other = known[name].rigid_parts or name
    good = other in known and known[other].rigid_parts is None
    faults.unless(good, "rigid_parts", name=name, other=other)
    bends = known[name].rigid_parts is not None
    faults.unless(
        bends == is_flex(p),
        "material_bends",
        name=name,
        kind="bends" if bends else "does not bend",
        needed="does not" if bends else "does",
    )
    rigid = other if good else name
    density = p.backing.density_g_ml
    printer = config.parts.printer.profile
    rest = _filament(config, rigid, density if rigid == name else known[rigid].density_g_ml)
    return Slicing(
        printer.nozzle_mm,
        _filament(config, name, density),
        rest,
        rest
        if mould.layer_mm == printer.layer_mm
        else replace(rest, layer_mm=mould.layer_mm, part="mould"),
        replace(
            _filament(config, p.mask.filament, config.parts.mask.filament.density_g_ml), part="mask"
        ),
    )


def _filament(config: Input, name: str, density_g_ml: float) -> Filament:
    entry = config.catalogue.filaments[name]
    return Filament(
        name,
        entry.kind,
        density_g_ml,
        entry.nozzle_c,
        entry.bed_c,
        entry.fan_percent,
        entry.speed_mm_s,
        entry.max_flow_mm3_s,
        entry.retract_mm,
        entry.layer_mpa,
        entry.layer_mpa if entry.plane_mpa is None else entry.plane_mpa,
        entry.bearing_mpa,
        config.parts.printer.profile.layer_mm,
    )


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
    p, known = config.parameters, config.catalogue
    film, silicone = config.parts.mask.film, config.parts.mould.silicone
    laminate = known.laminates.flexible if is_flex(p) else known.laminates.rigid
    kind = "polyimide" if is_flex(p) else "FR-4"
    printed = [("backing", slicing.backing.name), ("mould", slicing.mould.name)]
    if is_flex(p):
        printed.insert(1, ("interface", slicing.rigid.name))
    steps: tuple[HeatStep, ...] = (
        HeatStep(
            "solder",
            "boards and wires, before a board goes into a printed part",
            JOINT_C,
            (HeatedPart("board", kind, laminate.solder_c),),
        ),
        HeatStep(
            "cure",
            "the finger in its mould",
            silicone.cure_c,
            (
                HeatedPart("silicone", config.title("mould.silicone"), silicone.limit_c),
                *(HeatedPart(part, name, known.filaments[name].limit_c) for part, name in printed),
                HeatedPart("board", kind, laminate.limit_c),
                *_joined(config),
                *_inserted(config, mould),
            ),
        ),
    )
    if p.mask.route != "tpu":
        crease = HeatStep(
            "crease",
            "the film alone, over a metal edge",
            film.soften_c,
            (HeatedPart("film", config.title("mask.film"), film.limit_c),),
        )
        steps = (*steps, crease)
    steps = (*steps, _use(config, slicing, in_use_c(figures, outline)))
    for step in steps:
        most_w = most_heat_w(figures, outline, step.limit_c)
        _refuse(step, config, faults, most_w)
    return steps


def _use(config: Input, slicing: Slicing, temperature_c: float) -> HeatStep:
    """The finger warmed by its own LEDs; primer and tape bear no load then."""
    p, known, mask = config.parameters, config.catalogue, config.parts.mask
    laminate = known.laminates.flexible if is_flex(p) else known.laminates.rigid
    plate, sheet = slicing.backing.name, p.mask.filament
    masked = HeatedPart("film", config.title("mask.film"), mask.film.limit_c)
    if p.mask.route == "tpu":
        masked = HeatedPart("mask", sheet, known.filaments[sheet].limit_c)
    return HeatStep(
        "use",
        "the emitter's finger by its LEDs, in the still air of a room (an estimate)",
        temperature_c,
        (
            HeatedPart(
                "silicone", config.title("mould.silicone"), config.parts.mould.silicone.limit_c
            ),
            HeatedPart("backing", plate, known.filaments[plate].limit_c),
            HeatedPart("board", "polyimide" if is_flex(p) else "FR-4", laminate.limit_c),
            masked,
            *(part for part in _joined(config) if part.name not in {"primer", "tape"}),
        ),
    )


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
    """Refuse a step that heats a part beyond the limit of its material; of the LEDs' own heat,
    `most_w` is what it bears."""
    field, remedy = _REMEDY[step.name]
    for part in step.parts:
        faults.unless(
            step.temperature_c <= part.limit_c,
            "step_too_hot",
            field=field,
            step=step,
            part=part,
            remedy=remedy.format(
                other=_OTHER.get(part.name, "a material that withstands it"), most_w=most_w
            ),
            value=config.value(field),
        )

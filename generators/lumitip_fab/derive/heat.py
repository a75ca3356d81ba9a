"""The steps that heat something, and the materials that would not bear it."""

from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.flex import is_flex
from lumitip_fab.design import HeatedPart, HeatStep, Slicing
from lumitip_fab.load import Input

JOINT_C = 250.0
"""A joint of lead-free solder, under an iron or in reflow. SAC305 melts at 217 to 220 °C."""
_REMEDY = {
    "solder": ("stack.pcb_mm", "a laminate in parts/laminates.toml that bears soldering"),
    "cure": (
        "mould.silicone",
        "a silicone that cures cooler, or parts of a filament that bears it",
    ),
    "crease": ("mask.film", "another film in parts/films.toml"),
}
"""Field to refuse, and what to change, of each step."""


def derive_heat(given: Input, slicing: Slicing, faults: Faults) -> tuple[HeatStep, ...]:
    """Soldering, curing and creasing, in the order of work.

    Printing is none of them: it melts a filament, and heats no part that is already made.
    """
    p, known = given.parameters, given.catalogue
    film, silicone = known.films[p.mask.film], known.silicones[p.mould.silicone]
    laminate = known.laminates.flexible if is_flex(p) else known.laminates.rigid
    kind = "polyimide" if is_flex(p) else "FR-4"
    printed = [("backing", slicing.backing.name), ("mould", slicing.mould.name)]
    if is_flex(p):
        printed.insert(1, ("interface", slicing.rigid.name))
    steps = (
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
                HeatedPart("silicone", given.title("mould.silicone"), silicone.limit_c),
                *(HeatedPart(part, name, known.filaments[name].limit_c) for part, name in printed),
                HeatedPart("board", kind, laminate.limit_c),
            ),
        ),
        HeatStep(
            "crease",
            "the film alone, over a metal edge",
            film.soften_c,
            (HeatedPart("film", given.title("mask.film"), film.limit_c),),
        ),
    )
    for step in steps:
        _refuse(step, given, faults)
    return steps


def _refuse(step: HeatStep, given: Input, faults: Faults) -> None:
    """Refuse a step that heats a part beyond the limit of its material."""
    field, remedy = _REMEDY[step.name]
    for part in step.parts:
        faults.refuse_unless(
            step.temperature_c <= part.limit_c,
            field,
            f"{given.value(field)!r} given; step {step.name!r} heats {step.place} to "
            f"{step.temperature_c:g} °C; the {part.name} of {part.material} bears at most "
            f"{part.limit_c:g} °C. Take {remedy}",
        )

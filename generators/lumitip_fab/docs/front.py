"""The manual's front: title, words, figures at a glance, tools, safety and heat."""

from collections.abc import Iterator

from lumitip_fab.design import Design, HeatStep, Mask, Mould
from lumitip_fab.docs.casting import rest_mm
from lumitip_fab.docs.mounting import has_cable_lugs
from lumitip_fab.text import as_written, passage

WARM_UP_MIN = 5
"""Until the readings stand still: Table I of the published sensor (arXiv 2306.05902)."""


def front(design: Design) -> str:
    """From the title to the first step."""
    return _text(
        "front",
        title=as_written(design.title.name),
        revision=design.title.revision,
        mould=design.mould,
        printing=design.printing,
        wiring=design.wiring,
        mount=design.mount,
        mask_rows=_mask_rows(design.mask),
        lit_ma=sum(design.wiring.current_ma),
        wires=sum(len(cable.wires) for cable in design.cabling.cables),
        bolts=len(design.mount.bolt_u_mm),
        rated_n=design.strength.rated_force_n,
        warm_up_min=WARM_UP_MIN,
        words="\n".join(_words(design)),
        keys=_keys(design),
        rest_mm=rest_mm(design.mount),
        nozzle_mm=design.slicing.nozzle_mm,
        board_tools=_board_tools(design),
        mask_tools=_text(f"tools_{design.mask.route}", soften_c=design.mask.soften_c),
        waiting=_waiting(design.mould) + _beside(design),
        heated="\n".join(map(_heated, design.heat)),
    )


def _words(design: Design) -> Iterator[str]:
    """Rows of the words that could be taken for one another."""
    yield _text("word_bends" if design.interfaces else "word_rigid")
    yield _text("word_block", mount=design.mount)
    if has_cable_lugs(design):
        yield _text("word_lug")
    if any(holder.arm_lugs for holder in design.holders):
        yield _text("word_arm_lug")
    for flange in design.flanges:
        yield _text("word_flange", flange=flange)


def _board_tools(design: Design) -> str:
    """For a module, panels, a socket on wires, a board that is tied on, and a smooth film."""
    module = any(board.module for board in design.auxiliary_boards)
    tools = ["hot air to solder with", "a programmer for SWD"] * module
    tools += ["pliers"] * bool(design.panels)
    tools += ["a small vice"] * bool(design.flanges) + ["a needle"] * bool(design.interfaces)
    tools += ["a plastic card"] * bool(design.mould.inserts)
    return "".join(f", {tool}" for tool in tools)


def _waiting(mould: Mould) -> str:
    """Hours that something hardens, one after the other."""
    glued = [f"{mould.glue_hard_h:g} h for the glue"] if mould.glue_hard_h else []
    cures = [f"{mould.cure_h:g} h for {what}" for what in ("a trial of the silicone", "the skin")]
    return ", then ".join([*glued, *cures, "what its label says for the flaps' adhesive"])


def _beside(design: Design) -> str:
    """How long the flange's pin hardens, which is glued while something else does."""
    hours = f"{design.mould.glue_hard_h:g} h" if design.mould.glue_hard_h else "some hours"
    return f"; meanwhile {hours} for the flange's pin" if design.flanges else ""


def _keys(design: Design) -> str:
    """Sizes of all screws."""
    others = {holder.screw for holder in design.holders}
    others |= {clamp.screw.name for clamp in design.clamps}
    others |= {thread for flange in design.flanges for thread in (flange.screw, flange.bolt)}
    return ", ".join(sorted({design.mount.bolt, *others}))


def _mask_rows(mask: Mask) -> str:
    """Material of the mask, and the temperature of its folds if they are creased."""
    if mask.route == "tpu":
        return f"| mask, printed | {mask.material} |"
    return f"| film | {mask.film} |\n| creasing the film, off the finger | {mask.soften_c:g} °C |"


def _heated(step: HeatStep) -> str:
    weakest = step.weakest
    return (
        f"| {step.name} | {step.place} | {step.temperature_c:g} °C "
        f"| {weakest.limit_c:g} °C ({weakest.name}: {as_written(weakest.material)}) |"
    )


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)

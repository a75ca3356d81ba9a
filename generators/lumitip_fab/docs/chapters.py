"""Text of the manual in Markdown: its own chapters, and the notes of the parts."""

import re
from typing import Any

from lumitip_fab.design import Design, Flange, HeatStep, Mask
from lumitip_fab.docs.bill import amount, money
from lumitip_fab.docs.boards import boards_chapter
from lumitip_fab.docs.spec_circuit import pulled_up
from lumitip_fab.pipeline.artefact import Files
from lumitip_fab.text import as_written

WARM_UP_MIN = 5
"""Until the readings stand still: Table I of the published sensor (arXiv 2306.05902)."""
WEAR_GRASPS = 100
"""After about so many grasps the published sensor's silicone had worn above the LEDs."""
_HEADING = re.compile(r"^(#+) ", re.MULTILINE)


def manual_text(design: Design, files: Files) -> str:
    """The whole manual. An image stands alone in its paragraph; its path is below the outputs."""
    chapters = (
        _front(design),
        _bought(files),
        _printed(files),
        boards_chapter(design, files),
        _wired(design, files),
        _cast(files),
        _wrapped(design, files),
        _mounted(design),
        _run(design),
        _kept(design.mask),
    )
    return "\n\n".join(chapter.strip() for chapter in chapters) + "\n"


def _front(design: Design) -> str:
    mould, mask, printing = design.mould, design.mask, design.printing
    lit_ma = sum(design.wiring.current_ma)
    fixed = "tie the boards on" if design.interfaces else "glue the boards in"
    return f"""# {as_written(design.title.name)} {design.title.revision}: build manual

Made from the design, with the drawings of the files beside it. File names are below the folder of
outputs. Read a chapter to its end before you begin with it.

![The receiver, exploded: what lies upon what](assembly/receiver_exploded.svg)

## At a glance

| figure | value |
|---|---|
| layers of the backings | {printing.layer_mm:g} mm |
| filament of the backings | {printing.material} |
| silicone | {mould.silicone} |
| curing at {mould.cure_c:g} °C | {mould.cure_h:g} h |
{_mask_rows(mask)}
| supply of the LEDs | {design.wiring.supply_v:g} V |
| current of the LEDs, nominal | {lit_ma:.1f} mA |
| wires | {sum(len(cable.wires) for cable in design.cabling.cables)} |
| gripper | {design.mount.title} |
| bolts for each finger | {len(design.mount.bolt_u_mm)} x {design.mount.bolt} |
| warm-up | {WARM_UP_MIN} min |

The order of work: print, order and solder boards, solder the wires on, {fixed}, cast,
{_ORDER[mask.route]}, wrap, mount, load the firmware, calibrate. Casting takes longest:
{mould.cure_h:g} h for each finger, both at once in their own moulds.

## Heat

These steps heat something, and no other does. Temperatures are the highest that a part reaches, and
below what each of them bears.

| step | what is heated | temperature | lowest limit |
|---|---|---:|---:|
{chr(10).join(map(_heated, design.heat))}"""


_MADE = {
    "film": "Print the film and wrap it",
    "cut": "Cut the film and wrap it",
    "tpu": "Print the masks and wrap them",
}
_ORDER = {
    "film": "print the film, crease it",
    "cut": "cut the film, crease it",
    "tpu": "print the masks",
}
"""Work before the wrapping, by the route of the mask."""


def _mask_rows(mask: Mask) -> str:
    """Material of the mask, and the temperature of its folds if they are creased."""
    if mask.route == "tpu":
        return f"| mask, printed | {mask.material} |"
    return f"| film | {mask.film} |\n| creasing the film, off the finger | {mask.soften_c:g} °C |"


def _heated(step: HeatStep) -> str:
    weakest = min(step.parts, key=lambda part: part.limit_c)
    return (
        f"| {step.name} | {step.place} | {step.temperature_c:g} °C "
        f"| {weakest.limit_c:g} °C ({weakest.name}: {as_written(weakest.material)}) |"
    )


def _bought(files: Files) -> str:
    bill = files.facts("bom.csv")
    lines = "\n".join(
        f"| {as_written(line['item'])} | {as_written(line['where'])} | {_how_much(line)} "
        f"| {money(line['price'])} |"
        for line in bill["lines"]
    )
    return f"""## 1. Parts

`bom.csv` has makers and order numbers too. Prices in {as_written(bill["prices"])}.

| what | for | how much | price |
|---|---|---:|---:|
{lines}
| all together | | | {money(bill["total"])} |"""


def _how_much(line: dict[str, Any]) -> str:
    """Pieces are counted; anything else has its unit."""
    unit = {"piece": "", "sheet": " sheets"}.get(line["unit"], f" {line['unit']}")
    return amount(line["quantity"]) + unit


def _printed(files: Files) -> str:
    return f"""## 2. Print

Print `fit/fit_plate.3mf` first: it takes some ten minutes, and its reading is `printer.fit_mm`.
Hold a board and the bolts against it, write the reading into the parameter file, build again, and
print the rest.

{_included(files.text("print/printing.md"))}"""


def _cast(files: Files) -> str:
    notes = "\n\n".join(_included(files.text(p)) for p in files.like("mould/*_casting.md"))
    return f"""## 5. Cast

The wires of chapter 4 are soldered before: they lie over the weir while the silicone cures.

{notes}"""


def _wrapped(design: Design, files: Files) -> str:
    mask = design.mask
    shown = "as it is printed" if mask.route == "film" else "outline, holes and folds"
    notes = "\n\n".join(
        f"![The {name} mask, {shown}](mask/{name}_mask.svg)\n\n"
        + _included(files.text(f"mask/{name}_wrapping.md"))
        for name in ("emitter", "receiver")
    )
    creased = f"creased at {mask.soften_c:g} °C, away from the finger, and wrapped"
    how = "The sheet is wrapped" if mask.route == "tpu" else f"The film is {creased}"
    return f"""## 6. {_MADE[mask.route]}

{how} cold, each
flap in the order of its number.

{notes}"""


def _wired(design: Design, files: Files) -> str:
    weak = f"{pins}.\n\n" if (pins := pulled_up(design.wiring)) else ""
    switched = design.wiring.emitter_pin is not None
    lit = "the LEDs are dark until the firmware runs, and" if switched else "the LEDs"
    return f"""## 4. Wire

![Wiring](wiring/wiring.svg)

{_included(files.text("wiring/cables.md"))}

{weak}Measure {design.wiring.supply_v:g} V and its polarity at the supply before the emitter is
connected; {lit} then draw about {sum(design.wiring.current_ma):.1f} mA."""


def _mounted(design: Design) -> str:
    flanged = "".join(_flanged(design, flange) for flange in design.flanges)
    return f"""## 7. Mount

Screw each finger on ({len(design.mount.bolt_u_mm)} x {design.mount.bolt}); emitter and receiver
face each other. Then join the cables of chapter 4 to their other ends.
{_held(design)}{flanged}
![Robot, gripper and fingers, exploded](assembly/system.svg)

Open and close the gripper slowly once: no wire may be drawn taut."""


def _held(design: Design) -> str:
    if design.holders:
        return (
            "The controller's board goes into `holder/holder.3mf`, whose arms clip round the "
            "gripper.\n"
        )
    if any(auxiliary.name == "breakout" for auxiliary in design.auxiliary_boards):
        return (
            f"Fix the controller's board beside the gripper: the body of {design.mount.title} "
            "is not round, so there is no holder for it (`holder.body_mm`).\n"
        )
    return ""


def _flanged(design: Design, flange: Flange) -> str:
    lit = "".join(
        f"""Before you close the flange, lay its contacts on those of the coupling, switch the
robot's tool output on, and look at D2 on the board's front: it lights {lit.colour} while the board
makes {lit.output_v:g} V. If it is dark, look for the fault before you go on: the test points beside
J2, J3 and the contacts have the names of their nets.

"""
        for lit in design.electrical.indicators
    )
    return f"""
Between robot and gripper: solder the spring contacts onto the back of the flange's board, cut every
solder tail under it to {flange.tail_mm:g} mm, and screw it into `flange/flange_lower.3mf` from
below, contacts towards the robot. Glue the locating pin in, lay `flange/flange_upper.3mf` on the
peg, and put all of it between the coupling and the gripper, with {len(flange.bolts)} bolts
{flange.bolt} that are {flange.top_z_mm:.1f} mm longer than before. Confirm first with the robot's
manual, or with a meter, that the coupling's contacts carry what the board's names say.

{lit}"""


def _run(design: Design) -> str:
    return f"""## 8. Firmware, warm-up and calibration

1. {_loading(design)}
2. Switch the LEDs' supply on and wait {WARM_UP_MIN} minutes: the readings drift while the finger
   warms.
3. `lumitip scan` finds the device by the `controller.name` of the parameter file. `lumitip doctor`
   with its address names dead, swapped and saturated cells.
4. Close the gripper on nothing, and run `lumitip tare`: it measures the empty grasp, against which
   everything else is read.
5. `lumitip view` shows the cells. Lay a card between the fingers: its edge must run where it is."""


def _loading(design: Design) -> str:
    """The first step: a module has no bootloader yet."""
    upload = "open `firmware/firmware.ino` in the Arduino IDE and upload it"
    if any(device.kind == "module" for c in design.auxiliary_boards for device in c.components):
        return (
            "Load the bootloader over J7 of the flange's board, solder a USB cable to J6, then\n"
            f"   {upload}; `firmware/README.md` has the steps."
        )
    return f"{upload[0].upper()}{upload[1:]}; `firmware/README.md` has the steps."


def _kept(mask: Mask) -> str:
    worn = "its black is rubbed off" if mask.route == "film" else "it is torn or has come loose"
    return f"""## 9. What wears

- The silicone above the LEDs: the published sensor's wore within about {WEAR_GRASPS} grasps. Run
  `lumitip doctor` now and then; cast the emitter anew when its light falls.
- The mask: where {worn}, light leaks in. Make and wrap a new one, as in chapter 6: it takes an
  hour.
- The wires at the fingers, which bend with each grasp.
- After each of these, tare again."""


def _included(note: str) -> str:
    """A note as a part of a chapter: its headings two levels lower."""
    return _HEADING.sub(lambda found: f"{found[1]}## ", note).strip()

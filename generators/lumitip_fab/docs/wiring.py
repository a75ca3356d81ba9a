"""`wiring/*`: the list of cables as a table and as a note, and the diagram."""

import csv
import io

from lumitip_fab.design import Cable, Cabling, Design, Wire
from lumitip_fab.design.cabling import named
from lumitip_fab.docs.diagram import diagram
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.text import as_written

COLUMNS = (
    "wire",
    "signal",
    "from_board",
    "from_pad",
    "to_board",
    "to_pad",
    "colour",
    "section_mm2",
    "length_mm",
    "current_ma",
)
_NOTE = """\
# Wiring {title}

Stranded copper, colours by IEC 60757; `wiring.svg` shows the same as a drawing. Pads are counted
from the square one: on a finger's board that is the leftmost, seen from the front with the tip up.
Put the wires of a finger in from the back of its board, solder them on the front, and cut the
joints short. Solder every board before it goes into a printed part, which an iron would melt.
{ties}
{tables}

Lengths are for each wire, rounded up to whole centimetres. From a finger: its reach on the finger,
{travel_mm:g} mm for half the gripper's stroke and {controller_mm:g} mm along the gripper; to the
supply {supply_mm:g} mm; and {slack_mm:g} mm each for bends and stripping.

{power}
- Measure a supply before it is connected: makers' colours differ from these. On the tool connector
  of Universal Robots' arms red is 0 V, and grey carries the voltage.
- Twist the wires of the emitter. Leave a loop at each finger, so that it opens without pulling.
"""
_TIED = """
Hold each cable at the {boards}: beside its row of wire pads are two holes of {hole_mm:g} mm. When
the wires are soldered, and before the board goes into a printed part, pass a waxed thread or a bare
wire of up to 1 mm through both, over the cable, and knot it behind the board. A pull is then on the
thread, not on the joints.{loose}
"""
_LOOSE = """ There is no room for such holes on the
board of {boards}: hold that cable to the gripper, near the finger."""
_FED = """\
- The wire of 5 V feeds the controller. Leave it away where it is fed over USB."""
_LIT = """\
- The wire of 5 V feeds LEDs and controller. Solder it even where the controller is fed over USB:
  the LEDs stay dark without it."""
_AT_FLANGE = """
- At the flange the wires end in a socket for its header {header}, whose contact 1 has the square
  pad."""
_ALONE = """\
- The controller is fed over USB. Its ground and that of the LEDs' supply need not be joined:
  between the fingers there is only light."""

_ALONE_SWITCHED = """\
- The controller is fed over USB. The wire LED of the emitter goes to its pin {pin}, not to the
  supply. Join the ground of the LEDs' supply with a ground pin of the controller: without it the
  LEDs cannot be switched."""
_SWITCHED = """
- High on the wire LED turns the LEDs on. While it is open, or the controller has no firmware, they
  stay dark."""

_MODULE = """\
- The controller is on the flange's board and fed by it. Solder the wires into the pads of that
  board before it goes into the flange."""


def cable_list(cabling: Cabling) -> str:
    """One line for each wire, in order of their numbers."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(COLUMNS)
    for cable in cabling.cables:
        for wire in cable.wires:
            writer.writerow(
                (
                    wire.number,
                    wire.signal,
                    wire.start.board,
                    wire.start.label,
                    wire.end.board,
                    wire.end.label,
                    wire.colour,
                    f"{cable.section_mm2:g}",
                    f"{cable.length_mm:g}",
                    f"{wire.current_ma:.2f}",
                )
            )
    return file.getvalue()


def wiring_note(design: Design) -> str:
    """The wires with what to mind, in Markdown."""
    title, cabling = design.title, design.cabling
    return _NOTE.format(
        ties=_tied(design),
        title=as_written(f"{title.name} {title.revision}"),
        tables="\n\n".join(map(_table, cabling.cables)),
        power=_power(cabling),
        travel_mm=cabling.travel_mm,
        controller_mm=cabling.controller_mm,
        supply_mm=cabling.supply_mm,
        slack_mm=cabling.slack_mm,
    )


def _tied(design: Design) -> str:
    """The step that holds the cables; empty where no board has holes for a thread."""
    ties = {f.name: f.ties for f in design.fingers}
    ties |= {board.name: board.ties for board in design.auxiliary_boards}
    tied = [name for name, found in ties.items() if found]
    if not tied:
        return ""
    loose = [finger.name for finger in design.fingers if not finger.ties]
    return _TIED.format(
        boards=_listed(tied),
        hole_mm=ties[tied[0]][0].hole_mm,
        loose=_LOOSE.format(boards=_listed(loose)) if loose else "",
    )


def _listed(names: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def _power(cabling: Cabling) -> str:
    """How the controller comes by its supply, and what switches the LEDs."""
    wires = (wire for cable in cabling.cables for wire in cable.wires)
    switching = [wire for wire in wires if wire.signal == "LED"]
    said = _fed_by(cabling)
    if switching and switching[0].end.board == "controller":
        said = _ALONE_SWITCHED.format(pin=switching[0].end.pin)
    return said + (_SWITCHED if switching else "")


def _fed_by(cabling: Cabling) -> str:
    """How the controller comes by its supply."""
    if cabling.cables[1].end.board == "flange":
        return _MODULE
    if not fed(cabling):
        return _ALONE
    headers = {w.end.connector for w in cabling.cables[2].wires if w.end.board == "flange"}
    lit = any(wire.signal == "5V" for wire in cabling.cables[0].wires)
    return (_LIT if lit else _FED) + "".join(
        _AT_FLANGE.format(header=header) for header in sorted(headers)
    )


def fed(cabling: Cabling) -> bool:
    """Whether a wire feeds the controller."""
    return any(wire.signal == "5V" for cable in cabling.cables[2:] for wire in cable.wires)


def _table(cable: Cable) -> str:
    start, end = cable.start.board, cable.end.board
    head = f"""\
## {cable.name}: {start} to {end}, {cable.length_mm:g} mm of {cable.section_mm2:g} mm²

| wire | colour | {start} | signal | {end} | at most (mA) |
|---|---|---|---|---|---:|
"""
    return head + "\n".join(map(_row, cable.wires))


def _row(wire: Wire) -> str:
    current = f"{wire.current_ma:.2f}" if wire.current_ma else "–"
    return (
        f"| {wire.number} | {wire.colour} {named(wire.colour)} | {wire.start.label} "
        f"| {wire.signal} | {wire.end.label} | {current} |"
    )


def wiring_files(design: Design) -> tuple[Artefact, ...]:
    """The list of cables as a table and as a note, and the diagram."""
    title, cabling = design.title, design.cabling
    return (
        Artefact("wiring/cables.csv", cable_list(cabling).encode(), frame=""),
        Artefact(
            "wiring/cables.md",
            wiring_note(design).encode(),
            frame="",
        ),
        Artefact("wiring/wiring.svg", diagram(title, cabling).encode(), frame=""),
    )

"""`wiring/*`: the list of cables as a table and as a note, and the diagram; the two steps of the
work, for the note and for the manual."""

import csv
import io

from lumitip_fab.design import Cable, Cabling, Design, Pack, Tie, Wire
from lumitip_fab.design.cabling import (
    COLOURS,
    SLOT_MM,
    SLOT_MM2,
    STRIP_MM,
    THREAD_MM,
    awg,
    codes_of,
    named,
    outer_mm,
)
from lumitip_fab.docs.diagram import diagram
from lumitip_fab.docs.spec_circuit import pulled_up
from lumitip_fab.docs.steps import WorkStep
from lumitip_fab.pipeline.artefact import Artefact
from lumitip_fab.text import as_written, listed, passage

_TEXTS = "docs/wiring.md"

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
    """The steps of the work in Markdown."""
    name = as_written(f"{design.title.name} {design.title.revision}")
    steps = (step.note() for step in wiring_steps(design))
    return "\n\n".join([f"# Wiring {name}", *steps]) + "\n"


def wiring_steps(design: Design) -> tuple[WorkStep, ...]:
    """The wires that are cut, and how they are soldered in and held."""
    lengths = ("manual/lengths.svg", "Each wire, and the cables to scale")
    cut = WorkStep("Cut the wires", _cut(design), (lengths,))
    shown = ("wiring/wiring.svg", "Wiring")
    return cut, WorkStep("Solder the wires", _soldered(design), (shown,))


def _cut(design: Design) -> str:
    cabling = design.cabling
    marked = _marked(cabling, design.purchase.pack("stranded wire"))
    sections = sorted({cable.section_mm2 for cable in cabling.cables})
    return passage(_TEXTS, "cut").format(
        wires=listed([f"stranded wire of {mm2:g} mm² (AWG {awg(mm2)})" for mm2 in sections]),
        tables="\n\n".join(map(_table, cabling.cables)),
        marked=marked,
        strip_mm=STRIP_MM,
        pen="a permanent pen, " * bool(marked),
        travel_mm=cabling.travel_mm,
        controller_mm=cabling.controller_mm,
        beyond=_beyond(cabling),
        supply_mm=cabling.supply_mm,
        slack_mm=cabling.slack_mm,
        loop=min(cabling.loops, key=lambda loop: loop.radius_mm / loop.least_mm),
    )


def _beyond(cabling: Cabling) -> str:
    """The way of the emitter's cable past the board."""
    return passage(_TEXTS, "beyond").format(cabling=cabling) if cabling.beyond_mm else ""


def _soldered(design: Design) -> str:
    return passage(_TEXTS, "soldered").format(
        but=", but for the flange's" * any(board.module for board in design.auxiliary_boards),
        ties_needed=", waxed thread" * any(boards_with_ties(design).values()),
        ties=_tied(design),
        power=_power(design),
        weak=f"{pins}.\n\n" if (pins := pulled_up(design.wiring)) else "",
    )


def _marked(cabling: Cabling, pack: Pack | None) -> str:
    """Wires whose colour is not in the set that is bought: of another one, marked with a pen."""
    wires = [wire for cable in cabling.cables for wire in cable.wires]
    known = pack.colours if pack else ()
    others = [wire for wire in wires if wire.colour not in known]
    if not known or not others:
        return ""
    marks = "; ".join(f"{wire.number} {_mark(wire.colour, known)}" for wire in others)
    return passage(_TEXTS, "marked").format(count=len(known), wires=marks)


def _mark(colour: str, known: tuple[str, ...]) -> str:
    """A wire out of the set and its mark, such as `"white, marked pink"`."""
    ground, *marks = codes_of(colour)
    if ground not in known:
        ground, marks = "WH", [ground, *marks]
    return f"{COLOURS[ground][0]}, marked {' and '.join(COLOURS[code][0] for code in marks)}"


def boards_with_ties(design: Design) -> dict[str, tuple[Tie, ...]]:
    """Pairs of holes for a thread, by the name of their board."""
    ties = {f.name: f.ties for f in design.fingers}
    return ties | {board.name: board.ties for board in design.auxiliary_boards}


def _tied(design: Design) -> str:
    """How the cables are held; empty where no board has holes for a thread."""
    ties = boards_with_ties(design)
    tied = [name for name, found in ties.items() if found]
    if not tied:
        return ""
    loose = [finger.name for finger in design.fingers if not finger.ties]
    held = "hold that cable to the gripper, near the finger"
    if design.mount.lugs:
        held = "there the tie at the finger's lug holds the cable"
    return passage(_TEXTS, "tied").format(
        boards=listed(tied),
        hole_mm=ties[tied[0]][0].hole_mm,
        thread_mm=THREAD_MM,
        loose=passage(_TEXTS, "loose").format(boards=listed(loose), held=held) if loose else "",
    )


def _power(design: Design) -> str:
    """How the controller comes by its supply, and what switches the LEDs."""
    cabling = design.cabling
    wires = (wire for cable in cabling.cables for wire in cable.wires)
    switching = [wire for wire in wires if wire.signal == "LED"]
    said = _seated(cabling) + _fed_by(design)
    if switching and switching[0].end.board == "controller":
        said = passage(_TEXTS, "alone_switched").format(pin=switching[0].end.pin)
    return said + (passage(_TEXTS, "switched") if switching else "")


def _seated(cabling: Cabling) -> str:
    """How the controller goes onto its board, where there is one."""
    boards = {wire.end.board for cable in cabling.cables for wire in cable.wires}
    return passage(_TEXTS, "seated") if "breakout" in boards else ""


def _fed_by(design: Design) -> str:
    """How the controller comes by its supply, joined to its wire or behind a diode."""
    cabling, joined = design.cabling, not (design.feed and design.feed.diode)
    if cabling.cables[1].end.board == "flange":
        (flange,) = design.flanges
        return passage(_TEXTS, "module").format(tail_mm=flange.tail_mm)
    if not fed(cabling):
        return passage(_TEXTS, "alone")
    plugged = [w for w in cabling.cables[2].wires if w.end.board == "flange"]
    headers = {wire.end.connector for wire in plugged}
    contacts = ", ".join(f"{w.number} goes to contact {w.end.pin}" for w in plugged)
    lit = any(wire.signal == "5V" for wire in cabling.cables[0].wires)
    feeds = ("lit" if lit else "fed") + ("_joined" if joined else "")
    return passage(_TEXTS, feeds) + "".join(
        passage(_TEXTS, "at_flange").format(header=header, contacts=contacts)
        for header in sorted(headers)
    )


def ends_of_fingers(design: Design) -> set[str]:
    """Where the wires of the fingers end: names of boards, or `"controller"`."""
    fingers = {finger.name for finger in design.fingers}
    cables = [cable for cable in design.cabling.cables if cable.start.board in fingers]
    return {wire.end.board for cable in cables for wire in cable.wires} - {"supply"}


def pressed(cabling: Cabling) -> str:
    """How wires come into a socket for flat cable."""
    section_mm2 = cabling.cables[2].section_mm2
    thick = section_mm2 > SLOT_MM2 or outer_mm(section_mm2) > SLOT_MM
    return passage(_TEXTS, "pressed_flat" if thick else "pressed").format(slot_mm=SLOT_MM)


def fed(cabling: Cabling) -> bool:
    """Whether a wire feeds the controller."""
    return any(wire.signal == "5V" for cable in cabling.cables[2:] for wire in cable.wires)


def _table(cable: Cable) -> str:
    start, end = cable.start.board, cable.end.board
    head = f"""\
### {cable.name}: {start} to {end}, {cable.length_mm:g} mm of {cable.section_mm2:g} mm²

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

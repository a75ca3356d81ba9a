"""The way of each cable: what holds it at both ends, and how much of it stays free."""

from collections.abc import Iterator

from lumitip_fab.design import Design
from lumitip_fab.design.cabling import Terminal, front_headers
from lumitip_fab.docs.wiring import boards_with_ties
from lumitip_fab.text import passage


def cable_ways(design: Design) -> str:
    """The table of all cables, for the step in which they are tied."""
    loops = {loop.cable: f"{loop.length_mm:.0f} mm" for loop in design.cabling.loops}
    rows = [
        f"| {cable.name}: {cable.start.board} to {cable.end.board} "
        f"| {', '.join(_held(design, cable.start)) or 'nothing'} "
        f"| {loops.get(cable.name, 'none of it')} "
        f"| {', '.join(_held(design, cable.end)) or 'nothing'} |"
        for cable in design.cabling.cables
    ]
    return passage("docs/chapters.md", "ways").format(rows="\n".join(rows))


def _held(design: Design, end: Terminal) -> Iterator[str]:
    """Threads, ties and sockets that hold an end, from its pads on."""
    ties = boards_with_ties(design)
    for tie in ties.get(end.board, ()):
        if tie.ref == end.connector:
            yield f"thread beside {end.connector}"
    fingers = {finger.name for finger in design.fingers}
    if end.board in fingers and design.mount.lugs:
        yield "block's cable lug"
    elif end.board in fingers and not ties[end.board]:
        yield "tie round the gripper"
    for holder in design.holders:
        named = [lug.name for lug in holder.lugs if holder.auxiliary == end.board]
        yield from (f"cable lug {name}" for name in named if name == end.connector)
    if end.board == "supply":
        yield "its terminals"
    elif (end.board, end.connector) in _headers(design):
        yield f"socket at {end.connector}"


def _headers(design: Design) -> set[tuple[str, str]]:
    """Board and reference of each header that a socket goes onto."""
    return {
        (board.name, part.ref) for board in design.auxiliary_boards for part in front_headers(board)
    }

"""Sentences of `cables.md` that name a wire, against the list of cables."""

import re
from collections.abc import Iterable, Iterator

from lumitip_fab.checks.cables import Row
from lumitip_fab.checks.result import Measurement, count
from lumitip_fab.design import Design
from lumitip_fab.design.cabling import COLOURS, codes_of, front_headers

_NOTE = "wiring/cables.md"
_WIRE = r"W\d+\.\d+"
_SOCKET = re.compile(r"a socket for its header (\w+):(.*?)\. Contact 1\s", re.DOTALL)
_CONTACT = re.compile(rf"({_WIRE}) goes to contact (\d+)")
_SET = re.compile(r"is in the set of (\d+) ")
_MARKED = re.compile(rf"({_WIRE}) ([a-z]+), marked ([a-z]+(?: and [a-z]+)*)")
_CODES = {word: code for code, (word, _) in COLOURS.items()}


def measure_prose(text: str, rows: Iterable[Row], design: Design) -> Iterator[Measurement]:
    """Contacts of the sockets, marks with a pen, and wires that are named in no such sentence."""
    prose = "\n".join(line for line in text.splitlines() if not line.startswith(("|", "#")))
    wires = tuple(rows)
    wrong = list(_wrong_contacts(prose, wires, design))
    yield count("wiring.contacts", _NOTE, wrong, "contacts that the list has otherwise")
    wrong = list(_wrong_marks(prose, wires, design))
    yield count("wiring.marks", _NOTE, wrong, "wires whose ground or marks are of other colours")
    rest = _MARKED.sub("", _CONTACT.sub("", prose))
    yield count("wiring.named", _NOTE, re.findall(_WIRE, rest), "wires in unknown sentences")


def _wrong_contacts(prose: str, rows: tuple[Row, ...], design: Design) -> Iterator[str]:
    """Headers whose socket has other contacts than the list, or is not spoken of."""
    headers = {
        (board.name, part.ref) for board in design.auxiliary_boards for part in front_headers(board)
    }
    wanted: dict[str, set[tuple[str, str]]] = {}
    for row in rows:
        header, _, contact = row.end[1].partition(".")
        if (row.end[0], header) in headers:
            wanted.setdefault(header, set()).add((row.wire, contact))
    found: dict[str, set[tuple[str, str]]] = {}
    for header, contacts in _SOCKET.findall(prose):
        found.setdefault(header, set()).update(_CONTACT.findall(contacts))
    for header in sorted({*wanted, *found}):
        pairs = wanted.get(header, set()) ^ found.get(header, set())
        yield from (f"{wire} at contact {at} of {header}" for wire, at in sorted(pairs))
    lone = set(_CONTACT.findall(prose)) - set().union(*found.values())
    yield from (f"{wire} at contact {at} of no header" for wire, at in sorted(lone))


def _wrong_marks(prose: str, rows: tuple[Row, ...], design: Design) -> Iterator[str]:
    """Wires of a colour that the bought set lacks, and of which the note has no such mark: on a
    wire of the colour's ground where the set has it, on a white one elsewhere."""
    pack = design.purchase.pack("stranded wire")
    known = pack.colours if pack else ()
    wanted = {row.wire: codes_of(row.colour) for row in rows if row.colour not in known}
    found = {wire: (ground, marks) for wire, ground, marks in _MARKED.findall(prose)}
    if not known:
        wanted = {}
    yield from sorted(wanted.keys() ^ found.keys())
    for wire in sorted(wanted.keys() & found.keys()):
        ground, *marks = wanted[wire]
        if ground not in known:
            ground, marks = "WH", [ground, *marks]
        words = [found[wire][0], *found[wire][1].split(" and ")]
        if [_CODES.get(word) for word in words] != [ground, *marks]:
            yield f"{wire} {found[wire][0]}, marked {found[wire][1]}"
    counts = {int(number) for number in _SET.findall(prose)}
    if counts != ({len(known)} if wanted else set()):
        yield "number of colours in the set"

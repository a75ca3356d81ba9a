"""The cable of a gripper on a flange, whose board lies between its contacts and the robot's: one
from the board's headers, or its maker's, which leads past the flange.

Wires of the fingers keep to a density of current that warms no bundle. The gripper's are few and
short: here a contact's own rating is the limit.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from lumitip_fab.design.cabling import INPUT_END, SLOT_A, Cable
from lumitip_fab.design.pcb import AuxiliaryBoard
from lumitip_fab.design.warming import bearable_a


@dataclass(frozen=True)
class GripperCable:
    """What the flange's headers have for a gripper."""

    headers: tuple[str, ...]
    """References of those with a line of the robot, or its supply before the fuse, sorted."""
    fed_from: tuple[str, ...]
    """Contacts that have the robot's supply before the fuse, such as `"J3.7"`."""
    most_a: float
    """Largest current over those contacts, there and back, over the tracks that lead to them and
    over the robot's contacts, beside that of the sensor; in whole tenths."""
    supply_a: float
    """Largest that the gripper draws; 0 where it is not known."""

    @property
    def feeds(self) -> bool:
        """Whether the headers feed the gripper, as far as its current is known."""
        return 0 < self.most_a >= self.supply_a

    @property
    def by_maker(self) -> bool:
        """Whether only its maker's cable will do: the headers have nothing for a gripper, or their
        supply carries less than it draws."""
        return not self.headers or (bool(self.fed_from) and not self.feeds)


def gripper_cable(
    boards: Iterable[AuxiliaryBoard],
    cables: Sequence[Cable],
    supply_a: float,
    track_mm: float,
    contact_a: float,
) -> GripperCable:
    """The cable of a gripper on a flange.

    Args:
        boards: for that of the flange.
        cables: which contacts they take, and what the sensor draws.
        supply_a: what the gripper draws at most; 0 where it is not known.
        track_mm: width of a supply's tracks.
        contact_a: what one of the flange's spring contacts carries.
    """
    ends = [wire for cable in cables for wire in cable.wires if wire.end.board == "flange"]
    taken = {wire.end.label for wire in ends}
    (board,) = (board for board in boards if board.name == "flange")
    headers: set[str] = set()
    supply, ground = [], []
    robot = {"supply": 0, "ground": 0}
    for part in board.components:
        if part.kind != "header":
            continue
        for number, net in part.nets:
            raw, contact = net.endswith(INPUT_END), f"{part.ref}.{number}"
            if part.side == "back":
                robot["supply"] += raw
                robot["ground"] += net == "GND"
            elif raw:
                supply.append(contact)
            elif net == "GND" and contact not in taken:
                ground.append(contact)
            if part.side == "front" and (raw or net not in board.supplies):
                headers.add(part.ref)
    there_a = min(contact_a * robot["supply"], contact_a * robot["ground"])
    left_a = min(there_a, bearable_a(track_mm, board.finish.copper_um)) - sensor_a(cables)
    carried_a = min(SLOT_A * len(supply), SLOT_A * len(ground), left_a)
    most_a = max(0.0, math.floor(10 * carried_a) / 10)
    return GripperCable(tuple(sorted(headers)), tuple(supply), most_a, supply_a)


def sensor_a(cables: Iterable[Cable]) -> float:
    """The sum of all wires that feed LEDs, receiver and controller: more than any of them carries.
    A controller on the flange's own board is not in it."""
    wires = (wire for cable in cables for wire in cable.wires)
    return sum(wire.current_ma for wire in wires if wire.signal != "GND") / 1000

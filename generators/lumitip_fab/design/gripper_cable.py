"""The cable of a gripper on a flange, whose board lies between its contacts and the robot's: one
from the board's headers, or its maker's, which leads past the flange."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from lumitip_fab.design.cabling import INPUT_END, SLOT_A, Cable, front_headers
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
    """Largest current over those contacts, there and back, and over the tracks that lead to them
    beside that of the sensor; in whole tenths."""
    supply_a: float
    """Largest that the gripper draws; 0 where it is not known."""

    @property
    def feeds(self) -> bool:
        """Whether the headers feed the gripper, as far as its current is known."""
        return bool(self.fed_from) and self.supply_a <= self.most_a

    @property
    def by_maker(self) -> bool:
        """Whether the gripper draws more than the contacts of its supply carry."""
        return bool(self.fed_from) and not self.feeds


def gripper_cable(
    auxiliary_boards: Iterable[AuxiliaryBoard],
    cables: Sequence[Cable],
    supply_a: float,
    track_mm: float,
) -> GripperCable:
    """The cable of a gripper; without headers for it where there is no flange.

    Args:
        auxiliary_boards: for that of the flange.
        cables: which contacts they take, and what the sensor draws.
        supply_a: what the gripper draws at most; 0 where it is not known.
        track_mm: width of a supply's tracks.
    """
    ends = [wire for cable in cables for wire in cable.wires if wire.end.board == "flange"]
    taken = {wire.end.label for wire in ends}
    headers: set[str] = set()
    supply, ground, most_a = [], [], 0.0
    for board in auxiliary_boards:
        if board.name != "flange":
            continue
        for part in front_headers(board):
            for number, net in part.nets:
                contact = f"{part.ref}.{number}"
                if net.endswith(INPUT_END):
                    supply.append(contact)
                elif net == "GND" and contact not in taken:
                    ground.append(contact)
                if net.endswith(INPUT_END) or net not in board.supplies:
                    headers.add(part.ref)
        left_a = bearable_a(track_mm, board.finish.copper_um) - sensor_a(cables)
        carried_a = min(SLOT_A * len(supply), SLOT_A * len(ground), left_a)
        most_a = max(0.0, math.floor(10 * carried_a) / 10)
    return GripperCable(tuple(sorted(headers)), tuple(supply), most_a, supply_a)


def sensor_a(cables: Iterable[Cable]) -> float:
    """More than LEDs, receiver and controller draw together: the sum of all wires that feed."""
    wires = (wire for cable in cables for wire in cable.wires)
    return sum(wire.current_ma for wire in wires if wire.signal != "GND") / 1000

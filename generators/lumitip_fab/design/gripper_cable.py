"""The cable of a gripper on a flange, whose board lies between its contacts and the robot's: one
from the board's headers, or its maker's, which leads past the flange."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from lumitip_fab.design.cabling import INPUT_END, SLOT_A, Cable, front_headers
from lumitip_fab.design.pcb import AuxiliaryBoard


@dataclass(frozen=True)
class GripperCable:
    """What the flange's headers have for a gripper."""

    headers: tuple[str, ...]
    """References of those with a line of the robot, or its supply before the fuse, sorted."""
    fed_from: tuple[str, ...]
    """Contacts that have the robot's supply before the fuse, such as `"J3.7"`."""
    most_a: float
    """Largest current over those contacts, there and back."""
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
    auxiliary_boards: Iterable[AuxiliaryBoard], cables: Sequence[Cable], supply_a: float
) -> GripperCable:
    """The cable of a gripper that draws `supply_a` at most; without headers for it where there is
    no flange."""
    wires = [wire for cable in cables for wire in cable.wires]
    taken = {wire.end.label for wire in wires if wire.end.board == "flange"}
    headers: set[str] = set()
    supply, ground = [], []
    for board in auxiliary_boards:
        for part in front_headers(board) if board.name == "flange" else ():
            for number, net in part.nets:
                contact = f"{part.ref}.{number}"
                if net.endswith(INPUT_END):
                    supply.append(contact)
                elif net == "GND" and contact not in taken:
                    ground.append(contact)
                if net.endswith(INPUT_END) or net not in board.supplies:
                    headers.add(part.ref)
    most_a = SLOT_A * min(len(supply), len(ground))
    return GripperCable(tuple(sorted(headers)), tuple(supply), most_a, supply_a)

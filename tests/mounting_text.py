"""What the manual says of flange, gripper's cable and mounting."""

from lumitip_fab.design import Design
from lumitip_fab.docs.flange import coupling_step, flange_board_step, flange_step
from lumitip_fab.docs.gripper_cable import gripper_cable
from lumitip_fab.docs.mounting import mounting_steps


def steps(design: Design) -> str:
    """The steps of flange and mounting, and what is said of the gripper's cable."""
    return words(" ".join([*map(gripper_cable, [design] * len(design.flanges)), work(design)]))


def work(design: Design) -> str:
    """The steps of flange and mounting, with their lines."""
    steps = [coupling_step(design, flange) for flange in design.flanges]
    steps += [flange_board_step(design, flange, "") for flange in design.flanges]
    steps += [flange_step(design, flange) for flange in design.flanges]
    return "\n\n".join([*steps, *mounting_steps(design)])


def words(text: str) -> str:
    """In one line."""
    return " ".join(text.split())

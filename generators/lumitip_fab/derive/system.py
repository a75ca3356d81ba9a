"""Heights from the robot's tool flange to the fingers, and what goes round the gripper's body."""

from lumitip_fab.derive.flex import held_by
from lumitip_fab.design import Flange, Holder, System
from lumitip_fab.load import Input

ROUND_MM = 2.0  # of a body's sides from the diameter that a holder is made for


def derive_system(given: Input, flanges: tuple[Flange, ...], holders: tuple[Holder, ...]) -> System:
    """The stack; without the printed flange it begins at the gripper."""
    body = held_by(given).envelope
    couplings = [given.catalogue.couplings[flange.coupling] for flange in flanges]
    gripper_z = sum(c.height_mm + f.top_z_mm for c, f in zip(couplings, flanges, strict=True))
    sides = (body.width_mm, body.depth_mm, 2 * body.corner_mm)
    return System(
        robot_mm=sum(coupling.robot_mm for coupling in couplings),
        coupling_mm=sum(coupling.height_mm for coupling in couplings),
        gripper_z_mm=gripper_z,
        width_mm=body.width_mm,
        depth_mm=body.depth_mm,
        corner_mm=body.corner_mm,
        length_mm=body.length_mm,
        reach_mm=body.reach_mm,
        load_kg=body.mass_kg + body.payload_kg,
        confidence=body.confidence,
        holders=tuple(
            holder.name
            for holder in holders
            if all(abs(side - holder.body_mm) <= ROUND_MM for side in sides)
        ),
        holder_z_mm=gripper_z + body.length_mm / 2,
    )

"""Every conversion between coordinate frames, as 4x4 matrices on column vectors, in mm.

- Sensor frame of a finger: gripping face seen with the tip up; x right, y to the tip, z out.
- Frame of an auxiliary board: see `lumitip_fab.design.pcb`; a holder prints standing on its end.
- Frame of a flange: see `lumitip_fab.design.mount`; both parts are printed as they are mounted.
- Mount frame: see `lumitip_fab.design.Mount`; what is bolted on is printed in it,
  standing on h = 0. The bed of the fit test plate is this frame, moved.
- Bed of the mould: the sensor frame turned over about x, so that the open side is up.
- Gripper frame: z = 0 is the mid-plane between the fingers, the lean applied; the receiver
  looks along +z. Opening is the smallest distance from skin to skin.
- Base of a robot's model: in the mount plane, midway between the fingers; x along the opening,
  from the receiver to the emitter, z to the tips. The tool centre point is the gripper frame's
  origin: between the middles of both grids.
- Tool frame: see `lumitip_fab.design.mount`; a holder's board looks along its -y.
- Page of a board file: seen from the board's front with the tip up, y down, as KiCad has it;
  z = 0 is the board's front, and looks to the back so that the frame stays right-handed.
- Page of a mask: seen from the film's inside, tip towards the top, so page x = -x of the
  finger's own frame; origin at the sensor frame's origin, before the page is stretched.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.design import (
    Clamp,
    Closing,
    Flange,
    GaugeCard,
    Holder,
    Mould,
    Mount,
    PocketCorner,
    Point,
    Prop,
    Stack,
    System,
)

Matrix = NDArray[np.float64]
BOARD_ON_PAGE_MM = (150.0, 100.0)
"""Where the sensor frame's origin lies on a board's page, which is an A4 sheet."""


def translation(x_mm: float, y_mm: float, z_mm: float) -> Matrix:
    """A shift."""
    matrix = np.eye(4)
    matrix[:3, 3] = x_mm, y_mm, z_mm
    return matrix


def rotation_x(angle_deg: float) -> Matrix:
    """A right-handed turn about x."""
    sine, cosine = np.sin(np.radians(angle_deg)), np.cos(np.radians(angle_deg))
    matrix = np.eye(4)
    matrix[1:3, 1:3] = ((cosine, -sine), (sine, cosine))
    return matrix


def rotation_y(angle_deg: float) -> Matrix:
    """A right-handed turn about y."""
    sine, cosine = np.sin(np.radians(angle_deg)), np.cos(np.radians(angle_deg))
    matrix = np.eye(4)
    matrix[0, 0], matrix[0, 2], matrix[2, 0], matrix[2, 2] = cosine, sine, -sine, cosine
    return matrix


def mount_to_sensor(mount: Mount, stack: Stack) -> Matrix:
    """From the mount frame (u, w, h), which is also the backing's print bed."""
    sine, cosine = np.sin(np.radians(mount.tilt_deg)), np.cos(np.radians(mount.tilt_deg))
    matrix = translation(0.0, mount.origin_y_mm, stack.rim_z_mm)
    matrix[:3, 1] = 0.0, -sine, -cosine
    matrix[:3, 2] = 0.0, cosine, -sine
    return matrix


def backing_bed_to_sensor(mount: Mount, stack: Stack) -> Matrix:
    """From a backing's print bed: a rigid one stands on its mount face, a bendable plate lies on
    its front."""
    if stack.sunk:
        return mount_to_sensor(mount, stack)
    return translation(0.0, 0.0, stack.face_z_mm) @ rotation_x(180.0)


def fit_corner_to_sensor(corner: PocketCorner, mount: Mount, stack: Stack) -> Matrix:
    """From the bed of the fit test plate to the receiver's sensor frame, of which its first coupon
    shows a corner."""
    x, y, z = corner.origin_mm
    return np.asarray(mount_to_sensor(mount, stack) @ translation(-x, -y, -z))


def plate_back_to_sensor(mount: Mount, stack: Stack) -> Matrix:
    """From the mount frame without its tilt: w is normal to the plate."""
    return mount_to_sensor(replace(mount, tilt_deg=0.0), stack)


def mould_bed_to_sensor(stack: Stack, mould: Mould) -> Matrix:
    """From the mould's print bed: its floor is `floor_mm` high below the silicone's face."""
    return translation(0.0, 0.0, stack.silicone_z_mm + mould.floor_mm) @ rotation_x(180.0)


def prop_bed_to_sensor(stack: Stack, mould: Mould, prop: Prop) -> Matrix:
    """From the print bed of a prop, stop up, as if the mould lay flat on it."""
    return mould_bed_to_sensor(stack, mould) @ translation(0.0, 0.0, -prop.height_mm)


def clamp_bed_to_sensor(stack: Stack, clamp: Clamp) -> Matrix:
    """From the print bed of a clamp, on which its flat back lies, to the sensor frame of a finger
    that it holds."""
    return translation(0.0, 0.0, stack.back_z_mm - clamp.foot_mm - clamp.thickness_mm)


def gauge_bed_to_sensor(card: GaugeCard) -> Matrix:
    """From the bed of a gauge card, on which its blade lies, to the sensor frame of the finger that
    its end E hugs."""
    return translation(0.0, 0.0, card.gap_mm) @ rotation_y(180.0)


def gauge_ends(card: GaugeCard) -> dict[str, Matrix]:
    """From the sensor frame of the finger that end E of a gauge card hugs, to that with the edge
    or the strip on the finger: end S is half a turn about z away."""
    half_turn = translation(0.0, 2 * card.middle_y_mm, 0.0) @ np.diag([-1.0, -1.0, 1.0, 1.0])
    return {"edge": np.eye(4), "strip": half_turn}


def gauge_to_receiver(card: GaugeCard, on: str) -> Matrix:
    """From the sensor frame of the finger that a gauge card hugs to the receiver's, both fingers on
    its frame."""
    turned = translation(0.0, 0.0, card.gap_mm) @ np.diag([-1.0, 1.0, -1.0, 1.0])
    return turned if on == "emitter" else np.eye(4)


def holder_bed_to_auxiliary(holder: Holder) -> Matrix:
    """From the print bed of a holder, which stands on its end at the lowest y, to the frame of
    the auxiliary board in it: bed x = x, bed y = -z, bed z = y."""
    matrix = translation(0.0, holder.outer.y_min_mm, 0.0)
    matrix[:3, :3] = ((1, 0, 0), (0, 0, 1), (0, -1, 0))
    return matrix


def flange_beds(flange: Flange) -> dict[str, Matrix]:
    """From the print beds of a flange's lower and upper part to the frame of the flange: each
    stands as it is mounted."""
    return {
        "lower": translation(0.0, 0.0, flange.seat_z_mm),
        "upper": translation(0.0, 0.0, flange.split_z_mm),
    }


def auxiliary_to_flange(flange: Flange) -> Matrix:
    """From the frame of the board in a flange to that of the flange."""
    return translation(*flange.board_at, flange.board_z_mm)


def finger_to_gripper(finger: str, mount: Mount, closing: Closing, opening_mm: float) -> Matrix:
    """From a finger's sensor frame to the gripper frame.

    Args:
        finger: `"emitter"` or `"receiver"`.
        mount: its coupling, for the lean.
        closing: where the fingers touch first.
        opening_mm: smallest distance from skin to skin.
    """
    leaned = rotation_x(mount.tilt_deg)
    receiver = translation(0.0, 0.0, -closing.contact_z_mm - opening_mm / 2) @ leaned
    turned = np.diag([-1.0, 1.0, -1.0, 1.0])  # half a turn about y
    return turned @ receiver if finger == "emitter" else receiver


def gripper_to_base(stack: Stack, mount: Mount, closing: Closing) -> Matrix:
    """From the gripper frame to the base of a robot's model."""
    plane = finger_to_gripper("receiver", mount, closing, 0.0) @ mount_to_sensor(mount, stack)
    turned = np.array([[0.0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    return np.asarray(translation(0.0, 0.0, -float(plane[1, 3])) @ turned)


def gripper_to_tool(stack: Stack, mount: Mount, closing: Closing, system: System) -> Matrix:
    """From the gripper frame to that of the robot's tool flange; the tool centre point is its
    origin."""
    up = translation(0.0, 0.0, system.gripper_z_mm + system.reach_mm)
    return np.asarray(up @ gripper_to_base(stack, mount, closing))


def flange_to_tool(system: System) -> Matrix:
    """From the frame of a flange to that of the robot's tool flange."""
    return translation(0.0, 0.0, system.coupling_mm)


def holder_to_tool(holder: Holder, system: System) -> Matrix:
    """From the frame of the auxiliary board in a holder to that of the robot's tool flange."""
    middle = (holder.outer.y_min_mm + holder.outer.y_max_mm) / 2
    matrix = translation(0.0, holder.axis_z_mm, system.holder_z_mm - middle)
    matrix[:3, :3] = ((1, 0, 0), (0, 0, -1), (0, 1, 0))
    return matrix


def holder_edge_mm(holder: Holder, system: System) -> float:
    """From the plane that the gripper stands on to the nearer edge of a holder."""
    return system.holder_z_mm - holder.outer.length_mm / 2 - system.gripper_z_mm


def sheet_bed_to_sensor() -> Matrix:
    """From the print bed of a mask's sheet, on which its outer face lies, to the sensor frame."""
    return rotation_y(180.0)


def sensor_to_page(measured_ruler_mm: Point) -> Matrix:
    """From a finger's sensor frame to its mask's page, stretched by what the rulers measured."""
    across, up = (100.0 / measured for measured in measured_ruler_mm)
    return np.diag([-across, up, 1.0, 1.0])


def board_page_to_sensor(stack: Stack) -> Matrix:
    """From the page of a finger's board file to its sensor frame."""
    across, down = BOARD_ON_PAGE_MM
    return translation(-across, down, stack.rim_z_mm) @ rotation_x(180.0)


def board_page_to_auxiliary(stack: Stack) -> Matrix:
    """From the page of an auxiliary board's board file to its frame, z = 0 on the board's back."""
    across, down = BOARD_ON_PAGE_MM
    return translation(-across, down, stack.auxiliary_mm) @ rotation_x(180.0)


def on_board_page(point: Point) -> Point:
    """A point of the sensor frame on the page of a finger's board file."""
    across, down = BOARD_ON_PAGE_MM
    return across + point[0], down - point[1]


def applied(matrix: Matrix, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points of shape `(n, 2)` or `(n, 3)` through a matrix, as `(n, 3)`."""
    flat = np.zeros((len(points), 4))
    flat[:, : points.shape[1]] = points
    flat[:, 3] = 1.0
    return np.asarray((flat @ matrix.T)[:, :3])

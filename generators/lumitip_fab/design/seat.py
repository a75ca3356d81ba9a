"""The bolts that hold a finger on the gripper, and the seats of their heads.

Lever model: the rated force turns the finger about a line near the edge of its foot. There plastic
presses on the gripper in a triangle, from nothing at the nearest bolt to most at the edge, whose
middle is a third of the way in; bolts pull by their distance from that line. The foot lies on the
gripper up to its back edge, or to that of the gripper's seat. Neither pre-load, nor pins and nose,
take part. Heads are the catalogue's, by ISO 4762.
"""

import math
from dataclasses import dataclass

from lumitip_fab.design.mount import Mount

NUT_FACTOR = 0.2
"""Torque of a bolt against its pull and thread, dry steel (Shigley, Mechanical Engineering Design,
torque factors K)."""
PRELOAD_SHARE = 0.5
"""Most of what plastic under a head bears, for the pre-load. A load adds almost wholly to it: bolts
are much stiffer than the plastic that they press."""


@dataclass(frozen=True)
class Foot:
    """Face of a finger that stands on the gripper, in the mount frame."""

    back_mm: float
    """Greatest w, no farther than the gripper's seat."""
    half_mm: float
    """Half width, no wider than the gripper's finger."""


@dataclass(frozen=True)
class Seated:
    """A finger's worst bolt under the rated force."""

    pull_n: float
    bearing_mpa: float
    """Pressure under its head."""
    shear_mpa: float
    """In the land round the head, along the bolt."""


def designed_foot(mount: Mount) -> Foot:
    """The foot by the coupling's figures."""
    back = min(mount.block_back_w_mm, mount.seat_back_w_mm)
    return Foot(back, min(mount.block_width_mm, mount.seat_width_mm) / 2)


def pull_n(force_n: float, arm_mm: float, mount: Mount, foot: Foot) -> float:
    """Greatest pull of a bolt, by a force at the tip, towards the back or sideways.

    Args:
        force_n: at the tip.
        arm_mm: its height over the mount plane.
        mount: for the bolts' axes.
        foot: its edges.
    """
    back = (mount.bolt_w_mm,) * len(mount.bolt_u_mm), foot.back_mm
    cases = (_by_lever(*case) for case in (back, (mount.bolt_u_mm, foot.half_mm)))
    return force_n * arm_mm * max(cases)


def _by_lever(bolts_mm: tuple[float, ...], edge_mm: float) -> float:
    """Greatest pull by a unit of moment; infinite where the edge is not beyond all bolts."""
    nearest = edge_mm - max(bolts_mm)
    if nearest <= 0:
        return math.inf
    away = [edge_mm - nearest / 3 - bolt for bolt in bolts_mm]
    return max(away) / sum(each**2 for each in away)


def designed_seat(mount: Mount, head_mm: float, pull: float) -> Seated:
    """The seat by the coupling's figures. Round a sleeve the land is thinner: what presses within
    its hole shears off there."""
    hole = mount.bolt_hole_mm
    area = math.pi / 4 * (head_mm**2 - hole**2)
    round_mm2 = math.pi * head_mm * mount.land_mm
    if not mount.sleeved:
        round_mm2 -= len(mount.pin_u_mm) * mount.pin_mm * mount.pin_depth_mm
        return Seated(pull, pull / area, pull / round_mm2)
    wide = min(mount.pin_mm, head_mm)
    within = (wide**2 - hole**2) / (head_mm**2 - hole**2)
    over_mm2 = math.pi * wide * (mount.land_mm - mount.pin_depth_mm)
    return Seated(pull, pull / area, pull * max(1 / round_mm2, within / over_mm2))


def torque_nm(thread_mm: float, bears_n: float, pull_n: float) -> float:
    """Torque that a bolt is tightened with, its head or what it clamps on plastic.

    Args:
        thread_mm: its diameter.
        bears_n: force on that plastic that breaks it.
        pull_n: greatest load.
    """
    preload_n = min(PRELOAD_SHARE * bears_n, bears_n - pull_n)
    return NUT_FACTOR * preload_n * thread_mm / 1000

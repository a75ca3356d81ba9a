"""How bolts through printed parts are tightened."""

import math

from lumitip_fab.design import Design, Flange
from lumitip_fab.design.seat import designed_foot, designed_seat, pull_n, torque_nm
from lumitip_fab.text import passage

ARM_SHARE = 5.0
"""Arm at which the key's short end is pushed, by the thread. For M3 to M5 that end is as long, or
a little longer (ISO 2936, from memory)."""
G_N_KG = 9.81


def flange_bolts(design: Design, flange: Flange) -> str:
    """The torque of the bolts through the flange, and how it is felt without a tool for it."""
    filament = design.slicing.of(f"flange/{flange.name}")
    bolt = design.threads[flange.bolt]
    area_mm2 = math.pi / 4 * (bolt.cap_head_mm**2 - flange.bolt_hole_mm**2)
    bears_n = filament.bearing_mpa * area_mm2
    return _tightened("tightened", design, flange.bolt, bears_n, 0.0, filament.name)


def finger_bolts(design: Design) -> str:
    """The torque of the bolts that hold a finger; how it is felt, if no flange's were before."""
    mount = design.mount
    filament = design.slicing.of("interface" if design.interfaces else "backing")
    one = designed_seat(mount, design.threads[mount.bolt].cap_head_mm, 1.0)
    bears_n = min(filament.bearing_mpa / one.bearing_mpa, filament.layer_mpa / one.shear_mpa)
    arm_mm = design.closing.contact_y_mm - mount.origin_y_mm
    load_n = pull_n(design.strength.rated_force_n, arm_mm, mount, designed_foot(mount))
    name = "tightened_too" if design.flanges else "tightened"
    return _tightened(name, design, mount.bolt, bears_n, load_n, filament.name)


def _tightened(
    name: str, design: Design, bolt: str, bears_n: float, load_n: float, filament: str
) -> str:
    thread_mm = design.threads[bolt].thread_mm
    torque = torque_nm(thread_mm, bears_n, load_n)
    arm_mm = ARM_SHARE * thread_mm
    return passage("docs/chapters.md", name).format(
        torque_nm=_rounded_down(torque),
        pushed_kg=_rounded_down(1000 * torque / arm_mm / G_N_KG),
        arm_mm=arm_mm,
        filament=filament,
    )


def _rounded_down(value: float) -> float:
    """With two digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return round(math.floor(value / step + 1e-9) * step, 9)

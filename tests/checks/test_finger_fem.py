"""Beam figures of a finger against finite elements on its written parts."""

import math
from pathlib import Path

import numpy as np
import pytest

from finger_fem import bent
from lumitip_fab.checks.strength import STEP_MM, finger_loads, loaded
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.beam import Layer, Vectors
from lumitip_fab.design.encoding import read_design
from lumitip_fab.design.frames import mount_to_sensor
from lumitip_fab.design.strength import Loaded
from lumitip_fab.design.torsion import torsion
from printed_fingers import written

pytestmark = pytest.mark.slow
BRICK_MM = (1.2, 0.8, 0.3)
COMPLIANT_BRICK_MM = (1.5, 0.8, 0.4)
BESIDE_MM = 1.0  # the interface's end, before its corner gathers the stress
WITHIN = 0.2
BEND_WITHIN = 0.1
ON_THE_SAFE_SIDE = 1.3  # at most, times the strain of the board's front by finite elements
OVER_MM = 4.0
OVERTURNED = 1.75
"""At most, the twist at the outermost cells over that by finite elements: the plate is short and
wide, and as stiff in its plane as the block holds it."""


def _loaded(preset: str, tmp_path: Path, design_dir: Path) -> tuple[Path, Design, Loaded]:
    """The written fingers of a preset, and its receiver as a beam."""
    made = derive(load(design_dir / "presets" / f"{preset}.toml"))
    out = written(made, made, tmp_path / preset)
    design = read_design(out / "design.json")
    to_mount = np.linalg.inv(mount_to_sensor(design.mount, design.stack))
    tip = to_mount @ (0.0, design.closing.contact_y_mm, design.stack.rim_z_mm, 1.0)
    return out, design, loaded(out, design, design.receiver, to_mount, float(tip[2]))


@pytest.mark.parametrize("preset", ["published", "franka_hand", "wsg50"])
def test_beam_and_finite_elements_agree(preset: str, tmp_path: Path, design_dir: Path) -> None:
    """Deflection of the tip; tension from layer to layer in the block, before the notch's corner
    gathers it; strain along the board's front over the flare, which the beam overrates."""
    out, design, of = _loaded(preset, tmp_path, design_dir)
    finger, mount, stack = design.receiver, design.mount, design.stack
    solved = bent(out, design, finger, BRICK_MM)
    found = finger_loads(out, design, finger)
    assert found.bend_mm == pytest.approx(solved.tip_mm, rel=BEND_WITHIN)
    assert solved.tip_mm < design.strength.most_bend_mm
    cosine, force = math.cos(math.radians(mount.tilt_deg)), design.strength.rated_force_n

    def beam(layer: Layer, y_mm: Vectors) -> Vectors:
        tension = of.beam.tension_mpa(layer) * force / layer.modulus_mpa
        return np.interp((y_mm - mount.origin_y_mm) * cosine, of.beam.h_mm, tension)

    block = np.arange(mount.origin_y_mm + 2.0, finger.notch.y_max_mm - 2.0, STEP_MM)
    pulled = solved.pulled(0.0, block[0], block[-1])
    assert float(beam(of.printed[0][0], block).mean()) == pytest.approx(pulled, rel=WITHIN)
    ramp_y = mount.ramp_end_y_mm(stack.back_z_mm, stack.rim_z_mm)
    flare = np.arange(ramp_y, ramp_y + mount.flare_mm - 2 * OVER_MM, STEP_MM)
    places = (0.0, design.board.box.x_max_mm / 2)
    front = [solved.front_strain(x, flare, stack.rim_z_mm, OVER_MM) for x in places]
    overrated = float(beam(of.board, flare).mean()) / float(np.mean(front))
    assert 1.0 <= overrated <= ON_THE_SAFE_SIDE


@pytest.mark.parametrize("preset", ["published", "wsg50"])
def test_twist_and_finite_elements_agree(preset: str, tmp_path: Path, design_dir: Path) -> None:
    """Turn about the axis by the rated force on the outermost cells: within the flare, and at those
    cells, where the beam overrates it."""
    out, design, of = _loaded(preset, tmp_path, design_dir)
    finger, mount, stack = design.receiver, design.mount, design.stack
    x, y = max(((abs(x), y) for x, y in finger.cells), key=lambda at: (round(at[0], 3), at[1]))
    solved = bent(out, design, finger, BRICK_MM, (x, y))
    ramp_y = mount.ramp_end_y_mm(stack.back_z_mm, stack.rim_z_mm)
    flare = np.arange(ramp_y, ramp_y + mount.flare_mm / 2, STEP_MM)
    by_elements = solved.turned(mount.block_width_mm / 2, flare, stack.pocket_z_mm)
    along = (flare - mount.origin_y_mm) * math.cos(math.radians(mount.tilt_deg))
    torque = design.strength.rated_force_n * x
    by_beam = of.beam.summed(torque / torsion(of.beam).stiffness_nmm2, along)
    assert by_beam == pytest.approx(by_elements, rel=WITHIN)
    at_cells = math.degrees(solved.tip_mm / x)
    assert 1.0 <= finger_loads(out, design, finger).twist_deg / at_cells <= OVERTURNED


def test_a_compliant_finger_and_finite_elements_agree(tmp_path: Path, design_dir: Path) -> None:
    """Deflection of the tip; tension of the plate, from the interface to the wedge, by the strain
    of its front; twist at the outermost cells, which the beam overrates. The board, which slips and
    has 1 % of the plate's stiffness, is left out of the elements. Both are linear."""
    out, design, of = _loaded("flex", tmp_path, design_dir)
    finger, mount, stack = design.receiver, design.mount, design.stack
    solved = bent(out, design, finger, COMPLIANT_BRICK_MM)
    found = finger_loads(out, design, finger)
    assert found.bend_mm == pytest.approx(solved.tip_mm, rel=WITHIN)
    (interface,), plate = design.interfaces, of.printed[0][0]
    ends = interface.box.y_max_mm + BESIDE_MM, design.tip.slant_start_y_mm
    free = np.arange(ends[0] + OVER_MM / 2, ends[1], STEP_MM)
    along = (free - mount.origin_y_mm) * math.cos(math.radians(mount.tilt_deg))
    tension = of.beam.tension_mpa(plate) * design.strength.rated_force_n
    by_beam = np.interp(along, of.beam.h_mm, tension) / plate.modulus_mpa
    places = (0.0, 6.0, 12.0, 18.0)
    front = [solved.front_strain(x, free, stack.face_z_mm, OVER_MM) for x in places]
    assert float(by_beam.mean()) == pytest.approx(float(np.mean(front)), rel=WITHIN)
    outermost = max(((abs(x), y) for x, y in finger.cells), key=lambda at: (round(at[0], 3), at[1]))
    twisted = bent(out, design, finger, COMPLIANT_BRICK_MM, outermost)
    at_cells = math.degrees(twisted.tip_mm / outermost[0])
    assert 1.0 <= found.twist_deg / at_cells <= OVERTURNED

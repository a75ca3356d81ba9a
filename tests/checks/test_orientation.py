"""The backing's printing orientation: by computed strength, and by what prints without support."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from lumitip_fab.checks.orientation import WAYS, lying, measure_orientation
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.spans import longest_span_mm
from lumitip_fab.checks.strength import finger_loads, measure
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.frames import backing_bed_to_sensor
from lumitip_fab.design.strength import lying_safety
from printed_fingers import written

pytestmark = pytest.mark.slow

PART = "backing/receiver_backing.stl"


@pytest.fixture(scope="module")
def design(design_dir: Path) -> Design:
    """The published design."""
    return derive(load(design_dir / "presets" / "published.toml"))


@pytest.fixture(scope="module")
def fingers(design: Design, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its printed fingers."""
    return written(design, design, tmp_path_factory.mktemp("fingers") / "published")


def of_receiver(out: Path, design: Design) -> dict[str, Measurement]:
    found = finger_loads(out, design, design.receiver)
    measured = measure_orientation(out, design, design.receiver, found)
    return {m.check.partition(".")[2]: m for m in measured}


def test_the_backing_stands_for_lying_needs_support(fingers: Path, design: Design) -> None:
    found = finger_loads(fingers, design, design.receiver)
    other = lying(fingers, design, design.receiver, found)
    assert other.safety > 1.2 * found.safety, "layers along the finger bear more"
    assert min(other.spans_mm.values()) > design.printing.bridge_mm
    measured = of_receiver(fingers, design)
    assert measured["lying"].measured == pytest.approx(other.safety)
    assert measured["orientation"].passed
    assert measured["orientation"].low == design.printing.bridge_mm
    assert f"{found.safety:.1f} times" in measured["orientation"].note
    names = {m.check for m in measure(fingers, design)}
    assert {"strength.lying", "strength.orientation"} <= names


def test_the_safety_of_a_lying_print_is_that_of_plane_and_shear(
    fingers: Path, design: Design
) -> None:
    """By the tension of the standing print, and by a section that the force shears alone."""
    found, filament = finger_loads(fingers, design, design.receiver), design.slicing.backing
    tension = filament.layer_mpa / found.safety
    assert lying_safety(found, 1e9, filament.plane_mpa) == pytest.approx(
        filament.plane_mpa / tension
    )
    mesh = solids.read_mesh(fingers / PART)
    force, heights = design.strength.rated_force_n, np.linspace(1.0, mesh.bounds[1, 2] - 4.0, 60)
    least_mm2 = min(solids.section(mesh, z).area for z in heights)
    shear = 1.5 * force / least_mm2
    assert shear < found.between_mpa < shear + tension, "twist adds to it"
    assert lying_safety(found, 10.0, 1e9) == pytest.approx(10.0 / found.between_mpa)


def test_what_hangs_is_the_plate_behind_and_the_pockets_roof(fingers: Path, design: Design) -> None:
    mesh = solids.read_mesh(fingers / PART)
    sensor = solids.moved(mesh, backing_bed_to_sensor(design.mount, design.stack))
    spans = {}
    for way, turn in WAYS.items():
        turned = solids.moved(sensor, turn)
        turned.apply_translation((0.0, 0.0, -turned.bounds[0, 2]))
        spans[way] = longest_span_mm(turned, design.printing)[0]
        assert longest_span_mm(turned, design.printing, enough_mm=15.0)[0] > 15.0
    pocket = design.board.pocket
    assert spans["face down"] >= max(pocket.width_mm, pocket.length_mm) - 2.0
    assert spans["face down"] <= math.hypot(pocket.width_mm, pocket.length_mm)
    outline = np.ptp(design.outline.polygon(), axis=0)
    assert outline.min() < spans["face up"] < math.hypot(*outline) + 5.0


def test_a_backing_that_would_print_better_lying_is_found(design: Design, tmp_path: Path) -> None:
    """With ribs in its pocket, and one below the block, it lies on its front without support."""
    out = written(design, design, tmp_path / "ribbed")
    assert of_receiver(out, design)["orientation"].passed
    to_sensor = backing_bed_to_sensor(design.mount, design.stack)
    whole = trimesh.load(out / PART, force="mesh").apply_transform(to_sensor)
    pocket, rim, floor = design.board.pocket, design.stack.rim_z_mm, design.stack.pocket_z_mm
    ribs = []
    for k, (low, high) in enumerate(
        ((pocket.x_min_mm, pocket.x_max_mm), (pocket.y_min_mm, pocket.y_max_mm))
    ):
        for at in np.arange(low, high, 8.0):
            size = np.array([pocket.width_mm, pocket.length_mm, rim - floor + 0.2])
            size[k] = 0.8
            middle = np.array([*pocket.centre_mm, (rim + floor - 0.2) / 2])
            middle[k] = at
            ribs.append(trimesh.creation.box(size).apply_translation(middle))
    end_y, notch_y = design.outline.end_y_mm, design.receiver.notch.y_max_mm
    below = trimesh.creation.box((0.8, notch_y - end_y + 2.0, 8.0))
    ribs.append(below.apply_translation((0.0, (notch_y + end_y) / 2, rim - 4.0)))
    ribbed = trimesh.boolean.union([whole, *ribs], engine="manifold")
    ribbed.apply_transform(np.linalg.inv(to_sensor)).export(out / PART)
    measured = of_receiver(out, design)["orientation"]
    assert not measured.passed
    assert measured.measured < design.printing.bridge_mm


def test_a_print_that_is_no_stronger_lying_may_stand_whatever_hangs(
    fingers: Path, design: Design
) -> None:
    weak = replace(design.slicing.backing, plane_mpa=design.slicing.backing.layer_mpa / 2)
    other = replace(design, slicing=replace(design.slicing, backing=weak))
    found = finger_loads(fingers, other, other.receiver)
    assert lying(fingers, other, other.receiver, found).safety < found.safety
    assert of_receiver(fingers, other)["orientation"].low == 0.0


def test_the_plate_of_a_compliant_finger_lies_in_any_case(design_dir: Path, tmp_path: Path) -> None:
    flex = derive(load(design_dir / "presets" / "flex.toml"))
    out = written(flex, flex, tmp_path / "flex")
    found = finger_loads(out, flex, flex.receiver)
    assert not list(measure_orientation(out, flex, flex.receiver, found))

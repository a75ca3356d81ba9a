"""The matrices between frames: rigid, and turning the way the words say."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from lumitip_fab.design import Design, frames
from lumitip_fab.design.frames import applied

PRESETS = ("asymmetric", "dense", "mux16", "published")


@pytest.fixture(params=PRESETS)
def design(request: Any, designs: dict[str, Design]) -> Design:
    """Every preset in turn."""
    return designs[request.param]


def _rigid(matrix: frames.Matrix) -> bool:
    turn = matrix[:3, :3]
    return (
        np.allclose(turn @ turn.T, np.eye(3))
        and bool(np.isclose(np.linalg.det(turn), 1.0))
        and matrix[3].tolist() == [0, 0, 0, 1]
    )


def _skin(design: Design) -> Any:
    """Points of the silicone's skin on the centreline, tip to gripper end, in the sensor frame."""
    stack, mould, outline = design.stack, design.mould, design.outline
    y = np.linspace(outline.tip_y_mm, outline.end_y_mm + mould.end_round_mm, 4001)
    y = np.sort(np.append(y, outline.tip_y_mm - mould.taper_length_mm))[::-1]
    from_tip = (outline.tip_y_mm - y) / mould.taper_length_mm
    z = np.where(from_tip < 1, (1 - from_tip) * (mould.tip_silicone_mm - stack.silicone_mm), 0.0)
    return np.stack([0 * y, y, z], axis=1)


def _skins(design: Design, opening_mm: float) -> tuple[Any, Any]:
    """Both skins in the gripper frame, emitter first."""
    emitter, receiver = (
        applied(
            frames.finger_to_gripper(name, design.mount, design.closing, opening_mm), _skin(design)
        )
        for name in ("emitter", "receiver")
    )
    return emitter, receiver


def test_every_conversion_of_solids_is_rigid(design: Design) -> None:
    matrices = [
        frames.translation(1.0, -2.0, 3.0),
        frames.rotation_x(33.0),
        frames.mount_to_sensor(design.mount, design.stack),
        frames.mould_bed_to_sensor(design.stack, design.mould),
        frames.finger_to_gripper("emitter", design.mount, design.closing, 12.0),
        frames.finger_to_gripper("receiver", design.mount, design.closing, 12.0),
    ]
    assert all(map(_rigid, matrices))
    for first, second in pairwise(matrices):
        assert _rigid(first @ second)


def test_a_turn_about_x_takes_y_to_z() -> None:
    assert applied(frames.rotation_x(90.0), np.array([[1.0, 2.0, 0.0]]))[0] == pytest.approx(
        (1.0, 0.0, 2.0)
    )


def test_points_in_the_plane_have_no_height_and_are_moved_like_the_others() -> None:
    moved = applied(frames.translation(1.0, 2.0, 3.0), np.array([[10.0, 20.0]]))
    assert moved.tolist() == [[11.0, 22.0, 3.0]]


def test_the_lean_turns_the_tip_towards_the_other_finger(design: Design) -> None:
    places = np.array([[0.0, design.outline.tip_y_mm], [0.0, design.outline.end_y_mm]])
    for name, inward in (("receiver", 1.0), ("emitter", -1.0)):
        matrix = frames.finger_to_gripper(name, design.mount, design.closing, 20.0)
        tip, end = applied(matrix, places)
        assert inward * (tip[2] - end[2]) > 0.5
        assert tip[1] > end[1]
        centre = applied(matrix, np.zeros((1, 3)))[0]
        out = applied(matrix, np.array([[0.0, 0.0, 1.0]]))[0] - centre
        assert inward * out[2] == pytest.approx(np.cos(np.radians(design.mount.tilt_deg)))
        assert inward * centre[2] < 0, "a finger is on its own side of the mid-plane"


@pytest.mark.parametrize("opening_mm", [0.0, 7.0, 60.0])
def test_the_opening_is_the_least_distance_from_skin_to_skin(
    design: Design, opening_mm: float
) -> None:
    emitter, receiver = _skins(design, opening_mm)
    apart = emitter[:, 2] - receiver[:, 2]
    assert apart.min() == pytest.approx(opening_mm, abs=1e-6)
    first = int(apart.argmin())
    assert _skin(design)[first, 1] == pytest.approx(design.closing.contact_y_mm, abs=0.05)
    assert design.outline.tip_y_mm - design.closing.contact_y_mm <= 4.0


@pytest.mark.parametrize("opening_mm", [0.0, 25.0])
def test_led_i_lies_opposite_photodetector_i(design: Design, opening_mm: float) -> None:
    leds, detectors = (
        applied(
            frames.finger_to_gripper(f.name, design.mount, design.closing, opening_mm),
            np.array(f.cells),
        )
        for f in (design.emitter, design.receiver)
    )
    assert leds[:, :2] == pytest.approx(detectors[:, :2], abs=1e-6)
    assert leds[:, 2] == pytest.approx(-detectors[:, 2], abs=1e-6)
    assert (leds[:, 2] > detectors[:, 2]).all()


def test_the_mount_frame_stands_on_the_mount_plane_and_leans_by_the_grippers_tilt(
    design: Design,
) -> None:
    matrix = frames.mount_to_sensor(design.mount, design.stack)
    origin, u, w, h = applied(matrix, np.vstack([np.zeros(3), np.eye(3)]))
    assert origin == pytest.approx((0.0, design.outline.end_y_mm, design.stack.rim_z_mm))
    assert u - origin == pytest.approx((1.0, 0.0, 0.0))
    assert (w - origin)[2] < -0.99, "w points back from the gripping face"
    assert (h - origin)[1] > 0.99, "h points towards the tip"
    lean = np.degrees(np.arcsin((h - origin)[2]))
    assert lean == pytest.approx(-design.mount.tilt_deg)


def test_the_bolt_stands_upright_in_the_gripper(design: Design) -> None:
    """With the lean applied, the bolt's axis lies along the gripper frame's y."""
    to_gripper = frames.finger_to_gripper("receiver", design.mount, design.closing, 10.0)
    matrix = to_gripper @ frames.mount_to_sensor(design.mount, design.stack)
    foot, head = applied(matrix, np.array([[0.0, 13.8, 0.0], [0.0, 13.8, 1.0]]))
    assert head - foot == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)


def test_the_mould_lies_open_side_up_with_its_floor_below_the_skin(design: Design) -> None:
    matrix = frames.mould_bed_to_sensor(design.stack, design.mould)
    skin = applied(np.linalg.inv(matrix), np.array([[3.0, 4.0, design.stack.silicone_z_mm]]))[0]
    rim = applied(np.linalg.inv(matrix), np.array([[3.0, 4.0, design.stack.rim_z_mm]]))[0]
    assert skin == pytest.approx((3.0, -4.0, design.mould.wall_mm))
    assert rim[2] == pytest.approx(design.mould.wall_mm + design.stack.silicone_mm)


def test_the_page_is_mirrored_and_stretched_by_what_the_rulers_measured() -> None:
    matrix = frames.sensor_to_page((99.2, 100.4))
    x, y, _ = applied(matrix, np.array([[10.0, 20.0]]))[0]
    assert (x, y) == pytest.approx((-10.0 * 100 / 99.2, 20.0 * 100 / 100.4))
    assert frames.sensor_to_page((100.0, 100.0)).tolist() == np.diag([-1.0, 1, 1, 1]).tolist()


def test_receiver_apertures_are_at_minus_x_and_emitter_apertures_at_plus_x(
    design: Design,
) -> None:
    page = frames.sensor_to_page((100.0, 100.0))
    x = design.layout.x_mm
    assert applied(page, np.array(design.receiver.cells))[:, 0] == pytest.approx(-x)
    assert applied(page, np.array(design.emitter.cells))[:, 0] == pytest.approx(x)

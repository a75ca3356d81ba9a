"""The light of ropes, cloth and soft solids in MuJoCo."""

import mujoco
import numpy as np
import pytest

from lumitip.mujoco import LightSensor
from lumitip.twin import Cable, HalfPlane
from mujoco_bodies import (
    LAYOUT,
    MOST_COUNTS,
    TWIN,
    cloth,
    rope,
    state,
    values,
)


@pytest.mark.parametrize(("y_mm", "turn_deg"), [(0.0, 0.0), (2.5, 12.0), (-3.0, -25.0)])
def test_the_edge_of_cloth(y_mm: float, turn_deg: float) -> None:
    expected = TWIN.values(HalfPlane(offset_mm=-y_mm, angle_deg=180.0 + turn_deg))
    assert np.abs(values(cloth(y_mm, turn_deg)) - expected).max() <= MOST_COUNTS


def test_a_fold_is_two_layers() -> None:
    """The part that is turned over is darker, if the cloth lets light through."""
    model, data = state(cloth(-40.0))
    sensor = LightSensor(model, LAYOUT, materials={"cloth": (0.4, 0.0)})
    single = sensor.values(data)
    assert np.allclose(single, single[0], atol=3.0)
    points = data.flexvert_xpos
    over = points[:, 1] > 0.0
    points[over, 1] *= -1.0  # folded along y = 0: two layers below it
    double = sensor.values(data)
    above, below = LAYOUT.y_mm > 4.0, LAYOUT.y_mm < -4.0
    assert (double[above] > 250.0).all()
    assert (double[below] < single[below] - 20.0).all()


def test_a_rope_is_a_cable_and_its_end_is_seen() -> None:
    whole = values(rope(1.0))
    assert np.abs(whole - TWIN.values(Cable(offset_mm=1.0))).max() <= MOST_COUNTS
    short = values(rope(1.0, number=5))  # from -6 to 6 mm
    outer, inner = np.abs(LAYOUT.x_mm) > 12.0, np.abs(LAYOUT.x_mm) < 2.0
    assert (short[outer] > 250.0).all() and short[inner].min() < whole[inner].min() + 30.0


def test_a_bent_rope_is_an_arc() -> None:
    radius_mm, step = 40.0, 0.05
    model, data = state(rope(0.0))
    along = (np.arange(60) - 29.5) * step
    points = np.stack([radius_mm * np.sin(along), radius_mm * (1.0 - np.cos(along))], axis=1)
    near = np.abs(along) < np.pi / 2.0
    data.flexvert_xpos[:, :2] = np.where(near[:, None], points, points + 1e3) / 1e3
    expected = TWIN.values(Cable(curvature_per_mm=1.0 / radius_mm))
    found = LightSensor(model, LAYOUT).values(data)
    assert np.abs(found - expected).max() <= 3.0  # chords of 2 mm instead of the arc


def test_a_coarse_cloth_and_a_solid_that_yields() -> None:
    """No point of theirs is between the fingers, yet they are."""

    def coarse(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="cloth_body")
        body.make_flex(
            "cloth", type="grid", dim=2, count=[2, 2, 1], spacing=[0.1] * 3, radius=2e-4,
            mass=0.01, equality=1,
        )  # fmt: skip

    def foam(spec: mujoco.MjSpec) -> None:
        body = spec.worldbody.add_body(name="foam_body")
        body.make_flex(
            "foam", type="grid", dim=3, count=[5, 5, 2], spacing=[0.004] * 3, radius=2e-4,
            mass=0.01, equality=1,
        )  # fmt: skip

    assert (values(coarse) < 5.0).all()
    assert values(foam, 4.0).min() < 5.0

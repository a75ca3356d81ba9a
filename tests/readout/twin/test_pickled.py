"""Twins that go to other processes."""

import copy
import pickle

import numpy as np
import pytest

from lumitip.links.twin import published_layout
from lumitip.twin import Cable, Disc, HalfPlane, Misregistration, Polygon, Twin

SCENES = [
    HalfPlane(offset_mm=2.0, angle_deg=15.0),
    Cable(angle_deg=30.0),
    [Cable(angle_deg=3.0), Disc(x_mm=1.0, y_mm=2.0, diameter_mm=5.0)],
    Polygon([(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)], clear=0.3, diffuse=0.2),
]


@pytest.mark.slow_cases
@pytest.mark.parametrize("again", [lambda t: pickle.loads(pickle.dumps(t)), copy.deepcopy])
def test_a_pickled_twin_reads_the_same(again) -> None:
    layout = published_layout()
    twin = Twin(layout, misregistration=Misregistration(x_mm=0.2), ambient=0.02, bits=12, seed=5)
    expected = twin.batch(SCENES)
    other = again(twin)
    assert other is not twin and other.layout == layout
    assert np.array_equal(other.batch(SCENES), expected)
    assert np.array_equal(other.frame(Cable(), t=1.5), twin.frame(Cable(), t=1.5))


def test_results_that_are_kept_are_not_pickled() -> None:
    twin = Twin(published_layout())
    fresh = len(pickle.dumps(twin))
    twin.batch(SCENES)
    assert len(pickle.dumps(twin)) < 2 * fresh < 100_000

"""Whatever kind a number or an array is of, it does as floats do."""

import math
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from lumitip import Calibration
from lumitip.control import Command, Limits, LineLaw, Tracer
from lumitip.estimation import PoseEstimator
from lumitip.grid import hexagonal_grid
from lumitip.links.twin import published_layout
from lumitip.processing import Processor, Tracker
from lumitip.robots import ArmLimits
from lumitip.twin import Cable, HalfPlane, Image, Twin

CELLS = published_layout()


@pytest.mark.slow
@pytest.mark.parametrize(
    "number",
    [
        np.float64(4.0),
        np.float32(4.0),
        np.int64(4),
        np.uint8(4),
        np.array(4.0),
        4,
        Decimal(4),
        Fraction(4),
    ],
    ids=lambda number: type(number).__name__,
)
def test_every_kind_of_number_does_as_a_float(number: Any) -> None:
    cable, same = Cable(0.0, 30.0, diameter_mm=number), Cable(0.0, 30.0, diameter_mm=4.0)
    assert cable == same and hash(cable) == hash(same)
    assert Twin(CELLS).values(cable).tolist() == Twin(CELLS).values(same).tolist()
    limits = Limits(forward_mm_s=number, lateral_mm_s=number, rotation_rad_s=number)
    assert limits.of(Command(9.0, -9.0)) == Command(4.0, -4.0)
    tracer = Tracer(LineLaw(), corner_at_mm=number)
    contact = Processor(CELLS)(Twin(CELLS).values(HalfPlane()))
    assert tracer(contact, number) == Tracer(LineLaw(), corner_at_mm=4.0)(contact, 4.0)
    assert Image.of(Cable(), number, number).pixels.shape == (3, 3)
    assert ArmLimits(number).share(8.0, 0.0) == 0.5
    assert Processor(CELLS, number).min_contrast == LineLaw(number).speed_mm_s == 4.0
    assert Tracker(CELLS, number, number)(np.full(32, 255.0)).shape == "none"
    assert hexagonal_grid([1, 2], number).y_mm.tolist() == [0.0, 2.0, -2.0]


@pytest.mark.parametrize(
    "kind",
    [np.float64, np.float32, np.float16, np.uint8, np.int64, object, list, tuple],
    ids=lambda kind: kind.__name__,
)
def test_every_kind_of_array_does_as_floats(kind: Any) -> None:
    estimator = PoseEstimator(CELLS)
    whole = np.round(Twin(CELLS).values(HalfPlane(1.0, 20.0)))
    values = kind(whole.tolist()) if kind in (list, tuple) else whole.astype(kind)
    for call in (Processor(CELLS), Tracker(CELLS)):
        assert call(values).line == call(whole).line
    assert repr(estimator(values)) == repr(estimator(whole))
    alike, wanted = (Processor(CELLS).batch([of] * 3).thresholds for of in (values, whole))
    assert np.array_equal(alike, wanted)
    kept = Calibration("dev", CELLS.design_hash, values).empty
    assert kept is not None and kept.tolist() == whole.tolist()
    assert Twin(CELLS, gains=values).gains.tolist() == whole.tolist()
    for columns in ([4, 5], (4, 5), np.array([4, 5], np.uint8)):
        assert len(hexagonal_grid(columns, 6.0).x_mm) == 9  # type: ignore[arg-type]


def test_a_cell_that_is_missing_is_left_out() -> None:
    values = [None, *np.linspace(0.0, 255.0, 31).tolist()]
    assert Processor(CELLS)(values).line == Processor(CELLS)([math.nan, *values[1:]]).line

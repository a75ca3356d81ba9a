"""Rows of dimensions: a name that stands beside its line is crossed by no other line."""

import re

import numpy as np
import pytest

from lumitip_fab.design import Point
from lumitip_fab.scenes.dimensions import LETTER_MM, dimension_rows
from lumitip_fab.scenes.drawing import Sheet

_NAME = re.compile(r'<text .*?x="([-\d.]+)" y="([-\d.]+)".*?>narrow_mm</text>')
_LINE = re.compile(r"M([-\d.]+),([-\d.]+)L([-\d.]+),([-\d.]+)")


@pytest.mark.parametrize("upright", [False, True])
def test_a_name_is_crossed_by_no_longer_dimension(upright: bool) -> None:
    sheet = Sheet()

    def point(along: float) -> Point:
        return (0.0, along) if upright else (along, 0.0)

    spans = [
        ("narrow_mm", point(0.0), point(8.0)),
        ("a wide one_mm", point(-9.0), point(14.0)),
        ("the widest_mm", point(-12.0), point(24.0)),
    ]
    dimension_rows(sheet, spans, -8.0 if upright else 8.0, -1 if upright else 1, upright)
    drawn = "\n".join(sheet.drawn)
    (name,) = (np.array(found, float) * (1, -1) for found in _NAME.findall(drawn))
    lines = [np.array(found, float).reshape(2, 2) * (1, -1) for found in _LINE.findall(drawn)]
    axis = 1 if upright else 0
    begin, end = name[axis], name[axis] + LETTER_MM * len("narrow_mm")
    across = [line for line in lines if line[0, axis] == line[1, axis]]
    assert len(across) == 6
    for line in across:
        low, high = sorted(line[:, 1 - axis])
        reaches = low <= name[1 - axis] <= high
        assert not (reaches and begin <= line[0, axis] <= end)
    # The dimension's own line leads to it.
    own = [line for line in lines if line[0, 1 - axis] == line[1, 1 - axis]]
    assert any(0.0 < begin - line[:, axis].max() < 2.0 for line in own)

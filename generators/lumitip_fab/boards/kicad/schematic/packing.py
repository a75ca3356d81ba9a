"""Places of frames on a page: rows of columns, a low frame below another where it has room."""

from collections.abc import Sequence
from dataclasses import dataclass

from lumitip_fab.design import Point

GAP_MM = 5.08
"""Between frames."""


@dataclass
class _Column:
    wide_mm: float
    high_mm: float
    frames: list[int]


def packed(sizes: Sequence[Point], wide_mm: float) -> tuple[list[tuple[Point, Point]], float]:
    """Place and size of each frame, and the height of them all.

    A frame is as wide as its column, and the last of a column reaches down to the row's end.

    Args:
        sizes: least widths and heights of the frames, in the order in which they are read.
        wide_mm: width of the page; a wider frame has a row of its own.
    """
    places: dict[int, tuple[Point, Point]] = {}
    y = 0.0
    for row in _rows(sizes, wide_mm):
        x, high = 0.0, _high_mm(row)
        for column in row:
            top = y
            for i in column.frames:
                last = i == column.frames[-1]
                tall = y + high - top if last else sizes[i][1]
                places[i] = (x, top), (column.wide_mm, tall)
                top += tall + GAP_MM
            x += column.wide_mm + GAP_MM
        y += high + GAP_MM
    return [places[i] for i in range(len(sizes))], y - GAP_MM


def _rows(sizes: Sequence[Point], wide_mm: float) -> list[list[_Column]]:
    rows: list[list[_Column]] = []
    for i, (wide, high) in enumerate(sizes):
        row = rows[-1] if rows else []
        before = sum(column.wide_mm + GAP_MM for column in row)
        if row and _goes_below(row, wide, high, wide_mm - before + GAP_MM):
            column = row[-1]
            column.wide_mm = max(column.wide_mm, wide)
            column.high_mm += GAP_MM + high
            column.frames.append(i)
        elif row and before + wide <= wide_mm:
            row.append(_Column(wide, high, [i]))
        else:
            rows.append([_Column(wide, high, [i])])
    return rows


def _goes_below(row: Sequence[_Column], wide: float, high: float, spare_mm: float) -> bool:
    """Whether a frame has room below the last column of a row."""
    column = row[-1]
    fits = wide - column.wide_mm <= spare_mm
    return fits and column.high_mm + GAP_MM + high <= _high_mm(row)


def _high_mm(row: Sequence[_Column]) -> float:
    return max(column.high_mm for column in row)

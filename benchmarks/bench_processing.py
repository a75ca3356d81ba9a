"""Speed of the processing on one core: per frame, in batches, and its growth with the cells.

Run by `make bench`; exits 1 if a goal is missed. Time depends on the machine, so the published way
runs beside it. Processor time is measured, since other load would slow down the longer of the two
more.

The published way is written from its description: largest gap, Python loops over the neighbours,
and `scipy.optimize.curve_fit`, once for the line, and from several starts for a corner, which may
point anywhere.
"""

import sys
import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import curve_fit

from common import PUBLISHED, Goals, columns_for, layout_of, on_one_core
from lumitip import Layout
from lumitip.grid import Floats
from lumitip.processing import Processor

Frames = NDArray[np.uint8]
Pose = tuple[tuple[float, float], float, float]
STARTS = (4, 8)  # with eight the published fit finds the best corner in every frame
TURNS = 4
SHAPES = ("edge", "corner", "cable")
CELLS = (32, 128, 512, 2048)
LIMIT_US, LIMIT_RATIO, LIMIT_BATCH = 100.0, 100.0, 100_000.0
LIMIT_GROWTH = 1.5  # of the cost of a cell, from 512 cells to 2,048: linear but for caches


@dataclass
class Published:
    """Result of the published way for one frame."""

    threshold: float
    centre: tuple[float, float]
    markers: list[tuple[float, float]]
    line: Floats
    """Slope and height of the line."""
    corner: Floats
    """Vertex, and the directions of both rays (rad)."""


def published(values: list[int], layout: Layout, starts: int) -> Published:
    """The published way for one frame.

    Args:
        values: of the cells, 255 is full light.
        layout: the cells.
        starts: number of starts of the fit of a corner.
    """
    level = _threshold(values)
    x_mm, y_mm = layout.x_mm.tolist(), layout.y_mm.tolist()
    dark = [i for i, value in enumerate(values) if value < level]
    weights = [255 - values[i] for i in dark]
    centre = (
        sum(w * x_mm[i] for w, i in zip(weights, dark, strict=True)) / sum(weights),
        sum(w * y_mm[i] for w, i in zip(weights, dark, strict=True)) / sum(weights),
    )
    markers = []
    for a, b in layout.neighbours.tolist():
        if (values[a] < level) != (values[b] < level):
            share = (level - values[a]) / (values[b] - values[a])
            markers.append(
                (x_mm[a] + share * (x_mm[b] - x_mm[a]), y_mm[a] + share * (y_mm[b] - y_mm[a]))
            )
    x, y = np.array(markers).T
    line, _ = curve_fit(_line, x, y)
    return Published(level, centre, markers, line, _corner(np.array((x, y)), starts))


def _threshold(values: list[int]) -> float:
    ordered = sorted(values)
    gap, cut = 0, 0
    for i in range(len(ordered) - 1):
        if ordered[i + 1] - ordered[i] > gap:
            gap, cut = ordered[i + 1] - ordered[i], i
    low, high = ordered[: cut + 1], ordered[cut + 1 :]
    return (sum(low) / len(low) + sum(high) / len(high)) / 2


def _line(x: Floats, slope: float, height: float) -> Floats:
    return slope * x + height


def _to_rays(markers: Floats, x: float, y: float, one: float, other: float) -> Floats:
    """Distance of each marker to the nearer of two rays from a vertex."""
    across, along = markers[0] - x, markers[1] - y
    distances = []
    for angle in (one, other):
        ahead = np.maximum(across * np.cos(angle) + along * np.sin(angle), 0.0)
        distances.append(np.hypot(across - ahead * np.cos(angle), along - ahead * np.sin(angle)))
    nearer: Floats = np.minimum(*distances)
    return nearer


def _corner(markers: Floats, starts: int) -> Floats:
    """The best of several fits, from the mean with rays at a right angle."""
    best, least = np.full(4, np.nan), np.inf
    mean, aim = markers.mean(axis=1), np.zeros(markers.shape[1])
    for middle in np.linspace(0.0, 2.0 * np.pi, starts, endpoint=False):
        begin = (*mean, middle - np.pi / 4.0, middle + np.pi / 4.0)
        try:
            found, _ = curve_fit(_to_rays, markers, aim, p0=begin)
        except RuntimeError:
            continue
        left = float((_to_rays(markers, *found) ** 2).sum())
        if left < least:
            best, least = found, left
    return best


def frames_of(layout: Layout, shape: str, count: int) -> tuple[Frames, list[Pose]]:
    """Frames of random poses with two counts of noise: vertex, direction and opening of each."""
    chance = np.random.default_rng(len(layout) + SHAPES.index(shape))
    reach_mm = float(min(np.ptp(layout.x_mm), np.ptp(layout.y_mm)))
    rows, poses = [], []
    for _ in range(count):
        x_mm, y_mm = chance.uniform(-0.15, 0.15, 2) * reach_mm
        angle, half = chance.uniform(-np.pi, np.pi), np.radians(chance.uniform(30.0, 60.0))
        x, y = layout.x_mm - x_mm, layout.y_mm - y_mm
        up, side = y * np.cos(angle) - x * np.sin(angle), x * np.cos(angle) + y * np.sin(angle)
        outside_mm = {
            "edge": up,
            "corner": np.abs(side) * np.cos(half) + up * np.sin(half),
            "cable": np.abs(up) - 0.15 * reach_mm,
        }[shape]
        light = 127.5 + 127.5 * np.tanh(outside_mm / 1.5)
        rows.append(np.clip(light + chance.normal(0.0, 2.0, x.size), 1.0, 255.0))
        poses.append(((x_mm, y_mm), angle, 2.0 * float(half)))
    return np.array(rows).astype(np.uint8), poses


def each_us(work: Callable[[Any], object], items: Sequence[Any]) -> float:
    """Median processor time of `work` on one of the items (µs)."""
    times = []
    for item in items:
        begun = time.thread_time()
        work(item)
        times.append(time.thread_time() - begun)
    return 1e6 * median(times)


def per_frame() -> tuple[float, float]:
    """Full pipeline against the published way: the slowest median (µs) and the least ratio.

    Both ways take turns, and the fastest turn of each counts: other load only slows down.
    """
    layout = layout_of(PUBLISHED, 6.0)
    process = Processor(layout)
    print(f"{'32 cells':<10}{'µs':>8}{'published, µs':>24}{'times faster':>24}")
    print(f"{'':<18}" + 2 * f"{'4 starts':>14}{'8 starts':>10}")
    slowest, least = 0.0, np.inf
    for shape in SHAPES:
        frames, _ = frames_of(layout, shape, 300)
        lists = [row.tolist() for row in frames[:30]]
        ways: list[tuple[Callable[[Any], object], list[Any]]] = [
            (process, list(np.tile(frames, (2, 1)))),
            *((partial(published, layout=layout, starts=n), lists) for n in STARTS),
        ]
        mine, *theirs = np.min([[each_us(*way) for way in ways] for _ in range(TURNS)], axis=0)
        print(
            f"{shape:<10}{mine:>8.1f}{theirs[0]:>14,.0f}{theirs[1]:>10,.0f}"
            f"{theirs[0] / mine:>14.0f}{theirs[1] / mine:>10.0f}"
        )
        slowest, least = max(slowest, mine), min(least, theirs[-1] / mine)
    return slowest, least


def corners() -> None:
    """Errors of both ways in vertex and opening of the same corners."""
    layout = layout_of(PUBLISHED, 6.0)
    process = Processor(layout)
    frames, poses = frames_of(layout, "corner", 100)
    misses: dict[str, list[tuple[float, float]]] = {"here": [], "published": []}
    not_found = 0
    for frame, (vertex_mm, _, opening) in zip(frames, poses, strict=True):
        corner = process(frame).corner
        if corner is None:
            not_found += 1
        else:
            miss_mm = float(np.hypot(*np.subtract(corner.vertex_mm, vertex_mm)))
            misses["here"].append((miss_mm, abs(corner.opening_deg - np.degrees(opening))))
        x_mm, y_mm, one, other = published(frame.tolist(), layout, STARTS[-1]).corner
        turn = abs((other - one + np.pi) % (2.0 * np.pi) - np.pi)
        miss_mm = float(np.hypot(x_mm - vertex_mm[0], y_mm - vertex_mm[1]))
        misses["published"].append((miss_mm, float(np.degrees(abs(turn - opening)))))
    print("\nmiss of 100 corners  vertex mm: median  95 %  opening deg: median  95 %")
    for name, errors in misses.items():
        (vertex, angle), (most_vertex, most_angle) = np.percentile(errors, (50.0, 95.0), axis=0)
        print(f"{name:<31}{vertex:>7.2f}{most_vertex:>6.2f}{angle:>21.1f}{most_angle:>6.1f}")
    print(f"not called a corner here: {not_found}")


def batches() -> float:
    """Frames a second for thresholds, centres and markers at 32 cells."""
    layout = layout_of(PUBLISHED, 6.0)
    frames = np.concatenate([frames_of(layout, shape, 1500)[0] for shape in SHAPES])
    process = Processor(layout)
    spent = min(each_us(process.batch, [frames]) for _ in range(7))
    rate = 1e6 * len(frames) / spent
    print(f"\nbatch of {len(frames)} frames: {rate:,.0f} frames/s")
    return rate


def growth() -> tuple[float, float]:
    """Time against the number of cells, over the same area; corners take longest.

    Returns:
        Ratio of the time of a cell with the most cells to that with the second most, for single
        frames and for batches.
    """
    each = []
    print(f"\n{'cells':>6}{'markers':>9}{'frame µs':>10}{'a cell':>8}{'batch µs':>10}{'a cell':>8}")
    for cells in CELLS:
        columns = columns_for(cells)
        layout = layout_of(columns, 6.0 * float(np.sqrt(32.0 / cells)))
        frames, _ = frames_of(layout, "corner", 200)
        process = Processor(layout)
        each_us(process, list(frames[:20]))
        alone = each_us(process, list(np.tile(frames, (3, 1))))
        many = min(each_us(process.batch, [frames]) for _ in range(7)) / len(frames)
        markers = float(process.batch(frames).counts.mean())
        count = len(layout)
        print(
            f"{count:>6}{markers:>9.1f}{alone:>10.1f}{alone / count:>8.3f}"
            f"{many:>10.2f}{many / count:>8.4f}"
        )
        each.append((alone / count, many / count))
    return each[-1][0] / each[-2][0], each[-1][1] / each[-2][1]


if __name__ == "__main__":
    on_one_core()
    warnings.simplefilter("ignore")  # the published fits warn where they find no covariance
    slowest_us, ratio = per_frame()
    corners()
    per_second = batches()
    frame_growth, batch_growth = growth()
    goals = Goals()
    goals.at_most("slowest shape", slowest_us, LIMIT_US, "µs a frame")
    goals.at_least("than the published way", ratio, LIMIT_RATIO, "times faster")
    goals.at_least("batch", per_second, LIMIT_BATCH, "frames/s")
    goals.at_most("a cell of 2,048 to one of 512, frame", frame_growth, LIMIT_GROWTH)
    goals.at_most("a cell of 2,048 to one of 512, batch", batch_growth, LIMIT_GROWTH)
    sys.exit(goals.exit_code())

"""Speed of the twin on one core: scenes one by one, in batches, from tables, and up to 512 cells.

Run by `make bench`. A reading is one cell of one frame. Published simulators of tactile sensors
give speeds for rendered images of many thousand pixels, so frames a second do not compare; nor do
readings, each of which stands here for some thousand rays that were traced once.
"""

import os
import sys
import time
from collections.abc import Callable

import numpy as np

from designs import columns_for
from goals import Goals
from lumitip import Layout, Optics
from lumitip.grid import hexagonal_grid, hexagonal_neighbours
from lumitip.twin import Cable, Corner, HalfPlane, Image, Polygon, Sheet, Twin

PUBLISHED = (5, 4, 5, 4, 5, 4, 5)
CELLS = (32, 128, 512)
GOAL_SCENES, GOAL_BATCH = 10_000.0, 50_000.0
BATCH = 256
THREADS = "OPENBLAS_NUM_THREADS"
STAR = [
    (
        9.0 * (1.0 - 0.5 * (i % 2)) * np.cos(i * np.pi / 5),
        9.0 * (1.0 - 0.5 * (i % 2)) * np.sin(i * np.pi / 5),
    )
    for i in range(10)
]


def layout_of(columns: tuple[int, ...]) -> Layout:
    """A layout whose wiring does not matter here."""
    grid = hexagonal_grid(columns, 6.0)
    index = np.arange(grid.x_mm.size)
    return Layout(
        grid.x_mm,
        grid.y_mm,
        grid.column,
        grid.row,
        hexagonal_neighbours(columns),
        index // 8,
        index % 8,
        np.array([f"A{i}" for i in index // 8]),
        6.0,
        Optics(2.5, "hexagon", 0.9, 0.9, 1.0, 2.0, 1.41, 0.1, 75e3, 3.3),
    )


def each_s(work: Callable[[int], object], seconds: float = 0.4) -> float:
    """Processor time of one call (s): the least mean of five turns, others matter little."""
    work(0)
    means = []
    for _ in range(5):
        begun, calls = time.process_time(), 0
        while time.process_time() < begun + seconds / 5.0:
            work(calls)
            calls += 1
        means.append((time.process_time() - begun) / calls)
    return min(means)


def timed(name: str, frames: float, seconds: float, cells: int) -> float:
    """Print a line; returns frames a second."""
    rate = frames / seconds
    print(f"{name:<46}{rate:>12,.0f}{rate * cells:>14,.0f}")
    return rate


def scenes(twin: Twin) -> tuple[float, float]:
    """One by one and in batches; the least rate of moving scenes, and that of drawn batches."""
    cells = len(twin.layout)
    poses = [(x, 30.0 * np.sin(x)) for x in np.linspace(-6.0, 6.0, 64).tolist()]
    drawn = Image.of(Polygon(STAR))
    stars = [np.add(STAR, (x, -x / 2.0)) for x, _ in poses]
    corner = lambda i: Corner(*poses[i % 64], -80.0, 90.0)  # noqa: E731
    print(f"{f'{cells} cells':<46}{'frames/s':>12}{'readings/s':>14}")
    moving = [
        timed(name, 1, each_s(lambda i, make=make: twin.values(make(i))), cells)
        for name, make in {
            "edge, by its table": lambda i: HalfPlane(*poses[i % 64]),
            "cable, exact cylinder, by its table": lambda i: Cable(*poses[i % 64]),
            "curved cable, by its table": lambda i: Cable(*poses[i % 64], 0.02),
            "corner, on the raster": corner,
            "any drawn shape that moves, on the raster": lambda i: drawn.at(
                poses[i % 64][0], 1.0, poses[i % 64][1]
            ),
            "polygon of ten corners, new each time": lambda i: Polygon(stars[i % 64]),
            "corner of cloth that scatters": lambda i: Corner(*poses[i % 64], diffuse=0.3),
        }.items()
    ]
    mixed = lambda i: twin.values([Cable(*poses[i % 64]), Sheet(clear=0.5)])  # noqa: E731
    timed("cable on cloth, ray by ray", 1, each_s(mixed), cells)
    at = twin.plane()
    coverage = np.random.default_rng(0).random((BATCH, at.x_mm.size), dtype=np.float32)
    batch = timed(
        f"batch of {BATCH} coverages of {at.x_mm.size} pixels",
        BATCH,
        each_s(lambda _: twin.batch(coverage)),
        cells,
    )
    offset, angle = np.array(poses * (BATCH // 64)).T
    timed(
        f"batch of {BATCH} edges, by their table",
        BATCH,
        each_s(lambda _: twin.edges(offset, angle)),
        cells,
    )
    return min(moving), batch


def main() -> int:
    """Print everything; the exit code."""
    rates = (0.0, 0.0)
    for cells in CELLS:
        layout = layout_of(PUBLISHED if cells == 32 else columns_for(cells))
        begun = time.process_time()
        twin = Twin(layout)
        twin.plane(), twin.edge_table(), twin.cable_table()
        print(f"\nraster and tables made in {time.process_time() - begun:.1f} s")
        measured = scenes(twin)
        rates = measured if cells == 32 else rates
    goals = Goals()
    goals.at_least("slowest moving scene at 32 cells", rates[0], GOAL_SCENES, "frames/s")
    goals.at_least(f"batch of {BATCH} at 32 cells", rates[1], GOAL_BATCH, "frames/s")
    return goals.exit_code()


if __name__ == "__main__":
    if os.environ.get(THREADS) != "1":
        # NumPy asks for threads as it is imported, and several of them on one core wait in turn.
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | {THREADS: "1"})
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    sys.exit(main())

"""Speed of the twin on one core: scenes one by one, in batches, from tables, and up to 512 cells.

Run by `make bench`. A reading is one cell of one frame. Published simulators of tactile sensors
render images of many thousand pixels, so neither frames nor readings a second compare; a reading
here stands for some thousand rays that were traced once.
"""

import math
import sys
import time
from collections.abc import Callable
from functools import partial

import numpy as np

from common import PUBLISHED, Goals, columns_for, layout_of, on_one_core
from lumitip.grid import Floats
from lumitip.twin import Cable, Corner, HalfPlane, Image, Polygon, Scene, Sheet, Twin

CELLS = (32, 128, 512)
GOAL_SCENES, GOAL_BATCH = 10_000.0, 50_000.0
BATCH = 256
STAR = [
    (radius * np.cos(i * np.pi / 5), radius * np.sin(i * np.pi / 5))
    for i, radius in enumerate([9.0, 4.5] * 5)
]


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


def timed(name: str, cells: int, work: Callable[[int], object], frames: int = 1) -> float:
    """Print a line; returns frames a second."""
    rate = frames / each_s(work)
    print(f"{name:<46}{rate:>12,.0f}{rate * cells:>14,.0f}")
    return rate


def _read(twin: Twin, make: Callable[[int], Scene], index: int) -> Floats:
    """Values of the scene with a number."""
    return twin.values(make(index))


def scenes(twin: Twin) -> tuple[float, float]:
    """Scenes one by one and in batches; the least rate of moving scenes, and that of batches."""
    cells = len(twin.layout)
    places: list[float] = np.linspace(-6.0, 6.0, 64).tolist()
    poses: list[tuple[float, float]] = [(x, 30.0 * math.sin(x)) for x in places]

    def pose(number: int) -> tuple[float, float]:
        return poses[number % 64]

    drawn = Image.of(Polygon(STAR))
    stars = [np.add(STAR, (x, -x / 2.0)) for x, _ in poses]
    print(f"{f'{cells} cells':<46}{'frames/s':>12}{'readings/s':>14}")
    moving = [
        timed(name, cells, partial(_read, twin, make))
        for name, make in {
            "edge, by its table": lambda i: HalfPlane(*pose(i)),
            "cable, exact cylinder, by its table": lambda i: Cable(*pose(i)),
            "curved cable, by its table": lambda i: Cable(*pose(i), 0.02),
            "corner, on the raster": lambda i: Corner(*pose(i), -80.0, 90.0),
            "any drawn shape that moves, on the raster": lambda i: drawn.at(
                pose(i)[0], 1.0, pose(i)[1]
            ),
            "polygon of ten corners, new each time": lambda i: Polygon(stars[i % 64]),
            "corner of cloth that scatters": lambda i: Corner(*pose(i), diffuse=0.3),
        }.items()
    ]
    cloth = Sheet(clear=0.5)
    timed("cable on cloth, ray by ray", cells, lambda i: twin.values([Cable(*pose(i)), cloth]))
    pixels = twin.plane().x_mm.size
    coverage = np.random.default_rng(0).random((BATCH, pixels), dtype=np.float32)
    name = f"batch of {BATCH} coverages of {pixels} pixels"
    batch = timed(name, cells, lambda _: twin.batch(coverage), BATCH)
    offset, angle = np.array(poses * (BATCH // 64)).T
    edges = f"batch of {BATCH} edges, by their table"
    timed(edges, cells, lambda _: twin.edges(offset, angle), BATCH)
    return min(moving), batch


def main() -> int:
    """Print everything; the exit code."""
    rates = (0.0, 0.0)
    for cells in CELLS:
        layout = layout_of(PUBLISHED if cells == 32 else columns_for(cells), 6.0)
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
    on_one_core()
    sys.exit(main())

"""Random grids: columns that alternate, equal columns, one column, irregular patches."""

import math
from collections.abc import Callable
from random import Random

LEAST_CELLS, MOST_CELLS = 3, 257
USUAL_CELLS = (6, 80)
USUAL_SHARE = 0.8
MOST_ASPECT = 2.5
MOST_IN_ONE_COLUMN = 24
MOST_STEP = 3


def draw_cells(random: Random) -> int:
    """How many cells a user asks for."""
    if random.random() < USUAL_SHARE:
        return random.randint(*USUAL_CELLS)
    low, high = (USUAL_CELLS[1], MOST_CELLS) if random.random() < 0.75 else (LEAST_CELLS, 6)
    return round(math.exp(random.uniform(math.log(low), math.log(high))))


def draw_columns(random: Random, cells: int) -> list[int]:
    """Cells of each column, about as many in all as asked for."""
    draws: list[Callable[[Random, int, int], list[int]]]
    draws = [_alternating, _alternating, _equal, _patch]
    if cells <= MOST_IN_ONE_COLUMN:
        draws.append(_single)
    while True:
        aspect = MOST_ASPECT ** random.uniform(-1, 1)  # length over width
        count = max(2, round(math.sqrt(cells * 2 / math.sqrt(3) / aspect)))
        columns = random.choice(draws)(random, cells, count)
        if LEAST_CELLS <= sum(columns) <= MOST_CELLS:
            return columns


def _single(_random: Random, cells: int, _count: int) -> list[int]:
    return [cells]


def _alternating(random: Random, cells: int, count: int) -> list[int]:
    high, first = max(2, round(cells / count + 0.5)), random.randint(0, 1)
    return [high - (i + first) % 2 for i in range(count)]


def _equal(_random: Random, cells: int, count: int) -> list[int]:
    return [max(1, round(cells / count))] * count


def _patch(random: Random, cells: int, count: int) -> list[int]:
    """Columns about as long as an ellipse is high there, or a walk of random steps."""
    mean = cells / count
    if random.random() < 0.5:
        middle = (count - 1) / 2
        heights = [math.sqrt(1 - ((i - middle) / (middle + 0.5)) ** 2) for i in range(count)]
        wanted = [mean * h * count / sum(heights) for h in heights]
    else:
        wanted = [mean]
        while len(wanted) < count:
            wanted.append(wanted[-1] + random.randint(-MOST_STEP, MOST_STEP))
    columns = [max(1, round(wanted[0]))]
    for height in wanted[1:]:
        near = min(max(round(height), columns[-1] - MOST_STEP), columns[-1] + MOST_STEP)
        columns.append(max(1, math.ceil(mean / 3), near))
    return columns

"""The edge of the black: the finger's outline grown by the wrap allowance, and its folds."""

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.design import Outline

Points = NDArray[np.float64]

SAGITTA_MM = 0.28  # of a straight fold from the black's edge; 0.3 is promised
STEP_MM = 0.4  # between the points where folds may end
LONGEST_FOLD_MM = 20.0  # a longer flap is hard to lay down without a crease; the tip's may be


def grown(outline: Outline, by_mm: float, step_mm: float = np.inf) -> Points:
    """Corners of the outline moved out by `by_mm`, counter-clockwise from its first point.

    Args:
        outline: the finger's outline; smooth, so that each point has one normal.
        by_mm: how far to move it.
        step_mm: longest chord on straight pieces; curved ones are always fine.
    """
    corners = []
    for piece in outline.curve:
        p = np.array(piece)
        straight = np.allclose(p[1], p[0] + (p[3] - p[0]) / 3, atol=1e-9)
        steps = max(1, int(np.linalg.norm(p[3] - p[0]) / step_mm)) if straight else 96
        t = np.linspace(0.0, 1.0, steps + 1)[:-1, None]
        at = (1 - t) ** 3 * p[0] + 3 * t * (1 - t) ** 2 * p[1]
        at += 3 * t * t * (1 - t) * p[2] + t**3 * p[3]
        along = (1 - t) ** 2 * (p[1] - p[0]) + 2 * t * (1 - t) * (p[2] - p[1])
        along += t * t * (p[3] - p[2])
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        corners.append(at + by_mm * np.stack([along[:, 1], -along[:, 0]], axis=1))
    return np.concatenate(corners)


def fold_corners(outline: Outline, by_mm: float, start_x_mm: float) -> Points:
    """Ends of the folds, counter-clockwise from the right leg of the gripper end to the left.

    Straight chords of the black's edge, as few as the sagitta allows; mirror-symmetric, with one
    fold across the tip and none across the notch.

    Args:
        outline: the finger's outline.
        by_mm: the wrap allowance.
        start_x_mm: where the first fold begins at the gripper end.
    """
    edge = grown(outline, by_mm, 0.1)
    right = edge[edge[:, 0] >= 0]  # bottom to tip: the outline starts at its left end
    bottom = (right[:, 1] < edge[:, 1].min() + 1e-6) & (right[:, 0] <= start_x_mm)
    right = np.concatenate([[(start_x_mm, edge[:, 1].min())], right[~bottom]])
    tip = int(np.flatnonzero(right[:, 1] < right[-1, 1] - SAGITTA_MM)[-1]) + 1
    half = _chords(right[: tip + 1])
    return np.concatenate([half, half[::-1] * (-1.0, 1.0)])


def _chords(run: Points) -> Points:
    """Corners of the fewest chords along a run, and of those the ones with no narrow chord.

    The best way to each point is the best way to one before it, and one chord more.
    """
    passed = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(run, axis=0).T))])
    steps = max(1, round(passed[-1] / STEP_MM))
    run = run[np.unique(np.searchsorted(passed, np.linspace(0, passed[-1], steps + 1) - 1e-9))]
    ways: list[tuple[int, float, int]] = [(0, 0.0, 0)]  # chords, narrowness, point before
    for end in range(1, len(run)):
        found = []
        for start in range(end - 1, -1, -1):
            length = _chord_length(run[start : end + 1])
            if length is None:
                break
            count, narrowness, _ = ways[start]
            found.append((count + 1, narrowness + length**-2, start))
        ways.append(min(found))
    corners = [len(run) - 1]
    while corners[-1]:
        corners.append(ways[corners[-1]][2])
    return run[corners[::-1]]


def _chord_length(run: Points) -> float | None:
    """Length of the chord of a run, None where it does not follow it; neighbours always do."""
    chord = run[-1] - run[0]
    length = float(np.hypot(*chord))
    if len(run) == 2:
        return length
    off = (run - run[0]) @ np.array([chord[1], -chord[0]]) / length
    follows = length <= LONGEST_FOLD_MM and float(np.abs(off).max()) <= SAGITTA_MM
    return length if follows else None

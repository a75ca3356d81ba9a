"""Random deviations of built fingers, and the fingers that come of them."""

from collections.abc import Mapping

import numpy as np

from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip.twin.built import Built, turned
from lumitip_fab.catalogue.tolerances import Tolerances
from lumitip_fab.tolerance.streams import Stream, generator

FACTORS = tuple(Tolerances.model_fields)
"""Names of the deviations."""
_EACH = {"placement": 4, "led": 1, "detector": 1, "drift": 1}
"""Numbers that a deviation has for each cell."""
_WHOLE = {
    "mask_shift": 4,
    "mask_turn": 2,
    "mask_scale": 2,
    "hole": 2,
    "board": 4,
    "print": 4,
    "silicone": 2,
    "lean": 4,
    "gap": 1,
    "finger_shift": 2,
    "finger_tilt": 1,
    "exposure": 1,
    "scatter": 1,
}
"""Numbers that a deviation has for a pair of fingers: first the emitter's, then the receiver's."""
_LEAST_DEPTH_MM = 0.05
_LEAST_HOLE_MM = 0.1
_DARKEST = 0.2  # of the nominal light

Draws = Mapping[str, Floats]
"""Deviations by name, each of shape `(fingers, numbers)`, in mm, degrees or shares."""


def draw(
    tolerances: Tolerances,
    spread: Mapping[str, float],
    cells: int,
    fingers: int,
    seed: int,
    part: int = 0,
) -> Draws:
    """Draw deviations of many fingers; more fingers begin with the same ones.

    Args:
        tolerances: their distributions.
        spread: of each, see `spreads`.
        cells: of a finger.
        fingers: pairs of them.
        seed: of the random numbers; each deviation has its own stream.
        part: which of several independent sets of fingers.
    """
    drawn = {}
    for number, name in enumerate(FACTORS):
        chance = generator(seed, Stream.DEVIATIONS, part, number)
        shape = (fingers, _EACH[name] * cells if name in _EACH else _WHOLE[name])
        uniform = getattr(tolerances, name).distribution == "uniform"
        of = chance.uniform(-1.0, 1.0, shape) if uniform else chance.standard_normal(shape)
        drawn[name] = spread[name] * of
    return drawn


def directions(tolerances: Tolerances, drawn: Draws, seed: int) -> Floats:
    """Directions in which both masks of each finger are shifted, as unit vectors, shape `(fingers,
    2, 2)`: those of the shifts that were drawn, if these are as likely in any direction.

    Args:
        tolerances: their distributions.
        drawn: deviations of the fingers.
        seed: of other directions: a shift without a spread has none, and those of a uniform
            distribution crowd at the diagonals.
    """
    shift_mm = drawn["mask_shift"].reshape(-1, 2, 2)
    length_mm = np.linalg.norm(shift_mm, axis=2, keepdims=True)
    if tolerances.mask_shift.distribution == "normal" and length_mm.all():
        own: Floats = shift_mm / length_mm
        return own
    angle = generator(seed, Stream.DIRECTIONS).uniform(-np.pi, np.pi, (len(shift_mm), 2))
    return np.stack([np.cos(angle), np.sin(angle)], axis=2)


def built(layout: Layout, model: Model, draws: Draws, finger: int) -> Built:
    """One pair of fingers of those drawn.

    Args:
        layout: the cells.
        model: optics of the drawing.
        draws: deviations.
        finger: its number in them.
    """
    of = {name: row[finger] for name, row in draws.items()}
    cells = np.stack([layout.x_mm, layout.y_mm])
    from_middle = cells / np.maximum(np.abs(cells).max(axis=1, keepdims=True), 1.0)
    beside = of["finger_shift"][:, None]
    boards = (of["board"] + of["print"]).reshape(2, 2, 1)
    parts = of["placement"].reshape(2, 2, -1)
    masks = [
        (1.0 + scale) * turned(cells, turn_deg) + shift[:, None]
        for scale, turn_deg, shift in zip(
            of["mask_scale"], of["mask_turn"], of["mask_shift"].reshape(2, 2), strict=True
        )
    ]
    # Where the silicone leans out, it is thicker, and the gap is narrower.
    out = of["lean"].reshape(2, 2) @ from_middle
    deeper = (of["silicone"][:, None] + out) / model.silicone_index
    depths = np.array([[model.emitter_depth_mm], [model.detector_depth_mm]]) + deeper
    tilt = np.tan(np.radians(of["finger_tilt"]))
    gaps = 0.5 * (model.gap_mm + of["gap"] + tilt * layout.y_mm) - out
    emitter_depth, detector_depth = np.maximum(depths, _LEAST_DEPTH_MM)
    light = {name: np.maximum(1.0 + of[name], _DARKEST) for name in (*_EACH, "exposure")}
    holes = model.hole_mm * layout.hole_share + of["hole"][:, None]
    return Built(
        led_mm=cells + beside + boards[0] + parts[0],
        emitter_hole_mm=beside + masks[0],
        receiver_hole_mm=masks[1],
        detector_mm=cells + boards[1] + parts[1],
        hole_mm=np.maximum(holes, _LEAST_HOLE_MM),
        led_depth_mm=emitter_depth,
        detector_depth_mm=detector_depth,
        led_gap_mm=gaps[0],
        detector_gap_mm=gaps[1],
        alpha=float(np.clip(model.alpha + of["scatter"][0], 0.0, 1.0)),
        led=light["led"],
        detector=light["detector"],
        drift=light["drift"],
        exposure=float(light["exposure"][0]),
    )

"""Built fingers with faults, and their frames at each step of the acceptance protocol.

Every finger has the spread of `design/parts/tolerances.toml`; on top of that comes one fault. The
gauge has a play on its finger.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from lumitip.acceptance.gauge import Gauge
from lumitip.acceptance.steps import Frames
from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin import Model
from lumitip.twin.built import Lines, Rays
from lumitip.twin.optics import FULL, values_of_drive
from lumitip_fab.catalogue.tolerances import Tolerances
from lumitip_fab.tolerance.draws import Draws, built, draw

PLAY_MM = 0.1
"""Standard deviation of the gauge's place on its finger, in x and in y."""
TURN_DEG = 0.3
"""Standard deviation of its direction between its rails."""
STEADY, MOVING = 60, 300
"""Frames of a steady step, and of the sheet that is moved."""
NOISE = 1.5
_DEAD = 0.01  # light of a dead LED: some light reaches every cell
_DRIFTED = 0.5  # assumed
_GAP_SD_MM = 0.1  # of fingers that are closed on the gauge


@dataclass(frozen=True)
class Fault:
    """A fault of a finger; none by default."""

    kind: str = "none"
    cells: tuple[int, ...] = ()
    moved: tuple[tuple[str, int, float], ...] = ()
    """Name and entry of the finger's draws, and what is added to it."""


class Workshop:
    """Builds fingers of one layout."""

    def __init__(
        self, layout: Layout, gauge: Gauge, tolerances: Tolerances, spread: Mapping[str, float]
    ) -> None:
        """Choose rays; `spread` is that of the tolerances of the design."""
        self._layout, self._gauge = layout, gauge
        self._tolerances, self._spread = tolerances, dict(spread) | {"gap": _GAP_SD_MM}
        self.model = Model.from_layout(layout, gauge.gap_mm)
        self._rays = Rays(layout, self.model)

    def draws(self, count: int, seed: int) -> Draws:
        """Deviations of fingers without a fault."""
        return draw(self._tolerances, self._spread, len(self._layout), count, seed)

    def frames(self, draws: Draws, finger: int, fault: Fault, seed: int) -> Frames:
        """Frames of a finger at all steps.

        Args:
            draws: of `draws`.
            finger: its number in them.
            fault: added to it.
            seed: of noise and movement.
        """
        chance = np.random.default_rng((seed, finger))
        own = {name: rows[finger : finger + 1].copy() for name, rows in draws.items()}
        for name, entry, value in fault.moved:
            own[name][0, entry] += value
        pair = built(self._layout, self.model, own, 0)
        if fault.kind == "dead LED":
            pair.led[list(fault.cells)] = _DEAD
        light = self._rays.of(pair)
        exposure = max(1.0 + float(own["exposure"][0, 0]), 0.2)
        detector = 1.0 + own["detector"][0]
        full = light.full * np.maximum(detector, 0.2)
        drive = self.model.gain * exposure * full / full.max()
        beside = own["finger_shift"][0]
        slack = float(own["gap"][0, 0])

        def steady(share: Floats, at: Floats) -> Values:
            return self._read(np.tile(share, (STEADY, 1)), at, chance)

        # Gains drift after the first step, within ten minutes by half as much as since a tare.
        later = drive * np.maximum(1.0 + _DRIFTED * own["drift"][0], 0.2)
        states = {
            "empty": steady(np.ones(len(self._layout)), drive),
            "sheet": steady(np.full(len(self._layout), 1e-3), later),
            "moving": self._read(light.shares(path(self._layout, chance)), later, chance),
        }
        rows = []
        for placement in self._gauge.placements:
            x, y = PLAY_MM * chance.standard_normal(2)
            if placement.on == "emitter":
                x, y = x + beside[0], y + beside[1]
            angle = np.radians(placement.piece.angle_deg)
            # It is pressed on the finger that its rails hug.
            up = slack if placement.on == "emitter" else 0.0
            piece = replace(
                placement.piece,
                angle_deg=placement.piece.angle_deg + TURN_DEG * chance.standard_normal(),
                offset_mm=placement.piece.offset_mm + float(y * np.cos(angle) - x * np.sin(angle)),
                low_mm=placement.piece.low_mm + up,
                high_mm=placement.piece.high_mm + up,
            )
            rows.append(steady(light.behind(piece), later))
        swapped = _damaged(states | {f"gauge {n}": row for n, row in enumerate(rows)}, fault)
        count = len(rows)
        return Frames(
            swapped["empty"],
            swapped["sheet"],
            swapped["moving"],
            tuple(swapped[f"gauge {n}"] for n in range(count)),
        )

    def _read(self, share: Floats, drive: Floats, chance: np.random.Generator) -> Values:
        # Codes are whole steps of the voltage, rounded down, so the light is rounded up.
        value = values_of_drive(share * drive, self.model)
        value += NOISE * chance.standard_normal(value.shape)
        codes: Values = np.clip(np.ceil(value), 0.0, FULL).astype(np.float32)
        return codes


def path(layout: Layout, chance: np.random.Generator) -> Lines:
    """Edges of a sheet that is moved to and fro over all cells, turned from stroke to stroke."""
    reach = 0.6 * float(np.hypot(np.ptp(layout.x_mm), np.ptp(layout.y_mm)))
    strokes = 12
    angle = np.repeat(chance.permutation(strokes) * (2 * np.pi / strokes), MOVING // strokes)
    angle = angle + np.repeat(chance.normal(0.0, 0.1, strokes), MOVING // strokes)
    sweep = np.linspace(-reach, reach, MOVING // strokes)
    offset = np.concatenate([sweep if n % 2 else sweep[::-1] for n in range(strokes)])
    offset = offset + chance.normal(0.0, 0.1, offset.size)
    return Lines("edge", np.stack([angle, offset], axis=1))


def _damaged(states: dict[str, Values], fault: Fault) -> dict[str, Values]:
    if fault.kind == "swapped":
        one, two = fault.cells
        order = np.arange(states["empty"].shape[1])
        order[[one, two]] = two, one
        return {name: frames[:, order] for name, frames in states.items()}
    if fault.kind == "bridged":
        pair = list(fault.cells)
        for frames in states.values():
            frames[:, pair] = frames[:, pair].mean(axis=1, keepdims=True)
    level = {"open": 0.0, "short": FULL}.get(fault.kind)
    if level is not None:
        for frames in states.values():
            frames[:, list(fault.cells)] = level
    return states

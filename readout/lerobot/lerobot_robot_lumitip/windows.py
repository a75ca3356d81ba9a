"""A window of frames as features of LeRobot: names, values, and arrays read back from a dataset.

Features of the finger `left`, in the order of the dataset; `f0` is the oldest frame of the window,
the last is the newest, and a window that is not full has no frame in its first places:

    lumitip_left.f0.c0 … c31    ADC codes of its cells
    lumitip_left.f0.back        frames from it to the newest of the window, lost ones included
    lumitip_left.f0.age_s       from reading its cells to the end of the observation (s)
    lumitip_left.missed         frames since the observation before that are not in the window
    lumitip_left.seq            number of the newest frame, modulo 2^24
    lumitip_left.bits           of its codes
    lumitip_left.empty.c0 …     light of each cell with nothing in the grasp, 255 is full light
    lumitip_left.dark.c0 …      the same in the dark

All values of a place without a frame are -1. LeRobot stores float32, which holds all of these whole
numbers exactly.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumitip.calibration import Calibration
from lumitip.errors import ArgumentError
from lumitip.frame import Frame, Values, complement

SEQ_MODULUS = 1 << 24
NO_FRAME = -1.0
_NAME = re.compile(r"lumitip_(\w+)\.(?:f(\d+)\.(?:c\d+|back|age_s)|missed|seq|bits|\w+\.c\d+)")
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class WindowFeatures:
    """The features of one finger."""

    finger: str
    window: int
    cells: int
    trace: bool

    def names(self) -> list[str]:
        """All names, in the order of `values`."""
        cells = [f"c{i}" for i in range(self.cells)]
        names = [f"f{k}.{part}" for k in range(self.window) for part in (*cells, "back", "age_s")]
        names.append("missed")
        if self.trace:
            references = [f"{kind}.{cell}" for kind in ("empty", "dark") for cell in cells]
            names += ["seq", "bits", *references]
        return [f"lumitip_{self.finger}.{name}" for name in names]

    def values(
        self, frames: Sequence[Frame], now_s: float, missed: int, calibration: Calibration
    ) -> list[float]:
        """The values of one observation.

        Args:
            frames: the newest frames, oldest first, at most `window`.
            now_s: end of the observation, `time.monotonic` (s).
            missed: frames since the observation before that are not among them.
            calibration: the references of the finger.
        """
        table = np.full((self.window, self.cells + 2), NO_FRAME)
        first = self.window - len(frames)
        for row, frame in zip(table[first:], frames, strict=True):
            row[: self.cells] = frame.raw
            row[self.cells :] = frames[-1].seq - frame.seq, now_s - frame.t
        values: list[float] = [*table.ravel().tolist(), float(missed)]
        if self.trace:
            newest = frames[-1] if frames else None
            values.append(float(newest.seq % SEQ_MODULUS) if newest else NO_FRAME)
            values.append(float(newest.bits) if newest else NO_FRAME)
            for reference, default in ((calibration.empty, 255.0), (calibration.dark, 0.0)):
                values += [default] * self.cells if reference is None else reference.tolist()
        return values


@dataclass(frozen=True, eq=False)
class Windows:
    """Windows of one finger, read back from `n` rows of a dataset."""

    codes: Integers
    """ADC codes, high is dark, shape `(n, window, cells)`; -1 where there is no frame."""
    back: Integers
    """Frames from each to the newest of its window, shape `(n, window)`; -1 without a frame."""
    age_s: NDArray[np.float32]
    """From reading the cells to the end of the observation (s), shape `(n, window)`; -1 without a
    frame."""
    missed: Integers
    """Frames between two observations that are not in the window, shape `(n,)`."""
    seq: Integers | None = None
    """Number of each frame modulo 2^24, shape `(n, window)`; -1 without a frame."""
    bits: Integers | None = None
    """Bits of the codes, shape `(n,)`; -1 for an empty window."""
    empty: Values | None = None
    """Light of each cell with nothing in the grasp, shape `(n, cells)`."""
    dark: Values | None = None
    """The same in the dark."""

    @property
    def valid(self) -> NDArray[np.bool_]:
        """Whether there is a frame, shape `(n, window)`."""
        return self.back >= 0

    def values(self) -> Values:
        """Calibrated light, equal to `Frame.values`, shape `(n, window, cells)`; NaN without a
        frame.

        Raises:
            ArgumentError: if the dataset was recorded with `trace=false`.
        """
        if self.bits is None or self.empty is None or self.dark is None:
            raise ArgumentError(
                "the dataset has no bits and references; record it with --robot.trace=true"
            )
        values = np.full(self.codes.shape, np.nan, dtype=np.float32)
        for row, (codes, valid, bits) in enumerate(
            zip(self.codes, self.valid, self.bits.tolist(), strict=True)
        ):
            correction = Calibration("", "", self.empty[row], self.dark[row]).correction()
            if valid.any() and correction is not None:
                light = complement(codes[valid].astype(np.uint16), bits)
                values[row, valid] = correction.apply(light)
        return values


def read_windows(names: Sequence[str], states: Any) -> dict[str, Windows]:
    """The windows of all fingers, by their names.

    Args:
        names: of the features, `dataset.features["observation.state"]["names"]`.
        states: column `observation.state` of the dataset, shape `(n, len(names))`.

    Raises:
        ArgumentError: if there is no fingertip among the features, one of its features is missing,
            or the shape is wrong.
    """
    table = np.asarray(states, dtype=np.float32)
    if table.ndim != 2 or table.shape[1] != len(names):
        raise ArgumentError(f"states has shape {table.shape}; (n, {len(names)}) is needed")
    found: dict[str, list[tuple[int, int]]] = {}
    for column, name in enumerate(names):
        if match := _NAME.fullmatch(name):
            found.setdefault(match[1], []).append((column, int(match[2] or -1)))
    if not found:
        raise ArgumentError("no feature begins with lumitip_; the dataset has no fingertip")
    windows = {}
    for finger, columns in found.items():
        own = [names[column] for column, _ in columns]
        window = max(place for _, place in columns) + 1
        cells = sum(name.startswith(f"lumitip_{finger}.f0.c") for name in own)
        features = WindowFeatures(finger, window, cells, f"lumitip_{finger}.seq" in own)
        if own != features.names():
            raise ArgumentError(f"features of the finger {finger!r} are missing or in disorder")
        windows[finger] = _unpack(table[:, [column for column, _ in columns]], features)
    return windows


def _unpack(table: NDArray[np.float32], features: WindowFeatures) -> Windows:
    rows, cells = len(table), features.cells
    size = features.window * (cells + 2)
    frames = table[:, :size].reshape(rows, features.window, cells + 2)
    back = frames[:, :, cells].astype(np.int64)
    common = Windows(
        codes=frames[:, :, :cells].astype(np.int64),
        back=back,
        age_s=frames[:, :, cells + 1],
        missed=table[:, size].astype(np.int64),
    )
    if not features.trace:
        return common
    seq = (table[:, size + 1, None].astype(np.int64) - back) % SEQ_MODULUS
    return Windows(
        codes=common.codes,
        back=back,
        age_s=common.age_s,
        missed=common.missed,
        seq=np.where(back >= 0, seq, -1),
        bits=table[:, size + 2].astype(np.int64),
        empty=table[:, size + 3 : size + 3 + cells],
        dark=table[:, size + 3 + cells :],
    )

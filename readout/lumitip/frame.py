"""`Frame`: all cells at one moment, with its times; `Block`: several frames as arrays."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from lumitip.errors import ArgumentError, EndOfRecording, LinkTimeout
from lumitip.grid import Floats, Integers
from lumitip.values import one_line, shown

Codes = NDArray[np.uint8] | NDArray[np.uint16]
"""ADC codes of cells; high is dark."""
Values = NDArray[np.float32]
_Array = TypeVar("_Array", bound=NDArray[Any])


def frozen(array: _Array) -> _Array:
    """A copy that stays read-only, because its memory is a `bytes` object."""
    copy = np.frombuffer(array.tobytes(), array.dtype).reshape(array.shape)
    return cast(_Array, copy)


@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """All cells at one moment. Immutable, so safe for any thread."""

    seq: int
    """Number of the frame since the link was opened, lost frames included. For a legacy device,
    number of frames received."""
    t_device: float | None
    """Device clock: time since power-on (s); `None` for a legacy device."""
    t_host: float
    """Arrival of the packet, `time.monotonic` (s)."""
    t: float
    """Time the cells were read, `time.monotonic` (s): the device clock fitted to the host clock,
    late by the shortest delay of the link. Strictly increases, and frames are never closer than a
    quarter of their distance by the device clock: after a stall before the first frame of a link
    `t` is later than `t_host`, by a quarter of the stall and 0.05 s at most, until it has caught
    up. So test an age by `Fingertip.latest(max_age_s)`, which counts from the earlier of both.
    For a legacy device `t_host`, but frames that arrive in one bunch are spaced by the mean period:
    from 0.5 s before `t_host` to a period after it."""
    t_wall: float
    """`t` as seconds since 1970 (UTC), by the computer's clock; where that is set by more than
    0.05 s, later frames follow it. Those of one recording do not."""
    raw: Codes
    """ADC codes, high is dark, shape `(cells,)`, read-only."""
    bits: int
    """Bits of each code."""
    values: Values
    """Light of each cell, 255 is full light whatever the bits, calibrated, shape `(cells,)`,
    read-only."""
    dropped_before: int | None
    """Frames lost on the link just before this one; `None` if unknown: from a legacy device, or
    first after a restart of the device."""
    device_id: str
    """Bluetooth address, USB serial number or port."""

    def __repr__(self) -> str:
        return one_line(self)


@dataclass(frozen=True, eq=False, slots=True)
class RecordedFrame:
    """A frame of a recording; fields as in `Frame`."""

    seq: int
    t_device: float | None
    t_host: float
    t_wall: float
    raw: Codes
    bits: int
    dropped_before: int | None

    def __repr__(self) -> str:
        return one_line(self)


@dataclass(frozen=True, eq=False)
class Block:
    """Consecutive frames as arrays of `n` rows, in order."""

    seq: Integers
    """`Frame.seq`, shape `(n,)`."""
    t: Floats
    """`Frame.t` (s), shape `(n,)`."""
    t_wall: Floats
    """`Frame.t_wall` (s), shape `(n,)`."""
    raw: Codes
    """`Frame.raw`, shape `(n, cells)`."""
    values: Values
    """`Frame.values`, shape `(n, cells)`."""
    dropped: int | None
    """Frames missing between the first and the last; `None` for a legacy device."""

    def __len__(self) -> int:
        return len(self.seq)

    def __repr__(self) -> str:
        return one_line(self)

    @classmethod
    def of(cls, frames: Sequence[Frame]) -> "Block":
        """Stack one or more frames.

        Raises:
            ArgumentError: if there are no frames, or other objects among them.
        """
        valid = isinstance(frames, Sequence) and all(isinstance(frame, Frame) for frame in frames)
        if not valid or not frames:
            raise ArgumentError(f"frames is {shown(frames)}; one or more frames are needed")
        seq = np.array([f.seq for f in frames], dtype=np.int64)
        raw: Codes = np.array([f.raw for f in frames])
        counted = all(f.t_device is not None for f in frames)
        return cls(
            seq=seq,
            t=np.array([f.t for f in frames]),
            t_wall=np.array([f.t_wall for f in frames]),
            raw=raw,
            values=np.stack([f.values for f in frames]),
            dropped=int(seq[-1] - seq[0]) + 1 - len(seq) if counted else None,
        )


def too_late(frames: Sequence[Frame], number: int, timeout_s: float) -> LinkTimeout:
    """The error when too few frames came in time; it holds those that came."""
    error = LinkTimeout(
        f"{len(frames)} of {number} frames came in {timeout_s:g} s. Increase the timeout, "
        "or ask for fewer"
    )
    error.block = Block.of(frames) if frames else None
    return error


def ended_early(frames: Sequence[Frame], number: int, end: EndOfRecording) -> EndOfRecording:
    """The error when a recording ended too early; it holds the last frames."""
    error = EndOfRecording(f"{end}: {len(frames)} of {number} frames were left, in `block`")
    error.block = Block.of(frames) if frames else None
    return error


def complement(raw: Codes, bits: int) -> Values:
    """Light of ADC codes: 255 is full light, independent of the bits."""
    light: Values = np.float32(255.0) - raw * np.float32(255.0 / ((1 << bits) - 1))
    return light

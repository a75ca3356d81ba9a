"""`Frame`: all cells at one moment, with its times; `Block`: several of them as arrays."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from lumitip.errors import ArgumentError, EndOfRecording, LinkTimeout
from lumitip.grid import Floats, Integers
from lumitip.values import shown

Codes = NDArray[np.uint8] | NDArray[np.uint16]
"""Raw values of cells, dark is high."""
Values = NDArray[np.float32]
_Array = TypeVar("_Array", bound=NDArray[Any])


def frozen(array: _Array) -> _Array:
    """A copy that nobody can make writeable again, since it lies in `bytes`."""
    copy = np.frombuffer(array.tobytes(), array.dtype).reshape(array.shape)
    return cast(_Array, copy)


@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """All cells at one moment. Immutable, so it may be handed to any thread."""

    seq: int
    """Number of the frame since the link was opened: it grows by one and by every frame that was
    lost. Of a legacy device it counts what came."""
    t_device: float | None
    """Time since the device was switched on (s), by its own clock; `None` of a legacy device."""
    t_host: float
    """When the packet arrived, by `time.monotonic` (s)."""
    t: float
    """When the cells were read, by `time.monotonic` (s): the device's clock fitted to the host's,
    late by the shortest delay of the link. Never goes back. Of a legacy device `t_host`."""
    t_wall: float
    """`t` as seconds since 1970 (UTC)."""
    raw: Codes
    """ADC codes as they came, dark is high, shape `(cells,)`, read-only."""
    bits: int
    """Bits of each code."""
    values: Values
    """Light of each cell, 255 is full light whatever the bits, calibrated, shape `(cells,)`,
    read-only."""
    dropped_before: int | None
    """Frames lost on the way just before this one; `None` where nobody can tell: a legacy device,
    the first frame after the device started anew."""
    device_id: str
    """Where it came from: Bluetooth address, USB serial number or port."""


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
    """Frames missing between the first and the last; `None` of a legacy device."""

    def __len__(self) -> int:
        return len(self.seq)

    @classmethod
    def of(cls, frames: Sequence[Frame]) -> "Block":
        """The block of one or more frames.

        Raises:
            ArgumentError: if there are none, or something else.
        """
        told = isinstance(frames, Sequence) and all(isinstance(frame, Frame) for frame in frames)
        if not told or not frames:
            raise ArgumentError(f"{shown(frames)} given, a block needs frames, at least one")
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


def too_late(frames: Sequence[Frame], wanted: int, timeout_s: float) -> LinkTimeout:
    """What to raise when fewer frames than wanted came in time; it holds those."""
    error = LinkTimeout(
        f"{len(frames)} of {wanted} frames came in {timeout_s:g} s: give more time or ask for fewer"
    )
    error.block = Block.of(frames) if frames else None
    return error


def ended_early(frames: Sequence[Frame], wanted: int, end: EndOfRecording) -> EndOfRecording:
    """What to raise when a recording ended before as many frames as wanted; it holds the last."""
    error = EndOfRecording(f"{end}: {len(frames)} of {wanted} frames were left, in `block`")
    error.block = Block.of(frames) if frames else None
    return error


def complement(raw: Codes, bits: int) -> Values:
    """Light of codes that are high in the dark: 255 is full light, whatever the bits."""
    light: Values = np.float32(255.0) - raw * np.float32(255.0 / ((1 << bits) - 1))
    return light

"""What a twin is given: refused as a `TwinError` before it comes to an array."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from lumitip import arguments
from lumitip.grid import Floats
from lumitip.twin.optics import TwinError
from lumitip.twin.scene import Singles
from lumitip.values import shown


def gains(told: ArrayLike | None, cells: int) -> Floats:
    """The gain of each cell, 1 if none are told, shape `(cells,)`."""
    if told is None:
        return np.ones(cells)
    read = arguments.numbers(told, "gains", TwinError)
    if read.shape != (cells,) or not (np.isfinite(read) & (read >= 0.0)).all():
        raise TwinError(f"gains: {shown(told)} given, {cells} numbers from 0 on are needed")
    return read.copy()


def height(told: float) -> float:
    """A height in the gap, 0 (receiver) to 1 (emitter)."""
    return arguments.number(told, "height", 0.0, 1.0, error=TwinError)


def coverage(told: Singles, pixels: int) -> None:
    """Refuse a coverage that is not of a raster of so many pixels."""
    if told.ndim != 2 or told.shape[1] != pixels:
        raise TwinError(f"coverage of shape {told.shape} given, the raster has (n, {pixels})")


def alike(**told: ArrayLike) -> Sequence[Floats]:
    """Arrays of one shape `(n,)`, of such arrays and single numbers."""
    read = {
        name: np.atleast_1d(arguments.numbers(of, name, TwinError)) for name, of in told.items()
    }
    shapes = {of.shape for of in read.values()} - {(1,)}
    if len(shapes) > 1 or any(of.ndim != 1 or not np.isfinite(of).all() for of in read.values()):
        shapes_told = ", ".join(f"{name} of shape {of.shape}" for name, of in read.items())
        raise TwinError(f"{shapes_told} given, as many finite numbers in each, or one, are needed")
    return np.broadcast_arrays(*read.values())

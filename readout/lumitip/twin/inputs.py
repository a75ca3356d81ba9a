"""Checks of a twin's inputs; a wrong one raises a `TwinError`."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from lumitip import arguments
from lumitip.grid import Floats
from lumitip.twin.optics import TwinError
from lumitip.twin.scene import Singles
from lumitip.values import shown


def gains(values: ArrayLike | None, cells: int) -> Floats:
    """The gain of each cell, 1 without `values`, shape `(cells,)`."""
    if values is None:
        return np.ones(cells)
    read = arguments.numbers(values, "gains", TwinError)
    if read.shape != (cells,) or not (np.isfinite(read) & (read >= 0.0)).all():
        raise TwinError(f"gains is {shown(values)}; {cells} numbers from 0 on are needed")
    return read.copy()


def height(value: float) -> float:
    """A height in the gap, 0 (receiver) to 1 (emitter)."""
    return arguments.number(value, "height", 0.0, 1.0, error=TwinError)


def coverage(rows: Singles, pixels: int) -> None:
    """Reject a coverage whose rows are not of a raster with so many pixels."""
    if rows.ndim != 2 or rows.shape[1] != pixels:
        raise TwinError(f"coverage has shape {rows.shape}; the raster needs (n, {pixels})")


def alike(**values: ArrayLike) -> Sequence[Floats]:
    """Arrays of one shape `(n,)`, of such arrays and single numbers."""
    read = {
        name: np.atleast_1d(arguments.numbers(of, name, TwinError)) for name, of in values.items()
    }
    shapes = {of.shape for of in read.values()} - {(1,)}
    if len(shapes) > 1 or any(of.ndim != 1 or not np.isfinite(of).all() for of in read.values()):
        shapes_of = ", ".join(f"{name} has shape {of.shape}" for name, of in read.items())
        raise TwinError(f"{shapes_of}; each needs as many finite numbers, or one")
    return np.broadcast_arrays(*read.values())

"""Inputs of a twin, checked."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from lumitip import arguments
from lumitip.grid import Floats
from lumitip.protocol.packet import BITS
from lumitip.twin.optics import TwinError
from lumitip.values import shown


def cell_gains(gains: ArrayLike | None, cells: int) -> Floats:
    """Gains of the cells, shape `(cells,)`; 1 without any."""
    if gains is None:
        return np.ones(cells)
    values = arguments.numbers(gains, "gains", TwinError)
    if values.shape != (cells,) or not (np.isfinite(values) & (values >= 0.0)).all():
        raise TwinError(f"gains is {shown(gains)}; {cells} numbers from 0 on are needed")
    return values.copy()


def code_bits(bits: int) -> int:
    """Bits of a raw code, one of `BITS`."""
    bits = arguments.count(bits, "bits", error=TwinError)
    if bits not in BITS:
        allowed = ", ".join(map(str, BITS))
        raise TwinError(f"bits is {shown(bits)}; one of {allowed} is needed")
    return bits


def height_in_gap(height: float) -> float:
    """Height in the gap, 0 (receiver) to 1 (emitter)."""
    return arguments.number(height, "height", 0.0, 1.0, error=TwinError)


def same_shape(**arrays: ArrayLike) -> Sequence[Floats]:
    """Arrays of one shape `(n,)`, from such arrays and single numbers."""
    values = {
        name: np.atleast_1d(arguments.numbers(of, name, TwinError)) for name, of in arrays.items()
    }
    shapes = {of.shape for of in values.values()} - {(1,)}
    if len(shapes) > 1 or any(of.ndim != 1 or not np.isfinite(of).all() for of in values.values()):
        found = ", ".join(f"{name} of shape {of.shape}" for name, of in values.items())
        raise TwinError(f"{found}: arrays of one length, of finite numbers, are needed")
    return np.broadcast_arrays(*values.values())

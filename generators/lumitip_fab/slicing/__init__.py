"""Slicing what was built, with PrusaSlicer: time, mass and what hangs in the air."""

from lumitip_fab.slicing.slicer import Sliced, slice_parts

__all__ = ["Sliced", "slice_parts"]

"""Lumitip on the robot's side: the layout of a fingertip and everything that reads it.

Needs numpy alone; links, recording and views come with extras.
"""

from lumitip.errors import LayoutError, LumitipError
from lumitip.layout import Cell, Layout, Optics

__all__ = ["Cell", "Layout", "LayoutError", "LumitipError", "Optics"]

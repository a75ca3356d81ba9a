"""Optical twin of a fingertip: the values that it would read of a scene. Needs numpy alone.

from lumitip.twin import Cable, Twin
Twin(layout).values(Cable(angle_deg=30.0, diameter_mm=4.0))
"""

from lumitip.twin.optics import Model, TwinError
from lumitip.twin.outline import Image, Polygon
from lumitip.twin.pairs import Misregistration
from lumitip.twin.scene import Cable, Corner, Disc, HalfPlane, Line, Scene, Shape, Sheet, Thing
from lumitip.twin.tables import LineTable
from lumitip.twin.twin import Twin

__all__ = [
    "Cable",
    "Corner",
    "Disc",
    "HalfPlane",
    "Image",
    "Line",
    "LineTable",
    "Misregistration",
    "Model",
    "Polygon",
    "Scene",
    "Shape",
    "Sheet",
    "Thing",
    "Twin",
    "TwinError",
]

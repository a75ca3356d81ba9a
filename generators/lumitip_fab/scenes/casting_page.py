"""A mould with its finger, and the page on which its cut is drawn, as it stands on the table.

In the frame of the mould's bed: the tip to the left, the open side up.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import shapely

from lumitip_fab.design import Box, frames
from lumitip_fab.design.cabling import COLOURS, codes_of
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.cut import cut, rings_of
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette
from lumitip_fab.scenes.finger_views import smooth
from lumitip_fab.scenes.glb import tints

WIDTH_MM = 154.0  # of a cut on the page
SIDE = View(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]))  # y right, z up
LABEL_MM, WORDS_MM = 8.0, 40.0
_ARC_STEPS = 24
_HEAD_MM = 3.0  # of an arrow
_ABREAST_MM = 1.2  # from wire to wire on the page
Words = tuple[str, str]


@dataclass(frozen=True, eq=False)
class Wire:
    """A wire of a finger in its mould."""

    colour: str
    """Codes of IEC 60757."""
    held_mm: Points
    """Places in the finger, shape `(n, 3)`."""
    lying_mm: Points
    """From the weir to the table."""


@dataclass(frozen=True, eq=False)
class Cast:
    """A mould with its finger, as if it lay in it."""

    mould: Mesh
    layers: Mapping[str, Mesh]
    """Interface, backing, board and silicone of the finger by name, from the back."""
    rim_mm: float
    """Height of the mould's stops."""
    tip_y_mm: float
    """Tip edge of the plate."""
    films: tuple[Box, ...]
    """Cuts of what lies smooth on the floor."""
    prop: Mesh | None = None
    """Under the gripper end, where the mould is tilted."""
    slope: float = 0.0
    """Height that the silicone's level gains for each mm towards the tip."""
    screws: tuple[Mesh, ...] = ()
    """On the rails, with the nuts that fix them."""
    wires: tuple[Wire, ...] = ()

    @property
    def lean_deg(self) -> float:
        """Of the mould on its prop."""
        return math.degrees(math.atan(self.slope))

    def turned(self, names: tuple[str, ...], by_deg: float) -> dict[str, Mesh]:
        """Layers of the finger, turned about its tip edge, the gripper end up."""
        turn = self._turn(by_deg)
        return {name: self.layers[name].moved(turn) for name in names if name in self.layers}

    def ways(self, by_deg: float) -> list[Points]:
        """Wires of a finger that is turned so: what lies over the weir stays there."""
        turn = self._turn(by_deg)
        found = []
        for wire in self.wires:
            held = wire.held_mm @ turn[:3, :3].T + turn[:3, 3]
            lying = wire.lying_mm[1:] if by_deg else wire.lying_mm
            found.append(smooth([*held, *lying]))
        return found

    def _turn(self, by_deg: float) -> frames.Matrix:
        about = frames.translation(0.0, self.tip_y_mm, self.rim_mm)
        return np.asarray(about @ frames.rotation_x(by_deg) @ np.linalg.inv(about))


class Page:
    """A sheet for the cut of a mould, enlarged, and turned as it stands."""

    def __init__(self, cast: Cast) -> None:
        self._turn = frames.rotation_x(cast.lean_deg)[1:3, 1:3]
        self.cast, self.mould = cast, cut(cast.mould)
        low, bottom, high, _ = self.mould.bounds
        self.scale = WIDTH_MM / (high - low)
        self._sheet, self._labels = Sheet(), list[tuple[Words, Points]]()
        below_rim = shapely.box(low, bottom, high, cast.rim_mm)
        within = shapely.Point(cast.tip_y_mm + 10.0, cast.rim_mm - 0.05)
        hollows = shapely.get_parts(below_rim - self.mould)
        self.cavity = min(hollows, key=lambda hollow: float(hollow.distance(within)))

    def behind(self, *meshes: Mesh) -> None:
        """Contours of what is cut, to show what lies behind the cut."""
        for mesh in meshes:
            rings = [self._placed(ring) for ring in silhouette(mesh, SIDE)]
            self._sheet.area(rings, "behind", "#fbfbfa")

    def fill(self, area: shapely.Geometry, tint: str) -> None:
        """Paint an area."""
        with self._sheet.group(tint):
            rings = [self._placed(ring) for ring in rings_of(area)]
            self._sheet.area(rings, "body", tints()[tint])

    def fill_mould(self) -> None:
        """Paint the mould, and the film on its floor."""
        self.fill(self.mould, "mould")
        for film in self.cast.films:
            self.fill(shapely.box(*film.bounds_mm), "film")

    def fill_all(self, areas: Mapping[str, shapely.Geometry]) -> None:
        """Paint layers, each in its own tint."""
        for name, area in areas.items():
            self.fill(area, name)

    def turn(self, from_deg: float, to_deg: float) -> None:
        """An arrow about the tip edge, over the gripper end."""
        radius = 0.9 * (self.mould.bounds[2] - self.cast.tip_y_mm)
        turns = np.radians(np.linspace(from_deg, to_deg, _ARC_STEPS))
        about = np.array([self.cast.tip_y_mm, self.cast.rim_mm])
        arc = self._placed(about + radius * np.column_stack([np.cos(turns), np.sin(turns)]))
        self._sheet.lines([arc, _head(arc)], "mark")

    def wires(self, by_deg: float) -> None:
        """The wires of a finger that is turned so, one over the other."""
        for k, way in enumerate(self.cast.ways(by_deg)):
            line = np.add(self._placed(way[:, 1:]), (0.0, _ABREAST_MM * k))
            self._sheet.wire(line, inks(self.cast.wires[k].colour))

    def label(self, words: Words, y_mm: float, z_mm: float) -> None:
        """Words with a line to a place."""
        self._labels.append((words, self._placed(np.array([[y_mm, z_mm]]))[0]))

    def stand(self) -> None:
        """The prop, if there is one, and the table under both."""
        if self.cast.prop is None:
            return
        self.fill(cut(self.cast.prop), "clamp")
        low, high = self._sheet.low, self._sheet.high
        self._sheet.lines([np.array([(low[0], low[1]), (high[0], low[1])])], "leader")

    def _placed(self, points: Points) -> Points:
        """Places of the mould's frame on the page."""
        return np.asarray(self.scale * points @ self._turn.T)

    def svg(self) -> str:
        """The page, its labels in a row below."""
        right = float(self._sheet.high[0]) - WORDS_MM
        row = float(self._sheet.low[1]) - LABEL_MM
        labels = sorted(self._labels, key=lambda label: float(label[1][0]))
        free = float(self._sheet.low[0])
        for k, (words, at) in enumerate(labels):
            most = right - WORDS_MM * (len(labels) - 1 - k)
            x = max(min(float(at[0]), most), free)
            free = x + WORDS_MM
            self._sheet.lines([np.array([at, (x, row + 4.0)])], "leader")
            self._sheet.dot(float(at[0]), float(at[1]))
            self._sheet.words(x, row, words[0], "name", "start")
            self._sheet.words(x, row - 4.0, words[1], "detail", "start")
            self._sheet.cover(x, row - 5.0)
        return self._sheet.svg({"data-scale": self.scale})


def inks(colour: str) -> list[str]:
    """Of a wire's insulation, the ground first."""
    return [COLOURS[code][1] for code in codes_of(colour)]


def _head(line: Points) -> Points:
    """The head of an arrow along a line."""
    way = math.atan2(*(line[-1] - line[-2])[::-1])
    sides = [way + math.pi + turn for turn in (-0.45, 0.45)]
    ends = [line[-1] + _HEAD_MM * np.array([math.cos(a), math.sin(a)]) for a in sides]
    return np.array([ends[0], line[-1], ends[1]])

"""Drawings of the casting: the mould cut along its middle, filled, with the finger going into it,
and with the finger coming out; and the clamp that holds it.

In the frame of the mould's bed: the tip to the left, the open side up.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import affinity

from lumitip_fab.design import Box, Clamp, frames
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.cut import cut, rings_of
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, view, visible_lines
from lumitip_fab.scenes.glb import tints

WIDTH_MM = 154.0  # of a cut on the page
BULGE_MM = 1.2  # of the silicone over the rim, as it is drawn
BELOW_WEIR_MM = 0.3  # of the silicone in a tilted mould, as it is drawn
LOWERED_DEG, LIFTED_DEG = 9.0, 4.0  # of the finger to the mould, as they are drawn
AZIMUTH_DEG, ELEVATION_DEG = 38.0, 30.0
CLAMP_SCALE = 1.4
_SIDE = View(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]))  # y right, z up
_LABEL_MM, _WORDS_MM = 8.0, 40.0
_ARC_STEPS = 24
_ARC_DEG = 7.0
_HEAD_MM = 3.0  # of an arrow
Words = tuple[str, str]


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

    def turned(self, names: tuple[str, ...], by_deg: float) -> dict[str, Mesh]:
        """Layers of the finger, turned about its tip edge, the gripper end up."""
        about = frames.translation(0.0, self.tip_y_mm, self.rim_mm)
        turn = about @ frames.rotation_x(by_deg) @ np.linalg.inv(about)
        return {name: self.layers[name].moved(turn) for name in names if name in self.layers}


def filled_view(cast: Cast) -> str:
    """The mould, filled until the silicone bulges over the rim; or tilted on its prop, the
    silicone level, as the table is."""
    page = _Page(cast, math.degrees(math.atan(cast.slope)))
    left, low, right, _ = page.cavity.bounds
    page.behind(cast.mould)
    words = "a little over the weir"
    if cast.prop is None:
        page.fill(shapely.union(page.cavity, _bulge(left, right, cast.rim_mm)), "silicone")
    else:
        words = "level, higher at the tip"
        page.fill(_poured(cast, page.mould, right), "silicone")
        page.fill(cut(cast.prop), "clamp")
        page.table()
        page.label(("Prop", "its stop at the mould's end"), page.mould.bounds[2] - 1.0, -0.5)
    page.fill_mould()
    page.label(("Silicone", words), (left + right) / 2, cast.rim_mm - 0.5)
    page.label(("Weir", "as high as the stops"), right + 1.0, cast.rim_mm)
    page.label(("Trough", "for the surplus"), page.mould.bounds[2] - 5.0, low)
    return page.svg()


def lowered_view(cast: Cast) -> str:
    """The finger, its tip on the stop, being lowered about it."""
    page = _Page(cast)
    layers = cast.turned(("interface", "backing", "board"), LOWERED_DEG)
    areas = {name: cut(mesh) for name, mesh in layers.items()}
    page.behind(cast.mould, *layers.values())
    page.fill(page.cavity - shapely.union_all(list(areas.values())), "silicone")
    page.fill_mould()
    page.fill_all(areas)
    page.turn(LOWERED_DEG + _ARC_DEG, LOWERED_DEG)
    page.label(("Tip", "first, on its stop"), cast.tip_y_mm + 0.5, cast.rim_mm + 1.0)
    page.label(("Weir", "wires and surplus go over it"), page.cavity.bounds[2] + 1.0, cast.rim_mm)
    return page.svg()


def lifted_view(cast: Cast) -> str:
    """The cast finger coming out, its gripper end first."""
    page = _Page(cast)
    layers = cast.turned(("silicone", "interface", "backing", "board"), LIFTED_DEG)
    page.behind(cast.mould, *layers.values())
    page.fill_mould()
    page.fill_all({name: cut(mesh) for name, mesh in layers.items()})
    page.turn(LIFTED_DEG, LIFTED_DEG + _ARC_DEG)
    page.label(("Gripper end", "first, until air is under it"), page.cavity.bounds[2] - 2.0, 4.0)
    last = "its silicone is thin" if cast.prop is None else "the skin goes round it"
    page.label(("Tip edge", f"last: {last}"), cast.tip_y_mm + 0.5, cast.rim_mm)
    return page.svg()


def clamped_view(cast: Cast, clamp: Clamp | None, printed: Mesh | None) -> str:
    """The finger in its mould, and the clamp that holds it, if there is one.

    Args:
        cast: mould and finger.
        clamp: for its marks.
        printed: its mesh, where it lies on the finger.
    """
    eye, sheet = view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(CLAMP_SCALE), Sheet()
    bodies = {"mould": cast.mould} | {
        name: mesh for name, mesh in cast.layers.items() if name in ("interface", "backing")
    }
    if printed is not None:
        bodies["clamp"] = printed
    lines = visible_lines(list(bodies.values()), eye)
    for name, mesh in bodies.items():
        with sheet.group(name):
            sheet.area(silhouette(mesh, eye), "body", tints()[name])
    for found in lines:
        sheet.lines(found, "line")
    labels = [] if clamp is None else _clamp_labels(clamp, eye)
    right = float(sheet.high[0]) + _LABEL_MM
    sheet.leaders(labels, right, "start")
    if labels:
        sheet.cover(right + _WORDS_MM, float(sheet.low[1]))
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def _clamp_labels(clamp: Clamp, eye: View) -> list[tuple[Words, Points]]:
    """A nut's place, and the marks of the leg that is nearest to the viewer; sensor y is -y."""
    nuts = [np.array([x, -y, clamp.top_mm]) for x, y in clamp.screws]
    legs = [
        np.array([leg.x_max_mm if leg.x_max_mm > 0 else leg.x_min_mm, -leg.y_min_mm, clamp.mark_mm])
        for leg in clamp.legs
    ]
    nut, leg = (max(places, key=lambda at: float(eye.seen(at)[2])) for places in (nuts, legs))
    return [
        (("Nut", "here, on each screw"), eye.seen(nut)[:2]),
        (("Marks", "of leg and mould in one line"), eye.seen(leg)[:2]),
    ]


class _Page:
    """A sheet for the cut of a mould, enlarged, and turned as it stands."""

    def __init__(self, cast: Cast, lean_deg: float = 0.0) -> None:
        self._turn = frames.rotation_x(lean_deg)[1:3, 1:3]
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
            rings = [self._placed(ring) for ring in silhouette(mesh, _SIDE)]
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
        radius = 0.9 * (self.mould.bounds[2] - self.cast.tip_y_mm) * self.scale
        turns = np.radians(np.linspace(from_deg, to_deg, _ARC_STEPS))
        about = np.array([self.cast.tip_y_mm, self.cast.rim_mm]) * self.scale
        arc = about + radius * np.column_stack([np.cos(turns), np.sin(turns)])
        self._sheet.lines([arc, _head(arc)], "mark")

    def label(self, words: Words, y_mm: float, z_mm: float) -> None:
        """Words with a line to a place."""
        self._labels.append((words, self._placed(np.array([[y_mm, z_mm]]))[0]))

    def table(self) -> None:
        """The line on which the lowest of what was drawn stands."""
        low, high = self._sheet.low, self._sheet.high
        self._sheet.lines([np.array([(low[0], low[1]), (high[0], low[1])])], "leader")

    def _placed(self, points: Points) -> Points:
        """Places of the mould's frame on the page."""
        return np.asarray(self.scale * points @ self._turn.T)

    def svg(self) -> str:
        """The page, its labels in a row below."""
        right = float(self._sheet.high[0]) - _WORDS_MM
        row = float(self._sheet.low[1]) - _LABEL_MM
        labels = sorted(self._labels, key=lambda label: float(label[1][0]))
        free = float(self._sheet.low[0])
        for k, (words, at) in enumerate(labels):
            most = right - _WORDS_MM * (len(labels) - 1 - k)
            x = max(min(float(at[0]), most), free)
            free = x + _WORDS_MM
            self._sheet.lines([np.array([at, (x, row + 4.0)])], "leader")
            self._sheet.dot(float(at[0]), float(at[1]))
            self._sheet.words(x, row, words[0], "name", "start")
            self._sheet.words(x, row - 4.0, words[1], "detail", "start")
            self._sheet.cover(x, row - 5.0)
        return self._sheet.svg({"data-scale": self.scale})


def _bulge(left_mm: float, right_mm: float, rim_mm: float) -> shapely.Geometry:
    """The silicone over the rim: half an ellipse."""
    centre = shapely.Point((left_mm + right_mm) / 2, 0.0)
    ellipse = affinity.scale(centre.buffer(1.0, 32), (right_mm - left_mm) / 2, BULGE_MM)
    above = shapely.box(left_mm, 0.0, right_mm, BULGE_MM)
    return affinity.translate(shapely.intersection(ellipse, above), 0.0, rim_mm)


def _poured(cast: Cast, mould: shapely.Geometry, weir_mm: float) -> shapely.Geometry:
    """The silicone in a tilted mould, before the finger raises it to the weir."""
    wall_mm = mould.bounds[0]
    top_mm = cast.rim_mm - BELOW_WEIR_MM
    raised_mm = top_mm + cast.slope * (weir_mm - wall_mm)
    corners = [(wall_mm, 0.0), (weir_mm, 0.0), (weir_mm, top_mm), (wall_mm, raised_mm)]
    parts = shapely.get_parts(shapely.difference(shapely.Polygon(corners), mould))
    return max(parts, key=lambda part: float(part.area))


def _head(line: Points) -> Points:
    """The head of an arrow along a line."""
    way = math.atan2(*(line[-1] - line[-2])[::-1])
    sides = [way + math.pi + turn for turn in (-0.45, 0.45)]
    ends = [line[-1] + _HEAD_MM * np.array([math.cos(a), math.sin(a)]) for a in sides]
    return np.array([ends[0], line[-1], ends[1]])

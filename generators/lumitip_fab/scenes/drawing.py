"""Line drawings of meshes: visible lines by a buffer of depths, on a page in mm, y up."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from xml.sax.saxutils import escape

import numpy as np
import shapely
import trimesh
from numpy.typing import NDArray

from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.depths import PIXEL_MM, counted, depths_mm, sides

Points = NDArray[np.float64]
Label = tuple[tuple[str, str], Points]
"""Name and detail, and the place that they point at."""
LINE_MM = 9.0  # from label to label

_INK, _FAINT = "#1a1a1a", "#5a6b7a"
_ROUND = 'stroke-linecap="round" stroke-linejoin="round"'
_STROKES = {
    "area": f'stroke="{_INK}" stroke-width=".5" {_ROUND}',
    "body": f'stroke="{_INK}" stroke-width=".3" {_ROUND}',
    "behind": f'stroke="{_FAINT}" stroke-width=".15" {_ROUND}',
    "part": f'stroke="{_INK}" stroke-width=".12" {_ROUND}',
    "line": f'fill="none" stroke="{_INK}" stroke-width=".22" {_ROUND}',
    "axis": f'fill="none" stroke="{_FAINT}" stroke-width=".18" stroke-dasharray="3 .8 .5 .8"',
    "hidden": f'fill="none" stroke="{_INK}" stroke-width=".18" stroke-dasharray="1.4 .8"',
    "mark": f'fill="none" stroke="#c0392b" stroke-width=".4" {_ROUND}',
    "estimate": f'fill="none" stroke="#d81b8c" stroke-width=".8" {_ROUND}',
    "leader": f'fill="none" stroke="{_FAINT}" stroke-width=".18"',
}
_WORDS = {
    "title": (6.0, f'font-weight="bold" fill="{_INK}"'),
    "name": (3.6, f'font-weight="bold" fill="{_INK}"'),
    "detail": (3.0, f'fill="{_FAINT}"'),
    "number": (4.0, f'fill="{_INK}"'),
}


@dataclass
class Sheet:
    """A page that grows with what is drawn on it."""

    margin_mm: float = 8.0
    words_scale: float = 1.0
    """Size of words against those of a single finger's drawing."""
    drawn: list[str] = field(default_factory=list)
    low: Points = field(default_factory=lambda: np.full(2, np.inf))
    high: Points = field(default_factory=lambda: np.full(2, -np.inf))

    @contextmanager
    def group(self, name: str) -> Iterator[None]:
        """Everything drawn meanwhile is one element, with this id."""
        self.drawn.append(f'<g id="{name}">')
        yield
        self.drawn.append("</g>")

    def area(self, rings: Iterable[Points], style: str, fill: str) -> None:
        """A filled area; rings inside others are holes."""
        path = "".join(f"M{self._joined(ring)}Z" for ring in rings)
        self.drawn.append(f'<path {_STROKES[style]} fill="{fill}" fill-rule="evenodd" d="{path}"/>')

    def lines(self, lines: Sequence[Points], style: str) -> None:
        """Open lines."""
        if lines:
            path = "".join(f"M{self._joined(line)}" for line in lines)
            self.drawn.append(f'<path {_STROKES[style]} d="{path}"/>')

    def wire(self, line: Points, colours: Sequence[str]) -> None:
        """A wire with a dark edge that parts it from its neighbours; a second colour as dashes."""
        path = f'fill="none" {_ROUND} d="M{self._joined(line)}"'
        self.drawn.append(f'<path stroke="{_FAINT}" stroke-width="1.1" {path}/>')
        for dashes, colour in zip(("", ' stroke-dasharray="1 2"'), colours, strict=False):
            self.drawn.append(f'<path stroke="{colour}" stroke-width=".8"{dashes} {path}/>')

    def dot(self, x_mm: float, y_mm: float) -> None:
        """Where a leader points at."""
        self.drawn.append(f'<circle fill="{_FAINT}" cx="{x_mm:.2f}" cy="{0.0 - y_mm:.2f}" r=".6"/>')

    def words(self, x_mm: float, y_mm: float, text: str, style: str, anchor: str) -> None:
        """A line of text on its baseline.

        Args:
            x_mm, y_mm: where it is anchored.
            text: what it says.
            style: `"title"`, `"name"`, `"detail"` or `"number"`.
            anchor: `"start"`, `"middle"` or `"end"`.
        """
        size, look = _WORDS[style]
        self.drawn.append(
            f'<text font-size="{size * self.words_scale:g}" {look} x="{x_mm:.2f}" '
            f'y="{0.0 - y_mm:.2f}" text-anchor="{anchor}">{escape(text)}</text>'
        )

    def leaders(self, labels: list[Label], x_mm: float, anchor: str) -> float:
        """A column of labels with a line from each to its place; labels keep apart. Returns the
        height of the lowest label's lower edge.

        Args:
            labels: name and detail of each, and where it points at.
            x_mm: where the words begin or end.
            anchor: `"start"` or `"end"`.
        """
        gap = 1.5 if anchor == "start" else -1.5
        scale = self.words_scale
        bend = x_mm - 4 * gap
        below = math.inf
        for words, at in sorted(labels, key=lambda label: -float(label[1][1])):
            y = min(float(at[1]), below - LINE_MM * scale)
            below = y
            self.lines([np.array([at, (bend, y), (x_mm, y)])], "leader")
            self.dot(float(at[0]), float(at[1]))
            self.words(x_mm + gap, y + 0.4 * scale, words[0], "name", anchor)
            self.words(x_mm + gap, y - 3.2 * scale, words[1], "detail", anchor)
        return below - 4.0 * scale

    def leaders_beside(self, labels: list[Label], words_mm: float, gap_mm: float = 8.0) -> float:
        """Labels in a column on the right of what is drawn. Returns the height of the lowest
        label's lower edge.

        Args:
            labels: as of `leaders`.
            words_mm: room for the words.
            gap_mm: from the drawing to the words.
        """
        right = float(self.high[0]) + gap_mm
        low = self.leaders(labels, right, "start")
        self.cover(right + words_mm, float(labels[0][1][1]))
        return low

    def cover(self, x_mm: float, y_mm: float) -> None:
        """Make the page reach a point."""
        self._joined(np.array([[x_mm, y_mm]]))

    def svg(self, figures: Mapping[str, float]) -> str:
        """The page, cut to what is on it.

        Args:
            figures: figures that go with it, for programs; their names begin with `data-`.
        """
        left, bottom = self.low - self.margin_mm
        right, top = self.high + self.margin_mm
        width, height = right - left, top - bottom
        return "\n".join(
            [
                f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.2f}mm" '
                f'height="{height:.2f}mm" viewBox="{left:.2f} {-top:.2f} {width:.2f} {height:.2f}" '
                'font-family="Helvetica, Arial, sans-serif"'
                + "".join(f' {name}="{value:g}"' for name, value in figures.items())
                + ">",
                f'<rect x="{left:.2f}" y="{-top:.2f}" width="{width:.2f}" height="{height:.2f}" '
                'fill="#fff"/>',
                *self.drawn,
                "</svg>\n",
            ]
        )

    def _joined(self, points: Points) -> str:
        self.low = np.minimum(self.low, points.min(axis=0))
        self.high = np.maximum(self.high, points.max(axis=0))
        return "L".join(f"{x:.2f},{0.0 - y:.2f}" for x, y in points.tolist())


PIECE_MM = 0.6  # of an edge that is seen or not as a whole
BEHIND_MM = 0.4  # by which a line may lie behind what is nearest: the buffer's own error
SHARP_DEG = 25.0  # between two faces, to be drawn as an edge
_NEAR_MM = 0.02  # of a simplified line from what it stands for
_EDGE_ON = 1e-2  # sine of the angle of a face to the line of sight, at most
_SLIT_MM = 0.01  # half the width of a slit in a silhouette that is closed


TALLEST_MM = 110.0
"""Of a picture of the manual, beside the words of a step."""


@dataclass(frozen=True, eq=False)
class View:
    """A direction of view; the page's x and y and the way to the viewer, as rows, which are as
    long as the page is enlarged."""

    axes: Points

    def enlarged(self, scale: float) -> "View":
        """The same view at another scale of the page."""
        return View(self.axes * scale)

    def fitted(self, meshes: Iterable[Mesh], tallest_mm: float = TALLEST_MM) -> "View":
        """The same view, smaller where things would be taller on the page than allowed: a page of
        the manual has room for a step's words, too."""
        ys = np.concatenate([self.seen(mesh.points_mm)[:, 1] for mesh in meshes])
        return self.enlarged(min(1.0, tallest_mm / float(np.ptp(ys))))

    @property
    def scale(self) -> float:
        """Lengths on the page to those of the thing."""
        return float(np.linalg.norm(self.axes[0]))

    def seen(self, points_mm: Points) -> Points:
        """Points as x and y on the page and height above it, shape `(n, 3)`."""
        return np.asarray(points_mm @ self.axes.T)


def view(azimuth_deg: float, elevation_deg: float) -> View:
    """A viewer at some angle from -y towards +x, and above the plane z = 0."""
    turn, lift = math.radians(azimuth_deg), math.radians(elevation_deg)
    right = np.array([math.cos(turn), math.sin(turn), 0.0])
    viewer = np.array(
        [math.sin(turn) * math.cos(lift), -math.cos(turn) * math.cos(lift), math.sin(lift)]
    )
    return View(np.stack([right, np.cross(viewer, right), viewer]))


def silhouette(mesh: Mesh, seen_by: View) -> list[Points]:
    """Outer and inner contours of a body on the page.

    The lines along which it turns away from the viewer divide the page; what a triangle covers of
    the pieces is the body.
    """
    seen = seen_by.seen(mesh.points_mm)
    solid = trimesh.Trimesh(mesh.points_mm, mesh.triangles, process=False)
    front = _front(mesh, seen)
    turns = solid.face_adjacency_edges[front[solid.face_adjacency].sum(axis=1) == 1]
    flat = seen[:, :2]
    contour = shapely.union_all(shapely.linestrings(flat[turns]), grid_size=0.001)
    pieces = shapely.get_parts(shapely.polygonize([contour]))
    triangles = shapely.STRtree(shapely.polygons(flat[mesh.triangles[front]]))
    covered, _ = triangles.query(shapely.point_on_surface(pieces), predicate="intersects")
    whole = shapely.simplify(shapely.coverage_union_all(pieces[np.unique(covered)]), _SLIT_MM / 2)
    whole = whole.buffer(_SLIT_MM, join_style="mitre").buffer(-_SLIT_MM, join_style="mitre")
    whole = shapely.simplify(whole, _NEAR_MM)
    return [
        np.array(ring.coords)
        for part in shapely.get_parts(whole)
        for ring in (part.exterior, *part.interiors)
    ]


def visible_lines(meshes: list[Mesh], seen_by: View) -> list[list[Points]]:
    """Sharp edges and contours of each body that no body hides, on the page."""
    seen = [seen_by.seen(mesh.points_mm) for mesh in meshes]
    low, depths = depths_mm(
        points[mesh.triangles] for mesh, points in zip(meshes, seen, strict=True)
    )
    return [_lines(mesh, points, depths, low) for mesh, points in zip(meshes, seen, strict=True)]


def _lines(mesh: Mesh, seen: Points, depths: Points, low: Points) -> list[Points]:
    """The pieces of a body's edges that are seen, joined."""
    starts, ends = _edges(mesh, seen)
    lengths = np.linalg.norm(ends - starts, axis=1)
    counts = np.maximum(np.ceil(lengths / PIECE_MM).astype(int), 1)
    edge = np.repeat(np.arange(len(counts)), counts)
    step = counted(counts)
    share = counts[edge][:, None]
    way = ends[edge] - starts[edge]
    first = starts[edge] + way * (step[:, None] / share)
    last = starts[edge] + way * ((step[:, None] + 1) / share)
    middle = (first + last) / 2
    column, row = np.round((middle[:, :2] - low) / PIXEL_MM).astype(int).T
    # The lowest of the neighbours: a contour's own pixel may be that of what is before it.
    around = [depths[row + i, column + j] for i in (-1, 0, 1) for j in (-1, 0, 1)]
    shown = middle[:, 2] >= np.min(around, axis=0) - BEHIND_MM
    pieces = np.round(np.stack([first, last], axis=1)[shown][:, :, :2], 4)
    pieces = pieces[np.abs(pieces[:, 0] - pieces[:, 1]).max(axis=1) > 1e-3]
    joined = shapely.line_merge(shapely.union_all(shapely.linestrings(pieces), grid_size=0.001))
    lines = shapely.simplify(shapely.get_parts(joined), _NEAR_MM)
    return [np.array(line.coords) for line in lines]


def _edges(mesh: Mesh, seen: Points) -> tuple[Points, Points]:
    """Both ends of each edge that is sharp, or where the body turns away from the viewer."""
    solid = trimesh.Trimesh(mesh.points_mm, mesh.triangles, process=False)
    pairs = _front(mesh, seen)[solid.face_adjacency]
    sharp = np.degrees(solid.face_adjacency_angles) > SHARP_DEG
    drawn = (sharp & pairs.any(axis=1)) | (pairs[:, 0] != pairs[:, 1])
    ends = solid.face_adjacency_edges[drawn]
    return seen[ends[:, 0]], seen[ends[:, 1]]


def _front(mesh: Mesh, seen: Points) -> NDArray[np.bool_]:
    """Whether each triangle looks to the viewer; one that is seen edge-on does not: which way it
    turns is rounding, and every edge of an upright wall would be drawn."""
    normal = np.cross(*sides(seen[mesh.triangles]))
    return np.asarray(normal[:, 2] > _EDGE_ON * np.linalg.norm(normal, axis=1))

"""`PanelBoard`: a panel as its file has it, with the board that it has copies of.

Everything is in the frame of the panel: mm, y up.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import shapely
from shapely import affinity
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard, path_of, read_any
from lumitip_fab.checks.readers.kicad_board import Part, Terminal, read_board
from lumitip_fab.design import Component, Design, Panel, PanelRules, Point
from lumitip_fab.design.panel import in_copy

_CLOSED_MM = 1e-5  # ends of lines nearer than this meet
_ON_EDGE_MM = 0.01
_LEAST_CONTACT_MM = 0.1  # what chords of round corners leave is shorter


@dataclass(frozen=True, eq=False)
class PanelBoard(ReadBoard):
    """A panel's file with what it should be."""

    single: ReadBoard
    """The board by itself."""
    panel: Panel

    @property
    def name(self) -> str:
        """Name of its folder and its files."""
        return self.panel.name

    @property
    def rules(self) -> PanelRules:
        """The strictest figures of all PCB fabs."""
        return self.panel.rules

    @property
    def copy_ends(self) -> tuple[str, str]:
        """Ends of the references in its first and last copy."""
        return in_copy("", 1), in_copy("", len(self.panel.copies))

    @property
    def components(self) -> tuple[Component, ...]:
        """The parts of each copy, where the design has their places."""
        return tuple(
            replace(part, ref=in_copy(part.ref, copy), x_mm=part.x_mm + x, y_mm=part.y_mm + y)
            for copy, (x, y) in enumerate(self.panel.copies, start=1)
            for part in self.single.components
        )

    def ordered(self, ref: str) -> tuple[str, str]:
        """Order number of a part and its number at LCSC: those of the part on the board."""
        return self.single.ordered(ref.rpartition("_")[0])

    def flat(self, area: BaseGeometry) -> BaseGeometry:
        """An area of the page in the panel's frame."""
        return shapely.transform(area, self.sensor)

    def at(self, place: Point) -> Point:
        """A place on the page in the panel's frame."""
        x, y = self.sensor([place])[0].tolist()
        return x, y

    @cached_property
    def faces(self) -> tuple[shapely.Polygon, ...]:
        """The areas that the drawn edges close, the largest outline first: the panel itself, then
        its routed openings."""
        edges = shapely.set_precision(np.array(self.board.edges, dtype=object), _CLOSED_MM)
        rings = shapely.get_parts(shapely.polygonize([shapely.union_all(edges)]))
        flat = [self.flat(ring) for ring in rings]
        return tuple(sorted(flat, key=lambda face: -face.envelope.area))

    @property
    def body(self) -> shapely.Polygon:
        """The panel without its openings."""
        return self.faces[0]

    @cached_property
    def openings(self) -> BaseGeometry:
        """Its routed openings."""
        return shapely.union_all(list(self.faces[1:]))

    @cached_property
    def inside(self) -> BaseGeometry:
        """The room within its frame."""
        return self.openings.envelope

    @cached_property
    def copies(self) -> tuple[BaseGeometry, ...]:
        """The outline of the board in the place of each copy."""
        outline = self.flat(self.single.outline)
        return tuple(affinity.translate(outline, *by) for by in self.panel.copies)

    @cached_property
    def tabs(self) -> tuple[BaseGeometry, ...]:
        """What joins copies to the frame and to each other."""
        rest = (self.body & self.inside) - shapely.union_all(list(self.copies))
        joined = shapely.union_all(list(self.copies)).buffer(_ON_EDGE_MM)
        parts = shapely.get_parts(rest.buffer(-_ON_EDGE_MM).buffer(_ON_EDGE_MM))
        return tuple(part for part in parts if part.intersects(joined))

    @cached_property
    def contacts(self) -> tuple[tuple[BaseGeometry, ...], ...]:
        """Of each copy, the pieces of its edge that are not routed."""
        routed = self.openings.buffer(_ON_EDGE_MM)
        found = []
        for copy in self.copies:
            left = shapely.line_merge(copy.exterior - routed)
            lines = shapely.get_parts(left).tolist()
            found.append(tuple(line for line in lines if line.length > _LEAST_CONTACT_MM))
        return tuple(found)

    @cached_property
    def bites(self) -> tuple[Terminal, ...]:
        """Unplated holes that reach over the edge of a copy."""
        edges = shapely.union_all([copy.exterior for copy in self.copies])
        return tuple(
            hole
            for hole in self.holes
            if shapely.Point(self.at(hole.at)).distance(edges) < hole.drill_mm / 2
        )

    @cached_property
    def on_frame(self) -> tuple[Part, ...]:
        """Parts, marks and holes on its rails and bars."""
        inside = self.inside
        return tuple(
            part
            for part in self.board.parts
            if not inside.intersects(shapely.Point(self.at(part.at)))
        )


def read_panel(outputs: Path, design: Design, panel: Panel) -> PanelBoard:
    """A panel and its board.

    Raises:
        OutputError: if one of their files cannot be read.
    """
    single = read_any(outputs, design, panel.board)
    path = path_of(panel.name)
    board = read_board(outputs / path)
    return PanelBoard("panels", path, board, design, single.of, single, panel)

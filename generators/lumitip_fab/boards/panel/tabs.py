"""Places of the tabs that hold a board in its panel, and of their mouse bites."""

import itertools
from collections.abc import Iterable, Iterator

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from lumitip_fab.boards.model import BoardModel, PlacedComponent
from lumitip_fab.boards.placed import placed_pads
from lumitip_fab.design import Box, Panel, PanelRules, Point
from lumitip_fab.errors import BuildError

_STEP_MM = 0.1
_NOISE_MM = 1e-6


def tab_places(panel: Panel, model: BoardModel) -> tuple[float, ...]:
    """The middle of each tab along the two edges of a board that face the rails, in the board's
    frame: each as near to the middle of its share of the edge as parts and copper allow. Both edges
    have the same, so that a tab can join two copies.

    Raises:
        BuildError: if a share has no room, with the numbers.
    """
    board, rules = model.placement, panel.rules
    box, half = board.outline, rules.contact_mm / 2
    ends = box.y_min_mm + board.corner_mm + half, box.y_max_mm - board.corner_mm - half
    kept = (
        (_parts(model), rules.part_mm),
        (_lands(model), rules.pad_mm),
        (copper := _copper(model), rules.copper_mm),
    )
    shares = np.linspace(box.y_min_mm, box.y_max_mm, panel.tabs + 1)
    found = []
    for low, high in itertools.pairwise(shares.tolist()):
        first, last = max(low + half, ends[0]), min(high - half, ends[1])
        middle = min(max((low + high) / 2, first), last)
        steps = np.arange(0.0, max(last - first, 0.0) + _NOISE_MM, _STEP_MM)
        places = np.round([middle, *(middle + steps), *(middle - steps)], 6)
        places = places[(places >= first - _NOISE_MM) & (places <= last + _NOISE_MM)]
        free = places[_free(places, box, rules, kept) & _clear(places, box, rules, copper)]
        if not free.size:
            remedy = "Make board.side_margin_mm greater, or write" if board.cells else "Write"
            raise BuildError(
                f"the panel of the {board.name} board has no room for a tab of "
                f"{rules.contact_mm:.2f} mm between y {low:.2f} and {high:.2f} mm on its left and "
                f"right edge: parts need {rules.part_mm:g} mm, pads for wires and holes "
                f"{rules.pad_mm:g} mm, copper {rules.copper_mm:g} mm. {remedy} "
                'board.panel = "none"'
            )
        found.append(float(free[np.abs(free - middle).argmin()]))
    return tuple(found)


def bites(rules: PanelRules, box: Box, y_mm: float) -> tuple[Point, ...]:
    """Middles of the holes of a tab's mouse bites along a board's left and right edge."""
    outside = rules.bite_mm / 2 - rules.bite_inset_mm
    row = np.linspace(-rules.bite_row_mm / 2, rules.bite_row_mm / 2, rules.bites) + y_mm
    edges = box.x_min_mm - outside, box.x_max_mm + outside
    return tuple((x, round(float(y), 6)) for x in edges for y in row)


def _free(
    places: NDArray[np.float64],
    box: Box,
    rules: PanelRules,
    kept: tuple[tuple[BaseGeometry, float], ...],
) -> NDArray[np.bool_]:
    """Whether a tab in each of these places is far enough from everything on both edges."""
    half, ok = rules.contact_mm / 2, np.ones(len(places), dtype=bool)
    for x in (box.x_min_mm, box.x_max_mm):
        lines = np.array([[(x, y - half), (x, y + half)] for y in places.tolist()])
        contacts = shapely.linestrings(lines.reshape(-1, 2, 2))
        for area, least_mm in kept:
            ok &= _apart(contacts, area, least_mm)
    return ok


def _clear(
    places: NDArray[np.float64], box: Box, rules: PanelRules, copper: BaseGeometry
) -> NDArray[np.bool_]:
    """Whether the holes of a tab in each of these places are far enough from copper."""
    holes = [shapely.multipoints(bites(rules, box, y)) for y in places.tolist()]
    return _apart(np.array(holes, dtype=object), copper, rules.bite_mm / 2 + rules.copper_mm)


def _apart(shapes: NDArray[np.object_], area: BaseGeometry, least_mm: float) -> NDArray[np.bool_]:
    """Whether each is so far from an area, which may be empty."""
    return np.asarray(~(shapely.distance(shapes, area) < least_mm - _NOISE_MM))


def _parts(model: BoardModel) -> BaseGeometry:
    """Mounted parts with their pads."""
    parts = [part for part in model.placement.components if part.part]
    boxes = [part.body_on_board for part in parts]
    shapes = [shapely.box(*b.bounds_mm) for b in boxes]
    return shapely.union_all([*shapes, *_pads(parts)])


def _lands(model: BoardModel) -> BaseGeometry:
    """Pads for wires, and unplated holes."""
    board = model.placement
    holes = [shapely.Point(at).buffer(size / 2) for at, size in board.unplated]
    wires = [part for part in board.components if part.contacts and not part.part]
    return shapely.union_all([*holes, *_pads(wires)])


def _pads(parts: Iterable[PlacedComponent]) -> Iterator[BaseGeometry]:
    yield from (pad.area for part in parts for pad in placed_pads(part))


def _copper(model: BoardModel) -> BaseGeometry:
    tracks = model.routing.tracks
    vias = ((via.x_mm, via.y_mm, via.diameter_mm) for via in model.routing.vias)
    return shapely.union_all(
        [
            *(fill.area for fill in model.fills),
            *(shapely.LineString((t.start, t.end)).buffer(t.width_mm / 2) for t in tracks),
            *(shapely.Point(x, y).buffer(size / 2) for x, y, size in vias),
            *_pads(model.placement.components),
        ]
    )

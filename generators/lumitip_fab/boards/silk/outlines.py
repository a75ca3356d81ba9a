"""Courtyard and silkscreen outline of each kind of component, by the rules of the board."""

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import fields

import shapely
from shapely import LineString

from lumitip_fab.boards.courtyards import land
from lumitip_fab.boards.model import AT_CELLS, Cells, PlacedComponent, Stroke
from lumitip_fab.boards.placed import placed, placed_pads
from lumitip_fab.design import Box, Component, Footprint, Pad, Rules

_BAR_MM = 0.3  # at the first contact
_NOTCH_MM = 0.4  # of a multiplexer's body
_DOT_MM = 0.02  # a stroke so short is a dot
_BARE = ("wires", "test point", "fiducial")
_MARKED = (
    *AT_CELLS,
    "multiplexer",
    "regulator",
    "current source",
    "transistor",
    "switch",
    "tvs diode",
    "esd diode",
    "schottky diode",
    "indicator",
    "socket",
    "header",
    "module",
)
_ROOMY_MM, _CLOSE_MM = 0.7, 0.6
_NOISE_MM = 1e-6


def with_outline(component: Component, rules: Rules, cells: Cells | None = None) -> PlacedComponent:
    """A component with its courtyard and its outline.

    Args:
        component: in its place, or not yet.
        rules: gap between parts, lines and gaps of the silkscreen.
        cells: of the board. The gap at cells decides the outline of the parts that stand there:
            from 0.7 mm on, a bracket goes round the marked end; where a bar at the marked end has
            no room, lines stand beside the marked pad. Other parts of such a board stand apart,
            and have longer lines than those of a board without cells.
    """
    apart_mm = math.inf if cells else _CLOSE_MM
    gap_mm = cells.gap_mm if cells and component.kind in AT_CELLS else apart_mm
    return PlacedComponent(
        **{field.name: getattr(component, field.name) for field in fields(Component)},
        courtyard=_courtyard(component, rules),
        outline=_outline(component, rules, gap_mm),
    )


def without_crowded_lines(
    parts: Sequence[PlacedComponent], rules: Rules
) -> tuple[PlacedComponent, ...]:
    """The parts of a board without outlines that are too near to another part's pads. Outlines
    that mark the first pad stay."""
    pads = [pad for part in parts for pad in placed_pads(part)]
    tree = shapely.STRtree([pad.area for pad in pads])

    def clear(part: PlacedComponent, stroke: Stroke) -> bool:
        line = LineString([placed(part, *point) for point in stroke.points])
        away_mm = stroke.width_mm / 2 + rules.silk_gap_mm - _NOISE_MM
        near = tree.query(line, predicate="dwithin", distance=away_mm)
        return not any(part.side in pads[k].sides for k in near)

    return tuple(
        part
        if part.kind in _MARKED or all(clear(part, stroke) for stroke in part.outline)
        else dataclasses.replace(part, outline=())
        for part in parts
    )


def _courtyard(component: Component, rules: Rules) -> Box:
    shape = component.footprint
    if component.kind == "fiducial":
        return shape.body.grown(shape.pads[0].width_mm / 2)  # a clear ring for cameras
    return land(shape).grown(rules.part_gap_mm / 2)


def _outline(component: Component, rules: Rules, gap_mm: float) -> tuple[Stroke, ...]:
    shape, kind, roomy = component.footprint, component.kind, gap_mm >= _ROOMY_MM
    if kind in _BARE:
        return ()
    if kind in AT_CELLS:
        if roomy:
            return (_bracket(shape, rules),)
        fits = gap_mm >= 2 * rules.silk_gap_mm + rules.silk_line_mm - _NOISE_MM
        return (_bar(shape, rules),) if fits else _beside(shape, rules)
    if kind in ("socket", "header"):
        return _socket(shape, rules)
    if kind in ("regulator", "current source", "transistor", "switch"):
        return (_dot(shape.pads[0], rules, _BAR_MM),)
    if kind in ("tvs diode", "esd diode", "schottky diode", "indicator"):
        return (_bar(shape, rules), *_sides(shape, rules, roomy))
    if kind == "multiplexer":
        return _multiplexer(shape, rules)
    if kind == "resistor array":
        return _ends(shape, rules)
    if kind == "module":
        return _module(shape, rules)
    return _sides(shape, rules, roomy)


def _bracket(shape: Footprint, rules: Rules) -> Stroke:
    """Round the marked end of a chip."""
    first, line = shape.pads[0], rules.silk_line_mm
    x = first.x_mm - first.width_mm / 2 - rules.silk_gap_mm - line / 2
    y = _half_mm(shape) + rules.silk_gap_mm + line / 2
    return Stroke(((0.0, y), (x, y), (x, -y), (0.0, -y)), line)


def _bar(shape: Footprint, rules: Rules) -> Stroke:
    """At the marked end of a chip."""
    first, line = shape.pads[0], rules.silk_line_mm
    x = first.x_mm - first.width_mm / 2 - rules.silk_gap_mm - line / 2
    half = _half_mm(shape)
    return Stroke(((x, -half), (x, half)), line)


def _beside(shape: Footprint, rules: Rules) -> tuple[Stroke, ...]:
    """On both sides of a chip's marked pad."""
    first, line = shape.pads[0], rules.silk_line_mm
    x, half = first.x_mm, (first.width_mm - line) / 2
    y = _half_mm(shape) + rules.silk_gap_mm + line / 2
    return tuple(Stroke(((x - half, side), (x + half, side)), line) for side in (y, -y))


def _half_mm(shape: Footprint) -> float:
    """Half the width of a chip's pads and body."""
    return max(shape.pads[0].height_mm, shape.body.length_mm) / 2


def _sides(shape: Footprint, rules: Rules, roomy: bool) -> tuple[Stroke, ...]:
    """A line along each side of a chip's body, between the pads where they are as wide as it."""
    first, line = shape.pads[0], rules.silk_line_mm
    x = -first.x_mm - first.width_mm / 2 - rules.silk_gap_mm - line / (2 if roomy else 1)
    y = shape.body.y_max_mm + line / 2
    least = 0.0 if roomy else line
    return tuple(Stroke(((-x, side), (x, side)), line) for side in (y, -y)) if x > least else ()


def _ends(shape: Footprint, rules: Rules) -> tuple[Stroke, ...]:
    """A line along each end of a body whose pads are along its sides."""
    body, line = shape.body, rules.silk_line_mm
    return tuple(
        Stroke(((x, body.y_min_mm), (x, body.y_max_mm)), line)
        for x in (body.x_min_mm - line / 2, body.x_max_mm + line / 2)
    )


def _multiplexer(shape: Footprint, rules: Rules) -> tuple[Stroke, ...]:
    """The body between the rows of pads, with a notch at lead 1's end, and a dot at lead 1."""
    first, body = shape.pads[0], shape.body
    left, right = body.x_min_mm, body.x_max_mm
    inner = -first.y_mm - first.height_mm / 2 - rules.silk_gap_mm - rules.silk_line_mm / 2
    y = min(inner, body.y_max_mm)
    outline = (
        (left, _NOTCH_MM),
        (left, y),
        (right, y),
        (right, -y),
        (left, -y),
        (left, -_NOTCH_MM),
        (left + _NOTCH_MM, -_NOTCH_MM),
        (left + _NOTCH_MM, _NOTCH_MM),
        (left, _NOTCH_MM),
    )
    return Stroke(outline, rules.silk_line_mm), _dot(first, rules, _BAR_MM / 2)


def _dot(first: Pad, rules: Rules, away_mm: float) -> Stroke:
    """A dot beyond lead 1, away from the body."""
    x, y = first.x_mm, first.y_mm - first.height_mm / 2 - rules.silk_gap_mm - away_mm
    return Stroke(((x, y), (x + _DOT_MM, y)), _BAR_MM)


def _module(shape: Footprint, rules: Rules) -> tuple[Stroke, ...]:
    """A line along both long sides, which end before the antenna's end at the board's edge, one
    along the other end, and a dot beside pad 1."""
    body, pen, away = shape.body, rules.silk_line_mm, rules.silk_gap_mm + _BAR_MM
    high = body.y_max_mm - 2 * away
    frame = body.grown(pen / 2)
    left, right, bottom = frame.x_min_mm, frame.x_max_mm, frame.y_min_mm
    dot = left - away, shape.pads[0].y_mm
    return (
        Stroke(((left, high), (left, bottom), (right, bottom), (right, high)), pen),
        Stroke((dot, (dot[0] + _DOT_MM, dot[1])), _BAR_MM),
    )


def _socket(shape: Footprint, rules: Rules) -> tuple[Stroke, ...]:
    """The body's outline, and a bar beside its first contact."""
    body, first, pen = shape.body, shape.pads[0], rules.silk_line_mm
    inner = body.grown(-pen / 2)
    left, right, low, high = inner.x_min_mm, inner.x_max_mm, inner.y_min_mm, inner.y_max_mm
    around = ((left, low), (right, low), (right, high), (left, high), (left, low))
    end = math.copysign(body.x_max_mm + rules.silk_gap_mm + _BAR_MM / 2, first.x_mm)
    reach = (high - abs(first.y_mm)) / 2
    bar = (end, first.y_mm - reach), (end, first.y_mm + reach)
    return Stroke(around, pen), Stroke(bar, _BAR_MM)

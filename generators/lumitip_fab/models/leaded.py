"""Packages with gull-wing leads in two rows."""

from build123d import Solid

from lumitip_fab.design import Footprint, Pad, Point
from lumitip_fab.models.shapes import MARK, METAL, PLASTIC, Named, bent
from lumitip_fab.parts.shapes import box_solid, cylinder

_STAND_OFF_MM = 0.1
_LEAD_MM = 0.15  # thickness
_FOOT_MM = 0.5  # on the board
_WIDTH_SHARE = 0.65  # of a pad: the lead on it
_DOT_MM = 0.5
_DEEP_MM = 0.05
_IN_MM = 0.3  # from the corner of the body to the dot, beyond its radius


def leaded(shape: Footprint) -> tuple[Named, ...]:
    """Body, leads, and a dot at lead 1."""
    body, height = shape.body, shape.height_mm
    dot_mm = min(_DOT_MM, body.length_mm / 4)
    aside = dot_mm / 2 + _IN_MM
    at = body.x_min_mm + aside, body.y_min_mm + aside
    dot = cylinder(at, dot_mm, height - _DEEP_MM, height)
    leads = [_lead(shape, pad) for pad in shape.pads]
    return (
        Named("body", [box_solid(body, _STAND_OFF_MM, height) - dot], PLASTIC),
        Named("dot", [dot], MARK),
        Named("leads", leads, METAL),
    )


def _lead(shape: Footprint, pad: Pad) -> Solid:
    """From the side of the body down to the board."""
    side = 1.0 if pad.y_mm > 0 else -1.0
    wall, thick = shape.body.y_max_mm, _LEAD_MM
    tip, middle = max(shape.lead_tips_mm / 2, wall + thick), shape.height_mm / 2
    bend = max(tip - _FOOT_MM, (wall + tip) / 2)  # outer face of the upright piece
    profile: tuple[Point, ...] = (
        (wall, middle - thick / 2),
        (wall, middle + thick / 2),
        (bend, middle + thick / 2),
        (bend, thick),
        (tip, thick),
        (tip, 0.0),
        (bend - thick, 0.0),
        (bend - thick, middle - thick / 2),
    )
    if bend - thick <= wall:  # so short that it goes straight down along the body
        profile = (
            (wall, 0.0),
            (wall, middle),
            (bend, middle),
            (bend, thick),
            (tip, thick),
            (tip, 0.0),
        )
    return bent([(side * y, z) for y, z in profile], pad.x_mm, _WIDTH_SHARE * pad.width_mm)

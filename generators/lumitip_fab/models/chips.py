"""Packages without leads: chips with two metal ends, arrays of them, and a module with its can."""

from lumitip_fab.design import Box, Footprint
from lumitip_fab.models.shapes import GOLD, LAMINATE, MARK, METAL, Colour, Named
from lumitip_fab.parts.shapes import box_solid, cylinder

_END_SHARE = 0.2  # of the length, each end
_COLOURS: dict[str, Colour] = {
    "resistor": (0.13, 0.13, 0.14),
    "capacitor": (0.62, 0.47, 0.32),
    "fuse": (0.88, 0.88, 0.82),
    "inductor": (0.27, 0.27, 0.28),
    "crystal": (0.72, 0.70, 0.62),
    "tvs diode": (0.16, 0.16, 0.17),
    "led": (0.95, 0.90, 0.70),
    "indicator": (0.80, 0.95, 0.82),
    "photodetector": (0.30, 0.26, 0.34),
}
_OTHER: Colour = (0.5, 0.5, 0.5)
_LENS = ("led", "photodetector", "indicator")
_FOOT_SHARE = 0.4  # of the height of a part with a lens: its ends, and the board under the lens
_LENS_SHARE = 0.7  # of the length
_MODULE_MM = 0.8  # thickness of a module's own board
_CAN_MM = 0.5  # from the sides of the module to its can
_MARK_MM = 0.4


def chip(kind: str, shape: Footprint) -> tuple[Named, ...]:
    """A chip along x; LEDs and detectors have a lens, and a mark at terminal 1."""
    body, height = shape.body, shape.height_mm
    colour = _COLOURS.get(kind, _OTHER)
    end = _END_SHARE * body.width_mm
    inner = Box(body.x_min_mm + end, body.x_max_mm - end, body.y_min_mm, body.y_max_mm)
    ends = (
        Box(body.x_min_mm, inner.x_min_mm, body.y_min_mm, body.y_max_mm),
        Box(inner.x_max_mm, body.x_max_mm, body.y_min_mm, body.y_max_mm),
    )
    if kind not in _LENS:
        metal = [box_solid(box, 0.0, height) for box in ends]
        return Named("body", [box_solid(inner, 0.0, height)], colour), Named("ends", metal, METAL)
    foot, lens = _FOOT_SHARE * height, _LENS_SHARE * body.width_mm / 2
    above = Box(-lens, lens, body.y_min_mm, body.y_max_mm)
    mark = Box(inner.x_min_mm, inner.x_min_mm + end / 2, body.y_min_mm, body.y_max_mm)
    rest = Box(mark.x_max_mm, inner.x_max_mm, body.y_min_mm, body.y_max_mm)
    return (
        Named("lens", [box_solid(above, foot, height)], colour),
        Named("base", [box_solid(rest, 0.0, foot)], MARK),
        Named("mark", [box_solid(mark, 0.0, foot)], LAMINATE),
        Named("ends", [box_solid(box, 0.0, foot) for box in ends], GOLD),
    )


def array(shape: Footprint) -> tuple[Named, ...]:
    """A chip with a metal end at each pad along both sides."""
    body, height, first = shape.body, shape.height_mm, shape.pads[0]
    end, half = _END_SHARE * body.length_mm, first.width_mm / 2
    inner = Box(body.x_min_mm, body.x_max_mm, body.y_min_mm + end, body.y_max_mm - end)
    ends = [
        Box(
            pad.x_mm - half,
            pad.x_mm + half,
            body.y_min_mm if pad.y_mm < 0 else inner.y_max_mm,
            inner.y_min_mm if pad.y_mm < 0 else body.y_max_mm,
        )
        for pad in shape.pads
    ]
    return (
        Named("body", [box_solid(inner, 0.0, height)], _COLOURS["resistor"]),
        Named("ends", [box_solid(box, 0.0, height) for box in ends], METAL),
    )


def module(shape: Footprint) -> tuple[Named, ...]:
    """A module's board with a can, which leaves the end beyond the pads to the antenna; pad 1 has
    a mark."""
    body, first = shape.body, shape.pads[0]
    top = max(pad.y_mm + pad.height_mm / 2 for pad in shape.pads)
    can = Box(
        body.x_min_mm + _CAN_MM, body.x_max_mm - _CAN_MM, body.y_min_mm + _CAN_MM, top - _CAN_MM
    )
    at = can.x_min_mm + 2 * _MARK_MM, min(first.y_mm, can.y_max_mm) - 2 * _MARK_MM
    height, sunk = shape.height_mm, _MARK_MM / 8
    mark = cylinder(at, 2 * _MARK_MM, height - sunk, height)
    return (
        Named("board", [box_solid(body, 0.0, _MODULE_MM)], LAMINATE),
        Named("can", [box_solid(can, _MODULE_MM, height) - mark], METAL),
        Named("mark", [mark], LAMINATE),
    )

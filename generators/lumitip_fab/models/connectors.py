"""Connectors: sockets, pin headers, spring contacts, and right-angle box headers."""

from build123d import Solid

from lumitip_fab.design import Box, Footprint, Pad
from lumitip_fab.models.shapes import (
    GOLD,
    PIN_MM,
    PLASTIC,
    TAIL_MM,
    Named,
    bent,
    round_pin,
    upright,
)
from lumitip_fab.parts.shapes import box_solid

_HOLE_MM = 0.9  # of a socket, for a pin
_HOLE_SHARE = 0.7  # of the height of a socket
_HEADER_MM = 2.54  # of a pin header's body
_BARREL_MM, _PLUNGER_MM, _SPRING_TAIL_MM = 1.4, 0.8, 0.5
_BODY_SHARE, _BARREL_SHARE = 0.6, 0.8  # of the height of spring contacts
_WALL_MM = 1.2  # of a shroud
_BACK_MM = 2.2  # wall behind its cavity
_SHORT_MM = 1.5  # from the tips of its pins to its front


def socket(shape: Footprint) -> tuple[Named, ...]:
    """A body with a hole over each contact, and the tails of the contacts."""
    height = shape.height_mm
    floor = (1 - _HOLE_SHARE) * height
    holes = [upright((p.x_mm, p.y_mm), _HOLE_MM, floor, height) for p in shape.pads]
    body = box_solid(shape.body, 0.0, height)
    return Named("body", [body.cut(*holes)], PLASTIC), _tails(shape)


def header(shape: Footprint) -> tuple[Named, ...]:
    """A flat body with pins through it."""
    body = box_solid(shape.body, 0.0, min(_HEADER_MM, shape.height_mm / 2))
    pins = [upright((p.x_mm, p.y_mm), PIN_MM, -TAIL_MM, shape.height_mm) for p in shape.pads]
    return Named("body", [body.cut(*pins)], PLASTIC), Named("pins", pins, GOLD)


def springs(shape: Footprint) -> tuple[Named, ...]:
    """A body with barrels and plungers, as high as without pressure."""
    height = shape.height_mm
    body, barrel = _BODY_SHARE * height, _BARREL_SHARE * height
    contacts = [
        piece
        for at in ((p.x_mm, p.y_mm) for p in shape.pads)
        for piece in (
            round_pin(at, _SPRING_TAIL_MM, -TAIL_MM, 0.0),
            round_pin(at, _BARREL_MM, body, barrel),
            round_pin(at, _PLUNGER_MM, barrel, height),
        )
    ]
    return (
        Named("body", [box_solid(shape.body, 0.0, body)], PLASTIC),
        Named("contacts", contacts, GOLD),
    )


def box_header(shape: Footprint) -> tuple[Named, ...]:
    """A right-angle box header: the shroud with its notch above, and the pins."""
    shroud, height = shape.shroud, shape.height_mm
    if shroud is None:
        raise ValueError(f"{shape.name} has no shroud")
    box = shroud.box
    front = box.y_max_mm
    cavity = Box(
        box.x_min_mm + _WALL_MM, box.x_max_mm - _WALL_MM, box.y_min_mm + _BACK_MM, front + _WALL_MM
    )
    half = shroud.notch_mm / 2
    notch = Box(-half, half, cavity.y_min_mm, cavity.y_max_mm)
    hollow = (
        box_solid(cavity, _WALL_MM, height - _WALL_MM),
        box_solid(notch, height / 2, height + _WALL_MM),
    )
    pins = [_pin(shape, pad, box) for pad in shape.pads]
    body = box_solid(box, 0.0, height).cut(*hollow).cut(*pins)
    return Named("shroud", [body], PLASTIC), Named("pins", pins, GOLD)


def _pin(shape: Footprint, pad: Pad, box: Box) -> Solid:
    """Up from the board and out through the back of the shroud; the farther row is the upper."""
    half, pitch = PIN_MM / 2, 2 * abs(pad.y_mm)
    level = shape.height_mm / 2 + (pitch / 2 if pad.y_mm < 0 else -pitch / 2)
    y, tip = pad.y_mm, box.y_max_mm - _SHORT_MM
    profile = (
        (y - half, -TAIL_MM),
        (y - half, level + half),
        (tip, level + half),
        (tip, level - half),
        (y + half, level - half),
        (y + half, -TAIL_MM),
    )
    return bent(profile, pad.x_mm, PIN_MM)


def _tails(shape: Footprint) -> Named:
    at = [(p.x_mm, p.y_mm) for p in shape.pads]
    return Named("tails", [upright(place, PIN_MM, -TAIL_MM, 0.0) for place in at], GOLD)

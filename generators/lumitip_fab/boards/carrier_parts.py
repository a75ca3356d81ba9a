"""Parts of a carrier as footprints, with what is printed round them."""

from lumitip_fab.boards.model import Component, Footprint, Pad, Stroke
from lumitip_fab.design import Box, Device, Pattern, Rules

_BAR_MM = 0.3  # at the first contact


def component(device: Device, rules: Rules) -> Component:
    """A device in its place, as board files have parts."""
    return Component(
        ref=device.ref, value=device.value, part=device.part, kind=device.kind,
        footprint=_footprint(device, rules), x_mm=device.x_mm, y_mm=device.y_mm,
        angle_deg=device.angle_deg, side="front", nets=device.nets,
        manufacturer=device.manufacturer, lcsc=device.lcsc,
    )  # fmt: skip


def _footprint(device: Device, rules: Rules) -> Footprint:
    pattern = device.pattern
    pads = tuple(
        Pad(
            land.number, land.x_mm, land.y_mm, land.width_mm, land.height_mm,
            "circle" if land.round else "rect", land.drill_mm, paste=not land.drill_mm,
        )
        for land in pattern.lands
    )  # fmt: skip
    return Footprint(
        name=pattern.name,
        pads=pads,
        body=pattern.body,
        courtyard=_courtyard(pattern, rules),
        height_mm=pattern.height_mm,
        silk=_socket(pattern.body, rules) if device.kind == "socket" else (),
    )


def _courtyard(pattern: Pattern, rules: Rules) -> Box:
    """Body and pads with half the gap that parts keep; bare pads for wires have no body."""
    lands = pattern.lands
    pads = Box(
        min(p.x_mm - p.width_mm / 2 for p in lands), max(p.x_mm + p.width_mm / 2 for p in lands),
        min(p.y_mm - p.height_mm / 2 for p in lands), max(p.y_mm + p.height_mm / 2 for p in lands),
    )  # fmt: skip
    if not pattern.height_mm:
        return pads.grown(rules.part_gap_mm / 2)
    body = pattern.body
    whole = Box(
        min(pads.x_min_mm, body.x_min_mm), max(pads.x_max_mm, body.x_max_mm),
        min(pads.y_min_mm, body.y_min_mm), max(pads.y_max_mm, body.y_max_mm),
    )  # fmt: skip
    return whole.grown(rules.part_gap_mm / 2)


def _socket(body: Box, rules: Rules) -> tuple[Stroke, ...]:
    """The body's outline, and a bar at its first contact."""
    pen = rules.silk_line_mm
    inner = body.grown(-pen / 2)
    left, right, low, high = inner.x_min_mm, inner.x_max_mm, inner.y_min_mm, inner.y_max_mm
    around = ((left, low), (right, low), (right, high), (left, high), (left, low))
    bar = body.x_min_mm - rules.silk_gap_mm - _BAR_MM / 2
    return Stroke(around, pen), Stroke(((bar, low / 2), (bar, high / 2)), _BAR_MM)

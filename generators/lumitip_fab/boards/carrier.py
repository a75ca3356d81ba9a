"""Every file of a board outside the fingers. Its design has all parts in their places, so that
only the copper is left to do."""

from lumitip_fab.boards.circuit import GROUND, SIGNAL, SUPPLY, net_class
from lumitip_fab.boards.fab.order import carrier_note
from lumitip_fab.boards.files import model_files
from lumitip_fab.boards.footprints import pad_at
from lumitip_fab.boards.kicad.schematic.carrier import carrier_sheet
from lumitip_fab.boards.model import (
    BoardModel,
    Component,
    Footprint,
    Net,
    Pad,
    Placement,
    Stroke,
)
from lumitip_fab.boards.placement import refuse_overlaps
from lumitip_fab.boards.pour import pour
from lumitip_fab.boards.route import route
from lumitip_fab.boards.silk.carrier import with_legend
from lumitip_fab.boards.verify import require_clean_drc
from lumitip_fab.design import (
    Box,
    Carrier,
    Design,
    Device,
    Land,
    Pattern,
    Reading,
    Rules,
    Title,
)
from lumitip_fab.design.frames import board_page_to_carrier
from lumitip_fab.pipeline.artefact import Artefact

_BAR_MM = 0.3  # at the first contact


def component(device: Device, rules: Rules) -> Component:
    """A device in its place, as board files have parts."""
    return Component(
        ref=device.ref,
        value=device.value,
        part=device.part,
        kind=device.kind,
        footprint=_footprint(device, rules),
        x_mm=device.x_mm,
        y_mm=device.y_mm,
        angle_deg=device.angle_deg,
        side="back" if device.side == "back" else "front",
        nets=device.nets,
        manufacturer=device.manufacturer,
        lcsc=device.lcsc,
    )


def _footprint(device: Device, rules: Rules) -> Footprint:
    pattern = device.pattern
    pads = tuple(
        Pad(
            land.number,
            land.x_mm,
            land.y_mm,
            land.width_mm,
            land.height_mm,
            "circle" if land.round else "rect",
            land.drill_mm,
            paste=not land.drill_mm and device.kind != "fiducial",
        )
        for land in pattern.lands
    )
    return Footprint(
        name=pattern.name,
        pads=pads,
        body=pattern.body,
        courtyard=_courtyard(pattern, rules),
        height_mm=pattern.height_mm,
        silk=_silk(device, rules),
    )


def _courtyard(pattern: Pattern, rules: Rules) -> Box:
    """Body and pads with half the gap that parts keep; bare pads for wires have no body."""
    lands = pattern.lands
    pads = Box(
        min(p.x_mm - p.width_mm / 2 for p in lands),
        max(p.x_mm + p.width_mm / 2 for p in lands),
        min(p.y_mm - p.height_mm / 2 for p in lands),
        max(p.y_mm + p.height_mm / 2 for p in lands),
    )
    if not pattern.height_mm:
        return pads.grown(rules.part_gap_mm / 2)
    body = pattern.body
    whole = Box(
        min(pads.x_min_mm, body.x_min_mm),
        max(pads.x_max_mm, body.x_max_mm),
        min(pads.y_min_mm, body.y_min_mm),
        max(pads.y_max_mm, body.y_max_mm),
    )
    return whole.grown(rules.part_gap_mm / 2)


def _silk(device: Device, rules: Rules) -> tuple[Stroke, ...]:
    body, lands = device.pattern.body, device.pattern.lands
    if device.kind in ("socket", "header"):
        return _socket(body, rules)
    if device.kind in ("regulator", "transistor"):
        return (_dot(lands[0], rules),)
    if device.kind == "module":
        return _module(body, lands, rules)
    return _sides(body, lands, rules) if device.kind not in ("wires", "fiducial") else ()


def _dot(first: Land, rules: Rules) -> Stroke:
    """A dot beyond lead 1, away from the body."""
    at = first.x_mm, first.y_mm - first.height_mm / 2 - rules.silk_gap_mm - _BAR_MM
    return Stroke((at, (at[0] + 0.02, at[1])), _BAR_MM)


def _sides(body: Box, lands: tuple[Land, ...], rules: Rules) -> tuple[Stroke, ...]:
    """A line along each side of the body, between the pads where they are as wide as it."""
    pen, first = rules.silk_line_mm, lands[0]
    reach = -first.x_mm - first.width_mm / 2 - rules.silk_gap_mm - pen
    y = body.y_max_mm + pen / 2
    if reach <= pen:
        return ()
    return tuple(Stroke(((-reach, side), (reach, side)), pen) for side in (y, -y))


def _module(body: Box, lands: tuple[Land, ...], rules: Rules) -> tuple[Stroke, ...]:
    """A line along both long sides, which end before the antenna's end at the board's edge, one
    along the other end, and a dot beside pad 1."""
    pen, away = rules.silk_line_mm, rules.silk_gap_mm + _BAR_MM
    low, high = body.y_min_mm, body.y_max_mm - 2 * away
    frame = body.grown(pen / 2)
    left, right, bottom = frame.x_min_mm, frame.x_max_mm, low - pen / 2
    dot = left - away, lands[0].y_mm
    return (
        Stroke(((left, high), (left, bottom), (right, bottom), (right, high)), pen),
        Stroke((dot, (dot[0] + 0.02, dot[1])), _BAR_MM),
    )


def _socket(body: Box, rules: Rules) -> tuple[Stroke, ...]:
    """The body's outline, and a bar at its first contact."""
    pen = rules.silk_line_mm
    inner = body.grown(-pen / 2)
    left, right, low, high = inner.x_min_mm, inner.x_max_mm, inner.y_min_mm, inner.y_max_mm
    around = ((left, low), (right, low), (right, high), (left, high), (left, low))
    bar = body.x_min_mm - rules.silk_gap_mm - _BAR_MM / 2
    return Stroke(around, pen), Stroke(((bar, low / 2), (bar, high / 2)), _BAR_MM)


def carrier_files(design: Design, carrier: Carrier) -> tuple[Artefact, ...]:
    """Every file of a board outside the fingers: KiCad project, pictures of both sides, orders.

    Raises:
        BuildError: if two parts overlap, a net cannot be routed, a label has no room, or the
            finished copper breaks its rules.
    """
    bare = _placement(design.title, design.reading, carrier, design.rules)
    refuse_overlaps(carrier.name, bare.components, "choose smaller parts")
    placement = with_legend(bare, carrier, design.rules)
    routing, fills = pour(placement, route(placement))
    model = require_clean_drc(BoardModel(placement, routing, fills))
    sheet = carrier_sheet(placement, carrier)
    return model_files(
        model,
        sheet,
        lambda fab: carrier_note(model.placement, carrier.title, fab),
        design.stack.carrier_mm,
        design.fabs,
        board_page_to_carrier(design.stack),
        "carrier",
    )


def _hot_loop(carrier: Carrier, components: tuple[Component, ...]) -> tuple[Box, ...]:
    """The box round the middles of the hot loop's pads; none without a regulator."""
    parts = {part.ref: part for part in components}
    places = [pad_at(parts[ref], number) for ref, number in carrier.hot_loop]
    if not places:
        return ()
    xs, ys = zip(*places, strict=True)
    return (Box(min(xs), max(xs), min(ys), max(ys)),)


def _placement(title: Title, reading: Reading, carrier: Carrier, rules: Rules) -> Placement:
    components = tuple(component(device, rules) for device in carrier.devices)
    return Placement(
        finger=carrier.name,
        name=title.on_boards().name,
        revision=title.revision,
        design_hash=reading.design_hash,
        outline=carrier.box,
        corner_mm=carrier.corner_mm,
        holes=carrier.holes,
        hole_mm=carrier.hole_mm,
        keep_outs=carrier.keep_outs,
        edge_clearance_mm=rules.edge_gap_mm,
        components=components,
        ground_only=_hot_loop(carrier, components),
        nets=tuple(
            Net(name, SUPPLY if name in carrier.supplies else SIGNAL) for name in carrier.nets
        ),
        classes=(
            net_class(SIGNAL, rules.track_mm, rules),
            net_class(SUPPLY, rules.supply_track_mm, rules),
        ),
        ground=GROUND,
        silk=(),
        texts=(),
    )

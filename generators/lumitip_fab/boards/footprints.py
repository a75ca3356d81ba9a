"""Land patterns from the dimensions in the catalogue, named by IPC-7351, and where the pads of a
placed part are."""

import math
from dataclasses import dataclass

from shapely import Point as Dot
from shapely import Polygon, affinity, box

from lumitip_fab.boards.model import SIDES, Component, Footprint, Pad, Side, Stroke
from lumitip_fab.design import Box, Chip, Connector, Multiplexer, Point, Rules


@dataclass(frozen=True)
class PlacedPad:
    """A pad on the board, in the finger's sensor frame."""

    component: Component
    pad: Pad
    net: str
    """Empty where it is connected to nothing."""
    x_mm: float
    y_mm: float
    sides: tuple[Side, ...]
    """Both for a plated hole."""
    area: Polygon


def placed(component: Component, x_mm: float, y_mm: float) -> Point:
    """A point of a footprint's frame on the board; a part on the back is mirrored in x first."""
    x = -x_mm if component.side == "back" else x_mm
    turn = math.radians(component.angle_deg)
    c, s = math.cos(turn), math.sin(turn)
    return component.x_mm + x * c - y_mm * s, component.y_mm + x * s + y_mm * c


def pad_at(component: Component, number: str) -> Point:
    """Centre of a pad on the board."""
    pad = next(pad for pad in component.footprint.pads if pad.number == number)
    return placed(component, pad.x_mm, pad.y_mm)


def courtyard(component: Component) -> Box:
    """The courtyard of a part in its place."""
    yard = component.footprint.courtyard
    corners = [
        placed(component, x, y)
        for x in (yard.x_min_mm, yard.x_max_mm)
        for y in (yard.y_min_mm, yard.y_max_mm)
    ]
    xs, ys = zip(*corners, strict=True)
    return Box(min(xs), max(xs), min(ys), max(ys))


def placed_pads(component: Component) -> tuple[PlacedPad, ...]:
    """All pads of a part, with their copper as polygons."""
    nets = dict(component.nets)
    return tuple(
        PlacedPad(
            component,
            pad,
            nets.get(pad.number, ""),
            *(at := placed(component, pad.x_mm, pad.y_mm)),
            SIDES if pad.drill_mm else (component.side,),
            _area(pad, component.angle_deg, at),
        )
        for pad in component.footprint.pads
    )


def _area(pad: Pad, angle_deg: float, at: Point) -> Polygon:
    if pad.shape == "circle":
        return Dot(at).buffer(pad.width_mm / 2, quad_segs=16)
    half = pad.width_mm / 2, pad.height_mm / 2
    flat = box(at[0] - half[0], at[1] - half[1], at[0] + half[0], at[1] + half[1])
    return affinity.rotate(flat, angle_deg, origin=at)


TEST_POINT_MM = 1.0
FIDUCIAL_MM = 1.0
COPPER_MM = 0.035


def chip(chip: Chip, letters: str, rules: Rules, roomy: bool = True) -> Footprint:
    """A two-terminal part.

    Args:
        chip: its dimensions.
        letters: what its name begins with: `RESC`, `CAPC`, `LEDC`, or `PTRC` of phototransistors,
            for which the standard has no letters.
        rules: for the courtyard, which is half the gap between parts wide.
        roomy: whether there is room beside it for more than a bar at its marked end.
    """
    length, width, height = chip.body_mm
    at = chip.pad_pitch_mm / 2
    pads = tuple(Pad(n, x, 0.0, *chip.pad_mm) for n, x in (("1", -at), ("2", at)))
    body = Box(-length / 2, length / 2, -width / 2, width / 2)
    return Footprint(
        name=f"{letters}{_tenths(length)}{_tenths(width)}X{_hundredths(height)}N",
        pads=pads,
        body=body,
        courtyard=_courtyard(body, pads, rules),
        height_mm=height,
        silk=_bracket(chip, rules, roomy) if chip.marked else _sides(chip, rules),
    )


def _bracket(chip: Chip, rules: Rules, roomy: bool) -> tuple[Stroke, ...]:
    """A bracket round the marked end; a bar where there is little room."""
    half = max(chip.pad_mm[1], chip.body_mm[1]) / 2
    line = rules.silk_line_mm
    x = (chip.pad_pitch_mm + chip.pad_mm[0]) / 2 + rules.silk_gap_mm + line / 2
    y = half + rules.silk_gap_mm + line / 2
    if not roomy:
        return (Stroke(((-x, -half), (-x, half)), line),)
    return (Stroke(((0.0, y), (-x, y), (-x, -y), (0.0, -y)), line),)


def _sides(chip: Chip, rules: Rules) -> tuple[Stroke, ...]:
    """A line along each side of the body, between the pads."""
    line = rules.silk_line_mm
    x = (chip.pad_pitch_mm - chip.pad_mm[0]) / 2 - rules.silk_gap_mm - line / 2
    y = chip.body_mm[1] / 2 + line / 2
    return tuple(Stroke(((-x, side), (x, side)), line) for side in (y, -y)) if x > 0 else ()


def multiplexer(mux: Multiplexer, rules: Rules) -> Footprint:
    """A part with its leads in two rows."""
    row = mux.leads // 2
    along, across = mux.lead_pad_mm
    pads = []
    for lead in range(1, mux.leads + 1):
        place = lead - 1 if lead <= row else mux.leads - lead
        side = -1 if lead <= row else 1
        x = (place - (row - 1) / 2) * mux.lead_pitch_mm
        pads.append(Pad(str(lead), x, side * (mux.lead_span_mm - along) / 2, across, along))
    x, y = mux.body_mm[0] / 2, mux.body_mm[1] / 2
    body = Box(-x, x, -y, y)
    pitch, span, height = map(_hundredths, (mux.lead_pitch_mm, mux.lead_tips_mm, mux.body_mm[2]))
    return Footprint(
        name=f"SOP{pitch}P{span}X{height}-{mux.leads}N",
        pads=tuple(pads),
        body=body,
        courtyard=_courtyard(body, tuple(pads), rules),
        height_mm=mux.body_mm[2],
        silk=_mux_silk(pads[0], body, mux.lead_span_mm / 2 - along, rules),
    )


def _mux_silk(first: Pad, body: Box, inner_mm: float, rules: Rules) -> tuple[Stroke, ...]:
    """The body between the rows of pads, with a notch at lead 1's end, and a dot at lead 1."""
    left, right = body.x_min_mm, body.x_max_mm
    gap, line = rules.silk_gap_mm, rules.silk_line_mm
    y = min(inner_mm - gap - line / 2, body.y_max_mm)
    notch = 0.4
    outline = (
        (left, notch),
        (left, y),
        (right, y),
        (right, -y),
        (left, -y),
        (left, -notch),
        (left + notch, -notch),
        (left + notch, notch),
        (left, notch),
    )
    dot = first.x_mm, first.y_mm - first.height_mm / 2 - gap - 0.15
    return Stroke(outline, line), Stroke((dot, (dot[0] + 0.02, dot[1])), 0.3)


def wire_pads(connector: Connector, rules: Rules) -> Footprint:
    """A row of holes for wires about its middle; pad 1 is square."""
    ways, pad = len(connector.pads), connector.pad_mm
    pads = tuple(
        Pad(
            str(i + 1),
            (i - (ways - 1) / 2) * connector.pitch_mm,
            0.0,
            pad,
            pad,
            "circle" if i else "rect",
            connector.drill_mm,
            paste=False,
        )
        for i in range(ways)
    )
    body = Box(pads[0].x_mm - pad / 2, pads[-1].x_mm + pad / 2, -pad / 2, pad / 2)
    name = f"WirePads_1x{ways:02d}_P{connector.pitch_mm:.2f}mm_D{connector.drill_mm:.1f}mm"
    return Footprint(name, pads, body, _courtyard(body, pads, rules), height_mm=0.0)


def test_point(rules: Rules) -> Footprint:
    """A bare round pad to hold a probe to."""
    return _dot("TestPoint", TEST_POINT_MM, rules.part_gap_mm / 2)


def fiducial() -> Footprint:
    """A round mark for the placing machine's camera, with a clear ring half as wide as itself."""
    return _dot("Fiducial", FIDUCIAL_MM, FIDUCIAL_MM / 2)


def _dot(kind: str, diameter_mm: float, beyond_mm: float) -> Footprint:
    pad = Pad("1", 0.0, 0.0, diameter_mm, diameter_mm, "circle", paste=False)
    body = Box(0.0, 0.0, 0.0, 0.0).grown(diameter_mm / 2)
    name = f"{kind}_D{diameter_mm:.1f}mm"
    return Footprint(name, (pad,), body, body.grown(beyond_mm), height_mm=COPPER_MM)


def _courtyard(body: Box, pads: tuple[Pad, ...], rules: Rules) -> Box:
    """Body and pads with half the gap that parts keep from each other."""
    return Box(
        min(body.x_min_mm, *(p.x_mm - p.width_mm / 2 for p in pads)),
        max(body.x_max_mm, *(p.x_mm + p.width_mm / 2 for p in pads)),
        min(body.y_min_mm, *(p.y_mm - p.height_mm / 2 for p in pads)),
        max(body.y_max_mm, *(p.y_mm + p.height_mm / 2 for p in pads)),
    ).grown(rules.part_gap_mm / 2)


def _tenths(length_mm: float) -> str:
    return f"{int(length_mm * 10 + 1e-9):02d}"


def _hundredths(length_mm: float) -> str:
    return str(round(length_mm * 100))

"""Land patterns from the dimensions in the catalogue, named by IPC-7351.

Footprints are seen from the side that the part is on, y up. A chip lies along x with its marked
terminal, pad 1, to the left; a multiplexer lies with lead 1 at the lower left.
"""

from lumitip_fab.boards.model import Footprint, Pad, Stroke
from lumitip_fab.design import Box, Chip, Connector, Multiplexer, Rules

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
    outline = ((left, notch), (left, y), (right, y), (right, -y), (left, -y), (left, -notch),
               (left + notch, -notch), (left + notch, notch), (left, notch))  # fmt: skip
    dot = first.x_mm, first.y_mm - first.height_mm / 2 - gap - 0.15
    return Stroke(outline, line), Stroke((dot, (dot[0] + 0.02, dot[1])), 0.3)


def wire_pads(connector: Connector, rules: Rules) -> Footprint:
    """A row of holes for wires about its middle; pad 1 is square."""
    ways, pad = len(connector.pads), connector.pad_mm
    pads = tuple(
        Pad(
            str(i + 1), (i - (ways - 1) / 2) * connector.pitch_mm, 0.0, pad, pad,
            "circle" if i else "rect", connector.drill_mm, paste=False,
        )
        for i in range(ways)
    )  # fmt: skip
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

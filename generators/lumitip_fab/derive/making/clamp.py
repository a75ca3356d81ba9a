"""The clamp of a finger in its mould: where there is room for it, and how stiff it must be.

Where there is no room, or no M3 in the catalogue, there is none, and tape holds the finger.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from shapely import Polygon

from lumitip_fab.config.load import Input
from lumitip_fab.derive.finger.strength import Body
from lumitip_fab.design import Box, Cabling, Fastener, Finger, Key, Mould, Point, Printing
from lumitip_fab.design.clamp import PITCH_MM, Clamp
from lumitip_fab.design.making import tip_stop_mm
from lumitip_fab.design.print_time import BRIM_MM

SCREW = "M3"
LENGTHS_MM = (8, 10, 12, 16, 20, 25, 30)
"""Countersunk screws of M3 as they are commonly sold (inferred)."""
ARM_MM = 8.0
BAR_MM = 8.0
THICKNESS_MM = (4.0, 12.0)
FOOT_MM = 3.0  # over thread knots on the back of a plate, and over a nut on the rail
FOOT_HALF_MM = 2.0
LUG_MM = 9.0  # at a screw
LEG_MM = (2.4, 5.0)  # thickness and width
LEG_GAP_MM = 0.5  # to the rail
LEG_END_MM = 0.6  # over the bed
RAIL_MM = (2.8, 5.0)
APART_MM = 0.5  # from what is not to be touched
OFF_WALL_MM = 0.41  # from a foot to the mould's wall, beside the printer's fit
SIDE_MM = 2.5  # beside the block, whose sides have fillets of 1.5 mm
KNOT_MM = 3.0  # round a hole for thread
HEAD_PLAY_MM = 0.4
LEAST_SPAN_MM = 12.0
INWARD = 0.9  # of the triangle between the stops
STEP_MM = 0.5

WIRE_N = 0.1
"""With which a stranded wire, laid out over the weir, pushes a plate up (assumed)."""
RESERVE = 2.0
GRAVITY_M_S2 = 9.81


@dataclass(frozen=True)
class _Plan:
    """Everything round the clamp."""

    body: Body
    fingers: tuple[Finger, Finger]
    keys: tuple[Key, ...]
    mould: Mould
    printing: Printing

    def taken(self) -> Iterator[Box]:
        """Places on the plate's back where no foot may stand, on the right side."""
        for finger in self.fingers:
            boxes = [finger.notch, *(relief.box for relief in finger.reliefs)]
            for (x, y), half in ((key.at, key.wide_mm / 2) for key in self.keys):
                boxes.append(Box(x, x, y, y).grown(half))
            for interface in self.body.interfaces:
                boxes += [Box(x, x, y, y).grown(KNOT_MM - APART_MM) for x, y in finger.holes]
                up = self.body.mount.origin_y_mm
                letter = interface.letter.box
                lifted = replace(
                    letter, y_min_mm=letter.y_min_mm + up, y_max_mm=letter.y_max_mm + up
                )
                boxes += [interface.box, lifted]
            for box in boxes:
                yield from (box.grown(APART_MM), box.mirrored().grown(APART_MM))

    def free(self, foot: Box) -> bool:
        """Whether a foot stands on the bare back."""
        return not any(_meet(foot, box) for box in self.taken())

    def off_wall(self, foot: Box) -> bool:
        """Whether a right foot is on the plate and keeps off the mould's wall, which ends below the
        plate's back."""
        stack, mould = self.body.stack, self.mould
        ends = foot.y_min_mm, foot.y_max_mm
        beside_mm = min(map(self.body.outline.half_width_at, ends)) - foot.x_max_mm
        wall_mm = beside_mm + mould.outside_mm - mould.wall_mm
        off_mm = math.hypot(wall_mm, stack.plate_mm - mould.guided_mm)
        return beside_mm >= 0 and off_mm >= OFF_WALL_MM + self.printing.fit_mm

    def behind_y_mm(self) -> float:
        """y where coupling and interface end towards the tip."""
        stack, mount = self.body.stack, self.body.mount
        pad = sum(interface.pad_mm for interface in self.body.interfaces)
        ends = [mount.ramp_end_y_mm(stack.back_z_mm - pad, stack.rim_z_mm) + mount.flare_mm]
        return max(ends + [interface.box.y_max_mm for interface in self.body.interfaces])


def derive_clamps(
    config: Input,
    body: Body,
    fingers: tuple[Finger, Finger],
    keys: tuple[Key, ...],
    mould: Mould,
    printing: Printing,
    cabling: Cabling,
) -> tuple[Clamp, ...]:
    """The clamp, alike for both fingers; none where there is no room for it."""
    entry = config.catalogue.fasteners.get(SCREW)
    plan = _Plan(body, fingers, keys, mould, printing)
    rear, front = _at_pads(plan), _at_tip(plan)
    if entry is None or rear is None or front is None:
        return ()
    screw = Fastener(SCREW, **entry.model_dump(include=_FIGURES))
    clamp = _drawn(plan, screw, rear, front)
    rigid = config.catalogue.filaments[body.slicing.mould.name]
    clamp = replace(
        clamp, modulus_mpa=rigid.modulus_mpa, needed_n=_needed_n(plan, _wires(fingers, cabling))
    )
    fitting = (_stiffened(clamp, t) for t in _layered(mould.layer_mm, *THICKNESS_MM))
    stiff = next((c for c in fitting if c.pads_n(c.thickness_mm) >= c.needed_n), None)
    wide = 2 * clamp.rails[1].x_max_mm + 2 * BRIM_MM
    if stiff is None or not stiff.screw_length_mm or wide > printing.bed_mm[0]:
        return ()
    low = max(RAIL_MM[0], (clamp.head_mm - clamp.rail_hole_mm) / 2 + printing.min_wall_mm)
    roomy = clamp.span_mm >= LEAST_SPAN_MM and clamp.rail_mm >= low - 1e-9
    return (stiff,) if roomy else ()


_FIGURES = {
    "thread_mm",
    "hole_mm",
    "cap_head_mm",
    "countersunk_mm",
    "nut_mm",
    "nut_height_mm",
}


def _at_pads(plan: _Plan) -> Box | None:
    """The right foot behind its pad: towards the board, too, where the back is bare there."""
    (x, y), inner = plan.mould.pads[1], _arm_from_mm(plan)
    half = plan.mould.pad_mm / 2
    for low, deep in ((x - FOOT_HALF_MM, FOOT_HALF_MM), (x - half, half)):
        foot = Box(max(low, inner), x + half, y - deep, y + deep)
        if foot.x_min_mm <= x - half and plan.off_wall(foot) and plan.free(foot):
            return foot
    return None


def _arm_from_mm(plan: _Plan) -> float:
    """Inner side of the right arm: beside block and lugs, notch and interface, over its foot."""
    notch = max(finger.notch.x_max_mm for finger in plan.fingers)
    mount = plan.body.mount
    out = max((lug.out_mm + 2 * APART_MM for lug in mount.lugs), default=SIDE_MM)
    beside = [mount.block_width_mm / 2 + max(out, SIDE_MM), notch + 2 * APART_MM]
    beside += [interface.box.x_max_mm + 2 * APART_MM for interface in plan.body.interfaces]
    return max(plan.mould.pads[1][0] - ARM_MM / 2, *beside)


def _at_tip(plan: _Plan) -> Box | None:
    """The right one of the feet towards the tip line: as near the wedge as the back is bare, and
    inside the triangle between the stops, so that no stop is lifted."""
    outline, (x_pad, y_pad) = plan.body.outline, plan.mould.pads[1]
    line = tip_stop_mm(outline.tip_width_mm) / 2
    lowest = plan.behind_y_mm() + APART_MM + BAR_MM / 2
    high = plan.body.tip.slant_start_y_mm - FOOT_HALF_MM - 2 * APART_MM
    for y in np.arange(high, lowest - 1e-9, -STEP_MM):
        share = (outline.tip_y_mm - y) / (outline.tip_y_mm - y_pad)
        most = INWARD * (line + share * (x_pad - line))
        places = np.arange(FOOT_HALF_MM + APART_MM, most + 1e-9, STEP_MM)
        for x in sorted(places, key=lambda place: abs(place - line)):
            at = round(float(x), 6), round(float(y), 6)
            foot = Box(at[0], at[0], at[1], at[1]).grown(FOOT_HALF_MM)
            if plan.free(foot):
                return foot
    return None


def _drawn(plan: _Plan, screw: Fastener, rear: Box, front: Box) -> Clamp:
    """The clamp but for its thickness, and for what presses on it."""
    stack, mould, fit = plan.body.stack, plan.mould, plan.printing.fit_mm
    layer = mould.layer_mm
    y_low, y_high = rear.centre_mm[1], front.centre_mm[1]
    least, most = _sides_mm(plan, y_low, y_high)
    head = screw.countersunk_mm + HEAD_PLAY_MM
    corner = screw.nut_mm / math.sqrt(3) + APART_MM
    x_screw = round(most + corner, 3)
    flush = round(x_screw + max(corner, head / 2 + max(plan.printing.min_wall_mm, 1.2)), 3)
    inner = round(_arm_from_mm(plan), 6)
    outer = inner + ARM_MM
    gap = LEG_GAP_MM + fit
    deep, wide = max(LEG_MM[0], plan.printing.min_wall_mm + 0.8), LEG_MM[1]
    ends = ((y_low - gap - wide, y_low - gap), (y_high + gap, y_high + gap + wide))
    legs = [Box(flush - deep, flush, *end) for end in ends]
    lugs = [Box(inner, flush, *end) for end in ends]
    y_screw = (y_low + y_high) / 2
    lugs.append(Box(inner, flush, y_screw - LUG_MM / 2, y_screw + LUG_MM / 2))
    rim = mould.stops_mm(stack.cover_mm)
    rail = math.floor(min(rim, RAIL_MM[1]) / layer + 1e-9) * layer
    arm = Box(inner, outer, ends[0][0], ends[1][1])
    bar_y = y_high - BAR_MM / 2, y_high + BAR_MM / 2
    return Clamp(
        name="clamp",
        arms=(arm.mirrored(), arm),
        bar=Box(-inner, inner, *bar_y),
        lugs=_both(lugs),
        legs=_both(legs),
        feet=(*_both([rear]), *_both([front])),
        rails=_both([Box(least, flush, y_low, y_high)]),
        screws=((-x_screw, y_screw), (x_screw, y_screw)),
        screw=screw,
        screw_length_mm=0.0,
        hole_mm=screw.hole_mm[1] + 2 * fit,
        rail_hole_mm=screw.hole_mm[0] + 2 * fit,
        head_mm=head,
        thickness_mm=0.0,
        foot_mm=next(_layered(layer, FOOT_MM, math.inf)),
        back_mm=rim + stack.plate_mm,
        rail_mm=round(rail, 6),
        mark_mm=round(round(rail / 2 / layer) * layer, 6),
        leg_end_mm=LEG_END_MM,
        modulus_mpa=0.0,
        needed_n=0.0,
    )


def _sides_mm(plan: _Plan, low_mm: float, high_mm: float) -> Point:
    """Middle of the mould's side wall where it is nearest, and its outside where it is farthest,
    along a rail."""
    mould, outline = plan.mould, plan.body.outline
    halves = [outline.half_width_at(y) for y in np.linspace(low_mm, high_mm, 60)]
    middle_mm = mould.outside_mm - mould.wall_mm / 2
    return round(min(halves) + middle_mm, 3), max(halves) + mould.outside_mm


def _stiffened(clamp: Clamp, thickness_mm: float) -> Clamp:
    """The clamp with a thickness, and with the shortest screw that ends a turn beyond its nut."""
    thick = replace(clamp, thickness_mm=thickness_mm)
    through = thick.top_mm + clamp.screw.nut_height_mm + PITCH_MM
    length = next((n for n in LENGTHS_MM if n >= through), 0)
    return replace(thick, screw_length_mm=float(length))


def _wires(fingers: tuple[Finger, Finger], cabling: Cabling) -> int:
    """Wires of the finger that has more of them."""
    ends = [end.board for c in cabling.cables for w in c.wires for end in (w.start, w.end)]
    return max(ends.count(finger.name) for finger in fingers)


def _needed_n(plan: _Plan, wires: int) -> float:
    """Press on both pads: against the wires at the gripper end, by their lever about the tip line,
    and half of what the plate's guided part displaces of silicone."""
    outline, mould = plan.body.outline, plan.mould
    lever = outline.length_mm / (outline.tip_y_mm - mould.pads[1][1])
    ml = float(Polygon(outline.polygon()).area) * mould.guided_mm / 1000
    floats_n = ml * mould.density_g_ml / 1000 * GRAVITY_M_S2
    return round(RESERVE * (wires * WIRE_N * lever + floats_n / 2), 3)


def _layered(layer_mm: float, low_mm: float, high_mm: float) -> Iterator[float]:
    """Heights of whole layers."""
    layers = math.ceil(low_mm / layer_mm - 1e-9)
    while layers * layer_mm <= high_mm + 1e-9:
        yield round(layers * layer_mm, 6)
        layers += 1


def _both(right: list[Box]) -> tuple[Box, ...]:
    """Each box on the left, then on the right."""
    return tuple(box for each in right for box in (each.mirrored(), each))


def _meet(a: Box, b: Box) -> bool:
    across = a.x_min_mm < b.x_max_mm and b.x_min_mm < a.x_max_mm
    return across and a.y_min_mm < b.y_max_mm and b.y_min_mm < a.y_max_mm

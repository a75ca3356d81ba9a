"""The silicone mould: where its stops stand and what is poured into it."""

import math

import shapely

from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards.boards import Plan
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.outline import DEPTH_MM, least_letter_mm, letter_on
from lumitip_fab.derive.finger.tip_slots import guided_mm
from lumitip_fab.derive.making.insert import derive_inserts
from lumitip_fab.derive.making.prop import derive_prop
from lumitip_fab.design import Board, Grip, Letter, Mould, Outline, Point, Prop, Stack, Tip
from lumitip_fab.design.making import LEDGE_MM

PAD_MM = 2.0
LEAST_FLOOR_RIM_MM = 0.5
PAD_MARGIN_MM = 0.1
STOP_FOOT_MM = 0.1  # a stop is wider by this where it meets the floor
END_ROUND = 2 / 3  # of the silicone's thickness
TROUGH_MM = 4.0  # along y
LETTER_OVER_BED_MM = 0.6  # or a printed line, which is clear of the chamfer at the foot
LETTER_UNDER_RIM_MM = 0.5  # or a printed line
LEAST_LAYER_MM = 0.05
GRIP_AT = 0.4  # of a finger's length from its gripper end: the middle of the gaps for the grip
GRIP_MM = 14.0  # along y: two fingers
GRIP_OVER_LEVEL_MM = 0.4  # of silicone that creeps up between plate and wall (assumed)
WHOLE_MM = 1e-6


def derive_mould(
    config: Input, outline: Outline, plan: Plan, stack: Stack, tip: Tip, faults: Diagnostics
) -> Mould:
    """The mould, refused where the silicone cannot be shaped as asked."""
    p = config.parameters
    silicone, primer = config.parts.mould.silicone, config.parts.mould.primer
    glue = config.parts.backing.glue
    refuse_inhibitors(config, stack, faults)
    film, films = config.parts.mould.insert, config.catalogue.films
    smooth = ", ".join(repr(name) for name, entry in films.items() if entry.smooth)
    faults.unless(film is None or film.smooth, "insert_rough", films=smooth)
    faults.unless(p.mould.taper_length_mm <= p.outline.tip_margin_mm, "taper_long")
    faults.unless(p.mould.tip_silicone_mm < p.stack.silicone_mm, "tip_silicone_thick")
    faults.unless(
        p.mould.wall_mm >= 2 * p.printer.min_wall_mm,
        "mould_wall_thin",
        least=2 * p.printer.min_wall_mm,
    )
    lean = math.tan(math.radians(p.mould.draft_deg))
    for depth, allowed, what in (
        (stack.cover_mm, LEAST_FLOOR_RIM_MM, "leans the skin in under the rim"),
        (p.mould.tip_silicone_mm, p.mould.wall_gap_mm - 0.02, "reaches under the tip edge"),
    ):
        faults.unless(
            depth * lean <= allowed + 1e-9,
            "draft_large",
            depth=depth,
            what=what,
            allowed=allowed,
            by_mm=depth * lean,
            most_deg=math.degrees(math.atan(allowed / depth)),
        )
    pads = _pads(config, outline, plan.board, faults)
    inserts = derive_inserts(config, _flat(config, outline, stack, pads), plan.receiver)
    recess_mm = sum(insert.thickness_mm for insert in inserts)
    floor_mm = p.mould.wall_mm + recess_mm
    layer_mm, off_mm = whole_layers(
        config.parts.printer.profile.layer_mm,
        (p.mould.wall_mm, floor_mm, floor_mm + stack.cover_mm),
        recess_mm,
    )
    guided = guided_mm(config, stack, tip)
    outside_mm = _outside_mm(config, guided)
    weir_y_mm = outline.end_y_mm - outside_mm - LEDGE_MM
    letter = _letter(config, weir_y_mm, stack, floor_mm, faults)
    ends = weir_y_mm, -letter.wall_mm, outline.tip_y_mm + outside_mm
    props = [_prop(config, outline, plan, tip, ends, layer_mm) for _ in tip.slots[:1]]
    return Mould(
        taper_length_mm=p.mould.taper_length_mm,
        tip_silicone_mm=p.mould.tip_silicone_mm,
        end_round_mm=END_ROUND * p.stack.silicone_mm,
        wall_gap_mm=p.mould.wall_gap_mm,
        draft_deg=p.mould.draft_deg,
        guided_mm=guided,
        wall_mm=p.mould.wall_mm,
        outside_mm=outside_mm,
        weir_y_mm=weir_y_mm,
        inserts=inserts,
        props=tuple(props),
        grip=_grip(outline, props),
        pads=pads,
        pad_mm=PAD_MM,
        letter=letter,
        layer_mm=layer_mm,
        off_layer_mm=off_mm,
        silicone=config.title("mould.silicone"),
        density_g_ml=silicone.density_g_ml,
        mix_ratio=silicone.mix_ratio,
        pot_life_min=silicone.pot_life_min or 0.0,
        cure_h=silicone.cure_h,
        cure_c=silicone.cure_c,
        waste_fraction=p.mould.waste_fraction,
        inhibited_by=silicone.inhibited_by,
        primer=config.title("mould.primer") if primer else "",
        primer_dry_min=primer.dry_min if primer else 0.0,
        tape=config.title("mould.tape"),
        glue_hard_h=(glue.hard_h or 0.0) if stack.sunk else 0.0,
    )


def refuse_inhibitors(config: Input, stack: Stack, faults: Diagnostics) -> None:
    """Refuse a tape or a glue by which the silicone does not cure, and a missing primer.

    The glue of a board in its pocket meets the silicone in the slit round the board; one that is
    harmless when it is hard is covered by the primer. The glue of an interface is behind the plate.
    """
    parts = config.parts
    silicone, primer, tape = parts.mould.silicone, parts.mould.primer, parts.mould.tape
    by = [s for s in tape.gives_off if s in silicone.inhibited_by]
    faults.unless(not by, "tape_inhibits", by=", ".join(by))
    glue = parts.backing.glue
    by = [s for s in glue.gives_off if s in silicone.inhibited_by] if stack.sunk else []
    faults.unless(not by or glue.hard_h is not None, "glue_inhibits", by=", ".join(by))
    bare = primer is None and (silicone.needs_primer or bool(by))
    faults.unless(not bare, "primer_missing")


def whole_layers(
    usual_mm: float, heights_mm: tuple[float, ...], recess_mm: float = 0.0
) -> tuple[float, float]:
    """The thickest layer, up to the printer's usual one, that divides all heights, and 0.

    After the usual one steps of 0.01 mm are tried, down to 0.05 mm, which printers still lay. Where
    none divides all, the usual one stays: with it, how far the worst height is from a whole layer.
    A recess takes one that divides its depth, or the finest, so that it is not rounded away.
    """
    finest, finer = round(LEAST_LAYER_MM * 100), math.floor(usual_mm * 100 + WHOLE_MM)
    layers_mm = (usual_mm, *(h / 100 for h in range(finer, finest - 1, -1)))
    for wanted_mm in (heights_mm, *([(recess_mm,)] if recess_mm else [])):
        for layer_mm in layers_mm:
            if _off_layer_mm(layer_mm, wanted_mm) < WHOLE_MM:
                off_mm = _off_layer_mm(layer_mm, heights_mm)
                return layer_mm, off_mm if off_mm >= WHOLE_MM else 0.0
    layer_mm = min(LEAST_LAYER_MM, usual_mm) if recess_mm else usual_mm
    return layer_mm, _off_layer_mm(layer_mm, heights_mm)


def _off_layer_mm(layer_mm: float, heights_mm: tuple[float, ...]) -> float:
    return max(abs(height - round(height / layer_mm) * layer_mm) for height in heights_mm)


def _letter(
    config: Input, weir_y_mm: float, stack: Stack, floor_mm: float, faults: Diagnostics
) -> Letter:
    """On the outside of the trough's end, whose wall is as high as the cavity and its floor."""
    p = config.parameters
    wall = p.mould.wall_mm
    line_mm = config.parts.printer.profile.line_mm
    least = least_letter_mm(line_mm)
    low = max(LETTER_OVER_BED_MM, line_mm)
    high = floor_mm + stack.cover_mm - max(LETTER_UNDER_RIM_MM, line_mm)
    faults.unless(
        high - low >= least - 1e-9,
        "mould_letter",
        wall=wall,
        least=least,
        room_mm=high - low,
        wall_mm=wall + least - (high - low),
    )
    end_mm = wall + TROUGH_MM - weir_y_mm
    return letter_on(low, high, min(DEPTH_MM, wall - p.printer.min_wall_mm), end_mm, line_mm)


def _outside_mm(config: Input, guided: float) -> float:
    """From the outline to the outside of the wall, where it ends."""
    mould = config.parameters.mould
    rise = guided * math.tan(math.radians(mould.draft_deg))
    return mould.wall_gap_mm + rise + mould.wall_mm


def _prop(
    config: Input,
    outline: Outline,
    plan: Plan,
    tip: Tip,
    ends_mm: tuple[float, float, float],
    layer_mm: float,
) -> Prop:
    """The prop under the mould, by the ends of `derive_prop`; as wide as the wire notch."""
    half = max(finger.notch.x_max_mm for finger in (plan.emitter, plan.receiver))
    return derive_prop(config.parameters.mould.tip_lip_mm, outline, tip, ends_mm, half, layer_mm)


def _grip(outline: Outline, props: list[Prop]) -> Grip:
    """The gaps for the grip, over the silicone's level at their higher end."""
    centre_y = outline.end_y_mm + GRIP_AT * outline.length_mm
    low, high = centre_y - GRIP_MM / 2, centre_y + GRIP_MM / 2
    level_mm = sum(prop.level_mm(high) for prop in props)
    return Grip(low, high, level_mm + GRIP_OVER_LEVEL_MM, GRIP_OVER_LEVEL_MM)


def _flat(
    config: Input, outline: Outline, stack: Stack, pads: tuple[Point, ...]
) -> shapely.Geometry:
    """The floor between the walls, the rounding at the gripper end, the taper and the stops."""
    mould, rounding = config.parameters.mould, END_ROUND * stack.silicone_mm
    lean = math.tan(math.radians(mould.draft_deg))
    floor = shapely.Polygon(outline.polygon()).buffer(mould.wall_gap_mm - stack.cover_mm * lean)
    left, _, right, _ = floor.bounds
    low = outline.end_y_mm - mould.wall_gap_mm + (stack.cover_mm - rounding) * lean + rounding
    flat = floor & shapely.box(left, low, right, outline.tip_y_mm - mould.taper_length_mm)
    half = PAD_MM / 2 + STOP_FOOT_MM
    ends = [sorted((x - math.copysign(half, x), left if x < 0 else right)) for x, _ in pads]
    feet = [
        shapely.box(a, y - half, b, y + half) for (a, b), (_, y) in zip(ends, pads, strict=True)
    ]
    return flat - shapely.union_all(feet)


def _pads(config: Input, outline: Outline, board: Board, faults: Diagnostics) -> tuple[Point, ...]:
    """Stops on the rim beside the board, as near the gripper end as the rim takes them: the
    finger's weight is in its coupling and must lie between them and the tip."""
    y = max(board.pocket.y_min_mm, outline.end_y_mm + config.parameters.outline.end_corner_mm)
    y += PAD_MM / 2 + PAD_MARGIN_MM
    inner, outer = board.pocket.x_max_mm, outline.half_width_at(y)
    needed = PAD_MM + 2 * PAD_MARGIN_MM
    faults.unless(
        outer - inner >= needed - 1e-6, "stops_narrow", needed=needed, rim_mm=outer - inner
    )
    x = (inner + outer) / 2
    return (-x, y), (x, y)

"""Load on a finger, and the flare of its coupling's ramp that bears it.

The beam here is of rectangles, fast enough to be tried often; the checks take the sections of the
written parts.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from lumitip.layout import Optics
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import is_flex
from lumitip_fab.design import (
    Board,
    Closing,
    Finger,
    Interface,
    Mount,
    Outline,
    Slicing,
    Stack,
    Tip,
)
from lumitip_fab.design.beam import (
    Beam,
    Block,
    Vectors,
    behind,
    board_blocks,
    joined_mm,
    reached_mm,
    rectangles,
)
from lumitip_fab.design.seat import designed_foot, designed_seat, pull_n
from lumitip_fab.design.strength import Loaded, Strength, loads

SAFETY = 1.4  # of an estimate that no test stands behind, of a known force, with layers taken weak
RESERVE = 1.08  # kept here to every limit, for rectangles are not quite the written part
LEAST_N = 8.0  # of a rigid finger: a weaker one must be asked for
OFFSET_SHARE = 0.5  # of an aperture's half width: no shadow of its edge on the die
STEP_MM = 0.5
NOSE_SLICES = 4
_SQUARE = math.sqrt(math.pi) / 2  # side of a square over the diameter of a circle as large
_ROUNDED = math.sqrt(1 - math.pi / 4)  # the same, over the radius of a round corner, cut away


@dataclass(frozen=True)
class Body:
    """The parts of a finger that bear its load, and where that acts."""

    stack: Stack
    outline: Outline
    tip: Tip
    board: Board
    finger: Finger
    mount: Mount
    interfaces: tuple[Interface, ...]
    slicing: Slicing
    closing: Closing
    """For the line on which the fingers touch first, where the force acts."""


@dataclass(frozen=True)
class _Use:
    """How far a finger goes in one rule."""

    rule: str
    figure: float
    most: float
    """Or least: with the reserve."""
    share: float
    """Of what is allowed; it grows with the force."""


def derive_strength(config: Input, body: Body, optics: Optics, faults: Diagnostics) -> Strength:
    """Load case, limits and materials; refused where the finger breaks or bends too far.

    Args:
        config: the parameters.
        body: what bears the load.
        optics: for the depth of the dies.
        faults: where to refuse.
    """
    strength, force = _limits(config, body), config.parameters.finger.rated_force_n
    uses = list(_uses(config, body, strength, optics))
    borne = math.floor(10 * force / max(use.share for use in uses)) / 10
    for use in uses:
        if use.share > 1:
            faults.add(use.rule, figure=use.figure, most=use.most, borne=borne)
    chosen = "finger.rated_force_n" in config.automatic and not is_flex(config.parameters)
    faults.unless(force >= LEAST_N or not chosen, "finger_weak", least=LEAST_N)
    return strength


def borne_n(config: Input, body: Body, optics: Optics) -> float:
    """The greatest force that keeps every limit: stress and bend grow with it."""
    limit = _limits(config, body)
    return limit.rated_force_n / max(use.share for use in _uses(config, body, limit, optics))


def _limits(config: Input, body: Body) -> Strength:
    p, parts, known = config.parameters, config.parts, config.catalogue
    laminate = known.laminates.flexible if is_flex(p) else known.laminates.rigid
    return Strength(
        rated_force_n=p.finger.rated_force_n,
        gripper_n=body.mount.force_n,
        safety=SAFETY,
        most_bend_mm=p.finger.bend_fraction * body.outline.length_mm,
        offset_share=OFFSET_SHARE,
        backing_mpa=parts.backing.material.modulus_mpa,
        rigid_mpa=known.filaments[body.slicing.rigid.name].modulus_mpa,
        board_mpa=laminate.modulus_mpa,
        board_strain=laminate.most_strain,
        glue=config.title("backing.glue"),
        glue_mpa=parts.backing.glue.shear_mpa,
        lap_mm=parts.backing.glue.lap_mm,
    )


def _uses(config: Input, body: Body, limit: Strength, optics: Optics) -> Iterator[_Use]:
    """Every rule, with what the rated force makes of it."""
    cells = np.array(body.finger.cells) - (0.0, body.mount.origin_y_mm)
    depth = max(optics.emitter_depth_mm, optics.detector_depth_mm)
    found = loads(_loaded(body, limit), limit, cells, depth)
    narrowest, _ = config.parameters.mask.extremes_mm
    for rule, figure, most in (
        ("finger_bends", found.bend_mm, limit.most_bend_mm),
        ("finger_strains_board", 100 * found.board_strain, 100 * limit.board_strain),
        ("finger_shades", found.offset_mm, limit.offset_share * narrowest / 2),
    ):
        yield _Use(rule, figure, most / RESERVE, figure * RESERVE / most)
    least = limit.safety * RESERVE
    glue = limit.glue_mpa / max(found.glue_mpa, 1e-9)
    head = config.catalogue.fasteners[body.mount.bolt].cap_head_mm
    arm = body.closing.contact_y_mm - body.mount.origin_y_mm
    pull = pull_n(limit.rated_force_n, arm, body.mount, designed_foot(body.mount))
    seat = designed_seat(body.mount, head, pull)
    filament = body.slicing.rigid if body.interfaces else body.slicing.backing
    for rule, safety in (
        ("finger_parts", found.safety),
        ("finger_comes_unglued", glue),
        ("finger_sinks_heads", filament.bearing_mpa / seat.bearing_mpa),
        ("finger_shears_land", filament.layer_mpa / seat.shear_mpa),
    ):
        yield _Use(rule, safety, least, least / max(safety, 1e-9))


def _loaded(body: Body, limit: Strength) -> Loaded:
    """The finger's layers as rectangles."""
    stack, mount, box, pocket = body.stack, body.mount, body.board.box, body.board.pocket
    tip_h = body.closing.contact_y_mm - mount.origin_y_mm
    tip_w = stack.rim_z_mm - tip_h * math.tan(math.radians(mount.tilt_deg))
    h = np.arange(STEP_MM, tip_h, STEP_MM)
    at = _Planes(body, h)
    notch_y = body.finger.notch.y_max_mm if stack.sunk else -math.inf
    cut = board_blocks(pocket, box, notch_y, mount, stack.pcb_mm, h)
    core = mount.block_width_mm / 2
    board = rectangles(limit.board_mpa, core, cut, glued=stack.sunk)
    blocks, taken = _held(body, at)
    front = at.front + stack.pcb_mm
    if body.interfaces:
        (interface,) = body.interfaces
        plate = rectangles(limit.backing_mpa, core, [(at.notch, at.half, front, at.back)])
        rigid = rectangles(limit.rigid_mpa, core, blocks, taken)
        width = np.where(at.y < interface.box.y_max_mm, 2 * interface.box.x_max_mm, 0.0)
        strong = body.slicing.backing.layer_mpa, body.slicing.rigid.layer_mpa
        printed = (plate, strong[0]), (rigid, strong[1])
        beam = Beam(h, tip_h, (plate, rigid, board), tip_w)
        return Loaded(beam, beam, printed, board, plate, width)
    held = at.notch == 0  # the plate's legs beside the notch bear nothing
    inside = (at.y > pocket.y_min_mm) & (at.y < pocket.y_max_mm)
    rims = np.where(inside, pocket.x_max_mm, at.notch)
    blocks += [
        (rims, at.half * held, at.front, np.minimum(front, at.back)),
        (at.notch, at.half * held, front, at.back),
    ]
    whole = rectangles(limit.backing_mpa, core, blocks, taken)
    width = 2 * (box.x_max_mm - at.notch) * (board.area_mm2 > 0)
    strength = ((whole, body.slicing.backing.layer_mpa),)
    beam, joined = Beam(h, tip_h, (whole, board), tip_w), joined_mm(mount, notch_y, h)
    stiff = (
        rectangles(limit.backing_mpa, core, behind(joined, blocks), taken),
        rectangles(limit.board_mpa, core, behind(joined, cut)),
    )
    return Loaded(beam, beam.alone(*stiff), strength, board, board, width)


class _Planes:
    """Plate and notch in each section, arrays of shape `(sections,)`."""

    def __init__(self, body: Body, h_mm: Vectors) -> None:
        stack, outline, tip, mount = body.stack, body.outline, body.tip, body.mount
        tilt = math.radians(mount.tilt_deg)
        self.h = h_mm
        self.y = mount.origin_y_mm + h_mm / math.cos(tilt)
        self.front = -h_mm * math.tan(tilt)
        corners = outline.polygon()
        right = corners[corners[:, 0] >= 0]
        right = right[np.argsort(right[:, 1], kind="stable")]
        self.half = np.interp(self.y, right[:, 1], right[:, 0])
        self.notch = np.where(self.y < body.finger.notch.y_max_mm, body.finger.notch.x_max_mm, 0.0)
        slant = [tip.slant_start_y_mm, outline.tip_y_mm]
        thick = np.interp(self.y, slant, [stack.plate_mm, tip.edge_mm])
        self.back = self.front + thick + (0.0 if stack.sunk else stack.pcb_mm)


def _held(body: Body, at: _Planes) -> tuple[list[Block], list[Block]]:
    """Block, ramp and flare, with the pad of an interface; and the room for the screws."""
    mount, zero = body.mount, np.zeros_like(at.h)
    foot, ends = at.back, np.full_like(at.h, np.inf)
    pads: list[Block] = []
    for interface in body.interfaces:
        ends = np.full_like(at.h, interface.box.y_max_mm)
        foot = at.back + interface.pad_mm * (at.y < ends)
        pads.append((zero, zero + interface.box.x_max_mm, at.back, foot))
    stack = body.stack
    rise = stack.back_z_mm - sum(interface.pad_mm for interface in body.interfaces)
    end_y = mount.ramp_end_y_mm(rise, stack.rim_z_mm)
    steep = math.tan(math.radians(45 - mount.tilt_deg))
    start_y, last_y = end_y - mount.flare_depth_mm / steep, end_y + mount.flare_mm
    ramp = mount.block_back_w_mm - np.maximum(at.h - mount.land_mm, 0.0)
    nose = mount.flare_end_mm
    profile = [start_y, last_y - nose, last_y], [mount.flare_depth_mm, nose, 0.0]
    slope = np.interp(at.y, *profile)
    back = np.where(at.y < start_y, ramp, foot + slope)
    back = np.minimum(back, np.maximum(reached_mm(mount, stack.rim_z_mm - rise, at.h), foot))
    back = np.where(at.y < ends, back, foot)
    before = np.minimum(mount.block_front_w_mm, foot + body.finger.notch.y_max_mm - at.y)
    front = np.where(at.notch > 0, np.maximum(before, foot), foot)
    half = zero + mount.block_width_mm / 2
    return [*pads, (zero, half, front, back)], _screws(mount, at, front, back)


def _screws(mount: Mount, at: _Planes, front: Vectors, back: Vectors) -> list[Block]:
    """Bolt holes, counterbores, pin holes and round corners, as squares of the same area."""
    bolt = np.where(at.h < mount.land_mm, mount.bolt_hole_mm, mount.counterbore_mm)
    pin = np.where(at.h < mount.pin_depth_mm, mount.pin_mm, 0.0)
    sleeves = () if mount.sleeved else mount.pin_u_mm
    taken = []
    for places, wide in ((mount.bolt_u_mm, bolt), (sleeves, pin)):
        reach = _SQUARE * wide / 2
        low = np.maximum(mount.bolt_w_mm - reach, front)
        high = np.minimum(mount.bolt_w_mm + reach, back)
        for u in sorted({abs(u) for u in places}):
            taken.append((np.maximum(u - reach, 0.0), u + reach, low, high))
    corner = _ROUNDED * mount.block_corner_mm
    half = np.full_like(at.h, mount.block_width_mm / 2)
    low = np.maximum(front, mount.block_back_w_mm - corner)
    taken.append((half - corner, half, low, np.minimum(back, mount.block_back_w_mm)))
    return [*taken, *_beside_nose(mount, at, front, back)]


def _beside_nose(mount: Mount, at: _Planes, front: Vectors, back: Vectors) -> list[Block]:
    """Room beside the block's nose, in slices; over its height the block widens at 45°."""
    nose, half = mount.nose, mount.block_width_mm / 2
    if nose is None:
        return []
    spread = math.tan(math.radians(nose.half_angle_deg))
    end_w = nose.front_w_mm + (half - nose.front_width_mm / 2) / spread
    edges = np.linspace(mount.block_front_w_mm, end_w, NOSE_SLICES + 1)
    taken = []
    for low, high in pairwise(edges):
        inner = nose.front_width_mm / 2 + ((low + high) / 2 - nose.front_w_mm) * spread
        wide = np.minimum(inner + np.maximum(at.h - nose.height_mm, 0.0), half)
        below, above = np.maximum(front, low), np.minimum(back, high)
        taken.append((wide, np.full_like(wide, half), below, above))
    return taken

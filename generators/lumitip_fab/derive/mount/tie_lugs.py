"""Lugs for cable ties: on the sides of the coupling's block, beside the tray of a holder, and
outside its arms."""

import math

from lumitip_fab.config.load import Input
from lumitip_fab.derive.finger.stack import behind_mm
from lumitip_fab.design import AuxiliaryBoard, Box, Holder, Mount, Outline, TieLug

TIE_MM = 2.5, 1.1
"""Width of the tie in `packs.toml`; its thickness is assumed: common for that width."""
PLAY_MM = 0.5
WALL_MM = 1.5
LENGTH_MM = 3.0, 4.0
"""Of a bar along its wall: least, and where there is room."""
ROOT_MM = 1.0
"""How far a lug reaches into its wall."""
OVER_NOSE_MM = 1.0
"""From the gripper, which is beside the nose, to a lug."""
FLAP_MM = 2.5
"""From the plate's back, onto which the mask's flaps fold, to a lug."""
_SIDES = {"left": -1, "right": 1}


def finger_lugs(config: Input, mount: Mount, outline: Outline) -> tuple[TieLug, ...]:
    """One on each side of the block, behind the wire notch; none where the block leaves no room."""
    half, wall = mount.block_width_mm / 2, _wall_mm(config)
    first = max(mount.block_front_w_mm, behind_mm(config.parameters) + FLAP_MM)
    low = OVER_NOSE_MM
    if mount.nose:
        angle = math.radians(mount.nose.half_angle_deg)
        wide = mount.nose.front_width_mm / 2 + (first - mount.nose.front_w_mm) * math.tan(angle)
        # Above the nose the block widens at 45°, square to its flanks.
        low += mount.nose.height_mm + max(half - wide, 0.0) * math.cos(angle)
    top = low + _height_mm(wall, on_bed=False)
    last = min(
        mount.block_back_w_mm + mount.land_mm - top, mount.block_back_w_mm - mount.block_corner_mm
    )
    lug = _lug("right", 1, half, low, (first, min(last, first + LENGTH_MM[1])), wall)
    if last - first < LENGTH_MM[0] or half + lug.out_mm > outline.end_width_mm / 2:
        return ()
    return tuple(_lug(name, side, half, low, lug.along_mm, wall) for name, side in _SIDES.items())


def holder_lugs(config: Input, holder: Holder, of: AuxiliaryBoard) -> tuple[TieLug, ...]:
    """One at the end of the tray over which each row of wires leaves, on the nearer side."""
    wall, high = _wall_mm(config), holder.outer.length_mm
    long, short = LENGTH_MM[1], 2 * _height_mm(wall, on_bed=False)
    low_z = holder.axis_z_mm + math.sqrt(
        max((holder.cradle_mm + holder.wall_mm) ** 2 - holder.outer.x_max_mm**2, 0.0)
    )
    middle = max(holder.floor_z_mm, low_z + long / 2)
    if high < short or middle + long / 2 > holder.top_z_mm:
        return ()
    along = (-middle - long / 2, -middle + long / 2)
    lugs = {}
    for row in (part for part in of.components if part.kind == "wires" and part.pins):
        side, end = (1 if row.x_mm >= 0 else -1), row.y_mm > 0
        low = high - _height_mm(wall, on_bed=False) if end else 0.0
        lugs[side, end] = _lug(row.ref, side, holder.outer.x_max_mm, low, along, wall, not end)
    return tuple(lugs.values())


def arm_lugs(config: Input, holder: Holder) -> tuple[TieLug, ...]:
    """Outside each arm, where the body is widest, for the ties round the gripper: at the end that
    it is printed on, and where there is room at the other."""
    wall, high = _wall_mm(config), holder.outer.length_mm
    face, middle = holder.cradle_mm + holder.wall_mm, -holder.axis_z_mm
    along = middle - LENGTH_MM[1] / 2, middle + LENGTH_MM[1] / 2
    lows = [0.0]
    if high >= 2 * _height_mm(wall, on_bed=False):
        lows.append(high - _height_mm(wall, on_bed=False))
    return tuple(
        _lug(f"{name} arm {n}", side, face, low, along, wall, on_bed=n == 1)
        for name, side in _SIDES.items()
        for n, low in enumerate(lows, 1)
    )


def _wall_mm(config: Input) -> float:
    return max(WALL_MM, config.parameters.printer.min_wall_mm)


def _height_mm(wall_mm: float, on_bed: bool) -> float:
    """From where a lug's underside meets its wall to its top."""
    beneath = wall_mm if on_bed else _deep_mm() + wall_mm * math.sqrt(2)
    return beneath + TIE_MM[0] + PLAY_MM + wall_mm


def _deep_mm() -> float:
    return TIE_MM[1] + PLAY_MM


def _lug(
    name: str,
    side: int,
    face_mm: float,
    low_mm: float,
    along_mm: tuple[float, float],
    wall_mm: float,
    on_bed: bool = False,
) -> TieLug:
    deep, top = _deep_mm(), low_mm + _height_mm(wall_mm, on_bed)
    out = deep + wall_mm
    under = (0.0, 0.0) if on_bed else (-ROOT_MM, out)
    return TieLug(
        name=name,
        side=side,
        face_mm=face_mm,
        profile=(
            (-ROOT_MM, low_mm + under[0]),
            (out, low_mm + under[1]),
            (out, top),
            (-ROOT_MM, top),
        ),
        opening=Box(0.0, deep, top - wall_mm - TIE_MM[0] - PLAY_MM, top - wall_mm),
        along_mm=along_mm,
        wall_mm=wall_mm,
        tie_mm=TIE_MM,
    )

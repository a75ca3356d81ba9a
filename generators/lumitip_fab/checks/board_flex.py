"""A flexible board's file: stack-up, bend without holes, stiffener, and teardrops."""

from collections.abc import Iterator

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import Read
from lumitip_fab.checks.readers.kicad_board import Copper
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Box, Flexible
from lumitip_fab.design.frames import on_board_page

PLY_MM = 0.001
PLACE_MM = 0.01
ROOM_MM = 0.2  # stiffener to the sides of the wire notch
IN_BEND = 95.0  # of all joints that must have teardrops (%),
ELSEWHERE = 60.0  # and between the leads of multiplexers, where some have no room
OUTSIDE_MM = 0.1  # of pad or via, where a joint's width is taken
WIDER = 1.6  # than the track
_OF_PAD = 0.9  # of the pad's width, where that is less
_STIFFENER, _BEND = "User.1", "User.2"


def measure_flexible(read: Read) -> Iterator[Measurement]:
    """Everything that a flexible board is ordered by."""
    flexible = read.design.board.flexible
    if flexible is None:
        return
    yield _stack_up(read)
    yield from _regions(read, flexible)
    yield _bend(read, flexible)
    yield _held(read)
    yield from _teardrops(read, flexible)


def _stack_up(read: Read) -> Measurement:
    """Thickness of all layers together; between copper there is polyimide, and nothing else."""
    plies, wanted = read.board.plies, read.design.stack.pcb_mm
    copper = [ply for ply in plies if ply.kind == "copper"]
    stiff = [ply for ply in plies if ply.kind != "copper" and ply.material != "Polyimide"]
    whole = sum(ply.thickness_mm for ply in plies)
    good = len(copper) == len(read.board.layers) and len(plies) > len(copper) and not stiff
    return read.figure(
        "stack_up",
        whole if good else np.nan,
        wanted - PLY_MM,
        wanted + PLY_MM,
        note=f"{len(copper)} of copper, the rest of polyimide",
    )


def _regions(read: Read, flexible: Flexible) -> Iterator[Measurement]:
    """Stiffener and bend where the design has them, and the stiffener within the wire notch."""
    wanted = {_STIFFENER: flexible.stiffener, _BEND: flexible.bend}
    off = [
        _off(read.board.regions[layer], box) if layer in read.board.regions else np.nan
        for layer, box in wanted.items()
    ]
    yield read.figure("regions", np.max(off), 0, PLACE_MM, note="stiffener and bend")
    notch = read.finger.notch
    drawn = read.board.regions.get(_STIFFENER, shapely.Point())
    low, high = on_board_page((notch.x_min_mm, 0.0))[0], on_board_page((notch.x_max_mm, 0.0))[0]
    room = min(drawn.bounds[0] - low, high - drawn.bounds[2]) if not drawn.is_empty else np.nan
    yield read.figure("stiffener_room", room, ROOM_MM, np.inf, note="to the sides of the notch")


def _bend(read: Read, flexible: Flexible) -> Measurement:
    """Vias and plated holes where the board bends."""
    bend = _on_page(flexible.bend)
    holes = [c for c in read.board.copper() if c.drill_mm and c.area.intersects(bend)]
    plated = [
        t
        for part in read.board.parts
        for t in part.terminals
        if t.copper is not None and t.drill_mm and t.copper.area.intersects(bend)
    ]
    return read.figure("bend", len(holes) + len(plated), 0, 0, "vias and plated holes")


def _held(read: Read) -> Measurement:
    """How far parts that are not at the cells are from the bend, where their joints would break."""
    bend = read.board.regions.get(_BEND, shapely.Point())
    bends = (read.finger.cells_hold.letter, "FID")
    apart = [
        (t.copper.area.bounds[1] - bend.bounds[3], part.ref)
        for part in read.board.parts
        if part.ref.rstrip("0123456789") not in bends and not bend.is_empty
        for t in part.terminals
        if t.copper is not None
    ]
    least, ref = min(apart, default=(np.nan, "no part"))
    return read.figure("held", least, 0, np.inf, note=f"from the bend to {ref}")


def _teardrops(read: Read, flexible: Flexible) -> Iterator[Measurement]:
    """Joints of tracks with pads and vias that are wider there than the track, but for ground,
    which the pour joins: where the board bends, and where the interface holds it."""
    copper = [c for c in read.board.copper() if c.net not in ("", "GND")]
    bend = _on_page(flexible.bend)
    found: dict[bool, list[bool]] = {True: [], False: []}
    for layer in read.board.layers:
        here = [c for c in copper if layer in c.layers]
        for net in sorted({c.net for c in here}):
            tracks = [c for c in here if c.net == net and c.kind == "track"]
            if tracks:
                lands = [c for c in here if c.net == net and c.kind in ("pad", "via")]
                for land in lands:
                    bends = bool(land.area.intersects(bend))
                    found[bends] += _widened(tracks, land)
    for bends, where, least in ((True, "bends", IN_BEND), (False, "is held", ELSEWHERE)):
        joints = found[bends]
        share = 100.0 * sum(joints) / len(joints) if joints else np.nan
        note = f"of {len(joints)} joints where the board {where}"
        yield read.figure("teardrops", share, least, 100, "%", note)


def _widened(tracks: list[Copper], land: Copper) -> list[bool]:
    """Whether the copper is wider than a track at each place where tracks leave a land."""
    thin = min(track.width_mm for track in tracks)
    together = shapely.union_all([track.area for track in tracks])
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(land.area))
    side = float(np.hypot(*np.diff(corners[:3], axis=0).T).min())
    needed = min(WIDER * thin, _OF_PAD * side)
    ring = land.area.buffer(OUTSIDE_MM).exterior
    crossed = shapely.line_merge(ring.intersection(together))
    return [float(part.length) >= needed for part in shapely.get_parts(crossed)]


def _off(drawn: BaseGeometry, box: Box) -> float:
    return float(np.abs(np.array(drawn.bounds) - np.array(_on_page(box).bounds)).max())


def _on_page(box: Box) -> BaseGeometry:
    (left, high), (right, low) = (
        on_board_page(at) for at in ((box.x_min_mm, box.y_min_mm), (box.x_max_mm, box.y_max_mm))
    )
    return shapely.box(left, low, right, high)

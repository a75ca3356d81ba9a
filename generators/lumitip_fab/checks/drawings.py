"""The exploded drawings of the fingers and of the whole system: every body is there, in its order
and size, all on the page."""

import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from xml.etree import ElementTree as XmlTree

import numpy as np

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.drawing import Drawing, margin_mm, read_drawing
from lumitip_fab.checks.readers.solids import Vectors
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Box, Design, Finger
from lumitip_fab.design.frames import backing_bed_to_sensor, mount_to_sensor
from lumitip_fab.errors import OutputError

NAMES = ("assembly.drawing", "assembly.drawing_page")
SYSTEM = ("drawing", "drawing_page")
_SYSTEM = "assembly/system.svg"
SIZE_MM = 0.1
SKIN_MM = 0.6  # of silicone and film, whose walls stand off the outline and lean
ORDER_MM = 10.0  # from body to body, on the page
MARGIN_MM = 2.0


def measure_exploded(outputs: Path, design: Design, finger: Finger) -> Iterator[Measurement]:
    """Hold a finger's drawing against the design and its backing."""
    file = f"assembly/{finger.name}_exploded.svg"
    try:
        drawing = read_drawing(outputs / file)
        wanted = _wanted(design, finger, dict(_printed(outputs, design, finger)))
        yield from _bodies(file, drawing, wanted, design.layers)
        yield _page("assembly", file, drawing)
    except (OutputError, OSError, XmlTree.ParseError, LookupError, ValueError) as error:
        yield from (unreadable(name, file, f"cannot be read: {error!r:.200}") for name in NAMES)


def _printed(outputs: Path, design: Design, finger: Finger) -> Iterator[tuple[str, Vectors]]:
    """Corners of the printed parts in the finger's frame."""
    stack, mount = design.stack, design.mount
    frames = {"backing": backing_bed_to_sensor(mount, stack)}
    if design.interfaces:
        frames["interface"] = mount_to_sensor(mount, stack)
    for kind, to_sensor in frames.items():
        mesh = solids.read_mesh(outputs / f"{kind}/{finger.name}_{kind}.stl")
        yield kind, solids.moved(mesh, to_sensor).vertices


def _wanted(
    design: Design, finger: Finger, printed: dict[str, Vectors]
) -> dict[str, tuple[Vectors, float]]:
    """Corners of each body that is to be seen, in the finger's frame, and how true they are."""
    stack, mould = design.stack, design.mould
    low, face = stack.rim_z_mm, stack.silicone_z_mm
    lean = stack.cover_mm * math.tan(math.radians(mould.draft_deg))
    foot = _grown(design.outline.polygon(), mould.wall_gap_mm)
    found = {
        **{kind: (corners, SIZE_MM) for kind, corners in printed.items()},
        "board": (_block(design.board.box, stack.pocket_z_mm, low), SIZE_MM),
        "silicone": (_keyed(_between(foot, stack.face_z_mm, face), design), SKIN_MM),
        "film": (_film(_grown(foot, -lean), face, mould.end_round_mm), SKIN_MM),
    }
    for part in finger.parts:
        if part.side == "front":
            found[part.name] = (_block(part.box, low, low + part.height_mm), SIZE_MM)
    return found


def _keyed(skin: Vectors, design: Design) -> Vectors:
    """A skin with the silicone in the plate's keys, down to the rims of their countersinks."""
    turn = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)
    round_ = np.column_stack([np.cos(turn), np.sin(turn)])
    corners = [skin]
    for key in design.keys:
        rim = np.array(key.at) + round_ * key.wide_mm / 2
        heights = [design.tip.back_z_mm(design.stack, y) for y in rim[:, 1]]
        corners.append(np.column_stack([rim, heights]))
    return np.concatenate(corners)


def _film(skin: Vectors, face_mm: float, radius_mm: float) -> Vectors:
    """The film over a face: at the gripper end it goes round the edge."""
    into = np.clip(skin[:, 1] - skin[:, 1].min(), 0.0, radius_mm)
    edge = face_mm - radius_mm + np.sqrt(radius_mm**2 - (radius_mm - into) ** 2)
    return np.concatenate([_between(skin, face_mm, 0.0), np.column_stack([skin, edge])])


def _grown(flat: Vectors, by_mm: float) -> Vectors:
    """An outline stretched so that its extents grow by a distance on each side."""
    return np.asarray(flat * (1 + by_mm / np.abs(flat).max(axis=0)))


def _bodies(
    file: str,
    drawing: Drawing,
    wanted: dict[str, tuple[Vectors, float]],
    layers: tuple[str, ...],
) -> Iterator[Measurement]:
    """Bodies that are missing, sizes on the page, and how far the layers are apart."""
    yield _missing("assembly", file, drawing, wanted)
    there = [name for name in wanted if len(drawing.groups.get(name, ()))]
    off: dict[str, float] = {}
    shifts: dict[str, Vectors] = {}
    for name in there:
        corners, within = wanted[name]
        drawn, flat = drawing.groups[name], corners @ drawing.view.T
        off[name] = float(np.abs(np.ptp(drawn, axis=0) - np.ptp(flat, axis=0)).max()) / within
        shifts[name] = (
            drawn.min(axis=0) + drawn.max(axis=0) - flat.min(axis=0) - flat.max(axis=0)
        ) / 2
    worst = max(off, key=lambda name: off[name])
    most, note = wanted[worst][1], f"of {worst}, against its size at 1:1"
    off_mm = off[worst] * most
    yield Measurement("assembly.drawing", f"{file} size", off_mm, 0, most, "mm", note)
    if not all(name in shifts for name in layers):
        yield unreadable("assembly.drawing", f"{file} order", "a layer is missing")
        return
    yield _order("assembly", file, [shifts[name][1] for name in layers])
    astray = {
        name: float(np.abs(shift - shifts["board"]).max())
        for name, shift in shifts.items()
        if name not in layers
    }
    loose = max(astray, key=lambda name: astray[name])
    note = f"of {loose}, on its board"
    yield Measurement("assembly.drawing", f"{file} place", astray[loose], 0, SIZE_MM, "mm", note)


def _missing(prefix: str, file: str, drawing: Drawing, wanted: Iterable[str]) -> Measurement:
    """Bodies of which nothing is drawn."""
    names = list(wanted)
    missing = [name for name in names if not len(drawing.groups.get(name, ()))]
    note = f"of {len(names)} bodies" + (f", first {missing[0]}" if missing else "")
    return Measurement(f"{prefix}.drawing", file, len(missing), 0, 0, "missing", note)


def _order(prefix: str, file: str, heights_mm: Sequence[float]) -> Measurement:
    """How far each body stands above the one before it on the page, at least."""
    rise, note = float(np.diff(heights_mm).min(initial=math.inf)), "least rise from body to body"
    return Measurement(f"{prefix}.drawing", f"{file} order", rise, ORDER_MM, math.inf, "mm", note)


def _page(prefix: str, file: str, drawing: Drawing) -> Measurement:
    """Least distance of anything drawn or written from the page's edge."""
    margin, note = margin_mm(drawing), "to the page's edge"
    return Measurement(f"{prefix}.drawing_page", file, margin, MARGIN_MM, math.inf, "mm", note)


def _block(box: Box, low_mm: float, high_mm: float) -> Vectors:
    corners = [(x, y) for x in (box.x_min_mm, box.x_max_mm) for y in (box.y_min_mm, box.y_max_mm)]
    return _between(np.array(corners), low_mm, high_mm)


def _between(flat: Vectors, low_mm: float, high_mm: float) -> Vectors:
    levels = [np.column_stack([flat, np.full(len(flat), z)]) for z in (low_mm, high_mm)]
    return np.concatenate(levels)


def measure_system(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Hold the drawing of the whole system against the design."""
    try:
        drawing = read_drawing(outputs / _SYSTEM)
    except (OSError, XmlTree.ParseError, LookupError, ValueError) as error:
        reason = f"cannot be read: {error!r:.200}"
        yield from (unreadable(f"system.{name}", _SYSTEM, reason) for name in SYSTEM)
        return
    stacked = [
        *(["robot.flange", "coupling.body"] if design.flanges else []),
        *(f"{f.name}.{part}" for f in design.flanges for part in ("lower", "board", "upper")),
        "gripper.envelope",
    ]
    held = [f"{name}.{part}" for name in design.system.holders for part in ("tray", "board")]
    layers = [f"{f.name}.{layer}" for f in design.fingers for layer in design.layers]
    yield _missing("system", _SYSTEM, drawing, [*stacked, *held, *layers])
    drawn = [drawing.groups[n] for n in (*stacked, "emitter.backing") if n in drawing.groups]
    yield _order("system", _SYSTEM, [points[:, 1].mean() for points in drawn if len(points)])
    yield _page("system", _SYSTEM, drawing)

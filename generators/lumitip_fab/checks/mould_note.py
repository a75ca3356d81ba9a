"""The note for the person who pours: volume, masses and figures against the mould's cavity."""

import math
import re
from collections.abc import Iterator
from pathlib import Path

import manifold3d
import numpy as np
import shapely

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design, Finger, Prop

VOLUME_FRACTION = 0.02
_GRID_MM = 0.05
_PART = re.compile(r", part ([AB]) \| \*\*([0-9.]+) g\*\*")
Figures = list[tuple[str, ...]]
"""Of each place where the note has them."""
_STATED = re.compile(r"stays on the finger \| \*\*([0-9.]+) mL\*\*")


def measure_note(outputs: Path, design: Design, finger: Finger) -> Iterator[Measurement]:
    """The casting note: grams of both parts, layers, heights and hours."""
    file = f"mould/{finger.name}_casting.md"
    try:
        text = (outputs / file).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        names = "masses", "note", "clamped"
        yield from (unreadable(f"mould.{name}", file, repr(error)) for name in names)
        return
    yield _masses(text, file, design)
    yield _figures(text, file, design)
    yield _clamped(text, file, design)


def _masses(text: str, file: str, design: Design) -> Measurement:
    """Grams of parts A and B in the note against its own millilitres and the mixing ratio."""
    mould = design.mould
    stated, grams = _STATED.search(text), dict(_PART.findall(text))
    if stated is None or grams.keys() != {"A", "B"}:
        return unreadable("mould.masses", file, "does not state the mass of parts A and B")
    whole = float(stated[1]) * (1 + mould.waste_fraction) * mould.density_g_ml
    wanted = [whole * part / sum(mould.mix_ratio) for part in mould.mix_ratio]
    worst = max(abs(float(grams[p]) / w - 1) for p, w in zip("AB", wanted, strict=True))
    note = f"parts of {wanted[0]:.2f} g and {wanted[1]:.2f} g"
    return Measurement("mould.masses", file, 100 * worst, 0, 100 * VOLUME_FRACTION, "%", note)


def _figures(text: str, file: str, design: Design) -> Measurement:
    """Layers, heights, ratio, times, temperature and the side that is up, wherever the note has
    them, against the design."""
    wanted = dict(_wanted(design))
    found = {pattern: re.findall(pattern, text) for pattern in wanted}
    wrong = [
        f"{pattern}: {found[pattern]}, not {values}"
        for pattern, values in wanted.items()
        if [v if isinstance(v, tuple) else (v,) for v in found[pattern]] != values
    ]
    return count("mould.note", file, wrong, "wrong figures")


def _wanted(design: Design) -> Iterator[tuple[str, Figures]]:
    """Patterns of the note, each with its figures wherever it stands."""
    mould, stack = design.mould, design.stack
    stops_mm, hours, warm = mould.stops_mm(stack.cover_mm), f"{mould.cure_h:g}", f"{mould.cure_c:g}"
    yield r"layers of (\S+) mm", [(f"{mould.layer_mm:g}",)]
    yield r"floor at (\S+) mm", [(f"{mould.floor_mm:g}",)]
    yield r"stops\s+at (\S+) mm", [(f"{stops_mm:g}",)]
    yield r"\(`print/printing\.md`\): (\w+) side (\w+),", [("open", "up")]
    yield r"\| curing at (\S+) °C \| (\S+) h \|", [(warm, hours)]
    yield r"Leave it for (\S+) h at (\S+) °C", [(hours, warm)]
    yield r"Wait (\S+) h at (\S+) °C", [(hours, warm)]
    yield r"Not before (\S+) h\.", [(hours,)]
    one, other = (f"{grams:g}" for grams in mould.trial_g)
    yield r"Mix (\S+) g of part (\S+) with (\S+) g of part ([A-Z])", [(one, "A", other, "B")]
    glued: Figures = [(f"{mould.glue_hard_h:g}",)] if stack.sunk else []
    yield r"Let it harden for (\d\S*) h", glued
    workable: Figures = [(f"{mould.pot_life_min:g}",)] if mould.pot_life_min else []
    yield r"can be worked for some (\S+) min at room", workable
    dried: Figures = [(f"{mould.primer_dry_min:g}",)] if mould.primer else []
    yield r"Let it dry for (\S+) min", dried
    yield r"Time:\*\* 20 min, twice (\S+) min to dry", dried
    yield r"with (\S+)% for the cup", [(f"{100 * mould.waste_fraction:.0f}",)]


def _clamped(text: str, file: str, design: Design) -> Measurement:
    """The note names the printed clamp and its screws, or says that there is none."""
    wanted = {"This finger has no printed clamp"} if not design.clamps else set()
    for clamp in design.clamps:
        name = f"{clamp.screw.name} x {clamp.screw_length_mm:g} countersunk"
        wanted |= {f"`mould/{clamp.name}.3mf`", name}
    missing = sorted(each for each in wanted if each not in text)
    note = f"of {', '.join(sorted(wanted))}"
    return Measurement("mould.clamped", file, len(missing), 0, 0, "missing", note)


def measure_volume(
    body: solids.Solid, file: str, outputs: Path, design: Design, finger: Finger
) -> Measurement:
    """Millilitres in the note against the cavity below the rim, less the parts that dip in."""
    note_file = f"mould/{finger.name}_casting.md"
    try:
        stated = _STATED.search((outputs / note_file).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        return unreadable("mould.volume", note_file, repr(error))
    if stated is None:
        return unreadable("mould.volume", note_file, "states no volume")
    dipped = sum(
        part.box.width_mm * part.box.length_mm * part.height_mm
        for part in finger.parts
        if part.side == "front"
    )
    box, stack = design.board.box, design.stack
    if not stack.sunk:
        dipped += box.width_mm * box.length_mm * stack.pcb_mm
    filled = _keys_mm3(design) + sum(_wrap_mm3(design, prop) for prop in design.props)
    measured = (_cavity_mm3(body, design) + filled - dipped) / 1000
    if not measured > 0:
        return unreadable("mould.volume", file, "has no cavity that could be measured")
    low, high = (round(measured * (1 + side * VOLUME_FRACTION), 4) for side in (-1, 1))
    note = f"{measured:.3f} mL in {file}"
    return Measurement("mould.volume", note_file, float(stated[1]), low, high, "mL", note)


def _keys_mm3(design: Design) -> float:
    """Silicone in the plate's keys: holes, and the rings that their countersinks are wider."""
    stack, total = design.stack, 0.0
    for key in design.keys:
        radius, deep = key.hole_mm / 2, key.sink_mm
        long = stack.face_z_mm - design.tip.back_z_mm(stack, key.at[1])
        total += math.pi * (radius**2 * long + deep**2 * (radius + deep / 3))
    return total


def _wrap_mm3(design: Design, prop: Prop) -> float:
    """Silicone round the tip: what stands over rim plane and plate, counted on a grid. The level is
    the design's, which `checks.wrap` holds against the written parts."""
    stack, tip, outline = design.stack, design.tip, design.outline
    plate = shapely.Polygon(outline.polygon())
    room = plate.buffer(design.mould.wall_gap_mm)
    slots = shapely.union_all([shapely.box(*slot.bounds_mm) for slot in tip.slots])
    left, _, right, high = room.bounds
    x = np.arange(left, right, _GRID_MM) + _GRID_MM / 2
    y = np.arange(tip.slant_start_y_mm, high, _GRID_MM) + _GRID_MM / 2
    at = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    level = prop.level_mm(at[:, 1])
    back = np.array([tip.back_z_mm(stack, v) for v in y]) - stack.face_z_mm
    on_plate = shapely.contains_xy(plate, at) & ~shapely.contains_xy(slots, at)
    above = level - np.where(on_plate, np.repeat(-back, len(x)), 0.0)
    round_tip = shapely.contains_xy(room, at) & (above > 0)
    covered = at[round_tip & on_plate, 1].min(initial=high)  # farther back it is flash
    return float(above[round_tip & (at[:, 1] >= covered)].sum()) * _GRID_MM**2


def _cavity_mm3(body: solids.Solid, design: Design) -> float:
    """Volume between rim plane and mould within the middle of the walls, less an insert's."""
    mould = design.mould
    silhouette = shapely.Polygon(design.outline.polygon() * (1, -1))
    within = silhouette.buffer(mould.wall_gap_mm + mould.wall_mm / 2)
    ring = np.array(shapely.geometry.polygon.orient(within).exterior.coords)[:-1]
    low = mould.wall_mm / 2
    section = manifold3d.CrossSection([ring])
    filled = section.extrude(mould.stops_mm(design.stack.cover_mm) - low).translate([0, 0, low])
    films = sum(insert.volume_mm3 for insert in mould.inserts)
    return float((filled - body).volume()) - films

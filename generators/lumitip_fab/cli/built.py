"""Masses, strength of fingers and flange, and numbers of parts, from the built files."""

from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.bolt_seat import finger_seat
from lumitip_fab.checks.flange import LEAST_SAFETY, strength
from lumitip_fab.checks.orientation import lying
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.tables import table
from lumitip_fab.checks.strength import finger_loads
from lumitip_fab.design import Design, Fab, Finger
from lumitip_fab.design.frames import flange_beds
from lumitip_fab.design.strength import Loads
from lumitip_fab.docs.row import Row, rows_of
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.manifest import Manifest


def part_number_rows(out: Path, design: Design) -> Iterator[Row]:
    """A row for each board and one for all, from the bill of materials for a fab that asks for both
    numbers; none where no fab does.

    Raises:
        OutputError: if a bill of materials cannot be read.
    """
    fab = next((f for f in design.fabs if {"part", "lcsc"} <= {field for _, field in f.bom}), None)
    if fab is None:
        return
    boards = [f.name for f in design.fingers] + [a.name for a in design.auxiliary_boards]
    lines = {board: _lines(out, board, fab) for board in boards}
    for board in boards:
        yield _row(f"part numbers of the {board} board", lines[board])
    yield _row("part numbers of all boards", [line for each in lines.values() for line in each])


def _row(quantity: str, lines: list[tuple[str, str]]) -> Row:
    """Counts of lines as pairs of order number and LCSC number."""
    known, at_lcsc = (sum(bool(line[i]) for line in lines) for i in (0, 1))
    missing = sorted({part for part, number in lines if not number})
    return Row(
        quantity,
        "not stated",
        f"{known} of {len(lines)} lines, {at_lcsc} with LCSC's ({_percent(at_lcsc, len(lines))} %)",
        f"LCSC numbers are not known for {', '.join(missing)}" if missing else "all are known",
    )


def _percent(count: int, total: int) -> int:
    return 100 * count // total if total else 100


def _lines(out: Path, board: str, fab: Fab) -> list[tuple[str, str]]:
    heading = {field: name for name, field in fab.bom}
    path = out / "boards" / board / "order" / f"{fab.name}_{board}_bom.csv"
    try:
        rows = table(path.read_text(encoding="utf-8"))
        return [(row[heading["part"]], row[heading["lcsc"]]) for row in rows]
    except (OSError, ValueError, KeyError) as error:
        raise OutputError(f"{path}: cannot be read: {error}. Run lumitip-fab build.") from error


def built_rows(out: Path, design: Design) -> tuple[Row, ...]:
    """Masses, strength and part numbers of what an output folder was built from.

    Raises:
        OutputError: if the folder was built from other values.
    """
    built = manifest.read(out)
    if built.origin.parameters_hash != design.parameters_hash:
        raise OutputError(f"{out}: not built from these values: run lumitip-fab build first")
    facts = built.files["robot/lumitip.urdf"].facts
    masses_g = {finger.name: facts[f"{finger.name}_g"] for finger in design.fingers}
    fingers = [
        row
        for name, grams in masses_g.items()
        for row in rows_of("finger_mass", name=name, grams=grams, of=design.densities)
    ]
    return (
        *fingers,
        *rows_of("payload", grams=sum(masses_g.values()), of=design.densities),
        *_outside(built, design),
        *_fingers(out, design),
        *_strength(out, design),
        *part_number_rows(out, design),
    )


def _outside(built: Manifest, design: Design) -> Iterator[Row]:
    """Masses of the printed parts and boards beside the fingers: flange and holder."""
    auxiliary_boards = {auxiliary.name: auxiliary for auxiliary in design.auxiliary_boards}
    parts = [(h.name, h.auxiliary, [f"holder/{h.name}.stl"]) for h in design.holders]
    parts += [
        (f.name, f.auxiliary, [f"flange/{f.name}_{part}.stl" for part in flange_beds(f)])
        for f in design.flanges
    ]
    for name, auxiliary, files in parts:
        box = auxiliary_boards[auxiliary].box
        board_ml = box.width_mm * box.length_mm * design.stack.auxiliary_mm / 1000
        printed = [(_volume_ml(built, file), design.slicing.of(file)) for file in files]
        grams = board_ml * design.densities.auxiliary_g_ml
        grams += sum(volume * filament.density_g_ml for volume, filament in printed)
        yield from rows_of("mass", name=name, grams=grams, filament=printed[0][1])


def _fingers(out: Path, design: Design) -> Iterator[Row]:
    """What the rated force does to the weaker finger."""
    limit, half_mm = design.strength, min(design.mask.holes_mm) / 2
    every = [finger_loads(out, design, finger) for finger in design.fingers]
    found = min(every, key=lambda each: each.safety)
    glue = limit.glue_mpa / found.glue_mpa
    seats = [finger_seat(out, design, finger) for finger in design.fingers]
    bearing, shear = max(s.bearing_mpa for s in seats), max(s.shear_mpa for s in seats)
    filament = design.slicing.rigid if design.interfaces else design.slicing.backing
    yield from rows_of(
        "finger_strength",
        found=found,
        limit=limit,
        glue=glue,
        bearing=bearing,
        shear=shear,
        pull_n=max(seat.pull_n for seat in seats),
        mount=design.mount,
        heads=filament.bearing_mpa / bearing,
        land=filament.layer_mpa / shear,
        parts_n=limit.rated_force_n * min(found.safety, glue),
        gripper=f"up to {limit.gripper_n:g} N" if limit.gripper_n else "a force that is not known",
        strain=100 * found.board_strain,
        most_strain=100 * limit.board_strain,
        most_mm=limit.offset_share * half_mm,
    )
    if not design.interfaces:
        yield from _orientation(out, design, design.fingers[every.index(found)], found)


def _orientation(out: Path, design: Design, finger: Finger, found: Loads) -> Iterator[Row]:
    """Why the backings are printed standing."""
    other, filament = lying(out, design, finger, found), design.slicing.backing
    yield from rows_of(
        "stronger_lying" if other.safety > found.safety else "stronger_standing",
        found=found,
        lying=other,
        filament=filament,
        bridge_mm=design.printing.bridge_mm,
    )


def _strength(out: Path, design: Design) -> Iterator[Row]:
    """Safety factors of the flange."""
    for flange in design.flanges:
        lower, upper = (
            solids.moved(solids.read_mesh(out / f"flange/{flange.name}_{part}.stl"), bed)
            for part, bed in flange_beds(flange).items()
        )
        found, filament = strength(lower, upper, design), design.slicing.of(f"flange/{flange.name}")
        loads = {"load_kg": design.system.load_kg, "least": LEAST_SAFETY}
        yield from rows_of("safety", found=found, filament=filament, **loads)


def _volume_ml(built: Manifest, file: str) -> float:
    return float(built.files[file].facts["volume_mm3"]) / 1000

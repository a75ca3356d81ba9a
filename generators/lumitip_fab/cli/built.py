"""Masses, the flange's strength and numbers of parts, from the built files."""

from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.flange import LEAST_SAFETY, strength
from lumitip_fab.checks.readers import solids
from lumitip_fab.cli.part_numbers import part_number_rows
from lumitip_fab.design import Design
from lumitip_fab.design.frames import flange_beds
from lumitip_fab.docs.outside import Row
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest
from lumitip_fab.pipeline.manifest import Manifest


def built_rows(out: Path, design: Design) -> tuple[Row, ...]:
    """Masses, strength and part numbers of what an output folder was built from.

    Raises:
        OutputError: if the folder was built from other values.
    """
    built = manifest.read(out)
    if built.origin.parameters_hash != design.parameters_hash:
        raise OutputError(f"{out}: not built from these values: run lumitip-fab build first")
    masses_g = built.files["robot/lumitip.urdf"].facts
    densities = design.densities
    why = (
        f"volumes of the solids, with {densities.backing_g_ml:g} g/mL for the backing, "
        f"{densities.board_g_ml:.2f} for the board with its copper, {densities.part_g_ml:g} for "
        f"its parts, {densities.silicone_g_ml:g} for the silicone and {densities.film_g_ml:g} for "
        "the film; screws and wires are not in it"
    )
    rows = [
        Row(f"mass of the {f.name} finger", "not stated", f"{masses_g[f'{f.name}_g']:.1f} g", why)
        for f in design.fingers
    ]
    payload = sum(masses_g[f"{f.name}_g"] for f in design.fingers)
    rows.append(Row("payload of both fingers", "not stated", f"{payload:.1f} g", why))
    return (
        *rows,
        *_outside(built, design),
        *_strength(out, design),
        *part_number_rows(out, design),
    )


def _outside(built: Manifest, design: Design) -> Iterator[Row]:
    """Masses of the printed parts and boards beside the fingers: flange and holder."""
    auxiliary_boards = {auxiliary.name: auxiliary for auxiliary in design.auxiliary_boards}
    parts: list[tuple[str, str, tuple[str, ...]]] = [
        (f"mass of the {h.name}", h.auxiliary, (f"holder/{h.name}.stl",)) for h in design.holders
    ]
    parts += [
        (
            f"mass of the {f.name}",
            f.auxiliary,
            tuple(f"flange/{f.name}_{part}.stl" for part in flange_beds(f)),
        )
        for f in design.flanges
    ]
    for what, name, files in parts:
        box = auxiliary_boards[name].box
        board_ml = box.width_mm * box.length_mm * design.stack.auxiliary_mm / 1000
        printed = [(_volume_ml(built, file), design.slicing.of(file)) for file in files]
        grams = board_ml * design.densities.auxiliary_g_ml
        grams += sum(volume * filament.density_g_ml for volume, filament in printed)
        yield Row(
            what,
            "not stated",
            f"{grams:.1f} g",
            f"printed solid from {printed[0][1].name}, with its bare board; parts, screws "
            "and wires are not in it",
        )


def _strength(out: Path, design: Design) -> Iterator[Row]:
    """Safety factors of the flange."""
    for flange in design.flanges:
        lower, upper = (
            solids.moved(solids.read_mesh(out / f"flange/{flange.name}_{part}.stl"), bed)
            for part, bed in flange_beds(flange).items()
        )
        found, filament = strength(lower, upper, design), design.slicing.of(f"flange/{flange.name}")
        load = (
            f"{design.system.load_kg:g} kg of gripper and payload, twice as heavy in a stop, "
            f"{found.lever_mm:.0f} mm before the coupling; an estimate, not tested; at least "
            f"{LEAST_SAFETY:g} is wanted"
        )
        yield Row(
            "safety of the flange's layers",
            "not stated",
            f"{found.layers:.1f}",
            f"{filament.layer_mpa:g} MPa from layer to layer by the filament's entry, the "
            f"bolts left out: {load}",
        )
        yield Row(
            "... right under its bolts' heads",
            "not stated",
            f"{found.bolts:.1f}",
            f"{filament.bearing_mpa:g} MPa when it is pressed: {load}",
        )


def _volume_ml(built: Manifest, file: str) -> float:
    return float(built.files[file].facts["volume_mm3"]) / 1000

"""Masses of fingers, flange and holder, and the flange's strength, from the built files."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lumitip_fab.checks.flange_read import LEAST_SAFETY, strength
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.stl import corners_mm
from lumitip_fab.checks.readers.urdf import read_urdf
from lumitip_fab.design import Design
from lumitip_fab.design.frames import flange_beds
from lumitip_fab.docs.outside import Row
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest


def built_rows(out: Path, design: Design) -> tuple[Row, ...]:
    """Masses from the robot's model in an output folder.

    Raises:
        OutputError: if the folder was built from other values, or the model cannot be read.
    """
    if manifest.read(out).origin.parameters_hash != design.parameters_hash:
        raise OutputError(f"{out}: not built from these values: run lumitip-fab build first")
    links = read_urdf(out / "robot/lumitip.urdf").links
    weighed = [links[f"lumitip_{finger.name}"] for finger in design.fingers]
    densities = design.densities
    why = (
        f"volumes of the solids, with {densities.backing_g_ml:g} g/mL for the backing, "
        f"{densities.board_g_ml:.2f} for the board with its copper, {densities.part_g_ml:g} for "
        f"its parts, {densities.silicone_g_ml:g} for the silicone and {densities.film_g_ml:g} for "
        "the film; screws and wires are not in it"
    )
    rows = [
        Row(f"mass of the {finger.name} finger", "not stated", f"{link.mass_g:.1f} g", why)
        for finger, link in zip(design.fingers, weighed, strict=True)
    ]
    payload = sum(link.mass_g for link in weighed)
    rows.append(Row("payload of both fingers", "not stated", f"{payload:.1f} g", why))
    return (*rows, *_outside(out, design), *_strength(out, design))


def _outside(out: Path, design: Design) -> Iterator[Row]:
    """Masses of the printed parts and boards beside the fingers: flange and holder."""
    carriers = {carrier.name: carrier for carrier in design.carriers}
    parts: list[tuple[str, str, tuple[str, ...]]] = [
        (f"mass of the {h.name}", h.carrier, (f"holder/{h.name}.stl",)) for h in design.holders
    ]
    parts += [
        (
            f"mass of the {f.name}",
            f.carrier,
            tuple(f"flange/{f.name}_{part}.stl" for part in flange_beds(f)),
        )
        for f in design.flanges
    ]
    for what, name, files in parts:
        box = carriers[name].box
        board_ml = box.width_mm * box.length_mm * design.stack.carrier_mm / 1000
        printed = [(_volume_ml(out / file), design.slicing.of(file)) for file in files]
        grams = board_ml * design.densities.carrier_g_ml
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


def _volume_ml(path: Path) -> float:
    a, b, c = corners_mm(path).reshape(-1, 3, 3).transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6000

"""Reference files: what the presets derive to. `make golden` writes them anew; read the diff."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.docs import spec

GOLDEN = Path(__file__).parents[1] / "golden"
DESIGN = Path(__file__).parents[2] / "design"
PRESETS = sorted(file.stem for file in (DESIGN / "presets").glob("*.toml"))


def figures(design: Design) -> Iterator[str]:
    """The figures of a design that a user sees or orders by, a line each."""
    for row in (*spec.rows(design), *spec.choice_rows(design)):
        yield f"{row.quantity}: {row.computed}"
    for finger in design.fingers:
        cells = " ".join(f"{x:.3f},{y:.3f}" for x, y in finger.cells)
        yield f"{finger.name}, cells: {cells}"
        yield f"{finger.name}, connector: {' '.join(finger.connector.signals)}"
        for part in finger.parts:
            at = f"{part.x_mm:.3f},{part.y_mm:.3f}"
            yield f"{finger.name}, {part.name} on the {part.side}: {at}"
    for auxiliary in design.auxiliary_boards:
        for device in auxiliary.components:
            at = f"{device.x_mm:.3f},{device.y_mm:.3f} at {device.angle_deg:g}°"
            yield f"{auxiliary.name}, {device.ref} {device.value} {device.part}: {at}"
    for cell in design.reading.cells:
        yield f"cell {cell.index}: multiplexer {cell.mux}, channel {cell.channel}"
    for number, string in enumerate(design.wiring.strings, start=1):
        yield f"string {number}: {' '.join(map(str, string))}"
    for cable in design.cabling.cables:
        signals = " ".join(wire.signal for wire in cable.wires)
        yield f"cable {cable.name}: {cable.length_mm:g} mm, {signals}"


@pytest.mark.slow_cases
@pytest.mark.golden
@pytest.mark.parametrize("preset", PRESETS)
def test_a_preset_derives_as_recorded(preset: str, design_dir: Path) -> None:
    text = "\n".join(figures(derive(load(design_dir / "presets" / f"{preset}.toml")))) + "\n"
    file = GOLDEN / f"{preset}.txt"
    if os.environ.get("LUMITIP_GOLDEN"):
        file.write_text(text, encoding="utf-8")
    assert file.read_text(encoding="utf-8") == text


def test_the_file_to_edit_starts_as_the_published_sensor(design_dir: Path) -> None:
    fingertip, published = (
        derive(load(design_dir / name)) for name in ("fingertip.toml", "presets/published.toml")
    )
    assert fingertip.grid == published.grid
    assert fingertip.board == published.board
    assert fingertip.outline == published.outline
    assert fingertip.mould == published.mould

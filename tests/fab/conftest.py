"""Parameter files and variants of them, without touching the disk more than once a session."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip.grid import hexagonal_grid, hexagonal_neighbours
from lumitip_fab.config.load import Input, load
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive import derive, resolve
from lumitip_fab.design import Design

PRESETS = Path(__file__).parents[2] / "design" / "presets"
Vary = Callable[[Input, Mapping[str, Any]], Input]


@pytest.fixture(scope="session")
def inputs() -> dict[str, Input]:
    """Every preset, read, with its automatic values in place."""
    return {file.stem: resolve(load(file)).config for file in sorted(PRESETS.glob("*.toml"))}


@pytest.fixture(scope="session")
def designs(inputs: dict[str, Input]) -> dict[str, Design]:
    """Every preset, derived from its file."""
    return {name: derive(load(given.sources[0].path)) for name, given in inputs.items()}


@pytest.fixture(scope="session")
def vary() -> Vary:
    """`vary(given, {"grid.pitch_mm": 5.0})`: the same file with some fields changed."""

    def varied(config: Input, values: Mapping[str, Any]) -> Input:
        told = config.parameters.model_dump()
        for field, value in values.items():
            table = told
            *sections, key = field.split(".")
            for section in sections:
                table = table[section]
            assert key in table, field
            table[key] = value
        return Input(Parameters.model_validate(told), config.catalogue, config.sources)

    return varied


@pytest.fixture(scope="session")
def wiring_faults() -> Callable[[Design], Iterator[str]]:
    """`wiring_faults(design)`: every promise about cells and wires that a design breaks."""
    return _of_wiring


def _of_wiring(design: Design) -> Iterator[str]:
    layout, wiring = design.layout, design.wiring
    cells = range(len(layout))
    grid = hexagonal_grid(design.grid.columns, design.grid.pitch_mm)
    if not np.allclose([layout.x_mm, layout.y_mm], [grid.x_mm, grid.y_mm], atol=1e-6):
        yield "cells are off the grid"
    if layout.neighbours.tolist() != hexagonal_neighbours(design.grid.columns).tolist():
        yield "neighbours are wrong"
    if design.receiver.cells != tuple(zip(layout.x_mm.tolist(), layout.y_mm.tolist(), strict=True)):
        yield "photodetectors are not at their cells"
    if design.emitter.cells != tuple((-x + 0.0, y) for x, y in design.receiver.cells):
        yield "an LED does not face its photodetector"
    if len(set(zip(layout.mux.tolist(), layout.channel.tolist(), strict=True))) != len(layout):
        yield "two cells share an input"
    if layout.mux.max() >= wiring.muxes or layout.channel.max() >= 2 ** len(wiring.select_pins):
        yield "a cell is on an input that there is not"
    if layout.adc_pin.tolist() != [wiring.adc_pins[m] for m in layout.mux]:
        yield "a cell is read by another multiplexer's pin"
    if len(set(wiring.adc_pins)) != wiring.muxes:
        yield "multiplexers share a pin"
    if sorted(i for string in wiring.strings for i in string) != list(cells):
        yield "strings do not hold every LED once"
    if not len(wiring.strings) == len(wiring.resistor_ohm) == len(wiring.current_ma):
        yield "a string has no resistor"
    lengths = {len(string) for string in wiring.strings}
    if max(lengths) - min(lengths) > 1:
        yield "strings differ by more than one LED"
    signals = design.receiver.connector.signals
    if len(set(signals)) != len(signals) or not set(wiring.adc_pins) < set(signals):
        yield "the connector lacks a signal"


@pytest.fixture
def file(design_dir: Path, tmp_path: Path) -> Any:
    """`file(text)`: a parameter file with this text over the published preset."""
    folder = tmp_path / "design"
    (folder / "presets").mkdir(parents=True)
    (folder / "parts").mkdir()
    base = (design_dir / "presets" / "published.toml").read_bytes()
    (folder / "presets" / "published.toml").write_bytes(base)

    def write(text: str) -> Path:
        path = folder / "mine.toml"
        path.write_text('extends = "presets/published.toml"\n' + text, encoding="utf-8")
        return path

    return write


@pytest.fixture
def written(inputs: dict[str, Input], vary: Vary) -> Callable[..., Design]:
    """`written({"flange.enabled": False}, "integrated")`: such a design."""
    return lambda changes=None, preset="published": derive(vary(inputs[preset], changes or {}))

"""Parameter files and variants of them, without touching the disk more than once a session."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.load import Input, load
from lumitip_fab.parameters import Parameters

PRESETS = Path(__file__).parents[2] / "design" / "presets"
Vary = Callable[[Input, Mapping[str, Any]], Input]


@pytest.fixture(scope="session")
def inputs() -> dict[str, Input]:
    """Every preset, read."""
    return {file.stem: load(file) for file in sorted(PRESETS.glob("*.toml"))}


@pytest.fixture(scope="session")
def designs(inputs: dict[str, Input]) -> dict[str, Design]:
    """Every preset, derived."""
    return {name: derive(given) for name, given in inputs.items()}


@pytest.fixture(scope="session")
def vary() -> Vary:
    """`vary(given, {"grid.pitch_mm": 5.0})`: the same file with some fields changed."""

    def varied(given: Input, values: Mapping[str, Any]) -> Input:
        told = given.parameters.model_dump()
        for field, value in values.items():
            table = told
            *sections, key = field.split(".")
            for section in sections:
                table = table[section]
            assert key in table, field
            table[key] = value
        return Input(Parameters.model_validate(told), given.catalogue, given.sources)

    return varied

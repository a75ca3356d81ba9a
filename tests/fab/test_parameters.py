"""The form of a parameter file: units in names, every field described, strict and frozen."""

import re
from collections.abc import Iterator
from typing import Any

import pytest
from pydantic import BaseModel, ValidationError

from lumitip_fab.config.load import Input
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.config.parts import NAMED

UNITS = ("mm", "mm2", "n", "deg", "g_ml", "ma", "v", "w", "ohm", "fraction")
PLAIN = {"outline.waist_at"}  # fractions of the length, by their description


def _leaves(model: type[BaseModel], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, field in model.model_fields.items():
        inner = field.annotation
        if isinstance(inner, type) and issubclass(inner, BaseModel):
            yield from _leaves(inner, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", field


LEAVES = dict(_leaves(Parameters))


@pytest.mark.parametrize("name", LEAVES)
def test_every_field_is_described_and_required(name: str) -> None:
    field = LEAVES[name]
    assert field.description
    assert field.is_required(), "a parameter file says everything that is in force"


@pytest.mark.parametrize("name", [n for n, f in LEAVES.items() if f.annotation is float])
def test_every_number_has_its_unit_in_its_name_and_bounds_on_both_sides(name: str) -> None:
    assert name in PLAIN or name.endswith(tuple(f"_{unit}" for unit in UNITS))
    bounds = str(LEAVES[name].metadata)
    assert re.search(r"G[te]\(", bounds)
    assert re.search(r"L[te]\(", bounds)


def test_the_names_that_other_files_rely_on_are_there() -> None:
    fixed = [
        "grid.columns",
        "grid.pitch_mm",
        "stack.floor_mm",
        "stack.pcb_mm",
        "stack.silicone_mm",
        "stack.film_mm",
        "mask.hole_mm",
        "mask.hole_shape",
        "mask.measured_ruler_mm",
        "coupling.gripper",
        "controller.board",
        "controller.name",
        "tip.angle_deg",
        "tip.slant_start_mm",
        "tip.edge_mm",
        "mould.taper_length_mm",
        "printer.min_wall_mm",
    ]
    assert set(fixed) <= set(LEAVES)
    assert set(NAMED) <= set(LEAVES)


def test_parameters_are_frozen_and_strict(inputs: dict[str, Input]) -> None:
    parameters = inputs["published"].parameters
    with pytest.raises(ValidationError, match="frozen"):
        parameters.grid.pitch_mm = 5.0
    with pytest.raises(ValidationError, match="frozen"):
        parameters.name = "x"
    told = parameters.model_dump()
    for key, value in (("name", 5), ("grid", {**told["grid"], "pitch_mm": "6"}), ("other", 1)):
        with pytest.raises(ValidationError):
            Parameters.model_validate({**told, key: value})


def test_whole_numbers_are_numbers(inputs: dict[str, Input], vary: Any) -> None:
    config = vary(inputs["published"], {"grid.pitch_mm": 6})
    assert config.parameters.grid.pitch_mm == 6.0


def test_a_device_name_fits_one_scan_response(inputs: dict[str, Input], vary: Any) -> None:
    vary(inputs["published"], {"controller.name": "x" * 29})
    for name in ("x" * 30, "", "ü" * 15, "a\nb"):
        with pytest.raises(ValidationError):
            vary(inputs["published"], {"controller.name": name})

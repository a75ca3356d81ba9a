"""Every value of a parameter file does something: none is read and forgotten."""

import dataclasses
from typing import Any

import pytest

from changed_values import CHANGES, FLEX, LIMITS, ONLY_WITH, SINGLE, WITH
from lumitip_fab.config.load import Input, load
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text

pytestmark = pytest.mark.slow
ROOMY_N = 25.0


@pytest.fixture(scope="module")
def published(inputs: dict[str, Input], vary: Any) -> Input:
    """The published file with a second part, "other", of every kind that has only one, and a rated
    force that leaves room for every change."""
    base = vary(inputs["published"], {"finger.rated_force_n": ROOMY_N})
    parts = base.catalogue
    more = {
        "leds": ("15406085BA300", {"exponent": 2.0}),
        "resistors": ("0603", {"order_number": "OTHER{code}"}),
        "resistor_arrays": ("4x0603", {"order_number": "other"}),
        "capacitors": ("100nF 0603", {"capacitance_nf": 220.0}),
        "films": ("TPU 100um", {"soften_c": 80.0}),
        "couplings": ("Robotiq I/O", {"bolt_hole_mm": 5.5}),
        "grippers": ("robotiq_2f85", {"stroke_mm": 84.0}),
        "fasteners": ("M2", {"nut_mm": 4.1}),
        "printers": ("fdm 0.4", {"layer_mm": 0.1}),
        "strips": ("socket 1x15", {"height_mm": 8.0}),
        "regulators": ("AP63205", {"order_number": "other"}),
        "inductors": ("4.7uH 4x4", {"order_number": "other"}),
        "fuses": ("500mA 1206", {"order_number": "other"}),
        "current_sources": ("LT3092", {"set_ua": 5.0}),
        "linear_regulators": ("MCP1700-3302", {"order_number": "other"}),
        "crystals": ("32.768kHz FC-135", {"order_number": "other"}),
        "transistors": ("Si2309CDS", {"order_number": "other"}),
        "pulse_resistors": ("1206 pulse", {"order_number": "other"}),
        "tvs_diodes": ("SMBJ24A", {"order_number": "other"}),
        "indicators": ("APT2012LZGCK", {"order_number": "other"}),
    }
    tables = {
        kind: {**getattr(parts, kind), "other": getattr(parts, kind)[name].model_copy(update=new)}
        for kind, (name, new) in more.items()
    }
    film = parts.films["TPU 100um"].model_copy(update={"thickness_mm": 0.15})
    black = parts.films["TPU 100um"].model_copy(update={"opaque": True})
    tables["films"] = {**tables["films"], "thick": film, "black": black}
    for name, like, height_mm in (
        ("other contacts", "pogo 2x5", 6.5),
        ("other header", "box header 2x7", 8.0),
    ):
        tables["strips"][name] = parts.strips[like].model_copy(update={"height_mm": height_mm})
    for like in ("10uF 0603", "22uF 0805", "18pF 0603"):
        told = {"order_number": "other"}
        tables["capacitors"][f"other {like[:4]}"] = parts.capacitors[like].model_copy(update=told)
    return dataclasses.replace(base, catalogue=parts.model_copy(update=tables))


@pytest.fixture(scope="module")
def before(published: Input) -> Design:
    """The published design."""
    return derive(published)


def _without_hash(design: Design) -> str:
    return design_text(dataclasses.replace(design, parameters_hash="", choices=()))


def test_these_tests_cover_every_field() -> None:
    fields = set()
    for name, field in Parameters.model_fields.items():
        inner = getattr(field.annotation, "model_fields", None)
        fields |= {f"{name}.{key}" for key in inner} if inner else {name}
    assert fields == {*CHANGES, *FLEX, *LIMITS, *SINGLE}


@pytest.mark.parametrize("field", CHANGES)
def test_a_changed_value_changes_the_design_and_its_parameters_hash(
    published: Input, before: Design, vary: Any, field: str
) -> None:
    if only_with := ONLY_WITH.get(field) or ONLY_WITH.get(field.partition(".")[0]):
        published = vary(published, only_with)
        before = derive(published)
    after = derive(vary(published, {field: CHANGES[field], **WITH.get(field, {})}))
    assert after.parameters_hash != before.parameters_hash
    assert _without_hash(after) != _without_hash(before)


@pytest.mark.parametrize("field", FLEX)
def test_a_field_of_compliant_fingers_changes_those_alone(
    inputs: dict[str, Input], vary: Any, field: str
) -> None:
    for preset, changes in (("flex", True), ("published", False)):
        design = derive(inputs[preset])
        after = derive(vary(inputs[preset], {field: FLEX[field]}))
        assert after.parameters_hash != design.parameters_hash
        assert (_without_hash(after) != _without_hash(design)) == changes


@pytest.mark.parametrize("field", LIMITS)
def test_a_changed_limit_changes_the_parameters_hash_alone(
    published: Input, before: Design, vary: Any, field: str
) -> None:
    after = derive(vary(published, {field: LIMITS[field]}))
    assert after.parameters_hash != before.parameters_hash
    assert _without_hash(after) == _without_hash(before)


@pytest.mark.parametrize(
    "changes",
    [
        {"controller.name": "Renamed", "name": "Renamed", "revision": "Z", "date": ""},
        {"mask.measured_ruler_mm": (99.2, 100.4)},
        {"mask.hole_mm": 2.0, "mask.hole_shape": "circle"},
        {"mask.cell_holes_mm": (2.0, *(2.5,) * 31)},
        {"mask.film": "other"},
        {"mould.silicone": "Sylgard 184", "emitter.current_ma": 10.0},
        {"stack.silicone_mm": 1.6, "receiver.pull_up_ohm": 1e5},
    ],
    ids=", ".join,
)
def test_what_is_no_cell_or_wire_keeps_the_design_hash(
    published: Input, before: Design, vary: Any, changes: dict[str, Any]
) -> None:
    after = derive(vary(published, changes))
    assert after.layout.design_hash == before.layout.design_hash
    assert after.layout == before.layout
    assert after.parameters_hash != before.parameters_hash


@pytest.mark.parametrize("field", ["grid.pitch_mm", "grid.columns", "receiver.multiplexer"])
def test_cells_and_wires_change_the_design_hash(
    published: Input, before: Design, vary: Any, field: str
) -> None:
    after = derive(vary(published, {field: CHANGES[field]}))
    assert after.layout.design_hash != before.layout.design_hash


def test_fewer_leds_make_a_string(published: Input, vary: Any) -> None:
    def lengths(most: int) -> list[int]:
        config = vary(published, {"emitter.current_ma": 5.0, "emitter.string_leds": most})
        return [len(string) for string in derive(config).wiring.strings]

    assert lengths(16) == [16, 16]
    assert lengths(12) == [11, 11, 10]


def test_a_part_counts_by_its_figures_and_not_by_what_else_is_in_the_catalogue(
    published: Input, inputs: dict[str, Input], vary: Any, before: Design
) -> None:
    alone = vary(inputs["published"], {"finger.rated_force_n": ROOMY_N})
    assert derive(alone).parameters_hash == before.parameters_hash
    led = published.catalogue.leds["15406085BA300"].model_copy(update={"exponent": 1.5})
    parts = published.catalogue.model_copy(update={"leds": {"15406085BA300": led}})
    after = derive(dataclasses.replace(published, catalogue=parts))
    assert after.parameters_hash != before.parameters_hash
    assert after.layout.optics.emitter_exponent == 1.5


def test_the_same_values_written_otherwise_give_the_same_design(
    inputs: dict[str, Input], tmp_path: Any
) -> None:
    file = tmp_path / "mine.toml"
    told = inputs["published"].sources[0].path.read_text(encoding="utf-8")
    file.write_text(told.replace("pitch_mm = 6.0 ", "pitch_mm = 6 "), encoding="utf-8")
    again = load(inputs["published"].sources[0].path)
    assert design_text(derive(load(file))) == design_text(derive(again))

"""Every value of a parameter file does something: none is read and forgotten."""

import dataclasses
from typing import Any

import pytest

from lumitip_fab.config.load import Input, load
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text

pytestmark = pytest.mark.slow

# Another valid value of every field.
CHANGES: dict[str, Any] = {
    "name": "Other",
    "revision": "B",
    "grid.columns": (3, 4, 5, 4, 5, 6, 5),
    "grid.pitch_mm": 5.9,
    "stack.floor_mm": 1.0,
    "stack.pcb_mm": 1.5,
    "stack.silicone_mm": 1.6,
    "stack.film_mm": 0.15,
    "outline.tip_fraction": 0.5,
    "outline.tip_margin_mm": 6.5,
    "outline.shoulder_margin_mm": 7.6,
    "outline.shoulder_at_mm": 10.2,
    "outline.waist_margin_mm": 2.6,
    "outline.waist_at": 0.66,
    "outline.end_margin_mm": 5.5,
    "outline.end_corner_mm": 6.9,
    "backing.variant": "flex",
    "backing.material": "PLA",
    "backing.density_g_ml": 1.24,
    "backing.pocket_clearance_mm": 0.15,
    "backing.pin_clearance_mm": 0.2,
    "backing.relief_clearance_mm": 0.7,
    "backing.tail_mm": 1.6,
    "tip.slant_start_mm": 5.9,
    "tip.edge_mm": 0.5,
    "board.side_margin_mm": 6.0,
    "board.tip_margin_mm": 3.75,
    "board.end_margin_mm": 2.0,
    "board.hole_mm": 2.0,
    "board.hole_edge_mm": 2.1,
    "board.channel_mm": 2.3,
    "board.clearance_mm": 0.3,
    "board.track_mm": 0.15,
    "board.supply_track_mm": 0.6,
    "board.copper_gap_mm": 0.15,
    "board.via_mm": 0.7,
    "board.via_drill_mm": 0.25,
    "board.edge_gap_mm": 0.6,
    "board.panel": "rails",
    "emitter.led": "other",
    "emitter.current_ma": 15.0,
    "emitter.string_leds": 12,
    "emitter.drive": "source",
    "emitter.source": "other",
    "emitter.resistor": "1210",
    "emitter.resistor_side": "front",
    "emitter.switch": "AO3400A",
    "receiver.photodetector": "PT19-21C",
    "receiver.multiplexer": "74HC4067PW",
    "receiver.load": "each",
    "receiver.array": "other",
    "receiver.pull_up_ohm": 68e3,
    "receiver.resistor": "0805",
    "receiver.capacitor": "other",
    "controller.board": "bench",
    "controller.name": "Other",
    "supply.voltage_v": 23.9,
    "breakout.enabled": False,
    "breakout.socket": "other",
    "breakout.board_mm": (46.0, 33.02),
    "breakout.hole_mm": 2.2,
    "breakout.hole_spacing_mm": 35.0,
    "holder.body_mm": 76.0,
    "holder.clearance_mm": 0.4,
    "holder.wall_mm": 3.2,
    "holder.wrap_deg": 106.0,
    "holder.standoff_mm": 3.2,
    "holder.screw": "other",
    "holder.strap_hole_mm": 4.1,
    "holder.strap_spacing_mm": 12.5,
    "flange.enabled": False,
    "flange.coupling": "other",
    "flange.clearance_mm": 0.25,
    "flange.tail_mm": 0.9,
    "flange.web_mm": 2.0,
    "flange.contacts": "other contacts",
    "flange.signals": (
        *("GND", "GND", "SUPPLY", "NC", "CASING", "Von", "485-", "485+", "3V3_out", "485GND"),
    ),
    "flange.header": "other header",
    "flange.headers": (
        ("GND", "CASING", "Von", "485-", "485+", "3V3_out", "485GND"),
        ("REGULATED", "REGULATED", "SUPPLY", "SUPPLY", "GND", "GND", "GND"),
    ),
    "flange.regulator": "other",
    "flange.inductor": "other",
    "flange.input_capacitor": "other 10uF",
    "flange.output_capacitor": "other 22uF",
    "flange.boot_capacitor": "other",
    "flange.fuse": "other",
    "flange.transistor": "other",
    "flange.resistor": "0805",
    "flange.gate_ohm": 120000.0,
    "flange.tvs": "other",
    "flange.inrush_resistor": "other",
    "flange.inrush_ohm": 5.1,
    "flange.indicator": "APT2012LZGCK",
    "receiver.bulk_capacitor": "10uF 0603 10V",
    "module.regulator": "other",
    "module.supply_capacitor": "22uF 0805",
    "module.capacitor": "other",
    "module.crystal": "other",
    "module.crystal_capacitor": "other 18pF",
    "wiring.supply_mm": 310.0,
    "wiring.controller_mm": 160.0,
    "wiring.slack_mm": 50.0,
    "wiring.section_mm2": 0.1,
    "wiring.order": "apart",
    "mask.route": "cut",
    "mask.film": "other",
    "mask.filament": "TPU 98A",
    "mask.layers": 1,
    "mask.hole_mm": 2.4,
    "mask.hole_shape": "circle",
    "mask.measured_ruler_mm": (99.0, 100.0),
    "mask.allowance_mm": 0.8,
    "mask.flap_mm": 12.0,
    "mould.silicone": "Sylgard 184",
    "mould.taper_length_mm": 2.9,
    "mould.tip_silicone_mm": 0.3,
    "mould.wall_gap_mm": 0.2,
    "mould.draft_deg": 4.0,
    "mould.wall_mm": 2.6,
    "mould.waste_fraction": 0.5,
    "printer.min_wall_mm": 0.7,
    "printer.fit_mm": 0.05,
    "coupling.gripper": "other",
    "printer.profile": "other",
}
# What else must change with a field.
FRONT: dict[str, Any] = {"emitter.resistor_side": "front", "emitter.resistor": "0603"}
WITH: dict[str, dict[str, Any]] = {
    "backing.variant": {
        "backing.material": "TPU 98A",
        "stack.floor_mm": 2.0,
        "stack.pcb_mm": 0.2,
    },
    "stack.film_mm": {"mask.film": "thick"},
    "emitter.string_leds": {"emitter.current_ma": 5.0},
    "emitter.drive": FRONT,
    "mask.route": {"mask.film": "black"},
}
# What a section or a field only does something with.
ONLY_WITH: dict[str, dict[str, Any]] = {
    "module": {"controller.board": "nrf52840_module"},
    "receiver.array": {"receiver.load": "each"},
    "emitter.source": {"emitter.drive": "source", **FRONT},
    "emitter.switch": {"receiver.load": "each"},
}
# Limits that only refuse; changing them leaves the design as it is.
LIMITS: dict[str, Any] = {"supply.max_ma": 400.0, "emitter.max_heat_w": 1.9}
# Only one value is allowed so far.
SINGLE = {"board.connector_side"}
# Of a compliant finger alone.
FLEX: dict[str, Any] = {
    "flex.thread_hole_mm": 2.3,
    "flex.interface_mm": 27.0,
    "flex.pad_mm": 1.7,
    "flex.standoff_mm": 2.1,
    "flex.groove_mm": 1.6,
    "flex.groove_depth_mm": 0.8,
    "flex.glue_mm": 0.12,
    "flex.lean_deg": 0.5,
}


@pytest.fixture(scope="module")
def published(inputs: dict[str, Input]) -> Input:
    """The published file with a second part, "other", of every kind that has only one."""
    given = inputs["published"]
    parts = given.catalogue
    more = {
        "leds": ("15406085BA300", {"exponent": 2.0}),
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
    return dataclasses.replace(given, catalogue=parts.model_copy(update=tables))


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
        {"controller.name": "Renamed", "name": "Renamed", "revision": "Z"},
        {"mask.measured_ruler_mm": (99.2, 100.4)},
        {"mask.hole_mm": 2.0, "mask.hole_shape": "circle"},
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
    published: Input, inputs: dict[str, Input], before: Design
) -> None:
    assert derive(inputs["published"]).parameters_hash == before.parameters_hash
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

"""The catalogue against datasheets and the published boards; entries that cannot be are refused."""

import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError
from reportlab.pdfbase.pdfmetrics import getFont

from lumitip_fab.catalogue import Catalogue
from lumitip_fab.catalogue.controllers import Controller
from lumitip_fab.catalogue.electronics import Led, Multiplexer, Resistor
from lumitip_fab.catalogue.record import Sourced
from lumitip_fab.config.load import Input
from lumitip_fab.typeface import BOLD, CODE, PLAIN, load_typeface


@pytest.fixture(scope="module")
def parts(inputs: dict[str, Input]) -> Catalogue:
    """The catalogue that comes with the package."""
    return inputs["published"].catalogue


def test_the_4051s_leads_are_those_of_the_datasheet(parts: Catalogue) -> None:
    mux = parts.multiplexers["74HC4051PW"]
    leads = [mux.inputs[str(i)] for i in range(8)]
    assert leads == [13, 14, 15, 12, 1, 5, 2, 4]
    assert (mux.select, mux.output, mux.leads, mux.channels) == ((11, 10, 9), 3, 16, 8)
    assert mux.lead_pitch_mm == 0.65


def test_the_4067s_leads_are_those_of_the_datasheet(parts: Catalogue) -> None:
    mux = parts.multiplexers["74HC4067PW"]
    leads = [mux.inputs[str(i)] for i in range(16)]
    assert leads == [9, 8, 7, 6, 5, 4, 3, 2, 23, 22, 21, 20, 19, 18, 17, 16]
    assert (mux.select, mux.output, mux.leads) == ((10, 11, 14, 13), 1, 24)
    used = {*leads, *mux.select, mux.output}
    assert set(range(1, 25)) - used == {12, 15, 24}, "ground, enable and supply are left"


def test_the_parts_of_the_benchmarks_are_entries_too(design_dir: Path) -> None:
    files = sorted((design_dir.parent / "benchmarks" / "parts").glob("*.toml"))
    for file in files:
        kind: Any = Catalogue.model_fields[file.stem].annotation
        text = json.dumps(tomllib.loads(file.read_text()))
        assert TypeAdapter(kind).validate_json(text)
    assert len(files) == 4


def test_the_published_detector_is_345_mm_over_its_pads(parts: Catalogue) -> None:
    assert parts.photodetectors["SML-H10TBT86"].over_pads_mm == pytest.approx((3.45, 1.25))


def test_the_published_led_is_2_mm_over_its_pads(parts: Catalogue) -> None:
    assert parts.leds["15406085BA300"].over_pads_mm == pytest.approx((2.0, 1.0))


def test_a_body_larger_than_its_pads_counts(parts: Catalogue) -> None:
    led = parts.leds["15406085BA300"].model_copy(update={"body_mm": (9.0, 8.0, 1.0)})
    assert led.over_pads_mm == (9.0, 8.0)


def test_every_entry_says_where_its_figures_come_from(parts: Catalogue) -> None:
    for kind in Catalogue.model_fields:
        entries = getattr(parts, kind)
        assert entries, kind
        told = {kind: entries} if isinstance(entries, Sourced) else dict(entries)
        for name, entry in told.items():
            assert len(entry.source) > 20, name


def test_what_people_call_a_part_is_told_and_else_its_name(inputs: dict[str, Input]) -> None:
    published = inputs["published"]
    assert published.title("coupling.gripper") == "Robotiq 2F-85"
    assert published.title("controller.board") == "Arduino Nano 33 BLE"
    assert published.title("mould.silicone") == "Solaris", "no title, but a name for people"


def test_no_name_made_for_typing_is_all_there_is(parts: Catalogue) -> None:
    for kind in set(Catalogue.model_fields) - {"laminates", "prices", "tolerances", "mask_shifts"}:
        for name, entry in getattr(parts, kind).items():
            assert "_" not in (entry.title or name), f"{kind}: {name} needs a title"


@pytest.mark.parametrize("title", ["two\nlines", "a | b", "x" * 65, " "])
def test_a_title_that_would_break_a_table_is_refused(parts: Catalogue, title: str) -> None:
    with pytest.raises(ValidationError, match="title"):
        Led.model_validate(_changed(parts.leds["15406085BA300"], title=title))


@pytest.mark.parametrize(
    "title", ["聚氨酯", "LED 新", "Λ", "Gripper _new_ x", "a *b*", "`code`", "a [b]", "<b>", "a\\b"]
)
def test_a_title_that_would_not_be_printed_as_it_is_is_refused(
    parts: Catalogue, title: str
) -> None:
    with pytest.raises(ValidationError, match="title"):
        Led.model_validate(_changed(parts.leds["15406085BA300"], title=title))


def test_a_title_of_any_letters_of_latin_1_is_in_every_typeface(parts: Catalogue) -> None:
    letters = "µ" + "".join(chr(code) for code in range(0xC0, 0x100) if chr(code) not in "×÷")
    for title in (letters, "Größe 2.5/1 (a-b), c+d"):
        led = Led.model_validate(_changed(parts.leds["15406085BA300"], title=title))
        assert led.title == title
    load_typeface()
    for face in (PLAIN, BOLD, CODE):
        assert {ord(letter) for letter in letters} <= getFont(face).face.charToGlyph.keys()


def _changed(entry: Any, **values: Any) -> dict[str, Any]:
    return {**entry.model_dump(), **values}


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"output": 13}, "each needs a lead of its own"),
        ({"leads": 14}, "each needs a lead of its own from 1 to leads = 14"),
        ({"select": (11, 10)}, "has 8 inputs; 2 select lines reach at most 4"),
        ({"inputs": {"1": 13}}, "inputs are 1; the channels 0, 1, 2"),
        ({"inputs": {}}, "inputs are none"),
    ],
)
def test_a_multiplexer_that_cannot_be_wired_is_refused(
    parts: Catalogue, values: dict[str, Any], said: str
) -> None:
    with pytest.raises(ValidationError, match=said):
        Multiplexer.model_validate(_changed(parts.multiplexers["74HC4051PW"], **values))


def test_a_die_above_its_body_is_refused(parts: Catalogue) -> None:
    with pytest.raises(ValidationError, match=r"die_height_mm is 0\.7; at most the body's"):
        Led.model_validate(_changed(parts.leds["15406085BA300"], die_height_mm=0.7))


def test_a_controller_uses_each_pin_once(parts: Catalogue) -> None:
    board = parts.controllers["arduino_nano_33_ble"]
    with pytest.raises(ValidationError, match="has A0 twice"):
        Controller.model_validate(_changed(board, select_pins=("A0",)))
    with pytest.raises(ValidationError, match="analog_pins"):
        Controller.model_validate(_changed(board, analog_pins=()))
    with pytest.raises(ValidationError, match="A9 in pulled_up_ohm"):
        Controller.model_validate(_changed(board, pulled_up_ohm={"A9": 4700.0}))


def test_entries_cannot_be_changed(parts: Catalogue) -> None:
    with pytest.raises(ValidationError, match="frozen"):
        parts.leds["15406085BA300"].exponent = 2.0


def test_resistors_of_known_values_have_a_number_at_lcsc(parts: Catalogue) -> None:
    small = parts.resistors["0603"]
    assert (small.part("100K"), small.lcsc_of("100K")) == ("RC0603FR-07100KL", "C14675")
    assert small.lcsc_of("101K") == ""
    assert parts.resistor_arrays["4x0603"].lcsc_of("20K") == "C728868"
    for series in (*parts.resistors.values(), *parts.resistor_arrays.values()):
        numbers = [number.split()[1] for number in series.lcsc_by_code]
        assert len(set(numbers)) == len(numbers) >= 60


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"lcsc_by_code": ["75K C1", "75K C2"]}, "75K twice"),
        ({"lcsc_by_code": ["75K"]}, "should match pattern"),
        ({"lcsc_by_code": ["75k C1"]}, "should match pattern"),
        ({"lcsc": "C1"}, "each value has its own number"),
    ],
)
def test_numbers_by_value_that_cannot_be_are_refused(
    parts: Catalogue, change: dict[str, Any], told: str
) -> None:
    entry = json.loads(parts.resistors["0603"].model_dump_json()) | change
    with pytest.raises(ValidationError, match=told):
        Resistor.model_validate_json(json.dumps(entry))


def test_every_part_has_a_manufacturer(parts: Catalogue) -> None:
    entries = [
        getattr(entry, "module", None) or entry
        for kind in Catalogue.model_fields
        if isinstance(table := getattr(parts, kind), Mapping)
        for entry in table.values()
    ]
    makers = {e.order_number: e.manufacturer for e in entries if hasattr(e, "order_number")}
    assert len(makers) > 25
    assert not [number for number, maker in makers.items() if maker == "any"]

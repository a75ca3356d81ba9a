"""`design/schema.json`: what editors complete, and that they find no fault in a valid file."""

import json
import re
import shutil
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from lumitip_fab.cli import main
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.config.parts import NAMED, OPTIONAL
from lumitip_fab.config.schema import UNITS, field_title

ROOT = Path(__file__).parents[2]
DESIGN = ROOT / "design"
FILES = [DESIGN / "fingertip.toml", *sorted(DESIGN.glob("presets/*.toml"))]
GOALS = {*(ROOT / "examples").glob("goals*.toml")}  # files of another kind
EXAMPLES = [*FILES, *sorted({*(ROOT / "examples").rglob("*.toml")} - GOALS)]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
FIELDS = [
    f"{s}.{f}"
    for s, m in Parameters.model_fields.items()
    for f in getattr(m.annotation, "model_fields", ())
]


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    read: dict[str, Any] = json.loads((DESIGN / "schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(read)
    return read


@pytest.fixture(scope="module")
def published() -> dict[str, Any]:
    return tomllib.loads((DESIGN / "presets" / "published.toml").read_text(encoding="utf-8"))


def _property(schema: dict[str, Any], field: str) -> dict[str, Any]:
    section, key = field.split(".")
    model = schema["properties"][section]["$ref"].rpartition("/")[2]
    found: dict[str, Any] = schema["$defs"][model]["properties"][key]
    return found


def _faults(schema: dict[str, Any], text: str) -> list[str]:
    found = Draft202012Validator(schema).iter_errors(tomllib.loads(text))
    return [fault.json_path for fault in found]


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_no_valid_file_is_underlined(schema: dict[str, Any], file: Path) -> None:
    assert _faults(schema, file.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("field", NAMED)
def test_every_entry_of_the_catalogue_is_offered(schema: dict[str, Any], field: str) -> None:
    entries = tomllib.loads((DESIGN / "parts" / f"{NAMED[field]}.toml").read_text(encoding="utf-8"))
    offered = [name for way in _property(schema, field)["anyOf"] for name in way.get("enum", ())]
    assert offered == [*entries, *(["none"] if field in OPTIONAL else [])]


@pytest.mark.parametrize("field", NAMED)
def test_an_entry_of_the_users_own_is_no_fault_and_a_number_is(
    schema: dict[str, Any], field: str
) -> None:
    assert _faults(schema, f'{field} = "my own part"') == []
    assert _faults(schema, f"{field} = 5") == [f"$.{field}"]


@pytest.mark.parametrize("field", FIELDS)
def test_every_field_has_the_published_value_as_its_default(
    schema: dict[str, Any], published: dict[str, Any], field: str
) -> None:
    section, key = field.split(".")
    # The published boards share pull-ups, and have no sources, switch, power LEDs, bulk capacitor,
    # ESD diodes or diode before the controller; their wires have an order of their own.
    differs = {"receiver.load", "receiver.pull_up_ohm", "emitter.drive", "emitter.switch"}
    differs |= {
        "breakout.feed_diode",
        "breakout.indicator",
        "flange.indicator",
        "receiver.bulk_capacitor",
        "wiring.order",
        "protection.diode",
    }
    wanted = "auto" if field in differs else published[section][key]
    assert _property(schema, field)["default"] == wanted


def test_name_revision_and_date_have_defaults_too(
    schema: dict[str, Any], published: dict[str, Any]
) -> None:
    for field in ("name", "revision", "date"):
        assert schema["properties"][field]["default"] == published[field]


@pytest.mark.parametrize("field", FIELDS)
def test_every_title_has_the_unit_that_the_description_has(
    schema: dict[str, Any], field: str
) -> None:
    shape = _property(schema, field)
    assert shape["title"] == field_title(field.split(".")[1])
    unit = re.search(r"\(([^()]+)\)$", shape["title"])
    if unit:
        assert unit[1] in UNITS.values()
        assert f"({unit[1]}" in shape["description"] or unit[1] == "°"
    else:
        assert "mm)" not in shape["description"]


def test_values_out_of_bounds_and_unknown_fields_are_underlined(schema: dict[str, Any]) -> None:
    text = "grid.pitch_mm = 0.1\nmask.hole_shape = 'star'\n[tip]\nedg_mm = 1.0\n"
    assert sorted(_faults(schema, text)) == ["$.grid.pitch_mm", "$.mask.hole_shape", "$.tip"]


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.name)
def test_every_example_begins_with_the_line_that_names_the_schema(file: Path) -> None:
    first = file.read_text(encoding="utf-8").splitlines()[0]
    assert first.startswith("#:schema ")
    assert (file.parent / first.removeprefix("#:schema ")).resolve() == DESIGN / "schema.json"


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda document: document.name)
def test_so_does_every_whole_file_in_a_document(document: Path) -> None:
    for block in re.findall(r"```toml\n(.*?)```", document.read_text(encoding="utf-8"), re.DOTALL):
        if "extends" in block:
            assert block.startswith("#:schema schema.json\n"), block


def test_a_design_folder_of_ones_own_comes_with_the_schema(tmp_path: Path) -> None:
    assert main(["init", str(tmp_path / "mine"), "--quiet"]) == 0
    for file in sorted((tmp_path / "mine").glob("*.toml")):
        first = file.read_text(encoding="utf-8").splitlines()[0]
        assert (file.parent / first.removeprefix("#:schema ")).is_file()


def test_entries_of_the_users_own_folder_are_offered(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(DESIGN, tmp_path / "mine")
    own, grippers = tmp_path / "mine/fingertip.toml", tmp_path / "mine/parts/grippers.toml"
    text = grippers.read_text(encoding="utf-8")
    grippers.write_text(text + "\n[my_jaw]\ntitle = 'mine'\n", encoding="utf-8")
    assert main(["schema", str(own)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert "my_jaw" in _property(found, "coupling.gripper")["anyOf"][0]["enum"]
    grippers.write_text("[my_jaw", encoding="utf-8")
    assert main(["schema", str(own)]) == 2
    assert "grippers.toml:" in capsys.readouterr().err
    assert main(["schema", str(tmp_path / "none.toml")]) == 2
    assert "none.toml" in capsys.readouterr().err

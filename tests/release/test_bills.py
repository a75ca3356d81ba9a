"""CycloneDX bills: valid, complete, and the same bytes from the same input."""

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator

from release import bills
from release.bills import hardware_bill, software_bill
from release.changes import ReleaseError, newest_release
from release.lock import pins

ROOT = Path(__file__).parents[2]
BOM = """group,item,manufacturer,part,for,quantity,unit,unit_price,price
electronics,LED 15406085BA300,Würth Elektronik,15406085BA300,32 on emitter,32,piece,0.3,9.60
wiring,"stranded wire, 0.08 mm²",,,wiring/cables.csv has their lengths,4.11,m,0.3,1.23
total,used by one pair of fingers,,,EUR,,,,10.83
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """An output folder with a short bill of materials."""
    (tmp_path / "bom.csv").write_text(BOM, encoding="utf-8")
    return tmp_path


def _faults(text: str) -> object:
    return JsonStrictValidator(SchemaVersion.V1_6).validate_str(text)


def _values(component: dict[str, Any]) -> dict[str, str]:
    return {entry["name"]: entry["value"] for entry in component["properties"]}


def test_both_bills_follow_the_schema_and_a_damaged_one_does_not(folder: Path) -> None:
    for text in (software_bill(ROOT), hardware_bill(ROOT, folder)):
        assert _faults(text) is None
        assert _faults(text.replace('"bom-ref"', '"bom_ref"', 1)) is not None
        about = json.loads(text)["metadata"]
        assert about["component"]["version"] == newest_release(ROOT)[0]
        assert about["component"]["licenses"] == [{"expression": "Apache-2.0"}]


def test_the_same_input_makes_the_same_bytes_without_time_and_serial_number(folder: Path) -> None:
    for first, second in (
        (software_bill(ROOT), software_bill(ROOT)),
        (hardware_bill(ROOT, folder), hardware_bill(ROOT, folder)),
    ):
        assert first == second
        assert "serialNumber" not in json.loads(first)
        assert "timestamp" not in json.loads(first)["metadata"]


def test_the_software_bill_has_every_locked_package() -> None:
    components = json.loads(software_bill(ROOT))["components"]
    locked = pins((ROOT / "requirements.lock").read_text(encoding="utf-8"))
    assert {c["name"]: c["version"] for c in components} == locked
    assert [c["name"] for c in components if c["scope"] == "required"] == ["numpy"]
    assert all(
        c["purl"] == f"pkg:pypi/{c['name']}@{c['version'].replace('!', '%21')}" for c in components
    )
    assert all(len(_values(c)["lumitip:sha256"]) == 64 for c in components)


def test_the_hardware_bill_has_every_line_with_its_quantity(folder: Path) -> None:
    text = hardware_bill(ROOT, folder)
    led, wire = sorted(json.loads(text)["components"], key=lambda c: str(c["bom-ref"]))
    assert led["type"] == wire["type"] == "device"
    assert led["manufacturer"] == {"name": "Würth Elektronik"}
    assert _values(led)["cdx:device:quantity"] == "32"
    assert _values(led)["lumitip:part"] == "15406085BA300"
    assert (_values(wire)["cdx:device:quantity"], _values(wire)["lumitip:unit"]) == ("4.11", "m")
    assert "manufacturer" not in wire
    (root,) = [d for d in json.loads(text)["dependencies"] if d["ref"] == "lumitip"]
    assert root["dependsOn"] == ["line/001", "line/002"]
    changed = folder / "changed"
    changed.mkdir()
    (changed / "bom.csv").write_text(BOM.replace(",32,piece", ",31,piece"), encoding="utf-8")
    assert hardware_bill(ROOT, changed) != text


def test_the_hardware_bill_of_a_built_design_is_valid_and_whole(outputs: Path) -> None:
    text = hardware_bill(ROOT, outputs)
    assert _faults(text) is None
    with (outputs / "bom.csv").open(encoding="utf-8", newline="") as file:
        lines = [row for row in csv.DictReader(file) if row["group"] != "total"]
    found = sorted(json.loads(text)["components"], key=lambda c: str(c["bom-ref"]))
    assert [(c["group"], c["name"]) for c in found] == [(r["group"], r["item"]) for r in lines]


def test_a_design_that_is_not_built_or_has_another_bill_is_rejected(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert bills.main(tmp_path / "none", tmp_path / "dist") == 1
    assert "make outputs" in capsys.readouterr().err
    assert not (tmp_path / "dist").exists()
    (folder / "bom.csv").write_text(BOM.replace("quantity", "number"), encoding="utf-8")
    with pytest.raises(ReleaseError, match="no column quantity"):
        hardware_bill(ROOT, folder)


def test_the_command_writes_both(folder: Path, tmp_path: Path) -> None:
    assert bills.main(folder, tmp_path / "dist") == 0
    version, _ = newest_release(ROOT)
    names = {f"lumitip-{version}-{kind}.cdx.json" for kind in ("software", "hardware")}
    assert {file.name for file in (tmp_path / "dist").iterdir()} == names

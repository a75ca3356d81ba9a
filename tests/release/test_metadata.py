"""The descriptions of the project agree, and follow their schemas."""

import json
import shutil
from importlib.resources import files
from pathlib import Path

import jsonschema
import pytest
import yaml

from release.metadata import LEROBOT, descriptions, differences, okh_missing, okh_paths

ROOT = Path(__file__).parents[2]
FULL = ("pyproject.toml", "CITATION.cff", "okh.toml", ".zenodo.json")
FILES = ("CHANGELOG.md", LEROBOT, *FULL)


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """A folder with all descriptions."""
    for name in FILES:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def test_all_descriptions_agree() -> None:
    assert set(descriptions(ROOT)) == set(FILES)
    assert list(differences(ROOT)) == []


@pytest.mark.parametrize("name", FILES)
def test_another_version_in_one_description_is_found(copied: Path, name: str) -> None:
    _replace(copied / name, descriptions(ROOT)[name]["version"], "7.8.9")
    assert any(line.startswith("version: ") and "7.8.9" in line for line in differences(copied))


@pytest.mark.parametrize("name", FULL)
def test_another_author_and_another_licence_are_found(copied: Path, name: str) -> None:
    _replace(copied / name, "Lumitip contributors", "Somebody")
    _replace(copied / name, "Apache-2.0", "MIT")
    found = " ".join(differences(copied))
    assert "Somebody" in found
    assert f"{name} has MIT" in found


@pytest.mark.parametrize("name", ["CITATION.cff", ".zenodo.json", "CHANGELOG.md"])
def test_another_date_is_found(copied: Path, name: str) -> None:
    _replace(copied / name, descriptions(ROOT)[name]["date"], "2020-02-02")
    assert any(line.startswith("date: ") and "2020-02-02" in line for line in differences(copied))


def test_the_citation_follows_the_schema_of_the_citation_file_format() -> None:
    vendored = files("check_jsonschema") / "builtin_schemas/vendor/citation-file-format.json"
    schema = json.loads(vendored.read_text(encoding="utf-8"))
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    citation = yaml.load(text, Loader=yaml.BaseLoader)  # its dates are strings
    jsonschema.validate(citation, schema)
    del citation["authors"]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(citation, schema)


def test_the_hardware_manifest_has_its_fields_and_files(copied: Path, outputs: Path) -> None:
    assert okh_missing(ROOT) == set()
    built = {p for p in okh_paths(ROOT) if p.startswith("outputs/")}
    assert len(built) > 10
    for path in okh_paths(ROOT):
        file = outputs.parent / path.replace("outputs", outputs.name, 1) if path in built else path
        assert (ROOT / file).is_file(), path
    _replace(copied / "okh.toml", 'license = "Apache-2.0"\n', "")
    assert okh_missing(copied) == {"license"}


def test_the_deposit_names_the_fields_that_zenodo_asks_for() -> None:
    zenodo = json.loads((ROOT / ".zenodo.json").read_text(encoding="utf-8"))
    assert {"title", "upload_type", "description", "creators", "access_right"} <= set(zenodo)
    assert zenodo["upload_type"] == "software"


def _replace(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")

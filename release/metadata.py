"""Descriptions of the project: pyproject.toml, CITATION.cff, okh.toml, .zenodo.json."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from release.changes import newest_release

OKH_FIELDS = {"okhv", "name", "version", "license", "licensor", "function"}
"""Fields that Open Know-How (OKH-LOSHv1.0) asks for, without `repo`: there is no public address."""
LEROBOT = "readout/lerobot/pyproject.toml"
_OKH_PATHS = ("readme", "contribution-guide", "user-manual", "image", "bom")


def descriptions(root: Path) -> dict[str, dict[str, Any]]:
    """The same fields of each description, by its file: name, version, licence, authors, and where
    the file has them keywords and the date (ISO 8601)."""
    project = _toml(root / "pyproject.toml")["project"]
    citation = yaml.safe_load((root / "CITATION.cff").read_text(encoding="utf-8"))
    okh = _toml(root / "okh.toml")
    zenodo = json.loads((root / ".zenodo.json").read_text(encoding="utf-8"))
    lerobot = _toml(root / LEROBOT)["project"]
    version, day = newest_release(root)
    return {
        "CHANGELOG.md": {"version": version, "date": day.isoformat()},
        "pyproject.toml": {
            "name": project["name"].capitalize(),
            "version": project["version"],
            "licence": project["license"],
            "authors": [author["name"] for author in project["authors"]],
            "keywords": project["keywords"],
        },
        LEROBOT: {"version": lerobot["version"], "licence": lerobot["license"]},
        "CITATION.cff": {
            "name": citation["title"],
            "version": citation["version"],
            "licence": citation["license"],
            "authors": [author["name"] for author in citation["authors"]],
            "keywords": citation["keywords"],
            "date": citation["date-released"].isoformat(),
        },
        "okh.toml": {
            "name": okh["name"],
            "version": okh["version"],
            "licence": okh["license"],
            "authors": [okh["licensor"]],
        },
        ".zenodo.json": {
            "name": zenodo["title"],
            "version": zenodo["version"],
            "licence": zenodo["license"],
            "authors": [creator["name"] for creator in zenodo["creators"]],
            "keywords": zenodo["keywords"],
            "date": zenodo["publication_date"],
        },
    }


def differences(root: Path) -> Iterator[str]:
    """Each field that two descriptions state differently, with what each says."""
    found = descriptions(root)
    for field in ("name", "version", "licence", "authors", "keywords", "date"):
        said = {file: values[field] for file, values in found.items() if field in values}
        if any(value != next(iter(said.values())) for value in said.values()):
            yield f"{field}: " + ", ".join(f"{file} has {value}" for file, value in said.items())


def okh_paths(root: Path) -> list[str]:
    """Paths of all files that okh.toml names."""
    okh = _toml(root / "okh.toml")
    paths = [okh[field] for field in _OKH_PATHS]
    paths += okh["manufacturing-instructions"] + okh["source"]
    for part in okh["part"]:
        paths += part["source"] + part["export"]
    for software in okh["software"]:
        paths += [software["release"], software["installation-guide"]]
    return paths


def okh_missing(root: Path) -> set[str]:
    """Fields that okh.toml lacks."""
    return OKH_FIELDS - set(_toml(root / "okh.toml"))


def _toml(file: Path) -> dict[str, Any]:
    return tomllib.loads(file.read_text(encoding="utf-8"))

"""`design/schema.json`: what an editor completes and underlines in a parameter file."""

import json
import tomllib
from pathlib import Path
from typing import Any

from lumitip_fab.config.automatic import AUTO, automatic_fields
from lumitip_fab.config.messages import shown_path
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.config.parts import NAMED, NONE, OPTIONAL
from lumitip_fab.config.source import read_toml
from lumitip_fab.paths import packaged_design, parts_file

BASE = "presets/published.toml"
"""The preset whose values are the defaults."""
UNITS = {
    "mm": "mm",
    "mm2": "mm²",
    "deg": "°",
    "ma": "mA",
    "v": "V",
    "w": "W",
    "ohm": "ohm",
    "g_ml": "g/mL",
}
"""Unit by the end of a field's name; a field without one is a count, a fraction or a name."""
_CONSTRAINTS = ("type", "anyOf", "enum", "const", "pattern", "minLength", "maxLength")


def schema_text(folder: Path | None = None) -> str:
    """The JSON Schema of parameter files: units, defaults, names of catalogue entries, and
    docstrings as descriptions.

    Args:
        folder: a design folder whose own entries are offered; none for the packaged ones.

    Raises:
        InputError: if a catalogue file of that folder is not TOML.
    """
    folder = folder or packaged_design()
    schema = Parameters.model_json_schema()
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "Lumitip parameter file"
    base = _packaged(BASE)
    for section, values in base.items():
        if isinstance(values, dict):
            model = schema["properties"][section]["$ref"].rpartition("/")[2]
            _annotate(schema["$defs"][model]["properties"], section, values, folder)
    flat = {k: v for k, v in schema["properties"].items() if "$ref" not in v}
    _annotate(flat, "", base, folder)
    schema["properties"]["extends"] = {
        "type": "string",
        "title": "extends",
        "pattern": r"\.toml$",
        "description": "A parameter file, relative to this one, whose values this one overrides. "
        "It may extend another one.",
        "examples": [BASE],
    }
    _allow_auto(schema)
    # What a file with `extends` leaves out comes from its base, so an editor must not ask for it.
    return (
        json.dumps(_without_required(schema), indent=1, sort_keys=True, ensure_ascii=False) + "\n"
    )


def _allow_auto(schema: dict[str, Any]) -> None:
    """Let the fields whose value the program can choose be `"auto"`, which is their default."""
    for field, automatic in automatic_fields().items():
        section, key = field.split(".")
        name = schema["properties"][section]["$ref"].rpartition("/")[2]
        table = schema["$defs"][name]["properties"]
        text = {k: table[key].pop(k) for k in ("title", "description")}
        table[key].pop("default")
        ways = table[key].get("anyOf", [table[key]])
        start = json.dumps(automatic.start)
        text["description"] += f' "auto": {start} by default; follows {automatic.follows}.'
        table[key] = {**text, "anyOf": [{"const": AUTO}, *ways], "default": AUTO}


def field_title(field: str) -> str:
    """A field's name in words, with its unit: `pitch_mm` is "pitch (mm)"."""
    for end, unit in UNITS.items():
        if field.endswith(f"_{end}"):
            return f"{field.removesuffix(f'_{end}').replace('_', ' ')} ({unit})"
    return field.replace("_", " ")


def _annotate(
    properties: dict[str, Any], section: str, values: dict[str, Any], folder: Path
) -> None:
    """Add to each property of a table its title, its default, and the names that it may have."""
    for field, shape in properties.items():
        shape["title"] = field_title(field)
        shape["default"] = values[field]
        kind = NAMED.get(f"{section}.{field}")
        if kind is not None:
            none = [NONE] if f"{section}.{field}" in OPTIONAL else []
            entries = parts_file(folder, kind)
            _offer(shape, [*read_toml(entries, shown_path(entries)).table, *none])


def _offer(shape: dict[str, Any], names: list[str]) -> None:
    """Let an editor complete these names, and accept others: entries of the user's own."""
    other = {key: shape.pop(key) for key in _CONSTRAINTS if key in shape}
    shape["anyOf"] = [{"enum": names}, *other.get("anyOf", [other])]


def _packaged(path: str) -> dict[str, Any]:
    return tomllib.loads((packaged_design() / path).read_text(encoding="utf-8"))


def _without_required(node: Any) -> Any:
    if isinstance(node, dict):
        return {k: _without_required(v) for k, v in node.items() if k != "required"}
    return [_without_required(v) for v in node] if isinstance(node, list) else node

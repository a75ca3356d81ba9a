"""`design/schema.json`: what an editor completes and underlines in a parameter file."""

import json
from typing import Any

from lumitip_fab.automatic import AUTO, FIELDS
from lumitip_fab.parameters import Parameters


def schema_text() -> str:
    """The JSON Schema of parameter files, with docstrings as descriptions."""
    schema = Parameters.model_json_schema()
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "Lumitip parameter file"
    schema["properties"]["extends"] = {
        "type": "string",
        "pattern": r"\.toml$",
        "description": "A complete parameter file, relative to this one, whose values this one "
        "overrides.",
    }
    _allow_auto(schema)
    # What a file with `extends` leaves out comes from its base, so an editor must not ask for it.
    return (
        json.dumps(_without_required(schema), indent=1, sort_keys=True, ensure_ascii=False) + "\n"
    )


def _allow_auto(schema: dict[str, Any]) -> None:
    """Let the fields whose value the program can choose be `"auto"`, which is their default."""
    for field, automatic in FIELDS.items():
        section, key = field.split(".")
        name = schema["properties"][section]["$ref"].rpartition("/")[2]
        table = schema["$defs"][name]["properties"]
        text = {k: table[key].pop(k) for k in ("title", "description") if k in table[key]}
        start = json.dumps(automatic.start)
        text["description"] += f' "auto": {start} by default; follows {automatic.follows}.'
        table[key] = {**text, "anyOf": [{"const": AUTO}, table[key]], "default": AUTO}


def _without_required(node: Any) -> Any:
    if isinstance(node, dict):
        return {k: _without_required(v) for k, v in node.items() if k != "required"}
    return [_without_required(v) for v in node] if isinstance(node, list) else node

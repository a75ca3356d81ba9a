"""`design/schema.json`: what an editor completes and underlines in a parameter file."""

import json
from typing import Any

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
    # What a file with `extends` leaves out comes from its base, so an editor must not ask for it.
    return (
        json.dumps(_without_required(schema), indent=1, sort_keys=True, ensure_ascii=False) + "\n"
    )


def _without_required(node: Any) -> Any:
    if isinstance(node, dict):
        return {k: _without_required(v) for k, v in node.items() if k != "required"}
    return [_without_required(v) for v in node] if isinstance(node, list) else node

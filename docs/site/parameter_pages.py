"""The parameter reference, from `design/schema.json`, with drawings of what lengths mean."""

import json
from collections.abc import Iterator
from typing import Any

from design_drawings import drawings
from markdown_text import code, prose, table
from repository_pages import ROOT

PAGE = "reference/parameters.md"
_TYPES = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true, false"}
_INTRO = """# Parameters

Every field of a parameter file, from `design/schema.json`, by which editors complete it. A value of
`"auto"` follows from the others; `lumitip-fab spec FILE` lists what was chosen and why. The
defaults are those of a file that does not write the field; presets write some that differ, such as
the published pull-ups in `published.toml`.
[How to change the design](../design.md) says how to write a file of your own.

"""


def parameter_pages() -> Iterator[tuple[str, str]]:
    """Path and text of the page and of its drawings."""
    schema = json.loads((ROOT / "design/schema.json").read_text("utf-8"))
    yield PAGE, _INTRO + "".join(_sections(schema))
    for name, drawing in drawings().items():
        yield f"reference/images/{name}.svg", drawing.svg()


def _sections(schema: dict[str, Any]) -> Iterator[str]:
    fields = schema["properties"]
    references = {name: shape["$ref"] for name, shape in fields.items() if "$ref" in shape}
    tables = {name: path.rpartition("/")[2] for name, path in references.items()}
    top = {name: shape for name, shape in fields.items() if name not in tables}
    yield f"## At the top of the file\n\n{_table('', top)}"
    for name, model in sorted(tables.items()):
        described = schema["$defs"][model]
        yield f"## `[{name}]` {{ #{name} }}\n\n{prose(described['description'])}\n\n"
        for drawn, drawing in drawings().items():
            if name == drawing.section:
                yield f"![{drawing.title}](images/{drawn}.svg)\n\n{drawing.title}.\n\n"
        yield _table(f"{name}.", described["properties"])


def _table(section: str, fields: dict[str, Any]) -> str:
    rows = (
        [
            f'<span id="{section}{name}"></span>{code(name)}',
            unit(shape["title"]),
            code(json.dumps(shape["default"], ensure_ascii=False)) if "default" in shape else "",
            allowed(shape),
            prose(shape.get("description", "")),
        ]
        for name, shape in sorted(fields.items())
    )
    return table(("field", "unit", "default", "allowed", "meaning"), rows)


def unit(title: str) -> str:
    """The unit in a title such as `pitch (mm)`; empty if it has none."""
    return title.rpartition("(")[2].rstrip(")") if title.endswith(")") else ""


def allowed(shape: dict[str, Any]) -> str:
    """The allowed values of a field, in words."""
    if "anyOf" in shape:
        return " or ".join(allowed(each) for each in shape["anyOf"])
    if "const" in shape:
        return code(json.dumps(shape["const"]))
    if "enum" in shape:
        return ", ".join(code(json.dumps(each, ensure_ascii=False)) for each in shape["enum"])
    if shape["type"] == "array":
        inner = shape.get("prefixItems") or [shape["items"]]
        each = ", ".join(dict.fromkeys(allowed(item) for item in inner))
        return f"list{_bounds(shape, 'minItems', 'maxItems')} of: {each}"
    if shape["type"] == "string":
        return _TYPES["string"] + _characters(shape)
    return _TYPES[shape["type"]] + _bounds(shape, "minimum", "maximum")


def _characters(shape: dict[str, Any]) -> str:
    """Length and pattern of a text, in brackets; empty if any text is allowed."""
    least, most = shape.get("minLength", 0), shape.get("maxLength")
    words = [f"{least} to {most} characters" if least else f"up to {most} characters"] * bool(most)
    words += [f"pattern {code(shape['pattern'])}"] if "pattern" in shape else []
    return f" ({', '.join(words)})" if words else ""


def _bounds(shape: dict[str, Any], least: str, most: str) -> str:
    low, high = shape.get(least), shape.get(most)
    above, below = shape.get("exclusiveMinimum"), shape.get("exclusiveMaximum")
    words = [f"above {above:g}"] if above is not None else []
    words += [f"below {below:g}"] if below is not None else []
    if low is not None and high is not None:
        words.append(f"{low:g}" if low == high else f"{low:g} to {high:g}")
    else:
        words += [f"from {low:g} on"] if low is not None else []
        words += [f"up to {high:g}"] if high is not None else []
    return f" ({', '.join(words)})" if words else ""

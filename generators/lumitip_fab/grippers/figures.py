"""The figures of a gripper's entry: how each is measured, and what is allowed."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from lumitip_fab.catalogue.grippers import FIGURES, Gripper
from lumitip_fab.text import table_of

TEXTS = "grippers/texts.toml"
NOT_FIGURES = ("source", "confidence")
"""Fields of the inner tables that are no figures."""


@dataclass(frozen=True)
class Figure:
    """A figure of `parts/grippers.toml`."""

    name: str
    """Its name, with that of its table: `pins.hole_mm`."""
    meaning: str
    """Its description in the catalogue."""
    how: str
    """How it is measured with calipers, or chosen."""
    allowed: str
    """The values that the catalogue accepts."""

    @property
    def table(self) -> str:
        """Its table, such as `pins`; empty for the entry itself."""
        return self.name.rpartition(".")[0]

    @property
    def optional(self) -> bool:
        """Whether a gripper may be without it."""
        return self.name in table_of(TEXTS)["optional"]


@lru_cache
def figures() -> tuple[Figure, ...]:
    """Every figure, those of tables last."""
    schema = Gripper.model_json_schema()
    found = []
    for name in (*FIGURES, "envelope"):
        found += list(_of(name, schema["properties"][name], schema["$defs"]))
    return tuple(sorted(found, key=lambda figure: bool(figure.table)))


def value_of(gripper: Gripper, name: str) -> Any:
    """A figure of an entry; none where the gripper is without it."""
    value: Any = gripper
    for part in name.split("."):
        value = getattr(value, part, None)
    return value


def _of(name: str, shape: Mapping[str, Any], models: Mapping[str, Any]) -> Iterator[Figure]:
    """A figure, or the figures of a table."""
    described = str(shape.get("description", ""))
    shape = next((way for way in shape.get("anyOf", [shape]) if way.get("type") != "null"), shape)
    if "$ref" in shape:
        inner = models[shape["$ref"].rpartition("/")[2]]["properties"]
        for key, each in inner.items():
            if key not in NOT_FIGURES:
                yield from _of(f"{name}.{key}", each, models)
        return
    meaning = " ".join(described.split())
    how = table_of(TEXTS)["figures"].get(name, meaning)
    yield Figure(name, meaning, how, _allowed(shape))


def _allowed(shape: Mapping[str, Any]) -> str:
    if "pattern" in shape:
        return 'a metric thread such as "M4"'
    low, high = (
        f"{sign}{shape[key]:g}"
        for sign, key in (
            ("", "minimum") if "minimum" in shape else ("more than ", "exclusiveMinimum"),
            ("", "maximum") if "maximum" in shape else ("less than ", "exclusiveMaximum"),
        )
    )
    return f"{low} to {high}"

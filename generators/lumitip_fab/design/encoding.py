"""The one JSON form of a `Design` and its parts: the same values give the same text."""

import json
import types
import typing
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

from lumitip.layout import Layout
from lumitip_fab.catalogue.record import Strict
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError
from lumitip_fab.paths import read_plain

T = TypeVar("T")
_DECIMALS = 9  # a picometre: keeps curves smooth, drops the noise of arithmetic


def canonical(value: Any) -> str:
    """The compact text of any part of a design, for keys and hashes."""
    return json.dumps(encoded(value), sort_keys=True, separators=(",", ":"))


def encoded(value: Any) -> Any:
    """A part of a design as plain JSON values."""
    if isinstance(value, Layout):
        return json.loads(value.to_json())
    if isinstance(value, Strict):
        return encoded(value.model_dump())
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: encoded(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, list | tuple):
        return [encoded(v) for v in value]
    if isinstance(value, Mapping):
        return {k: encoded(v) for k, v in value.items()}
    if isinstance(value, float):
        return round(value, _DECIMALS) + 0.0
    return value


def round_trip(design: Design) -> Design:
    """The design with its lengths rounded as in `design.json`: equal to the design read back."""
    return _decoded(encoded(design), Design)


def design_text(design: Design) -> str:
    """The text of `design.json`."""
    record = encoded(design)
    lines = (f"{json.dumps(k)}: {json.dumps(record[k], sort_keys=True)}" for k in sorted(record))
    return "{\n " + ",\n ".join(lines) + "\n}\n"


def read_design(path: Path) -> Design:
    """Read a `design.json`.

    Raises:
        OutputError: if it is missing or was not written by this version.
    """
    try:
        return _decoded(json.loads(read_plain(path).decode()), Design)
    except FileNotFoundError as error:
        raise OutputError(f"{path}: no such file: build the design first") from error
    except (OSError, ValueError, KeyError, TypeError, ArithmeticError, RecursionError) as error:
        raise OutputError(f"{path}: is not a design of this version: {error!r}") from error


@lru_cache
def _fields(kind: type) -> tuple[tuple[str, Any], ...]:
    """Names and types of the fields of a dataclass."""
    hints = typing.get_type_hints(kind)
    return tuple((each.name, hints[each.name]) for each in fields(kind))


def _decoded(value: Any, kind: type[T]) -> T:
    if kind is Layout:
        return typing.cast(T, Layout.from_json(json.dumps(value)))
    if isinstance(kind, type) and issubclass(kind, Strict):
        return kind.model_validate_json(json.dumps(value))
    if is_dataclass(kind):
        values = {name: _decoded(value[name], hint) for name, hint in _fields(kind)}
        return typing.cast(T, kind(**values))
    arguments = typing.get_args(kind)
    if typing.get_origin(kind) in (types.UnionType, typing.Union):
        inner = next(a for a in arguments if a is not type(None))
        return typing.cast(T, None if value is None else _decoded(value, inner))
    if typing.get_origin(kind) is typing.Literal:
        if value not in arguments:
            raise TypeError(f"{value!r:.80} is none of {arguments}")
        return typing.cast(T, value)
    if typing.get_origin(kind) is tuple:
        if arguments[-1] is Ellipsis:
            return typing.cast(T, tuple(_decoded(v, arguments[0]) for v in value))
        return typing.cast(T, tuple(_decoded(v, a) for v, a in zip(value, arguments, strict=True)))
    if kind is float and isinstance(value, int | float):
        return typing.cast(T, float(value))
    if not isinstance(value, kind):
        raise TypeError(f"{value!r:.80} is not {kind.__name__}")
    return value

"""JSON, TOML, CSV and settings: values changed, removed, repeated or swapped."""

import csv
import io
import json
import re
from collections.abc import Iterator
from typing import Any

from numpy.random import Generator

from mutations.amounts import (
    LEAST_MM,
    changed,
    cut_short,
    doubled,
    number_changed,
    removed,
    word_changed,
)
from mutations.damage import Mutators, NotApplicableError

Place = tuple[str | int, ...]
_UNREAD = re.compile(r"(^|\.)(\$schema|comment|tasks?|\w*color|wire_width|bus_width)(\.|$)")
"""Comments, looks of a schematic, and what the next build remembers in the manifest of its own
steps: at worst it runs one once more."""
_HASH = re.compile(r"^[0-9a-f]{64}$")


def _leaves(value: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    """Every number, text and switch of a record, with the keys that lead to it."""
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for key, inner in items:
        if isinstance(inner, dict | list):
            yield from _leaves(inner, (*place, key))
        else:
            yield (*place, key), inner


def _groups(value: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    """Every table and list that has something in it."""
    if isinstance(value, dict | list) and value:
        yield place, value
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _groups(inner, (*place, key))


def _holder(record: Any, place: Place) -> Any:
    for key in place[:-1]:
        record = record[key]
    return record


def _matters(record: Any, place: Place) -> bool:
    """Whether anybody reads what is in a place.

    In the manifest a file without a frame has a matrix that places nothing.
    """
    if _UNREAD.search(_named(place)):
        return False
    if place[:1] == ("files",) and place[2:3] == ("to_sensor",):
        return bool(record["files"][place[1]].get("frame"))
    return True


def _read(data: bytes) -> tuple[Any, list[tuple[Place, Any]]]:
    """A record, and its numbers, texts and switches that matter."""
    record = json.loads(data)
    return record, [(p, v) for p, v in _leaves(record) if _matters(record, p)]


def _drawn(found: list[tuple[Place, Any]], rng: Generator) -> tuple[Place, Any]:
    """One of some places, each kind of place (its keys without numbers) as often as another."""
    if not found:
        raise NotApplicableError
    kinds: dict[str, list[tuple[Place, Any]]] = {}
    for place, value in found:
        kinds.setdefault(".".join(k for k in place if isinstance(k, str)), []).append(
            (place, value)
        )
    names = sorted(kinds)
    chosen = kinds[names[int(rng.integers(len(names)))]]
    return chosen[int(rng.integers(len(chosen)))]


def _written(record: Any, data: bytes) -> bytes:
    """The record as its file had it: with its indent."""
    indent = re.search(rb"\n( +)\S", data)
    text = json.dumps(record, indent=len(indent[1]) if indent else None, ensure_ascii=False)
    return text.encode() + (b"\n" if data.endswith(b"\n") else b"")


def _named(place: Place) -> str:
    return ".".join(map(str, place)) or "the whole"


def _json_number(data: bytes, rng: Generator) -> tuple[bytes, str]:
    record, leaves = _read(data)
    numbers = [(p, v) for p, v in leaves if type(v) in {int, float}]
    place, old = _drawn(numbers, rng)
    least = LEAST_MM if any(str(key).endswith("_mm") for key in place) else 0.0
    new = json.loads(changed(json.dumps(old), rng, least))
    _holder(record, place)[place[-1]] = new
    return _written(record, data), f"{_named(place)}: {old!r} becomes {new!r}"


def _json_text(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Another text of the file, or one with a letter more."""
    record, leaves = _read(data)
    texts = [(p, v) for p, v in leaves if isinstance(v, str)]
    place, old = _drawn(texts, rng)
    alike = sorted({v for p, v in texts if p[-1] == place[-1] and v != old})
    new = alike[int(rng.integers(len(alike)))] if alike else f"{old}x"
    if _HASH.match(old):
        new = old[::-1]
    _holder(record, place)[place[-1]] = new
    return _written(record, data), f"{_named(place)}: {old!r} becomes {new!r}"


def _json_switch(data: bytes, rng: Generator) -> tuple[bytes, str]:
    record, leaves = _read(data)
    place, old = _drawn([(p, v) for p, v in leaves if isinstance(v, bool)], rng)
    _holder(record, place)[place[-1]] = not old
    return _written(record, data), f"{_named(place)}: {old!r} becomes {not old!r}"


def _json_removed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    record = json.loads(data)
    groups = [(p, g) for p, g in _groups(record) if _matters(record, p)]
    place, group = _drawn(groups, rng)
    keys = list(group) if isinstance(group, dict) else [*range(len(group))]
    key = keys[int(rng.integers(len(keys)))]
    if not _matters(record, (*place, key)):
        raise NotApplicableError
    del group[key]
    return _written(record, data), f"{_named((*place, key))} is gone"


def _json_swapped(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Two neighbours of a list in each other's place."""
    record = json.loads(data)
    lists = [
        (p, g)
        for p, g in _groups(record)
        if isinstance(g, list) and len({str(v) for v in g}) > 1 and _matters(record, p)
    ]
    place, group = _drawn(lists, rng)
    pairs = [(i, j) for i in range(len(group)) for j in range(i) if group[i] != group[j]]
    i, j = pairs[int(rng.integers(len(pairs)))]
    group[i], group[j] = group[j], group[i]
    return _written(record, data), f"{_named(place)}: items {i} and {j} are swapped"


JSON: Mutators = {
    "number": _json_number,
    "word": _json_text,
    "switch": _json_switch,
    "remove": _json_removed,
    "swap items": _json_swapped,
    "truncate": cut_short,
}

KICAD_PROJECT: Mutators = {kind: JSON[kind] for kind in JSON if kind != "swap items"}
"""Its lists are sets: nets of a class, patterns of names."""

_TOML_COMMENT = re.compile(r"#.*")
_TOML_TEXT = re.compile(r'= "([^"\n]+)"')
_TOML_LINE = re.compile(r"^\w+ = .*[^[\n]\n", re.MULTILINE)  # none that a list begins on
TOML: Mutators = {
    "number": number_changed(least=0.0, skip=_TOML_COMMENT),
    "word": word_changed(_TOML_TEXT, skip=_TOML_COMMENT),
    "remove": removed(_TOML_LINE),
    "truncate": cut_short,
}

_INI_LINE = re.compile(r"^\w+ = .*\n", re.MULTILINE)
_INI_COMMENT = re.compile(r"^[#;].*", re.MULTILINE)
INI: Mutators = {
    "number": number_changed(skip=_INI_COMMENT),
    "word": word_changed(re.compile(r"= ([^\d\n]+)$", re.MULTILINE), skip=_INI_COMMENT),
    "remove": removed(_INI_LINE),
    "truncate": cut_short,
}

# Comments, and how finely the simulator steps.
_CIR_COMMENT = re.compile(r"^\*.*|^\.end\b.*|^\.options.*", re.MULTILINE)
_CIR_LINE = re.compile(r"^[^*\n].*\n", re.MULTILINE)
CIR: Mutators = {
    "number": number_changed(skip=_CIR_COMMENT),
    "word": word_changed(re.compile(r"(?<=\s)\w*[A-Za-z]\w*(?=\s)"), skip=_CIR_COMMENT),
    "remove": removed(_CIR_LINE, skip=_CIR_COMMENT),
    "truncate": cut_short,
}


def _rows(data: bytes) -> list[list[str]]:
    return list(csv.reader(io.StringIO(data.decode())))


def _table(rows: list[list[str]], data: bytes) -> bytes:
    target = io.StringIO()
    csv.writer(target, lineterminator="\r\n" if b"\r\n" in data else "\n").writerows(rows)
    return target.getvalue().encode()


def _cell(rows: list[list[str]], rng: Generator) -> tuple[int, int]:
    cells = [(i, j) for i in range(1, len(rows)) for j in range(len(rows[i])) if rows[i][j]]
    if not cells:
        raise NotApplicableError
    return cells[int(rng.integers(len(cells)))]


def _csv_cell(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """A number changed, or another text of the same column, or one letter more."""
    rows = _rows(data)
    i, j = _cell(rows, rng)
    old = rows[i][j]
    try:
        new = changed(old, rng)
    except ValueError:
        others = sorted({row[j] for row in rows[1:] if len(row) > j} - {old, ""})
        new = others[int(rng.integers(len(others)))] if others else f"{old}X"
    rows[i][j] = new
    return _table(rows, data), f"{rows[0][j]} of row {i}: {old!r} becomes {new!r}"


def _csv_emptied(data: bytes, rng: Generator) -> tuple[bytes, str]:
    rows = _rows(data)
    i, j = _cell(rows, rng)
    old, rows[i][j] = rows[i][j], ""
    return _table(rows, data), f"{rows[0][j]} of row {i}: {old!r} is gone"


def _csv_removed(data: bytes, rng: Generator) -> tuple[bytes, str]:
    rows = _rows(data)
    i, _ = _cell(rows, rng)
    row = rows.pop(i)
    return _table(rows, data), f"row {i} is gone: {row}"


def _csv_doubled(data: bytes, rng: Generator) -> tuple[bytes, str]:
    rows = _rows(data)
    i, _ = _cell(rows, rng)
    rows.insert(i, rows[i])
    return _table(rows, data), f"row {i} is there twice: {rows[i]}"


def _csv_swapped(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Cells of one column and two rows in each other's place."""
    rows = _rows(data)
    i, j = _cell(rows, rng)
    others = [k for k in range(1, len(rows)) if len(rows[k]) > j and rows[k][j] != rows[i][j]]
    if not others:
        raise NotApplicableError
    k = others[int(rng.integers(len(others)))]
    rows[i][j], rows[k][j] = rows[k][j], rows[i][j]
    return _table(rows, data), f"{rows[0][j]} of rows {i} and {k} are swapped"


def _csv_columns(data: bytes, rng: Generator) -> tuple[bytes, str]:
    """Two headings in each other's place."""
    rows = _rows(data)
    i, j = sorted(rng.choice(len(rows[0]), 2, replace=False).tolist())
    rows[0][i], rows[0][j] = rows[0][j], rows[0][i]
    return _table(rows, data), f"headings {rows[0][j]!r} and {rows[0][i]!r} are swapped"


CSV: Mutators = {
    "cell": _csv_cell,
    "empty": _csv_emptied,
    "remove": _csv_removed,
    "duplicate": _csv_doubled,
    "swap cells": _csv_swapped,
    "swap headings": _csv_columns,
    "truncate": cut_short,
}
PLAIN: Mutators = {
    "number": number_changed(),
    "word": word_changed(),
    "remove": removed(re.compile(r"^.*\S.*\n", re.MULTILINE)),
    "duplicate": doubled(re.compile(r"^.*\S.*\n", re.MULTILINE)),
    "truncate": cut_short,
}

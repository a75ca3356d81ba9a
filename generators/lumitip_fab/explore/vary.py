"""Varied fields, `FIELD=SPEC`, and the designs of all combinations.

grid.pitch_mm=3:8                        as many values as `points`, evenly from 3 to 8
grid.pitch_mm=3:8:0.5                    from 3 in steps of 0.5, 8 included
mask.hole_mm=1.5,2,2.5                   these values
board.track_mm=auto,0.15                 likewise, chosen by the derivation where it may be
grid.columns=[[5, 4, 5], [4, 5, 6, 5]]   a TOML list of values
"""

import itertools
import math
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from pydantic import ValidationError

from lumitip_fab.config.automatic import AUTO, automatic_fields
from lumitip_fab.config.load import Input
from lumitip_fab.config.messages import problems_of, unknown_name
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.config.parts import NAMED, names_for
from lumitip_fab.config.source import Source, flat
from lumitip_fab.errors import InputError, Problem

MOST_DESIGNS = 10_000
_DECIMALS = 6  # a nanometre


@dataclass(frozen=True)
class Axis:
    """A field and the values that it takes."""

    field: str
    values: tuple[Any, ...]


Changes = tuple[tuple[str, Any], ...]


def axes(config: Input, texts: Sequence[str], points: int) -> tuple[Axis, ...]:
    """Parse the texts of `--vary`.

    Args:
        config: the parameter file that is varied.
        texts: `FIELD=SPEC`, each.
        points: values of a range that has no step.

    Raises:
        InputError: with every fault of every text.
    """
    read: list[Axis] = []
    faults: list[Problem] = []
    for text in texts:
        try:
            read.append(_axis(config, text, points))
        except InputError as error:
            faults += error.problems
    fields = [axis.field for axis in read]
    for field in sorted({f for f in fields if fields.count(f) > 1}):
        faults.append(_fault(field, "is there twice; write all of its values in one"))
    for axis in read:
        faults += not_allowed(config, axis) + without_effect(config, axis.field)
    designs = math.prod(len(axis.values) for axis in read)
    if not faults and designs > MOST_DESIGNS:
        faults.append(_fault("", f"makes {designs} designs; at most {MOST_DESIGNS} are evaluated"))
    if faults:
        raise InputError(faults)
    return tuple(read)


def combinations(asked: Sequence[Axis]) -> Iterator[Changes]:
    """Every design: the last axis varies fastest."""
    fields = [axis.field for axis in asked]
    for values in itertools.product(*(axis.values for axis in asked)):
        yield tuple(zip(fields, values, strict=True))


def changed(config: Input, changes: Changes, keep_size: bool = False) -> Input:
    """The parameter file with some fields changed.

    Args:
        config: the file.
        changes: fields and their values; `"auto"` of a field that may be chosen.
        keep_size: whether the grid gets as many columns and rows as keep its size when its pitch
            changes.
    """
    table = config.parameters.model_dump()
    left = {field for field, value in changes if _is_automatic(field, value)}
    for field, value in changes:
        _set(table, field, automatic_fields()[field].start if field in left else value)
    if keep_size:
        grid = config.parameters.grid
        table["grid"]["columns"] = same_size(grid.columns, grid.pitch_mm, table["grid"]["pitch_mm"])
    automatic = config.automatic - {field for field, _ in changes} | left
    return replace(config, parameters=Parameters.model_validate(table), automatic=automatic)


def _is_automatic(field: str, value: Any) -> bool:
    """Whether the value is left to the derivation."""
    return bool(value == AUTO) and field in automatic_fields()


def not_allowed(config: Input, axis: Axis) -> list[Problem]:
    """A fault for each value of a field that no design may have."""
    faults = []
    kind = NAMED.get(axis.field)

    def source(_: str) -> Source:
        return config.sources[0]

    for value in axis.values:
        if _is_automatic(axis.field, value):
            continue
        if kind is not None:
            names = names_for(axis.field, config.catalogue)
            if value not in names:
                message = unknown_name(str(value), list(names), f"parts/{kind}.toml")
                faults.append(_fault(axis.field, message))
            continue
        try:
            changed(config, ((axis.field, value),))
        except ValidationError as error:
            found = problems_of(error, Parameters, source)
            faults += [_fault(axis.field, problem.message) for problem in found]
    return faults


def without_effect(config: Input, field: str) -> list[Problem]:
    """A fault where another parameter takes the place of one that is to vary."""
    if field == "mask.hole_mm" and config.parameters.mask.cell_holes_mm:
        text = "has no effect here, since mask.cell_holes_mm has a size for each cell: vary that"
        return [_fault(field, text)]
    return []


def same_size(columns: Sequence[int], pitch_mm: float, new_mm: float) -> tuple[int, ...]:
    """Columns of a grid of another pitch that is as wide and as long, to the nearest cell.

    Where long and short columns alternate they do so still, and the first is long or short as it
    was; of any other grid the lengths follow its silhouette, and columns that were centred stay so.
    """
    share = pitch_mm / new_mm
    count = max(2, round((len(columns) - 1) * share) + 1) if len(columns) > 1 else 1
    if len(columns) > 1 and _alternate(columns):
        longest = max(2, round((max(columns) - 1) * share) + 1)
        short_first = columns[0] < columns[1]
        return tuple(longest - (i + short_first) % 2 for i in range(count))
    at = np.linspace(0, len(columns) - 1, count)
    lengths = (np.interp(at, np.arange(len(columns)), columns) - 1) * share + 1
    if not _centred(columns):
        return tuple(max(1, round(length)) for length in lengths)
    made = [
        [_nearest(length, (i + first) % 2) for i, length in enumerate(lengths)] for first in (0, 1)
    ]
    return tuple(min(made, key=lambda m: float(np.abs(np.array(m) - lengths).sum())))


def _alternate(columns: Sequence[int]) -> bool:
    """Whether long and short columns alternate, and differ by one cell."""
    return abs(columns[0] - columns[1]) == 1 and all(
        a == b for a, b in zip(columns, columns[2:], strict=False)
    )


def _centred(columns: Sequence[int]) -> bool:
    """Whether the lattice allows every column to be centred: odd and even lengths alternate."""
    return all((a - b) % 2 == 1 for a, b in itertools.pairwise(columns))


def _nearest(length: float, parity: int) -> int:
    """The nearest odd (1) or even (0) number of cells."""
    least = 2 - parity
    return max(least, 2 * round((length - parity) / 2) + parity)


def _set(table: dict[str, Any], field: str, value: Any) -> None:
    *sections, key = field.split(".")
    for section in sections:
        table = table[section]
    table[key] = value


def _axis(config: Input, text: str, points: int) -> Axis:
    field, equals, spec = (part.strip() for part in text.partition("="))
    known = config.parameters.model_dump()
    fields = [name for name, _ in flat(known)]
    if not equals or not spec:
        raise _refusal(
            text, "is no range; FIELD=FROM:TO, FIELD=FROM:TO:STEP or FIELD=A,B,C is needed"
        )
    if field not in fields:
        raise _refusal("", unknown_name(field, fields, "a parameter file"))
    return Axis(field, tuple(dict.fromkeys(_values(field, spec, points, _whole(known, field)))))


def _whole(known: dict[str, Any], field: str) -> bool:
    value = dict(flat(known))[field]
    return isinstance(value, int) and not isinstance(value, bool)


def _values(field: str, spec: str, points: int, whole: bool) -> list[Any]:
    if spec.startswith("["):
        try:
            listed = tomllib.loads(f"list = {spec}")["list"]
        except tomllib.TOMLDecodeError as error:
            raise _refusal(field, f"is {spec!r:.80}, which is no TOML list: {error}") from error
        if not listed:
            raise _refusal(field, "is an empty list; at least one value is needed")
        return [_tuple(value) for value in listed]
    if ":" in spec:
        numbers = _range(field, spec, points)
        return [round(v) if whole else v for v in numbers]
    return [_scalar(part.strip()) for part in spec.split(",")]


def _range(field: str, spec: str, points: int) -> list[float]:
    try:
        bounds = [float(part) for part in spec.split(":")]
    except ValueError:
        bounds = []
    if len(bounds) not in (2, 3) or not all(map(math.isfinite, bounds)):
        raise _refusal(field, f"is {spec!r:.80}; FROM:TO or FROM:TO:STEP in numbers is needed")
    low, high = bounds[:2]
    if not low < high:
        raise _refusal(field, f"is {spec!r:.80}; FROM must be below TO")
    if len(bounds) == 2:
        if points < 2:
            raise _refusal(field, f"has {points} points; a range needs at least 2")
        return [round(low + (high - low) * i / (points - 1), _DECIMALS) for i in range(points)]
    step = bounds[2]
    if not (high - low) / MOST_DESIGNS <= step:
        raise _refusal(
            field, f"has a step of {step:g}; at least {(high - low) / MOST_DESIGNS:g} is needed"
        )
    count = math.floor((high - low) / step + 1e-9) + 1
    return [round(low + i * step, _DECIMALS) for i in range(count)]


def _scalar(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text  # names need no quotes


def _tuple(value: Any) -> Any:
    return tuple(map(_tuple, value)) if isinstance(value, list) else value


def _fault(field: str, message: str) -> Problem:
    return Problem("--vary", 0, field, message)


def _refusal(field: str, message: str) -> InputError:
    return InputError([_fault(field, message)])

"""Texts of faults: the value, the limit, and the nearest valid name."""

import datetime
import difflib
import itertools
import os
import re
import types
import typing
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from lumitip_fab.catalogue.grippers import SCREW
from lumitip_fab.catalogue.record import NAME, PIN, TITLE
from lumitip_fab.config.parameters import DATE, REVISION
from lumitip_fab.config.source import Source
from lumitip_fab.errors import Problem

_KINDS = {
    "float_type": "a number",
    "finite_number": "a finite number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "string_type": "text in quotes",
    "bool_type": "true or false",
    "tuple_type": "a list in brackets",
    "dict_type": "a table",
    "mapping_type": "a table",
    "model_type": "a table",
    "model_attributes_type": "a table",
}
_BOUNDS = {
    "greater_than": "more than {gt:g} is needed",
    "greater_than_equal": "at least {ge:g} is needed",
    "less_than": "less than {lt:g} is allowed",
    "less_than_equal": "at most {le:g} is allowed",
    "string_too_short": "text of {min_length} or more characters is needed",
    "string_too_long": "text of at most {max_length} characters is allowed",
    "literal_error": "{expected} is allowed",
}
"""Continuations of a message by pydantic's kind of fault."""
_WITH_UNIT = re.compile(r"\s*(-?\d+(?:\.\d+)?)\s*[a-zA-ZµΩ°%²/]*\s*")
"""A number in quotes, with or without a unit."""
_PATTERNS = {
    NAME: "letters of Latin-1, digits, spaces, any of . + - / and a _ before a letter or digit, "
    "beginning with an ASCII letter or digit,",
    TITLE: "letters of Latin-1, digits, spaces and any of . , + - / ( ), beginning with a letter "
    "or digit,",
    PIN: "1 to 16 letters, digits or _, beginning with a letter,",
    DATE: 'year, month and day as in "2026-11-28", or nothing',
    SCREW: 'M and the diameter of a metric thread, as in "M4" or "M2.5", without its pitch,',
    REVISION: "1 to 8 letters, digits, dots or hyphens",
}


def shown_path(path: Path) -> str:
    """A file's name in messages: relative to the working folder where it lies below it."""
    try:
        return str(Path(os.path.abspath(path)).relative_to(Path.cwd()))  # noqa: PTH100 - links stay
    except ValueError:
        return str(path)


def unknown_name(name: str, allowed: Iterable[str], where: str) -> str:
    """The message for a name that does not exist.

    Args:
        name: the name in the file.
        allowed: the names that exist.
        where: where they exist, such as a catalogue file.
    """
    names = sorted(allowed)
    by_case = {each.casefold(): each for each in names}
    near = difflib.get_close_matches(name.casefold(), by_case, n=1, cutoff=0.5)
    hint = f"Did you mean {by_case[near[0]]!r}? " if near else ""
    listed = ", ".join(names[:24]) + (", …" if len(names) > 24 else "") or "none"
    return f"is {name!r:.80}, which does not exist. {hint}Names in {where}: {listed}"


def brief(value: Any) -> str:
    """A value as it was written in TOML, shortened."""
    text = _written(value)
    return text if len(text) <= 80 else text[:79] + "…"


def problems_of(
    error: ValidationError, model: Any, setting: Callable[[str], Source], missing: bool = True
) -> list[Problem]:
    """One problem for each fault that pydantic found.

    Args:
        error: what pydantic raised.
        model: the model or annotation that was validated, for the valid names.
        setting: gives the file that wrote a field.
        missing: whether to report fields that are not there.
    """
    problems = []
    faults = error.errors(include_url=False)
    within = {fault["loc"][:-1] for fault in faults}
    for fault in faults:
        if fault["type"] == "too_short" and fault["loc"] in within:
            continue  # pydantic counts only the values that are valid themselves
        if fault["type"] == "missing" and not missing:
            continue
        location = tuple(part for part in fault["loc"] if part != "[key]")
        field = ".".join(map(str, location))
        source = setting(field)
        message = _message(fault, model, location)
        place = shown_path(source.path), source.line(field)
        problems.append(Problem(*place, _named(location), message))
    return problems


def _named(location: tuple[int | str, ...]) -> str:
    """A field by its name; a value of a list by its number, which begins with 1."""
    text = ""
    for before, part in itertools.pairwise(("", *location)):
        if isinstance(part, int):
            text += f", value {part + 1}"
        else:
            text += f", {part}" if isinstance(before, int) else f".{part}"
    return text.removeprefix(".")


def _message(fault: Any, model: Any, location: tuple[Any, ...]) -> str:
    kind, value, context = fault["type"], fault["input"], fault.get("ctx", {})
    if kind == "missing":
        return "is missing; " + _described(model, location)
    if kind == "extra_forbidden":
        message = unknown_name(str(location[-1]), _names(model, location[:-1]), "this table")
        return "is not a known key" + message[message.index(". ") :]
    if kind in ("too_long", "too_short"):
        bound, count = (
            ("at most {} are allowed", context["max_length"])
            if kind == "too_long"
            else ("at least {} are needed", context["min_length"])
        )
        return f"is {brief(value)}, a list of {len(value)}; {bound.format(count)}"
    if kind in _KINDS:
        bare = _bare_number(value) if "number" in _KINDS[kind] else ""
        return f"is {brief(value)}; {_KINDS[kind]} is needed{bare}"
    if kind in _BOUNDS:
        return f"is {brief(value)}; {_BOUNDS[kind].format(**context)}"
    if kind == "string_pattern_mismatch":
        pattern = context["pattern"]
        return f"is {brief(value)}; {_PATTERNS.get(pattern, pattern)} are allowed"
    if kind == "value_error":
        return str(context["error"])
    return f"is {brief(value)}: {fault['msg']}"


def _bare_number(value: Any) -> str:
    """How to write a number that is in quotes, perhaps with a unit; empty for anything else."""
    match = _WITH_UNIT.fullmatch(value) if isinstance(value, str) else None
    return f": write {match[1]}, without quotes" if match else ""


def _written(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple | list):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{k} = {_written(v)}' for k, v in value.items())} }}"
    if isinstance(value, datetime.date | datetime.time):
        return str(value)
    try:
        return repr(value)
    except ValueError:  # Python prints no number of more than 4300 digits
        return "a number of thousands of digits"


def _names(model: Any, location: tuple[Any, ...]) -> list[str]:
    found = _model_at(model, location)
    return list(found.model_fields) if found else []


def _described(model: Any, location: tuple[Any, ...]) -> str:
    around = _model_at(model, location[:-1])
    field = around.model_fields.get(str(location[-1])) if around else None
    if field is None:
        return "it is needed"
    if field.description:
        return "it is needed: " + " ".join(field.description.split())
    inner = _model_at(field.annotation, ())
    return f"the table [{'.'.join(map(str, location))}] is needed" if inner else "it is needed"


def _model_at(annotation: Any, location: tuple[Any, ...]) -> type[BaseModel] | None:
    """The model that stands at a location of an annotation, if one does."""
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is typing.Annotated:
        return _model_at(arguments[0], location)
    if origin in (typing.Union, types.UnionType):
        found = (_model_at(a, location) for a in arguments)
        return next((m for m in found if m is not None), None)
    if origin is not None and issubclass(origin, Mapping):
        return _model_at(arguments[1], location[1:]) if location else None
    if not (isinstance(annotation, type) and issubclass(annotation, BaseModel)):
        return None
    if not location:
        return annotation
    field = annotation.model_fields.get(str(location[0]))
    return _model_at(field.annotation, location[1:]) if field else None

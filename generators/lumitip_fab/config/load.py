"""Read a parameter file with its bases and its catalogue, and report every fault at once."""

import copy
import difflib
import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from lumitip_fab.catalogue import Catalogue
from lumitip_fab.catalogue.record import Entry
from lumitip_fab.config.automatic import filled
from lumitip_fab.config.messages import brief, problems_of, shown_path, unknown_name
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.config.parts import NAMED, NONE, OPTIONAL, Parts, named_parts
from lumitip_fab.config.source import Source, read_toml
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.paths import design_folder, parts_file

_VALUE = re.compile(r"^is (?:'[^']*'|-?\d[\d.e-]*)(?![^\s,;])")
"""The value at the beginning of a message."""


@dataclass(frozen=True)
class Input:
    """A valid parameter file: its values, the catalogue, and where each value was written."""

    parameters: Parameters
    catalogue: Catalogue
    sources: tuple[Source, ...]
    """The file itself, then the file that it extends, and so on down to the complete one."""
    automatic: frozenset[str] = frozenset()
    """Fields that the program chooses; their values are start values."""

    @cached_property
    def parts(self) -> Parts:
        """The catalogue entries that the parameters name: `parts.emitter.led`."""
        return named_parts(self.parameters, self.catalogue)

    def parts_by_field(self) -> dict[str, Entry]:
        """The same entries by field, like `"emitter.led"`; without a field that is `"none"`."""
        entries = {field: _attribute(self.parts, field) for field in NAMED}
        return {field: entry for field, entry in entries.items() if entry is not None}

    def title(self, field: str) -> str:
        """Title of the entry that a field in `NAMED` names."""
        return self.parts_by_field()[field].title or str(self.value(field))

    def value(self, field: str) -> Any:
        """The value of a field, like `"grid.pitch_mm"`."""
        return _attribute(self.parameters, field)

    def with_values(self, values: Mapping[str, Any]) -> "Input":
        """The same input with other values of some fields, as written in a file.

        Raises:
            ValidationError: if a value is outside what its field allows.
        """
        table = self.parameters.model_dump()
        for field, value in values.items():
            section, key = field.split(".")
            table[section][key] = value
        return replace(self, parameters=Parameters.model_validate(table))

    def problem(self, field: str, message: str) -> Problem:
        """A fault of a field, placed in the file that set it; an automatic value is marked."""
        source, own = _setting(self.sources, field), self.sources[0]
        if field in self.automatic:
            message = _VALUE.sub(r"\g<0> (automatic)", message, count=1)
        elif source is not own:  # the base may be good for others
            message = f"{message.removesuffix('.')}. Override it in {shown_path(own.path)}."
        return Problem(shown_path(source.path), source.line(field), field, message)


def _attribute(record: Any, field: str) -> Any:
    section, key = field.split(".")
    return getattr(getattr(record, section), key)


def load(path: Path, folder: Path | None = None) -> Input:
    """Read and validate a parameter file.

    Args:
        path: the file.
        folder: where the catalogue is looked for first; the design folder that the file lies in, if
            it is left out.

    Raises:
        InputError: with every fault of the file, its bases and the catalogue files it uses.
    """
    own, folder = read_toml(path, shown_path(path)), folder or design_folder(path)
    sources, faults = _with_bases(own)
    merged = _merged(sources)
    faults = faults or _without_base(sources[-1], merged, folder)
    whole = not faults  # without its bases, what a file leaves out is no fault
    merged, automatic = filled(merged)
    catalogue, broken = _catalogue(folder)
    faults += broken
    parameters = None
    try:
        parameters = Parameters.model_validate(_tuples(merged))
    except ValidationError as error:
        faults += problems_of(
            error, Parameters, lambda field: _setting(sources, field), missing=whole
        )
    unknown = _unknown_parts(merged, catalogue, sources)
    named = {fault.field for fault in unknown}
    faults = [fault for fault in faults if fault.field not in named] + unknown
    if faults or parameters is None:
        raise InputError(faults)
    return Input(parameters, Catalogue.model_validate(catalogue), sources, automatic)


def written(config: Input) -> dict[str, Any]:
    """All values as the file and its bases wrote them, `"auto"` included."""
    return copy.deepcopy(_merged(config.sources))


def _merged(sources: tuple[Source, ...]) -> dict[str, Any]:
    merged: dict[str, Any] = {}
    for source in reversed(sources):
        merged = _merge(merged, {k: v for k, v in source.table.items() if k != "extends"})
    return merged


def _setting(sources: tuple[Source, ...], field: str) -> Source:
    """The file that wrote a field; of a field that none wrote, the one that wrote its table."""
    while field:
        for source in sources:
            if source.sets(field):
                return source
        field = field.rpartition(".")[0]
    return sources[0]


def _with_bases(own: Source) -> tuple[tuple[Source, ...], list[Problem]]:
    """The file and all that it extends, and the fault of the first base that cannot be used."""
    chain = [own]
    try:
        while "extends" in chain[-1].table:
            chain.append(_base(chain))
    except InputError as error:
        return tuple(chain), list(error.problems)
    return tuple(chain), []


def _without_base(last: Source, merged: Mapping[str, Any], folder: Path) -> list[Problem]:
    """One fault for a file that extends no other and has less than half of the tables."""
    absent = [name for name in Parameters.model_fields if name not in merged]
    if 2 * len(absent) <= len(Parameters.model_fields):
        return []
    message = (
        f"is missing, and so are {len(absent)} tables and values that are needed, such as "
        f"[{absent[-1]}]. A file with only what differs begins with the name of its base. "
    )
    return [Problem(shown_path(last.path), 1, "extends", message + _available(folder, last.path))]


def _base(chain: list[Source]) -> Source:
    """The file that the last of a chain extends; all lie in the first one's design folder."""
    own = chain[-1]
    name = own.table["extends"]

    def refuse(message: str) -> InputError:
        file = shown_path(own.path)
        return InputError([Problem(file, own.line("extends"), "extends", message)])

    if not isinstance(name, str) or not name.endswith(".toml"):
        raise refuse(f"is {brief(name)}; the name of a .toml file is needed")
    folder = design_folder(chain[0].path)
    try:
        base = (own.path.resolve().parent / name).resolve()
        inside, exists = base.is_relative_to(folder.resolve()), base.is_file()
    except (OSError, ValueError, RuntimeError) as error:
        raise refuse(f"is {name!r:.80}, which is not a valid file name") from error
    if not inside:
        raise refuse(
            f"is {name!r:.80}, which is outside the design folder {shown_path(folder)!r}. "
            "Copy the base into that folder."
        )
    if base.is_dir():
        raise refuse(f"is {name!r:.80}, which is a folder. {_available(folder, own.path)}")
    if base.exists() and not exists:
        raise refuse(f"is {name!r:.80}, which is a pipe or device. {_available(folder, own.path)}")
    if not exists:
        near = difflib.get_close_matches(name, _bases(folder, own.path), n=1, cutoff=0.8)
        hint = f"Did you mean {near[0]!r}? " if near else ""
        raise refuse(f"is {name!r:.80}, which does not exist. {hint}{_available(folder, own.path)}")
    if base == own.path.resolve():
        raise refuse(f"is {name!r:.80}, the file itself. Name another file.")
    above = [source.path.resolve() for source in chain]
    if base in above:
        circle = _chain_text([*above[above.index(base) :], base])
        raise refuse(f"is {name!r:.80}, which closes a circle: {circle}. Name a complete file.")
    return read_toml(base, shown_path(base))


def _chain_text(files: list[Path]) -> str:
    shown = [shown_path(file) for file in files]
    return " → ".join(shown if len(shown) <= 5 else [*shown[:3], "…", shown[-1]])


def _bases(folder: Path, own: Path) -> list[str]:
    """The files of the design folder that a file may extend, as it would name them: presets
    first."""
    here = own.resolve().parent
    found = [*sorted(folder.glob("presets/*.toml")), *sorted(folder.glob("*.toml"))]
    others = (p for p in found if p.is_file() and p.resolve() != own.resolve())
    return [os.path.relpath(p, here) for p in others]


def _available(folder: Path, own: Path) -> str:
    names = _bases(folder, own)
    listed = ", ".join(names[:20]) + (", …" if len(names) > 20 else "")
    return f"Available files: {listed}" if names else "There is no other file."


def _merge(base: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    merged = dict(base)
    for key, value in over.items():
        below = merged.get(key)
        both = isinstance(below, dict) and isinstance(value, dict)
        merged[key] = _merge(below, value) if both else value  # type: ignore[arg-type]
    return merged


def _tuples(value: Any) -> Any:
    """TOML has arrays only; the strict models hold tuples."""
    if isinstance(value, dict):
        return {k: _tuples(v) for k, v in value.items()}
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def _catalogue(folder: Path) -> tuple[dict[str, Any], list[Problem]]:
    """Entries by kind, without the kinds that cannot be read, and their faults."""
    tables: dict[str, Any] = {}
    faults: list[Problem] = []
    own = folder / "parts"
    if os.path.lexists(own) and not own.is_dir():
        faults.append(Problem(shown_path(own), 0, "", "is no folder; the catalogue's is needed"))
    for kind, field in Catalogue.model_fields.items():
        path = parts_file(folder, kind)
        try:
            source = read_toml(path, shown_path(path))
            model: Any = field.annotation
            tables[kind] = TypeAdapter[Any](model).validate_python(_tuples(source.table))
        except InputError as error:
            faults += error.problems
        except ValidationError as error:
            faults += problems_of(error, field.annotation, _always(source))
    return tables, faults or _unknown_rotations(folder, tables)


def _unknown_rotations(folder: Path, tables: dict[str, Any]) -> list[Problem]:
    """Parts that a PCB fab turns by their order number, which no entry has: a slip of the pen there
    would leave the part the wrong way round."""
    entries = (e for table in tables.values() if isinstance(table, Mapping) for e in table.values())
    numbers = sorted({e.order_number for e in entries if getattr(e, "order_number", "")})
    path = parts_file(folder, "fabs")
    source = read_toml(path, shown_path(path))
    return [
        Problem(
            shown_path(path),
            source.line(f"{name}.part_rotations"),
            f"{name}.part_rotations",
            unknown_name(number, numbers, "order numbers of parts/*.toml"),
        )
        for name, fab in tables["fabs"].items()
        for number in fab.part_rotations
        if number not in numbers
    ]


def _always(source: Source) -> Callable[[str], Source]:
    return lambda _: source


def _unknown_parts(
    merged: dict[str, Any], catalogue: dict[str, Any], sources: tuple[Source, ...]
) -> list[Problem]:
    faults = []
    for field, kind in NAMED.items():
        section, key = field.split(".")
        table = merged.get(section)
        name = table.get(key) if isinstance(table, dict) else None
        if name == NONE and field in OPTIONAL:
            continue
        if isinstance(name, str) and name not in catalogue.get(kind, (name,)):
            source = _setting(sources, field)
            message = unknown_name(name, list(catalogue[kind]), f"parts/{kind}.toml")
            faults.append(Problem(shown_path(source.path), source.line(field), field, message))
    return faults

"""The answers file of a new gripper: written with every figure open, read back as an entry."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from textwrap import wrap
from typing import Any

import tomli_w
from pydantic import ValidationError

from lumitip_fab.catalogue.grippers import FIGURES, Gripper
from lumitip_fab.catalogue.record import Origin
from lumitip_fab.config.messages import problems_of, shown_path
from lumitip_fab.config.source import Source, read_toml
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.grippers.figures import TEXTS, Figure, figures, value_of
from lumitip_fab.text import table_of

OPEN = "?"
"""The answer of a figure that is not measured yet."""
_COLUMNS = 96
_TRUST = ("datasheet", "measured", "inferred", "assumed")
_MEASURED = Origin(source="measured with calipers by its user", confidence="measured")


class Answer(Origin):
    """A figure that was not measured by the user, with its source."""

    value: float | str
    """The figure."""


def template(name: str, known: Mapping[str, Answer], like: Gripper | None, page: str) -> str:
    """The text of an answers file.

    Args:
        name: of the new gripper.
        known: figures that need not be measured.
        like: a gripper whose figures stand beside the open ones.
        page: name of the page that shows how to measure.
    """
    texts = table_of(TEXTS)["answers"]
    head, table = texts["head"].format(name=name, page=page).rstrip(), ""
    lines = [head, 'title = ""', *_comment(texts["base"]), '# base = ""']
    for figure in figures():
        if figure.table != table:
            table = figure.table
            lines += ["", *_comment(texts["tables"][table]), f"[{table}]"]
        lines += ["", *_comment(_about(figure, like)), _line(figure, known.get(figure.name))]
    return "\n".join(lines) + "\n"


def _about(figure: Figure, like: Gripper | None) -> str:
    beside = "" if like is None else value_of(like, figure.name)
    shown = f" ({like.title}: {beside})" if like and beside not in ("", None) else ""
    return f"{figure.how}\nAllowed: {figure.allowed}.{shown}"


def _comment(text: str) -> list[str]:
    return [f"# {part}" for line in text.splitlines() for part in wrap(line, _COLUMNS)]


def _line(figure: Figure, answer: Answer | None) -> str:
    key = figure.name.rpartition(".")[2]
    if answer is None:
        return f'{key} = "{OPEN}"'
    parts = tomli_w.dumps(answer.model_dump()).splitlines()
    return f"{key} = {{ {', '.join(sorted(parts, key=lambda p: not p.startswith('value')))} }}"


@dataclass
class _Read:
    """What a file says, figure by figure."""

    source: Source
    values: dict[str, Any] = field(default_factory=dict)
    origins: dict[str, Origin] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    unanswered: set[str] = field(default_factory=set)

    def take(self, table: Mapping[str, Any], into: dict[str, Any], prefix: str = "") -> None:
        """Sort each answer into values and sources, and note what is open or wrong."""
        known = {figure.name: figure for figure in figures()}
        tables = {figure.table for figure in known.values()}
        for key, value in table.items():
            name = f"{prefix}{key}"
            if value == OPEN:
                self._open(name, known.get(name))
            elif isinstance(value, dict) and name in tables:
                self.take(value, into.setdefault(key, {}), f"{name}.")
            elif isinstance(value, dict) and name in known:
                self._answer(name, value, into, key)
            else:
                into[key] = value

    def _open(self, name: str, figure: Figure | None) -> None:
        self.unanswered.add(name)
        rule = "none" if figure is None else "optional" if figure.optional else "open"
        text = table_of(TEXTS)["faults"][rule].format(
            allowed=figure.allowed if figure else "", how=figure.how if figure else ""
        )
        self.problems.append(self._problem(name, " ".join(text.split())))

    def _answer(self, name: str, value: Any, into: dict[str, Any], key: str) -> None:
        try:
            answer = Answer.model_validate(value)
        except ValidationError as error:
            self.unanswered.add(name)
            for problem in problems_of(error, Answer, lambda _: self.source):
                where = f"{name}.{problem.field}"
                self.problems.append(replace(problem, field=where, line=self.source.line(where)))
            return
        into[key] = answer.value
        self.origins[name] = Origin(source=answer.source, confidence=answer.confidence)

    def _problem(self, name: str, message: str) -> Problem:
        return Problem(shown_path(self.source.path), self.source.line(name), name, message)

    def of(self, table: str) -> Origin:
        """Source of a table's figures as one: the weakest confidence counts."""
        parts = {
            n.rpartition(".")[2]: o for n, o in self.origins.items() if n.startswith(f"{table}.")
        }
        if not parts:
            return _MEASURED
        named = "; ".join(f"{name}: {origin.source}" for name, origin in parts.items())
        whole = len(parts) == sum(figure.table == table for figure in figures())
        return Origin(
            source=named if whole else f"{_MEASURED.source}; {named}",
            confidence=max((o.confidence for o in parts.values()), key=_TRUST.index),
        )


def read_answers(file: Path) -> Gripper:
    """The entry that an answers file describes.

    Raises:
        InputError: with every fault: figures that are open, missing, out of range or unknown.
    """
    read = _Read(read_toml(file, shown_path(file)))
    read.take(read.source.table, read.values)
    origin = {name: o for name, o in read.origins.items() if name in FIGURES}
    origin |= {table: read.of(table) for table in _tables(read.origins) if table != "envelope"}
    whole = {**_MEASURED.model_dump(), **read.values}
    if isinstance(whole.get("envelope"), dict):
        whole["envelope"] = {**read.of("envelope").model_dump(), **whole["envelope"]}
    try:
        gripper = Gripper.model_validate(whole)
    except ValidationError as error:
        read.problems += [
            problem
            for problem in problems_of(error, Gripper, lambda _: read.source)
            if problem.field not in read.unanswered
        ]
    if read.problems:
        raise InputError(read.problems)
    return gripper.model_copy(update={"origin": {**gripper.origin, **origin}})


def _tables(names: Iterable[str]) -> list[str]:
    return sorted({name.partition(".")[0] for name in names if "." in name})


def entry_text(name: str, gripper: Gripper) -> str:
    """The entry as a table of `parts/grippers.toml`."""
    entry = gripper.model_dump(exclude_none=True, exclude_defaults=True)
    return tomli_w.dumps({name: entry})

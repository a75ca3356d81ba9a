"""Steps, their runs for a design, and the key that tells whether one must run again.

A generator's arguments are its dependencies: each is named after a field of `Design`, but for
those in `EACH`, which make the step run once for each of several. They are read from the source,
because importing a generator of solids takes seconds.
"""

import ast
import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from lumitip_fab.design import Design
from lumitip_fab.design.encoding import canonical
from lumitip_fab.pipeline.artefact import Made
from lumitip_fab.pipeline.fingerprint import PACKAGE, code_hash, tool_version


@dataclass(frozen=True)
class Step:
    """A generator: the function `name` of `lumitip_fab.<room>.<module>`."""

    room: str
    module: str
    name: str
    heavy: bool
    """Whether it takes long, and so runs in a worker: routing, and what imports the CAD kernel."""
    tools: tuple[str, ...]
    """Distributions whose version its output may depend on."""
    reads: tuple[str, ...] = ()
    """Patterns of files that other steps write: it runs after them, and is given those files as
    `made`."""


EACH = {
    "finger": "fingers",
    "carrier": "carriers",
    "regulated": "regulated",
    "holder": "holders",
    "flange": "flanges",
}
"""Arguments that a step takes one of at a time, and the field that has them all."""


@dataclass(frozen=True)
class Task:
    """One run of a step."""

    name: str
    step: Step
    arguments: dict[str, Any]

    @property
    def key(self) -> str:
        """Changes when the output may: arguments, code and tools."""
        plain = {name: value for name, value in self.arguments.items() if name != "made"}
        told = [self.step.name, canonical(plain), code_hash(self.step.room)]
        if self.step.reads:
            told.append(canonical(self.arguments["made"].sha256))
        told += [tool_version(tool) for tool in self.step.tools]
        return hashlib.sha256("\n".join(told).encode()).hexdigest()


def late_steps(steps: tuple[Step, ...]) -> tuple[Step, ...]:
    """The steps that read what others made, in their order: a later one may read an earlier's."""
    return tuple(step for step in steps if step.reads)


def late_task(step: Step, design: Design, made: Made) -> Task:
    """The run of a step that reads what others made."""
    names = (name for name in argument_names(step) if name != "made")
    shared = {name: getattr(design, name) for name in names}
    return Task(step.name, step, {"made": made.only(step.reads), **shared})


def tasks(steps: tuple[Step, ...], design: Design) -> Iterator[Task]:
    """Every run for a design of every step that needs nothing else."""
    for step in steps:
        if step.reads:
            continue
        names = argument_names(step)
        shared = {name: getattr(design, name) for name in names if name not in EACH}
        each = next((name for name in names if name in EACH), None)
        if each is None:
            yield Task(step.name, step, shared)
            continue
        for one in getattr(design, EACH[each]):
            yield Task(f"{step.name}.{one.name}", step, {each: one, **shared})


@lru_cache
def argument_names(step: Step) -> tuple[str, ...]:
    """Names of a generator's arguments, read from its source."""
    source = (PACKAGE / step.room / f"{step.module}.py").read_text(encoding="utf-8")
    for node in ast.parse(source).body:
        if isinstance(node, ast.FunctionDef) and node.name == step.name:
            return tuple(a.arg for a in (*node.args.args, *node.args.kwonlyargs))
    raise LookupError(f"lumitip_fab.{step.room}.{step.module} has no function {step.name}")

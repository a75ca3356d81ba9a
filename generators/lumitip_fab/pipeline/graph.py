"""Steps of a build, and their runs for a design."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from lumitip_fab.design import Design
from lumitip_fab.design.encoding import canonical
from lumitip_fab.pipeline.fingerprint import code_hash, tool_version


@dataclass(frozen=True)
class Step:
    """A generator: a function of the design that returns files with their facts.

    It is called with the design; then with one of `each`, where that is set; then with the files
    of earlier steps, where it is `late`.
    """

    name: str
    function: str
    """Its place below `lumitip_fab`, such as `"parts.backing.backing"`."""
    each: str = ""
    """The field of `Design` that the step runs once for each item of."""
    late: bool = False
    """Whether it uses files of other steps: it runs after those that stand before it."""
    heavy: bool = False
    """Whether it takes long, and so runs in a worker: routing, and what imports the CAD kernel."""
    tools: tuple[str, ...] = ()
    """Distributions whose version its output may depend on."""

    @property
    def module(self) -> str:
        """Name of the module that has the function."""
        return f"lumitip_fab.{self.function.rpartition('.')[0]}"

    @property
    def room(self) -> str:
        """Folder of the package with all its code."""
        return self.function.partition(".")[0]


@dataclass(frozen=True)
class Task:
    """One run of a step."""

    name: str
    step: Step
    design: Design
    item: tuple[Any, ...] = ()
    """The one of `each` that it is for; empty if it runs once."""

    def fixed(self) -> tuple[str, ...]:
        """Fixed dependencies: its item, its code and its tools."""
        tools = (tool_version(tool) for tool in self.step.tools)
        return (self.step.name, canonical(self.item), code_hash(self.step.room), *tools)


def tasks(steps: tuple[Step, ...], design: Design) -> Iterator[Task]:
    """Every run of some steps for a design."""
    for step in steps:
        if not step.each:
            yield Task(step.name, step, design)
            continue
        for item in getattr(design, step.each):
            yield Task(f"{step.name}.{item.name}", step, design, (item,))

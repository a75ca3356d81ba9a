"""What is built from what: the steps, and the key that tells whether one must run again.

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
    """A generator: the function `name` of `lumitip_fab.<folder>.<module>`."""

    folder: str
    module: str
    name: str
    heavy: bool
    """Whether it takes long, and so runs in a worker: routing, and what imports the CAD kernel."""
    tools: tuple[str, ...]
    """Distributions whose version its output may depend on."""
    reads: tuple[str, ...] = ()
    """Patterns of files that other steps write: it runs after them, and is given those files as
    `made`."""


_CAD = (
    "build123d", "cadquery-ocp", "cadquery-ocp-novtk", "lib3mf", "numpy", "shapely", "trimesh",
)  # fmt: skip
_INK = ("matplotlib", "reportlab", "ezdxf", "numpy", "shapely")
_COPPER = (
    "gerbonara", "kicad-skip", "matplotlib", "networkx", "numba", "numpy", "scipy", "sexpdata",
    "shapely",
)  # fmt: skip
_DRAWN = ("numpy", "shapely", "trimesh")
_STACKED = ("assembly/assembly.glb", "flange/*.stl", "holder/*.stl")
_LISTED = (
    "backing/*.stl", "interface/*.stl", "mould/*.stl", "holder/*.stl", "flange/*.stl",
    "fit/*.stl", "mould/*_casting.md", "boards/*/order/generic_*_bom.csv",
)  # fmt: skip
_SHOWN = (
    "assembly/*.svg", "bom.csv", "boards/*/*_front.png", "boards/*/*_back.png",
    "mask/*_mask.svg", "mask/*_wrapping.md", "mould/*_casting.md", "print/printing.md", "wiring/*",
)  # fmt: skip
_SET = ("lxml", "markdown-it-py", "matplotlib", "pillow", "reportlab", "svglib")
STEPS = (
    Step("mask", "files", "mask_files", False, _INK),
    Step("printing", "settings", "print_settings", False, ()),
    Step("wiring", "files", "wiring_files", False, ()),
    Step("firmware", "files", "firmware_files", False, ("numpy",)),
    Step("boards", "files", "board_files", True, _COPPER),
    Step("boards", "carrier", "carrier_files", True, _COPPER),
    Step("boards", "spice", "simulation", False, ()),
    Step("boards", "spice_supply", "supply_simulation", False, ()),
    Step("mechanical", "assembly", "assembly", True, _CAD),
    Step("mechanical", "robot", "robot_files", True, _CAD),
    Step("mechanical", "mould", "mould_files", True, _CAD),
    Step("mechanical", "backing", "backing", True, _CAD),
    Step("mechanical", "holder", "holder_files", True, _CAD),
    Step("mechanical", "flange", "flange_files", True, _CAD),
    Step("mechanical", "fit_plate", "fit_plate_files", True, _CAD),
    Step("mechanical", "system", "system_files", False, _DRAWN, _STACKED),
    Step("parts_list", "files", "bill_of_materials", False, ("numpy",), _LISTED),
    Step("manual", "files", "manual_files", False, _SET, _SHOWN),
)


EACH = {
    "finger": "fingers", "carrier": "carriers", "regulated": "regulated", "holder": "holders",
    "flange": "flanges",
}  # fmt: skip
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
        told = [self.step.name, canonical(plain), code_hash(self.step.folder)]
        if self.step.reads:
            told.append(canonical(self.arguments["made"].sha256))
        told += [tool_version(tool) for tool in self.step.tools]
        return hashlib.sha256("\n".join(told).encode()).hexdigest()


def late_steps() -> tuple[Step, ...]:
    """The steps that read what others made, in their order: a later one may read an earlier's."""
    return tuple(step for step in STEPS if step.reads)


def late_task(step: Step, design: Design, made: Made) -> Task:
    """The run of a step that reads what others made."""
    names = (name for name in argument_names(step) if name != "made")
    shared = {name: getattr(design, name) for name in names}
    return Task(step.name, step, {"made": made.only(step.reads), **shared})


def tasks(design: Design) -> Iterator[Task]:
    """Every run for a design of every step that needs nothing else."""
    for step in STEPS:
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
    source = (PACKAGE / step.folder / f"{step.module}.py").read_text(encoding="utf-8")
    for node in ast.parse(source).body:
        if isinstance(node, ast.FunctionDef) and node.name == step.name:
            return tuple(a.arg for a in (*node.args.args, *node.args.kwonlyargs))
    raise LookupError(f"lumitip_fab.{step.folder}.{step.module} has no function {step.name}")

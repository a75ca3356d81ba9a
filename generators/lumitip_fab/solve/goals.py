"""The goals file of a search: goals, limits, the base design and the parameters that may move."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, ValidationError, model_validator

from lumitip_fab.catalogue.record import Strict
from lumitip_fab.config.load import Input, load
from lumitip_fab.config.messages import brief, problems_of, shown_path, unknown_name
from lumitip_fab.config.source import Source, flat, read_toml
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.explore.run import without_price
from lumitip_fab.explore.vary import Axis, Changes, changed, not_allowed, without_effect
from lumitip_fab.solve.holes import FIELD, HOLE, grouped, joined
from lumitip_fab.solve.information import POSE_SD, Grasps
from lumitip_fab.solve.ranges import RANGE, as_numbers_of, values_of

KEEP_SIZE = "keep_size"
"""Spec of `grid.columns`: they follow the pitch, so that the grid keeps its size."""
COLUMNS = "grid.columns"
WITHOUT_LIGHT = ("emitter.led", "receiver.photodetector")
"""Parts whose light the twin does not know; what they do to the accuracy is unknown."""
_Millimetres = Annotated[float, Field(gt=0, lt=POSE_SD[0])]
_Degrees = Annotated[float, Field(gt=0, lt=POSE_SD[1])]
_Gaps = Annotated[tuple[Annotated[float, Field(ge=1, le=10)], ...], Field(min_length=1)]
_Cables = tuple[Annotated[float, Field(ge=0.5, le=20)], ...]


class Targets(Strict):
    """Errors to reach, rms over all grasps, and the grasps."""

    edge_mm: _Millimetres | None = None
    """Position of an edge (mm)."""
    edge_deg: _Degrees | None = None
    """Its angle (degrees)."""
    cable_mm: _Millimetres | None = None
    """Position of a cable (mm)."""
    cable_deg: _Degrees | None = None
    """Its angle (degrees)."""
    gaps_mm: _Gaps = (3.0,)
    """Gaps from skin to skin (mm)."""
    cables_mm: _Cables = (3.0,)
    """Diameters of cables (mm); a gap is gripped with those that are not thicker."""

    @property
    def errors(self) -> dict[str, float]:
        """The goals that are set, by figure."""
        every = {n: getattr(self, n) for n in ("edge_mm", "edge_deg", "cable_mm", "cable_deg")}
        return {name: value for name, value in every.items() if value is not None}

    @model_validator(mode="after")
    def _every_goal_can_be_tried(self) -> "Targets":
        if not self.errors:
            raise ValueError("is without an error; write at least edge_mm or cable_mm")
        for name, values in (("gaps_mm", self.gaps_mm), ("cables_mm", self.cables_mm)):
            if twice := [value for value in values if values.count(value) > 1]:
                raise ValueError(f"{name} has {twice[0]:g} mm twice; write it once")
        of_cables = [name for name in ("cable_mm", "cable_deg") if name in self.errors]
        if of_cables and not self.cables_mm:
            raise ValueError(
                f"{of_cables[0]} is set, but cables_mm is empty; add a diameter, or remove the goal"
            )
        thick = [d for d in self.cables_mm if d > max(self.gaps_mm)]
        if thick and of_cables:
            raise ValueError(
                f"cables_mm has {thick[0]:g} mm, which fits no gap of gaps_mm; add a gap or remove "
                "it"
            )
        return self


class Limits(Strict):
    """Limits of a design; without a limit there is none."""

    cost: float = Field(default=math.inf, gt=0, allow_inf_nan=True)
    """Price of parts and boards at most, in the currency of `parts/prices.toml`."""
    current_ma: float = Field(default=math.inf, gt=0, allow_inf_nan=True)
    """Current of all LED strings at most (mA)."""
    cells: float = Field(default=math.inf, ge=4, allow_inf_nan=True)
    """Cells at most."""
    width_mm: float = Field(default=0.0, ge=0)
    """Extent of the cell centres across the finger at least (mm)."""
    length_mm: float = Field(default=0.0, ge=0)
    """Extent of the cell centres along the finger at least (mm)."""


class GoalsFile(Strict):
    """The file as it is written."""

    base: str = Field(min_length=1)
    """Parameter file that is varied, beside the goals file or by its path from there."""
    goals: Targets
    limits: Limits = Limits()
    fixed: dict[str, dict[str, Any]] = Field(default_factory=dict)
    """Parameters that differ from the base in all designs."""
    vary: dict[str, dict[str, Any]]
    """Parameters that move: a list of values, a range, or `"keep_size"` of `grid.columns`."""

    @model_validator(mode="after")
    def _some_vary(self) -> "GoalsFile":
        if not any(self.vary.values()):
            raise ValueError(f"vary is empty; write at least one parameter as {RANGE} or a list")
        return self


@dataclass(frozen=True)
class Task:
    """A valid goals file with its base."""

    base: Input
    """With the fixed values."""
    written: Input
    """The base as its file has it, without the fixed values."""
    fixed: Changes
    targets: Targets
    limits: Limits
    axes: tuple[Axis, ...]
    keep_size: bool

    @property
    def grasps(self) -> Grasps:
        """Grasps that designs are judged by."""
        return Grasps(self.targets.gaps_mm, self.targets.cables_mm)

    @property
    def designs(self) -> int:
        """Number of all combinations."""
        return math.prod(len(axis.values) for axis in self.axes)

    def design(self, changes: Changes) -> Input:
        """The base with changed parameters."""
        return changed(self.base, self.joined(changes), self.keep_size)

    def joined(self, changes: Changes) -> Changes:
        """Changes by axis as changes of parameters."""
        return joined(changes, self.base.parameters.grid.columns)


def read_goals(path: Path) -> Task:
    """Read a goals file and its base.

    Raises:
        InputError: with every fault of the file, or those of the base.
    """
    source = read_toml(path, shown_path(path))
    try:
        file = GoalsFile.model_validate(_tuples(source.table))
    except ValidationError as error:
        raise InputError(problems_of(error, GoalsFile, lambda _: source)) from error
    base = load(path.parent / file.base)
    fixed, faults = _fixed(source, base, file.fixed)
    task_base = base if faults else changed(base, fixed)
    axes, more = _axes(source, task_base, file.vary)
    varied = {
        field
        for field, _ in joined(
            tuple((a.field, a.values[0]) for a in axes), task_base.parameters.grid.columns
        )
    }
    both = {field for field, _ in fixed} & varied
    faults += more + [
        _fault(source, f"vary.{field}", "is in [fixed] too; keep one of them") for field in both
    ]
    if faults:
        raise InputError(faults)
    if unpriced := without_price(task_base, axes):
        raise InputError(unpriced)
    keep_size = file.vary.get("grid", {}).get("columns") == KEEP_SIZE
    return Task(task_base, base, fixed, file.goals, file.limits, axes, keep_size)


def _tuples(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _tuples(one) for key, one in value.items()}
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def _fault(source: Source, field: str, message: str) -> Problem:
    return Problem(shown_path(source.path), source.line(field), field, message)


def _fields(
    source: Source, base: Input, name: str, table: Mapping[str, Mapping[str, Any]]
) -> tuple[dict[str, Any], list[Problem]]:
    """Values of a table by field, and a fault for each field that does not exist."""
    written = {
        f"{section}.{key}": of for section, keys in table.items() for key, of in keys.items()
    }
    known = {".".join(field.split(".")[:2]) for field, _ in flat(base.parameters.model_dump())}
    faults = [
        _fault(source, f"{name}.{field}", unknown_name(field, known, "a parameter file"))
        for field in written.keys() - known
    ]
    return {field: of for field, of in written.items() if field in known}, faults


def _fixed(
    source: Source, base: Input, table: Mapping[str, Mapping[str, Any]]
) -> tuple[Changes, list[Problem]]:
    written, faults = _fields(source, base, "fixed", table)
    for field, value in written.items():
        faults += _placed(source, f"fixed.{field}", not_allowed(base, Axis(field, (value,))))
    return tuple(written.items()), faults


def _axes(
    source: Source, base: Input, table: Mapping[str, Mapping[str, Any]]
) -> tuple[tuple[Axis, ...], list[Problem]]:
    written, faults = _fields(source, base, "vary", table)
    axes = []
    for field, spec in written.items():
        name = f"vary.{field}"
        if field in WITHOUT_LIGHT:
            text = (
                "is not allowed to vary: the twin does not know how much light other parts give. "
                "Write it in [fixed]."
            )
            faults.append(_fault(source, name, text))
        elif field == COLUMNS and spec == KEEP_SIZE:
            if "grid.pitch_mm" not in written:
                text = (
                    f'is "{KEEP_SIZE}", but grid.pitch_mm does not vary. Vary it, or remove this.'
                )
                faults.append(_fault(source, name, text))
        elif field == FIELD and isinstance(spec, dict):
            more, problems = grouped(base, spec, written.keys() & {COLUMNS, HOLE})
            axes += more
            faults += _placed(source, name, problems)
        elif isinstance(values := values_of(spec), str):
            faults.append(_fault(source, name, values))
        else:
            axis = Axis(field, as_numbers_of(base, field, values))
            found = not_allowed(base, axis) + without_effect(base, field)
            if len(axis.values) == 1:
                text = f"has one value, {brief(axis.values[0])}; add another, or move it to [fixed]"
                found.append(Problem("", 0, field, text))
            faults += _placed(source, name, found)
            axes.append(axis)
    return tuple(axes), faults


def _placed(source: Source, name: str, problems: list[Problem]) -> Iterator[Problem]:
    for problem in problems:
        yield replace(problem, file=shown_path(source.path), line=source.line(name), field=name)

"""Search for the smallest changes that mend every broken rule."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from annotated_types import Ge, Gt, Le, Lt
from pydantic import ValidationError

from lumitip_fab.config.automatic import FIELDS
from lumitip_fab.config.load import Input
from lumitip_fab.config.parameters import Parameters
from lumitip_fab.derive.faults import Faults
from lumitip_fab.derive.once import derive_once
from lumitip_fab.design import Design
from lumitip_fab.errors import InputError, Problem

_NUMBER = re.compile(r"-?\d+(\.\d+)?(e-?\d+)?")

Rule = tuple[str, str]
"""A field and the message of its rule without numbers: the same at other values."""


@dataclass(frozen=True)
class Verdict:
    """What derivation says of an input."""

    config: Input
    design: Design | None
    stage: int
    """How far derivation went; later rules are only reached without faults before them."""
    problems: tuple[Problem, ...]

    @property
    def rules(self) -> dict[Rule, Problem]:
        """Every rule that is broken."""
        return {rule_of(problem): problem for problem in self.problems}

    def mends(self, rule: Rule, before: "Verdict") -> bool:
        """Whether a rule holds that was broken before, and no other one is broken instead."""
        mine = set(self.rules)
        further = self.stage > before.stage
        return rule not in mine and (
            further or (self.stage == before.stage and mine <= set(before.rules))
        )


def rule_of(problem: Problem) -> Rule:
    """The rule that a problem is about."""
    return problem.field, _NUMBER.sub("#", problem.message)


def judge(config: Input) -> Verdict:
    """Derive, and keep what is wrong."""
    faults = Faults(config)
    try:
        design = derive_once(config, faults)
    except InputError as error:
        return Verdict(config, None, faults.stage, error.problems)
    return Verdict(config, design, faults.stage, ())


def judge_with(config: Input, values: dict[str, Any]) -> Verdict | None:
    """Judge other values of some fields; none where a field does not allow its value."""
    try:
        return judge(config.with_values(values))
    except ValidationError:
        return None


DECIMALS = 4


@dataclass(frozen=True)
class Change:
    """Another value of a field, and what derivation then says."""

    field: str
    value: Any
    verdict: Verdict


def smallest_number(before: Verdict, rule: Rule, field: str, step: float) -> Change | None:
    """The number nearest to a field's value, on multiples of a step from it, that mends a rule."""
    found = [
        change
        for sign in (1, -1)
        if (change := _along(before, rule, field, sign * step)) is not None
    ]
    start = before.config.value(field)
    return min(found, key=lambda change: abs(change.value - start), default=None)


def first_of(before: Verdict, rule: Rule, field: str, values: Iterator[Any]) -> Change | None:
    """The first of some values that mends a rule."""
    for value in values:
        verdict = judge_with(before.config, {field: value})
        if verdict and verdict.mends(rule, before):
            return Change(field, value, verdict)
    return None


def _along(before: Verdict, rule: Rule, field: str, step: float) -> Change | None:
    start, whole = before.config.value(field), isinstance(before.config.value(field), int)
    low, high = bounds(field)

    def tried(steps: int) -> Change | None:
        value = start + steps * step if whole else round(start + steps * step, DECIMALS)
        verdict = judge_with(before.config, {field: value})
        mended = verdict is not None and verdict.mends(rule, before)
        return Change(field, value, verdict) if mended and verdict else None

    steps, failed = 1, 0
    while low <= start + steps * step <= high:
        change = tried(steps)
        if change:
            return _bisected(change, failed, steps, tried)
        steps, failed = 2 * steps, steps
    return None


def _bisected(change: Change, failed: int, worked: int, tried: Any) -> Change:
    while worked - failed > 1:
        middle = (failed + worked) // 2
        better = tried(middle)
        if better:
            change, worked = better, middle
        else:
            failed = middle
    return change


def bounds(field: str) -> tuple[float, float]:
    """Least and greatest value that a numeric field allows."""
    section, key = field.split(".")
    table = Parameters.model_fields[section].annotation
    metadata = table.model_fields[key].metadata  # type: ignore[union-attr]
    low = max(
        (
            float(m.ge if isinstance(m, Ge) else m.gt)  # type: ignore[arg-type]
            for m in metadata
            if isinstance(m, Ge | Gt)
        ),
        default=float("-inf"),
    )
    high = min(
        (
            float(m.le if isinstance(m, Le) else m.lt)  # type: ignore[arg-type]
            for m in metadata
            if isinstance(m, Le | Lt)
        ),
        default=float("inf"),
    )
    return low, high


def catalogue_names(before: Verdict, kind: str, field: str) -> Iterator[str]:
    """Other entries of a catalogue file."""
    entries: Mapping[str, Any] = getattr(before.config.catalogue, kind)
    yield from (name for name in entries if name != before.config.value(field))


_ROOM = ("board.channel_mm", "board.side_margin_mm")
_FINGER = (
    "outline.waist_margin_mm",
    "outline.end_margin_mm",
    "board.channel_mm",
    "board.tip_margin_mm",
    "outline.tip_margin_mm",
    "tip.slant_start_mm",
)
_CURRENT = ("emitter.current_ma", "emitter.string_leds", "emitter.resistor")

MENDS: dict[str, tuple[str, ...]] = {
    "grid.columns": ("receiver.multiplexer",),
    "stack.silicone_mm": ("emitter.resistor_side",),
    "stack.floor_mm": ("backing.tail_mm",),
    "outline.tip_fraction": ("outline.shoulder_margin_mm",),
    "outline.waist_margin_mm": (
        "outline.shoulder_margin_mm",
        "outline.end_corner_mm",
        "outline.shoulder_at_mm",
        "outline.tip_margin_mm",
    ),
    "outline.waist_at": ("outline.end_corner_mm", "outline.shoulder_at_mm"),
    "outline.shoulder_margin_mm": ("outline.waist_margin_mm",),
    "backing.tail_mm": ("stack.floor_mm",),
    "tip.slant_start_mm": ("outline.tip_margin_mm",),
    "coupling.gripper": (*_FINGER, "mould.taper_length_mm"),
    "board.side_margin_mm": (),
    "board.tip_margin_mm": ("board.hole_edge_mm", "board.hole_mm"),
    "board.hole_mm": ("board.tip_margin_mm", "board.side_margin_mm"),
    "board.end_margin_mm": ("board.hole_mm",),
    "board.channel_mm": ("board.hole_mm",),
    "board.copper_gap_mm": ("receiver.multiplexer",),
    "board.supply_track_mm": (),
    "emitter.led": ("board.clearance_mm", "emitter.current_ma"),
    "emitter.current_ma": _CURRENT,
    "emitter.max_heat_w": _CURRENT,
    "emitter.resistor": (
        "emitter.resistor_side",
        "board.channel_mm",
        *_CURRENT,
        "board.side_margin_mm",
        "backing.relief_clearance_mm",
    ),
    "supply.max_ma": _CURRENT,
    "supply.voltage_v": ("emitter.string_leds", "flange.gate_ohm"),
    "receiver.photodetector": ("board.clearance_mm",),
    "receiver.resistor": ("receiver.capacitor", "board.clearance_mm"),
    "receiver.multiplexer": _ROOM,
    "mask.hole_mm": ("board.channel_mm",),
    "mask.flap_mm": ("mask.allowance_mm",),
    "mould.draft_deg": ("mould.tip_silicone_mm",),
    "mould.wall_mm": (),
    "mould.taper_length_mm": ("outline.tip_margin_mm",),
    "mould.tip_silicone_mm": (),
    "flex.standoff_mm": ("flex.groove_depth_mm",),
    "flex.interface_mm": (
        "flex.standoff_mm",
        "board.channel_mm",
        "tip.slant_start_mm",
        "outline.end_margin_mm",
        "board.tip_margin_mm",
        "outline.tip_margin_mm",
    ),
    "flex.thread_hole_mm": ("board.hole_edge_mm", "board.end_margin_mm", "board.side_margin_mm"),
    "breakout.board_mm": ("breakout.hole_spacing_mm",),
    "breakout.hole_mm": ("breakout.hole_spacing_mm",),
    "breakout.hole_spacing_mm": ("breakout.hole_mm",),
    "holder.body_mm": ("holder.wall_mm",),
    "holder.wrap_deg": ("holder.wall_mm", "holder.strap_hole_mm"),
    "holder.standoff_mm": ("breakout.hole_spacing_mm",),
    "holder.screw": ("breakout.hole_spacing_mm", "holder.wall_mm"),
    "holder.strap_hole_mm": ("holder.wrap_deg",),
    "holder.strap_spacing_mm": ("holder.strap_hole_mm",),
    "printer.profile": (),
    "flange.fuse": ("emitter.current_ma",),
    "flange.gate_ohm": (),
}


def menders(field: str) -> tuple[str, ...]:
    """Fields to try for a rule about a field, in order, each once."""
    return tuple(dict.fromkeys((field, *MENDS.get(field, ()))))


MOST_CHANGES = 40

Moved = Callable[[Change, str], None]
"""Called with a change that was made and the message of the rule that it mended."""


def search(start: Verdict, free: frozenset[str], moved: Moved) -> Verdict:
    """Change automatic fields until every rule holds, or no change of one of them mends another.

    Args:
        start: where to begin.
        free: fields that may change.
        moved: told of each change.
    """
    now = start
    for _ in range(MOST_CHANGES):
        found = _next(now, free)
        if found is None:
            return now
        change, message = found
        moved(change, message)
        now = change.verdict
    return now


def _next(now: Verdict, free: frozenset[str]) -> tuple[Change, str] | None:
    for rule, problem in now.rules.items():
        for field in menders(problem.field):
            if field in free:
                change = change_of(now, rule, field)
                if change:
                    return change, problem.message
    return None


def change_of(now: Verdict, rule: Rule, field: str) -> Change | None:
    """The smallest change of an automatic field that mends a rule; none where none does."""
    automatic = FIELDS[field]
    if automatic.names:
        return first_of(now, rule, field, catalogue_names(now, automatic.names, field))
    if field == "emitter.resistor_side":
        return first_of(now, rule, field, iter(_others(("back", "front"), now, field)))
    if automatic.step:
        return smallest_number(now, rule, field, automatic.step)
    return None


def _others(values: Iterable[str], now: Verdict, field: str) -> list[str]:
    return [value for value in values if value != now.config.value(field)]

"""Automatic values of a parameter file, and the design that follows."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from lumitip_fab.config.automatic import Value, automatic_fields
from lumitip_fab.config.load import Input
from lumitip_fab.config.messages import brief
from lumitip_fab.derive.auto.judge import Verdict, judge
from lumitip_fab.derive.auto.search import Change, search
from lumitip_fab.derive.auto.starts import proposals
from lumitip_fab.derive.finger.tip import EDGE, START, wedge
from lumitip_fab.derive.finger.tip_slots import LIP
from lumitip_fab.design import Choice, Design
from lumitip_fab.errors import InputError

THINNER_LIPS_MM = (0.3, 0.2, 0.0)
"""Tried in turn. A table that leans by 0.2° takes 0.2 mm of a lip."""


@dataclass(frozen=True)
class Resolved:
    """A parameter file with a value in every field, and its design."""

    config: Input
    """With no field left to choose."""
    design: Design


class RuleError(InputError):
    """Rules that no automatic value mends; `verdict` is where the search ended."""

    def __init__(self, verdict: Verdict) -> None:
        self.verdict = verdict
        super().__init__(verdict.problems)


@dataclass
class _Reasons:
    """Why each automatic field has its value."""

    of: dict[str, str] = field(default_factory=dict)

    def propose(self, name: str, reason: str) -> None:
        self.of[name] = reason

    def moved(self, change: Change, message: str) -> None:
        text = message.partition(". Override it in")[0].removesuffix(".")
        self.of |= {change.field: f"otherwise {text}", **change.also}

    def choices(self, config: Input) -> tuple[Choice, ...]:
        """Every automatic field in the order of the file, with its value and reason."""
        return tuple(
            Choice(
                name,
                brief(config.value(name)),
                self.of.get(name, f"default; follows {automatic.follows}"),
            )
            for name, automatic in automatic_fields().items()
            if name in config.automatic
        )


def resolve(config: Input) -> Resolved:
    """Choose every automatic value, and derive.

    Raises:
        RuleError: if rules are broken that no automatic value mends.
    """
    reasons = _Reasons()
    started = _started(config, reasons)
    end = search(judge(started), config.automatic, reasons.moved)
    if end.design is not None:
        end = _thinner_lip(_settled(end, reasons), reasons)
    if end.design is None:
        raise RuleError(end)
    choices = reasons.choices(end.config)
    config = replace(end.config, automatic=frozenset())
    return Resolved(config, replace(end.design, choices=choices))


def _settled(end: Verdict, reasons: _Reasons) -> Verdict:
    """The same design, with start and edge of its wedge where a written angle moved them."""
    sizes = dict(zip((START, EDGE), wedge(end.config), strict=True))
    moved = {name: size for name, size in sizes.items() if end.config.value(name) != size}
    if not moved:
        return end
    for name in moved:
        reasons.propose(name, f"follows tip.angle_deg = {end.config.parameters.tip.angle_deg:g}")
    return judge(end.config.with_values(moved))


def _thinner_lip(end: Verdict, reasons: _Reasons) -> Verdict:
    """The same design, with a thinner automatic lip, or none, where there is no room for it."""
    for lip_mm in THINNER_LIPS_MM:
        if LIP not in end.config.automatic or end.design is None or end.design.tip.slots:
            return end
        reasons.of.setdefault(LIP, "otherwise it " + _refusal_of_lip(end).partition("; 0 or")[0])
        end = judge(end.config.with_values({LIP: lip_mm}))
    return end


def _refusal_of_lip(end: Verdict) -> str:
    """The words in which an automatic lip without room would be refused if it were written."""
    written = judge(replace(end.config, automatic=end.config.automatic - {LIP}))
    return next(problem.message for problem in written.problems if problem.field == LIP)


def accepted_with(config: Input, values: Mapping[str, Any]) -> bool:
    """Whether the file would be accepted with other values of some fields: every automatic value
    is then chosen anew.

    Args:
        config: the file's values, the automatic ones as some search left them.
        values: of fields, as they would be written.
    """
    free = config.automatic - values.keys()
    begun = {field: automatic_fields()[field].start for field in free}
    try:
        resolve(replace(config, automatic=free).with_values({**begun, **values}))
    except InputError:
        return False
    return True


def _started(config: Input, reasons: _Reasons) -> Input:
    """The input with every computed start in place."""
    for formula in proposals():
        values: dict[str, Value] = {}
        for name, value, reason in formula(config):
            if name in config.automatic:
                values[name] = value
                reasons.propose(name, reason)
        config = config.with_values(values)
    return config

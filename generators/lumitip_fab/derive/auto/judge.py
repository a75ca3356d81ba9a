"""How good a set of values is: how far derivation goes with it, and which rules it breaks."""

import re
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from lumitip_fab.config.load import Input
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

"""Verdict on a set of values: stages of derivation without faults, and broken rules."""

import re
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.once import derive_once
from lumitip_fab.design import Design
from lumitip_fab.errors import InputError, Problem

_NUMBER = re.compile(r"-?\d+(\.\d+)?(e-?\d+)?")
Rule = tuple[str, str]
"""A field and the message of its rule without numbers: the same at other values."""


@dataclass(frozen=True)
class Verdict:
    """Result of derivation for an input."""

    config: Input
    design: Design | None
    stage: int
    """Number of stages without faults; a later rule is only tested after these."""
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
    faults = Diagnostics(config)
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

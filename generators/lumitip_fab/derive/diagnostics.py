"""Collector of the faults of a parameter file, so that all are reported at once."""

from lumitip_fab.config.load import Input
from lumitip_fab.errors import InputError, Problem
from lumitip_fab.text import table_of


class Diagnostics:
    """The faults found so far in one parameter file."""

    def __init__(self, config: Input) -> None:
        self._config = config
        self._found: list[Problem] = []
        self.stage = 0
        """Number of stages of derivation that had no faults."""

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The faults noted so far."""
        return tuple(self._found)

    def refuse(self, field: str, message: str) -> None:
        """Note a fault of a field.

        Args:
            field: its name, such as `"grid.pitch_mm"`.
            message: continues the name: "is 1; at least 1.5 is needed".
        """
        self._found.append(self._config.problem(field, message))

    def add(self, rule: str, field: str = "", **values: object) -> None:
        """Note a fault with the sentence of a rule.

        Args:
            rule: its name in `rules.toml`.
            field: that it is about, where the rule is about several.
            values: in the braces of its sentence.
        """
        texts = table_of("derive/rules.toml")[rule]
        message = texts["text"].format(p=self._config.parameters, **values)
        self.refuse(field or texts["field"], message)

    def unless(self, holds: bool, rule: str, field: str = "", **values: object) -> None:
        """Note a fault with the sentence of a rule unless a condition holds."""
        if not holds:
            self.add(rule, field, **values)

    def refuse_unless(self, holds: bool, field: str, message: str) -> None:
        """Note a fault unless a condition holds."""
        if not holds:
            self.refuse(field, message)

    def stop(self) -> None:
        """Raise `InputError` with all faults noted so far, if there are any."""
        if self._found:
            raise InputError(self._found)
        self.stage += 1

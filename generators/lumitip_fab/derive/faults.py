"""Collects everything that is impossible together, so that all of it is reported at once."""

from lumitip_fab.config.load import Input
from lumitip_fab.errors import InputError, Problem


class Faults:
    """The faults found so far in one parameter file."""

    def __init__(self, config: Input) -> None:
        self._given = config
        self._found: list[Problem] = []
        self.stage = 0
        """How many times derivation could go on: later rules are only reached without faults."""

    def refuse(self, field: str, message: str) -> None:
        """Note a fault of a field; `message` has what was given and what is allowed."""
        self._found.append(self._given.problem(field, message))

    def refuse_unless(self, holds: bool, field: str, message: str) -> None:
        """Note a fault unless a condition holds."""
        if not holds:
            self.refuse(field, message)

    def stop(self) -> None:
        """Raise `InputError` with all faults noted so far, if there are any."""
        if self._found:
            raise InputError(self._found)
        self.stage += 1

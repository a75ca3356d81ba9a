"""Parameters to `Design`: automatic values are chosen, then each quantity is derived once."""

from lumitip_fab.config.load import Input
from lumitip_fab.derive.auto.resolve import Resolved, resolve
from lumitip_fab.design import Design


def derive(given: Input) -> Design:
    """Derive the whole sensor.

    Raises:
        InputError: with every combination of values that is impossible, and the smallest changes
            that work.
    """
    return resolve(given).design


__all__ = ["Resolved", "derive", "resolve"]

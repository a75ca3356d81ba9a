"""Parameters to `Design`: automatic values are chosen, then each quantity is derived once."""

from lumitip_fab.config.load import Input
from lumitip_fab.derive.auto.resolve import Resolved, resolve
from lumitip_fab.design import Design


def derive(config: Input) -> Design:
    """Derive the whole sensor.

    Raises:
        InputError: with every combination of values that is impossible, and the smallest changes
            that work.
    """
    return resolve(config).design


__all__ = ["Resolved", "derive", "resolve"]

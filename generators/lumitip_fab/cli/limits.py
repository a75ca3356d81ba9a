"""Ranges of the numbers in options."""

import argparse
from collections.abc import Mapping

from lumitip_fab.errors import InputError, Problem

SEEDS = (0, 2**32 - 1)


def require_in_range(
    options: argparse.Namespace, limits: Mapping[str, tuple[float, float]]
) -> None:
    """Refuse numbers that are out of range.

    Args:
        options: of the command.
        limits: least and largest value by name of the option.

    Raises:
        InputError: with every option that is out of its range.
    """
    faults = [
        Problem(f"--{name}", 0, "", f"is {value}; {least} to {most} is allowed")
        for name, (least, most) in limits.items()
        if not least <= (value := getattr(options, name)) <= most
    ]
    if faults:
        raise InputError(faults)

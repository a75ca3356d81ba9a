"""Programs beside Python's own that tests run. Without one its tests are skipped with what to do;
`LUMITIP_REQUIRE=all` makes that a failure (see `conftest.py`)."""

import shutil

import pytest

_PACKAGES = {
    "kicad-cli": "kicad (version 9)",
    "arm-none-eabi-g++": "gcc-arm-none-eabi",
    "xtensa-lx106-elf-g++": "gcc-xtensa-lx106 and picolibc-xtensa-lx106-elf",
}
"""Debian's packages, where they are not called like the program."""


def program(name: str) -> str:
    """The path of a program; skips the test that asks without it."""
    found = shutil.which(name)
    if found is None:
        pytest.skip(_missing(name))
    return found


def needs(name: str) -> pytest.MarkDecorator:
    """Marks a test that is skipped without a program."""
    return pytest.mark.skipif(shutil.which(name) is None, reason=_missing(name))


def _missing(name: str) -> str:
    return f"{name} is missing: install Debian's {_PACKAGES.get(name, name)}"

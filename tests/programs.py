"""Programs beside Python's own that tests run. Without one its tests are skipped with what to do;
`LUMITIP_REQUIRE=all` makes that a failure (see `conftest.py`)."""

import shutil
import subprocess
from functools import cache

import pytest

WITH_3D = [
    "--no-sandbox",
    "--use-gl=swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-gpu-watchdog",
]
"""Options of Chromium for pages with 3D views: drawn by the processor, which may take its time."""

_PACKAGES = {
    "kicad-cli": "kicad (version 9)",
    "pdftoppm": "poppler-utils",
    "arm-none-eabi-g++": "gcc-arm-none-eabi",
    "xtensa-lx106-elf-g++": "gcc-xtensa-lx106",
}
"""Debian's packages, where they are not called like the program."""
_HEADERS = {
    "g++": ("cstdint", (), "g++"),
    "arm-none-eabi-g++": (
        "cstdint",
        (),
        "libnewlib-arm-none-eabi and libstdc++-arm-none-eabi-newlib",
    ),
    "xtensa-lx106-elf-g++": (
        "string.h",
        ("-isystem", "/usr/lib/xtensa-lx106-elf/include"),
        "picolibc-xtensa-lx106-elf",
    ),
}
"""A header that each compiler finds with its library, options for that, and Debian's package."""


def program(name: str) -> str:
    """The path of a program; skips the test that asks without it, or without its library."""
    found = shutil.which(name)
    if found is None:
        pytest.skip(_missing(name))
    if lacking := _lacking(name, found):
        pytest.skip(lacking)
    return found


def needs(name: str) -> pytest.MarkDecorator:
    """Marks a test that is skipped without a program."""
    return pytest.mark.skipif(shutil.which(name) is None, reason=_missing(name))


@cache
def _lacking(name: str, path: str) -> str:
    """The library that a compiler at a path lacks, and its package; empty if it has it."""
    if name not in _HEADERS:
        return ""
    header, options, package = _HEADERS[name]
    command = [path, *options, "-x", "c++", "-fsyntax-only", "-"]
    code = f"#include <{header}>\n"
    done = subprocess.run(command, input=code, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return ""
    return f"{name} has no library, <{header}> is missing: install Debian's {package}"


def _missing(name: str) -> str:
    return f"{name} is missing: install Debian's {_PACKAGES.get(name, name)}"

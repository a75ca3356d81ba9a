"""System libraries that the wheels of the extra `fab` are linked against, and their packages.

It imports the standard library alone, because it runs before anything is installed.
"""

import ctypes
import sys
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class SystemLibrary:
    """A shared library, and the package that has it on each distribution."""

    soname: str
    debian: str
    fedora: str
    arch: str


LIBRARIES = (
    # Nothing is drawn on a screen: the CAD kernel's viewer is linked into its only module.
    SystemLibrary("libGL.so.1", "libgl1", "libglvnd-glx", "libglvnd"),
    SystemLibrary("libX11.so.6", "libx11-6", "libX11", "libx11"),
    SystemLibrary("libexpat.so.1", "libexpat1", "expat", "expat"),
    SystemLibrary("libstdc++.so.6", "libstdc++6", "libstdc++", "gcc-libs"),
)
"""Libraries of `cadquery-ocp-novtk` beyond libc and libgcc, from its files' NEEDED entries."""


def missing_libraries() -> tuple[SystemLibrary, ...]:
    """The libraries that the dynamic linker does not find; none on other systems than Linux,
    whose wheels use what the system has."""
    if sys.platform != "linux":
        return ()
    return tuple(library for library in LIBRARIES if not _loads(library.soname))


def libraries_message(libraries: Iterable[SystemLibrary]) -> str:
    """An error message: the missing libraries, and one line for each distribution."""
    missing = tuple(libraries)
    names = " and ".join(library.soname for library in missing)
    verb = "is" if len(missing) == 1 else "are"
    debian, fedora, arch = (
        " ".join(getattr(library, name) for library in missing)
        for name in ("debian", "fedora", "arch")
    )
    return (
        f"{names} {verb} missing, which the CAD kernel needs. Install as root, then run this "
        "again:\n"
        f"  Debian, Ubuntu:  apt-get install {debian}\n"
        f"  Fedora:          dnf install {fedora}\n"
        f"  Arch:            pacman -S --needed {arch}"
    )


def _loads(soname: str) -> bool:
    try:
        ctypes.CDLL(soname)
    except OSError:
        return False
    return True

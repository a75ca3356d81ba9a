"""The rooms of both packages: which may import which, and that no import closes a circle.

`docs/architecture.md` shows the same rooms. `ALLOWED` is the order that holds: a new arrow is
added here and there, or not at all.
"""

import ast
import subprocess
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDERS = {
    "lumitip_fab": ROOT / "generators" / "lumitip_fab",
    "lumitip": ROOT / "readout" / "lumitip",
}
GROUND = "errors paths text typeface system_libraries"
"""Files at the root of `lumitip_fab` that belong to no room: every room may import them."""
ALLOWED = {
    "catalogue": "",
    "config": "catalogue",
    "design": "catalogue",
    "derive": "catalogue config design",
    "pipeline": "design",
    "boards": "design pipeline",
    "mask": "design pipeline",
    "firmware": "design pipeline",
    "parts": "design mask pipeline",
    "models": "design pipeline parts",
    "scenes": "design pipeline parts",
    "docs": "design pipeline",
    "checks.readers": "design",
    "checks": "checks.readers config derive design pipeline",
    "explore": "boards catalogue checks config derive design pipeline",
    "solve": "catalogue config derive design explore pipeline",
    "tolerance": "catalogue config derive design pipeline",
    "diff": "checks checks.readers config design docs parts pipeline scenes",
    "site": "checks checks.readers design pipeline",
    "grippers": "catalogue config derive design docs parts scenes",
    "cli": (
        "boards catalogue checks checks.readers config derive design diff docs explore grippers "
        "parts pipeline site solve tolerance"
    ),
    "__init__": "checks cli config derive design parts pipeline",
    "__main__": "cli",
}
"""The rooms of `lumitip_fab`, and the rooms that each may import."""
ALLOWED_READOUT = {
    "core": "",
    "protocol": "core",
    "processing": "core",
    "twin": "core protocol",
    "estimation": "core processing twin",
    "control": "core estimation processing",
    "recording": "core protocol",
    "links": "core protocol recording twin",
    "session": "core links protocol",
    "sharing": "core links protocol session",
    "health": "core",
    "acceptance": "core estimation health twin",
    "face": "core health links session",
    "robots": "core control",
    "foxglove": "core estimation processing recording twin view",
    "mujoco": "core twin",
    "view": "core estimation face links processing recording session twin",
    "tasks": "control core estimation face links processing protocol session twin view",
    "commands": (
        "acceptance core face foxglove health links processing recording session sharing tasks "
        "twin view"
    ),
}
"""The rooms of `lumitip`: `core` is its root, `face` what opens fingertips."""
FACE = {"__init__", "__main__", "async_fingertip", "cli", "fingertip", "group", "options"}


def modules(package: str) -> dict[str, Path]:
    """The files of a package by their dotted name."""
    folder = FOLDERS[package]
    found = {}
    for file in sorted(folder.rglob("*.py")):
        parts = file.relative_to(folder.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = file
    return found


def imports(name: str, file: Path, known: dict[str, Path]) -> Iterator[str]:
    """The modules that a file imports, wherever in it."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name}: a relative import hides its room"
            base = str(node.module)
            for alias in node.names:
                inner = f"{base}.{alias.name}"
                yield inner if inner in known else base


def arrows(package: str) -> dict[str, set[str]]:
    """Each module of a package with those of the same package that it imports."""
    known = modules(package)
    return {
        name: {found for found in imports(name, file, known) if found in known} - {name}
        for name, file in known.items()
    }


def room(name: str) -> str:
    """The room of a module of `lumitip_fab`."""
    _, *inner = name.split(".")
    if not inner:
        return "__init__"
    return "checks.readers" if inner[:2] == ["checks", "readers"] else inner[0]


def room_of_readout(name: str) -> str:
    """The room of a module of `lumitip`."""
    _, *inner = name.split(".")
    first = inner[0] if inner else "__init__"
    if (FOLDERS["lumitip"] / first).is_dir():
        return first
    return "face" if first in FACE else "core"


def forbidden(
    drawn: dict[str, set[str]], allowed: dict[str, str], rooms: dict[str, str]
) -> list[str]:
    """Arrows between rooms that the order does not have."""
    ground = GROUND.split()
    return sorted(
        f"{a} imports {b}: {rooms[a]} may not import {rooms[b]}"
        for a, names in drawn.items()
        for b in names
        if rooms[a] != rooms[b] and rooms[b] not in (*ground, *allowed.get(rooms[a], "").split())
    )


@pytest.mark.parametrize("package", FOLDERS)
def test_no_import_closes_a_circle(package: str) -> None:
    drawn = arrows(package)
    assert sum(map(len, drawn.values())) > 200
    try:
        TopologicalSorter(drawn).prepare()
    except CycleError as error:
        pytest.fail(" imports ".join(reversed(error.args[1])))


def test_rooms_of_the_makers_side_import_only_what_they_may() -> None:
    drawn = arrows("lumitip_fab")
    rooms = {name: room(name) for name in drawn}
    assert set(rooms.values()) == {*ALLOWED, *GROUND.split()}
    assert forbidden(drawn, ALLOWED, rooms) == []


def test_rooms_of_the_robots_side_import_only_what_they_may() -> None:
    drawn = arrows("lumitip")
    rooms = {name: room_of_readout(name) for name in drawn}
    assert set(rooms.values()) == {*ALLOWED_READOUT}
    assert forbidden(drawn, ALLOWED_READOUT, rooms) == []


def test_the_robots_side_never_imports_the_makers() -> None:
    for name, file in modules("lumitip").items():
        for found in imports(name, file, {}):
            assert found.partition(".")[0] not in {"lumitip_fab", "build123d", "pydantic", "pcbnew"}


def test_the_robots_side_needs_numpy_alone() -> None:
    code = (
        "import sys; before = set(sys.modules); import lumitip, lumitip.layout, lumitip.grid; "
        "print(*sorted({m.partition('.')[0] for m in set(sys.modules) - before}))"
    )
    done = subprocess.run(
        [sys.executable, "-I", "-c", code], capture_output=True, text=True, check=True
    )
    loaded = set(done.stdout.split())
    assert loaded - sys.stdlib_module_names == {"lumitip", "numpy"}


@pytest.mark.parametrize("place", ["derive", "mask", "boards", "firmware", "docs"])
def test_what_needs_no_solids_never_imports_the_cad_kernel(place: str) -> None:
    for name, file in modules("lumitip_fab").items():
        if room(name) == place:
            names = {found.partition(".")[0] for found in imports(name, file, {})}
            assert not names & {"build123d", "OCP"}, name


def test_an_arrow_that_may_not_be_is_found() -> None:
    drawn = {
        "lumitip_fab.design.shape": {"lumitip_fab.checks.run"},
        "lumitip_fab.checks.run": set(),
    }
    found = forbidden(drawn, ALLOWED, {name: room(name) for name in drawn})
    assert found == [
        "lumitip_fab.design.shape imports lumitip_fab.checks.run: design may not import checks"
    ]


def test_the_orders_are_orders() -> None:
    for allowed in (ALLOWED, ALLOWED_READOUT):
        TopologicalSorter({name: under.split() for name, under in allowed.items()}).prepare()

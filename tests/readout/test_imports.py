"""The arrows between the packages: who may import whom."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FAB = ROOT / "generators" / "lumitip_fab"
READOUT = ROOT / "readout" / "lumitip"
GENERATORS = {"mechanical", "boards", "mask", "firmware"}


def _imported(file: Path, root: Path = ROOT) -> Iterator[str]:
    """Every module that a file imports, anywhere in it, by its full name."""
    package = file.relative_to(root).with_suffix("").parts[1:-1]
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join((*above, *([node.module] if node.module else [])))
            yield module
            yield from (f"{module}.{alias.name}" for alias in node.names)


def _files(folder: Path) -> list[Path]:
    found = sorted(folder.rglob("*.py"))
    assert found
    return found


def test_the_robot_side_needs_numpy_alone() -> None:
    code = (
        "import sys; before = set(sys.modules); import lumitip, lumitip.layout, lumitip.grid; "
        "print(*sorted({m.partition('.')[0] for m in set(sys.modules) - before}))"
    )
    done = subprocess.run(
        [sys.executable, "-I", "-c", code], capture_output=True, text=True, check=True
    )
    loaded = set(done.stdout.split())
    assert loaded - sys.stdlib_module_names == {"lumitip", "numpy"}


def test_no_file_of_the_robot_side_imports_the_makers_side() -> None:
    offenders = {
        str(file.relative_to(ROOT)): name
        for file in _files(READOUT)
        for name in _imported(file)
        if name.partition(".")[0] in {"lumitip_fab", "build123d", "OCP", "pydantic", "skip"}
    }
    assert not offenders


def test_no_check_imports_a_generator() -> None:
    offenders = {
        str(file.relative_to(ROOT)): name
        for file in _files(FAB / "checks")
        for name in _imported(file)
        if name.startswith("lumitip_fab.") and name.split(".")[1] in GENERATORS
    }
    assert not offenders


@pytest.mark.parametrize("package", ["derive", "mask"])
def test_what_needs_no_solids_never_imports_the_cad_kernel(package: str) -> None:
    for file in _files(FAB / package):
        names = {name.partition(".")[0] for name in _imported(file)}
        assert not names & {"build123d", "OCP"}, file


def test_derive_imports_no_generator_and_no_check() -> None:
    for file in _files(FAB / "derive"):
        later = {n for n in _imported(file) if n.startswith("lumitip_fab.")}
        assert not {n for n in later if n.split(".")[1] in GENERATORS | {"checks", "build"}}, file


def test_the_scan_of_imports_sees_every_form(tmp_path: Path) -> None:
    file = FAB / "checks" / "result.py"
    assert "dataclasses" in set(_imported(file))
    text = "from ..mask import page\nfrom lumitip_fab import mechanical\nimport lumitip_fab.boards"
    seen = tmp_path / "generators" / "lumitip_fab" / "checks" / "x.py"
    seen.parent.mkdir(parents=True)
    seen.write_text(text, encoding="utf-8")
    names = set(_imported(seen, tmp_path))
    assert {"lumitip_fab.mask", "lumitip_fab.parts", "lumitip_fab.boards"} <= names

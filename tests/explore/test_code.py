"""A change of the code that judges designs, or of a library, makes studies judge them again."""

import ast
import shutil
from collections.abc import Iterable
from pathlib import Path
from types import SimpleNamespace

import pytest

import lumitip
from lumitip_fab.config.load import load
from lumitip_fab.explore import evaluate
from lumitip_fab.explore.accuracy import Sample
from lumitip_fab.pipeline import fingerprint

ROOTS = {"lumitip": Path(lumitip.__file__).parent, "lumitip_fab": fingerprint.PACKAGE}
JUDGES = ("explore/accuracy.py", "explore/evaluate.py", "solve/judge.py")
BESIDE = {"build.py", "control", "interrupt.py", "tasks", "unfinished.py"}
"""Modules and folders that are imported with the judges, and change no figure."""


def imported_by(starts: Iterable[Path]) -> set[Path]:
    """The modules of both packages that modules import, themselves and theirs too, but for what
    the packages themselves offer."""
    inits = {root / "__init__.py" for root in ROOTS.values()}
    found: set[Path] = set()
    ahead = [*starts]
    while ahead:
        module = ahead.pop()
        if module in found | inits or not module.is_file():
            continue
        found.add(module)
        for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
            top, *rest = (getattr(node, "module", None) or "").split(".")
            if isinstance(node, ast.ImportFrom) and top in ROOTS:
                base = ROOTS[top].joinpath(*rest)
                names = (base, *(base / alias.name for alias in node.names))
                ahead += [p for n in names for p in (n.with_suffix(".py"), n / "__init__.py")]
    return found - {ROOTS["lumitip_fab"] / "pipeline/__init__.py"}


@pytest.mark.slow
def test_whatever_judges_a_design_makes_it_judged_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    without = shutil.ignore_patterns("__pycache__")
    copies = {n: shutil.copytree(r, tmp_path / n, ignore=without) for n, r in ROOTS.items()}
    monkeypatch.setattr(fingerprint, "PACKAGE", copies["lumitip_fab"])
    readout = SimpleNamespace(__file__=copies["lumitip"] / "__init__.py")
    monkeypatch.setattr(fingerprint, "lumitip", readout)
    code_hash = fingerprint.code_hash.__wrapped__
    files = imported_by(ROOTS["lumitip_fab"] / name for name in JUDGES)
    files = {f for f in files if not BESIDE & {f.name, f.parent.name}}
    assert {ROOTS["lumitip"] / "values.py", ROOTS["lumitip_fab"] / "config/load.py"} < files
    before, unseen = code_hash("explore", "solve"), []
    for file in files:
        name = next(n for n, root in ROOTS.items() if root in file.parents)
        copy = copies[name] / file.relative_to(ROOTS[name])
        code = copy.read_bytes()
        copy.write_bytes(code + b"ANOTHER = 1\n")
        if code_hash("explore", "solve") == before:
            unseen.append(f"{name}/{file.relative_to(ROOTS[name])}")
        copy.write_bytes(code)
    assert unseen == []


@pytest.mark.parametrize("library", ["numpy", "scipy", "shapely"])
def test_another_version_of_a_library_makes_designs_judged_again(
    library: str, design_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    config = load(design_dir / "fingertip.toml")

    def key() -> str:
        return evaluate.Job.of(config, (), config.catalogue.prices, Sample()).key

    before, version = key(), evaluate.tool_version
    monkeypatch.setattr(
        evaluate, "tool_version", lambda name: "another" if name == library else version(name)
    )
    assert key() != before

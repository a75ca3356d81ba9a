"""User files that once failed, derived anew; and random ones, built and checked."""

from collections.abc import Collection
from pathlib import Path

import pytest

from acceptance.generator import Design, design
from acceptance.parts import preset
from acceptance.trial import Trial, build_file, derive_file, design_folder

CASES = sorted((Path(__file__).parent / "cases").glob("*.toml"))
BUILT_CASES = sorted((Path(__file__).parent / "cases" / "built").glob("*.toml"))
BOARD_CASES = sorted((Path(__file__).parent / "cases" / "boards").glob("*.toml"))
"""Designs of which a board failed: nothing else of them is built."""
BOARD_STEPS = ("finger_board", "other_board", "models")
BOARD_CHECKS = ("board", "orders", "schematic", "models", "libraries")
BUILT = 3
"""`make bench` builds more of them, and larger boards, which are routed for minutes."""
MOST_CELLS = 80


def _derived(text: str, name: str) -> Trial:
    with design_folder() as folder:
        file = folder / f"{name}.toml"
        file.write_text(text, encoding="utf-8")
        return derive_file(file)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.stem)
def test_a_design_that_was_refused_is_accepted(case: Path) -> None:
    trial = _derived(case.read_text(encoding="utf-8"), case.stem)
    assert not trial.crash, trial.crash
    assert trial.refusals == ()


def _passes(case: Path, steps: Collection[str] = (), checks: Collection[str] = ()) -> None:
    with design_folder() as folder:
        file = folder / case.name
        file.write_text(case.read_text(encoding="utf-8"), encoding="utf-8")
        trial = build_file(file, steps, checks)
    assert not trial.crash, trial.crash
    assert trial.failed == ()


@pytest.mark.slow
@pytest.mark.parametrize("case", BUILT_CASES, ids=lambda case: case.stem)
def test_a_design_that_failed_a_check_passes_every_check(case: Path) -> None:
    _passes(case)


@pytest.mark.slow
@pytest.mark.parametrize("case", BOARD_CASES, ids=lambda case: case.stem)
def test_boards_that_failed_a_check_pass_every_check_of_boards(case: Path) -> None:
    _passes(case, BOARD_STEPS, BOARD_CHECKS)


def cells(drawn: Design) -> int:
    return sum(drawn.edits.get("grid.columns", preset(drawn.base)["grid.columns"]))


@pytest.mark.slow
@pytest.mark.parametrize("number", range(BUILT))
def test_a_random_design_is_built_and_passes_every_check(number: int) -> None:
    """The first accepted design of ordinary size of each ten of the seed."""
    with design_folder() as folder:
        for index in range(number * 10, number * 10 + 10):
            drawn = design(1, index)
            file = folder / f"{drawn.name}.toml"
            file.write_text(drawn.text, encoding="utf-8")
            if cells(drawn) <= MOST_CELLS and derive_file(file).accepted:
                break
        trial = build_file(file)
    assert not trial.crash, trial.crash
    assert trial.failed == ()

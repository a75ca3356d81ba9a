"""`make bench` tells a missed goal, and runs every part."""

import importlib.util
import math
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def _goals():
    spec = importlib.util.spec_from_file_location("common", ROOT / "benchmarks" / "common.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.Goals()


def test_met_goals_are_told(capsys: pytest.CaptureFixture[str]) -> None:
    goals = _goals()
    goals.at_most("slowest", 76.04, 100.0, "µs")
    goals.at_least("batch", 450_123.4, 1e5, "frames/s")
    goals.at_most("lost", 0, 0)
    assert goals.exit_code() == 0
    assert capsys.readouterr().out.strip().splitlines() == [
        "met     slowest: 76.04 µs (goal: at most 100)",
        "met     batch: 450,123 frames/s (goal: at least 100,000)",
        "met     lost: 0 (goal: at most 0)",
    ]


@pytest.mark.parametrize(
    "miss",
    [
        lambda goals: goals.at_most("age", 50.1, 50.0),
        lambda goals: goals.at_least("ratio", 99.9, 100.0),
        lambda goals: goals.at_most("age", math.nan, 50.0),
        lambda goals: goals.not_measured("age", "there is no browser"),
    ],
)
def test_one_missed_goal_is_enough(miss, capsys: pytest.CaptureFixture[str]) -> None:
    goals = _goals()
    goals.at_most("met", 1.0, 2.0)
    miss(goals)
    assert goals.exit_code() == 1
    assert [line.split()[0] for line in capsys.readouterr().out.split("\n") if line] == [
        "met",
        "MISSED",
    ]


def test_make_bench_runs_every_part() -> None:
    listed = re.search(r"^BENCHES = (.*)$", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert listed
    there = {path.stem.removeprefix("bench_") for path in (ROOT / "benchmarks").glob("bench_*.py")}
    assert set(listed[1].split()) == there

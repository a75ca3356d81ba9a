"""Whole studies: their figures, their files, what makes the yield fall, and bad options."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip_fab.cli import main
from lumitip_fab.config.load import load
from lumitip_fab.derive.auto.resolve import Resolved
from lumitip_fab.derive.making.tolerances import spreads
from lumitip_fab.errors import InputError
from lumitip_fab.tolerance.bench import COLUMNS, Bench
from lumitip_fab.tolerance.draws import FACTORS, draw
from lumitip_fab.tolerance.study import (
    Goals,
    Options,
    mask_allowance_mm,
    study,
    wilson,
    yield_of,
)

FEW = Options(fingers=16, poses=4, seed=2)
COMMAND = ("--fingers", "16", "--poses", "4", "--seed", "2")


@pytest.fixture(scope="module")
def alone(design: Resolved) -> dict[str, Any]:
    """A small study, in this process."""
    return study(design.config, design.design.layout, FEW, cores=1)


def test_a_study_has_all_figures_and_says_what_they_are_worth(alone: dict[str, Any]) -> None:
    assert tuple(alone["columns"]) == COLUMNS
    for column in alone["columns"].values():
        low, high = column["yield_95"]
        assert 0.0 <= low <= column["yield"] <= high <= 1.0
        for name in ("edge_mm", "edge_deg", "cable_mm", "cable_deg"):
            values = list(column[name].values())
            assert 0.0 < values[0] <= values[1] <= values[2]
    assert set(alone["tolerances"]) == set(FACTORS)
    for entry in alone["tolerances"].values():
        assert entry["confidence"] in ("datasheet", "measured", "inferred", "assumed")
        assert entry["source"] and entry["measure"] and entry["spread"] > 0.0
    assert alone["evidence"] == "simulated with our own model"
    assert set(alone["yield_if_exact"]) <= set(FACTORS)
    assert alone["pose_estimator"]["agree_percent"] > 60.0


def test_the_command_writes_the_same_bytes_on_all_cores_and_on_one(
    alone: dict[str, Any], design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from lumitip_fab.tolerance import report

    file, out = str(design_dir / "fingertip.toml"), tmp_path / "cores"
    assert main(["tolerance", file, "--out", str(out), *COMMAND]) == 0
    report.write(alone, tmp_path / "one")
    names = sorted(path.name for path in out.iterdir())
    assert names == ["tolerance.json", "tolerance.png"]
    for name in names:
        assert (out / name).read_bytes() == (tmp_path / "one" / name).read_bytes(), name
    assert json.loads((out / "tolerance.json").read_text(encoding="utf-8")) == alone
    printed = " ".join(capsys.readouterr().out.split())
    for text in (*COLUMNS, "simulated with our own model", "assumed", "tolerance.png"):
        assert text in printed


def test_the_yield_falls_when_a_tolerance_grows_or_the_goals_tighten(
    design: Resolved, tried: Bench
) -> None:
    table, spread = design.config.catalogue.tolerances, spreads(design.config)
    yields = []
    for times in (0.0, 2.0, 5.0):
        wider = {**spread, "mask_shift": times * spread["mask_shift"]}
        rows = tried.errors(draw(table, wider, 32, 20, 0), COLUMNS[1:2])[0]
        yields.append(yield_of(rows, Goals()))
        assert yield_of(rows, Goals(0.2, 1.0)) <= yields[-1] <= yield_of(rows, Goals(1.0, 5.0))
    assert yields == sorted(yields, reverse=True)
    assert yields[0] > 0.9
    assert yields[-1] < 0.5


def test_the_mask_may_be_less_off_where_the_goals_are_tighter(
    design: Resolved, tried: Bench
) -> None:
    drawn = draw(design.config.catalogue.tolerances, spreads(design.config), 32, 10, 0)
    wide, default, narrow = (
        mask_allowance_mm(tried.errors, drawn, goals)
        for goals in (Goals(1.0, 5.0), Goals(), Goals(0.01, 0.05))
    )
    assert narrow is None
    assert wide is not None and default is not None
    assert 0.0 <= default < wide


def test_the_interval_of_a_yield_narrows_with_more_fingers() -> None:
    assert wilson(0.5, 100) == pytest.approx((0.404, 0.596), abs=1e-3)
    assert wilson(1.0, 50) == pytest.approx((0.929, 1.0), abs=1e-3)
    assert np.diff(wilson(0.9, 1000)) < np.diff(wilson(0.9, 100))


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--fingers", "2"], "--fingers: is 2 fingers; 16 to 100000 is allowed"),
        (["--poses", "0"], "--poses: is 0 poses; 4 to 1000 is allowed"),
        (["--position", "nan"], "--position: is nan mm; 0.01 to 2 is allowed"),
        (["--angle", "-1"], "--angle: is -1 degrees; 0.05 to 10 is allowed"),
        (["--gap", "0"], "--gap: is 0 mm; 1 to 10 is allowed"),
        (["--seed", "-3"], "--seed: is -3; 0 to 4294967295 is allowed"),
    ],
)
def test_a_bad_option_is_rejected_in_one_line(
    options: list[str], text: str, design_dir: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["tolerance", str(design_dir / "fingertip.toml"), *options]) == 2
    assert capsys.readouterr().err.strip() == text


def test_a_tolerance_that_cannot_be_is_rejected_with_its_place(
    design_dir: Path, tmp_path: Path
) -> None:
    file = tmp_path / "fingertip.toml"
    file.write_bytes((design_dir / "fingertip.toml").read_bytes())
    (tmp_path / "parts").mkdir()
    text = (design_dir / "parts" / "tolerances.toml").read_text(encoding="utf-8")
    wrong = text.replace("spread = 0.4", "spread = -0.4")
    (tmp_path / "parts" / "tolerances.toml").write_text(wrong, encoding="utf-8")
    with pytest.raises(InputError, match=r"tolerances\.toml:\d+: gap\.spread is -0\.4"):
        load(file)

"""Whole studies: their figures, their files, what makes the yield fall, and bad options."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from lumitip_fab.cli import main
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.auto.resolve import Resolved
from lumitip_fab.derive.making.tolerances import spreads
from lumitip_fab.errors import InputError, OutputError
from lumitip_fab.tolerance import report
from lumitip_fab.tolerance.bench import COLUMNS, Bench
from lumitip_fab.tolerance.draws import FACTORS, directions, draw
from lumitip_fab.tolerance.options import Goals, Options
from lumitip_fab.tolerance.study import (
    MOST_SHIFT_MM,
    cases_of,
    draws_of,
    mask_allowance,
    sensitivities,
    study,
)
from lumitip_fab.tolerance.yields import design_effect, good, interval, wilson

pytestmark = pytest.mark.slow

FEW = Options(fingers=16, poses=4, seed=2)
WIDE = Goals.of_both(1.0, 5.0)
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
    assert not any("total" in entry for entry in alone["tolerances"].values())
    assert alone["sobol_draws"] == 0, "16 fingers are too few for indices"
    assert alone["yield_if_exact"] == {}
    assert alone["pose_estimator"]["agree_percent"] > 60.0


def test_the_command_writes_the_same_bytes_on_all_cores_and_on_one(
    alone: dict[str, Any], design_dir: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, out = str(design_dir / "fingertip.toml"), tmp_path / "cores"
    assert main(["tolerance", file, "--out", str(out), *COMMAND]) == 0
    report.write(alone, tmp_path / "one")
    names = sorted(path.name for path in out.iterdir())
    assert names == ["tolerance.json", "tolerance.png"]
    for name in names:
        assert (out / name).read_bytes() == (tmp_path / "one" / name).read_bytes(), name
    assert json.loads((out / "tolerance.json").read_text(encoding="utf-8")) == alone
    printed = " ".join(capsys.readouterr().out.split())
    for text in (
        *COLUMNS,
        "simulated with our own model",
        "No Sobol indices: they need 64 draws or more. Use --fingers 128 or more.",
        "Fingers are tried at 64 sets of poses in turn; intervals are as wide",
        "gross errors",
        "Optimistic:",
        "tolerance.png",
    ):
        assert text in printed


def test_the_yield_falls_when_a_tolerance_grows_or_the_goals_tighten(
    design: Resolved, tried: Bench
) -> None:
    table, spread = design.config.catalogue.tolerances, spreads(design.config)
    yields = []
    for times in (0.0, 2.0, 5.0):
        wider = {**spread, "mask_shift": times * spread["mask_shift"]}
        rows = tried.errors(draw(table, wider, 32, 20, 0), COLUMNS[1:2])[0]
        tight, own, wide = (
            good(rows, goals).mean() for goals in (Goals.of_both(0.2, 1.0), Goals.of_both(), WIDE)
        )
        assert tight <= own <= wide
        yields.append(own)
    assert yields == sorted(yields, reverse=True)
    assert yields[0] > 0.8
    assert yields[-1] < 0.5


def test_the_mask_may_be_less_off_where_the_goals_are_tighter(
    design: Resolved, tried: Bench
) -> None:
    table = design.config.catalogue.tolerances
    drawn = draw(table, spreads(design.config), 32, 10, 0)
    ways = directions(table, drawn, 0)
    wide, default, narrow = (
        mask_allowance(tried.errors, drawn, ways, goals)[0]
        for goals in (WIDE, Goals.of_both(), Goals.of_both(0.01, 0.05))
    )
    assert narrow is None
    assert wide is not None and default is not None
    assert 0.0 <= default <= wide, "gross errors count with wide goals, too"


def test_the_interval_of_a_yield_narrows_with_more_fingers() -> None:
    assert wilson(0.5, 100) == pytest.approx((0.404, 0.596), abs=1e-3)
    assert wilson(1.0, 50) == pytest.approx((0.929, 1.0), abs=1e-3)
    assert np.diff(wilson(0.9, 1000)) < np.diff(wilson(0.9, 100))


def test_fingers_of_one_set_of_poses_make_the_interval_wider() -> None:
    chance, sets = np.random.default_rng(0), np.arange(640) % 64
    alone = chance.random(640) < 0.5
    together = (chance.random(64) < 0.5)[sets]
    assert design_effect(alone) == pytest.approx(1.0, abs=0.3)
    assert design_effect(together) == pytest.approx(10.0, rel=0.1)
    low, high = interval(together)
    assert high - low == pytest.approx(np.diff(wilson(0.5, 64))[0], rel=0.1)
    assert design_effect(np.ones(640, bool)) == design_effect(np.zeros(640, bool)) == 1.0
    # Of many studies with shares of their own for each set, 95 % have the true yield.
    held = []
    for _ in range(400):
        low, high = interval(chance.random(500) < chance.beta(2, 2, 64)[np.arange(500) % 64])
        held.append(low <= 0.5 <= high)
    assert np.mean(held) == pytest.approx(0.95, abs=0.03)


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--fingers", "2"], "--fingers: is 2 fingers; 16 to 100000 is allowed"),
        (["--poses", "0"], "--poses: is 0 poses; 4 to 1000 is allowed"),
        (["--position", "nan"], "--position: is nan mm; 0.01 to 1 is allowed"),
        (["--angle", "-1"], "--angle: is -1 degrees; 0.05 to 5 is allowed"),
        (["--position", "2"], "--position: is 2 mm; 0.01 to 1 is allowed"),
        (["--angle", "10"], "--angle: is 10 degrees; 0.05 to 5 is allowed"),
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


def linear(drawn: dict[str, Any], _: tuple[str, ...]) -> Any:
    """Errors that only the gap changes."""
    away = np.abs(drawn["gap"])
    return np.concatenate([1.0 + away] * 4 + [0.0 * away], axis=1)[None]


def test_indices_are_printed_with_their_draws_and_deviation(
    design: Resolved, alone: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    assert [draws_of(count) for count in (127, 128, 500)] == [0, 64, 128]
    table, ones = design.config.catalogue.tolerances, dict.fromkeys(FACTORS, 1.0)

    def take(count: int, seed: int, part: int = 0) -> Any:
        return draw(table, ones, 4, count, seed, part)

    found = sensitivities(linear, take, 64, Options())
    assert found["gap"]["total"]["position"] == pytest.approx(1.0, abs=0.3)
    assert found["hole"]["total"]["position"] == 0.0
    entries = {"gap": {**alone["tolerances"]["gap"], **found["gap"]}}
    report.print_tables({**alone, "sobol_draws": 64, "tolerances": entries}, Console(width=200))
    printed = " ".join(capsys.readouterr().out.split())
    of = found["gap"]
    assert f"{of['total']['angle']:.2f} ± {of['total_sd']['angle']:.2f}" in printed
    assert "n = 64" in printed


def test_the_shift_of_the_masks_saturates(design: Resolved) -> None:
    drawn = draw(design.config.catalogue.tolerances, dict.fromkeys(FACTORS, 1.0), 32, 4, 0)
    exact = {**drawn, "gap": 0.0 * drawn["gap"]}
    assert (
        mask_allowance(linear, exact, np.ones((4, 2, 2)), Goals.of_both(9, 9))[0] == MOST_SHIFT_MM
    )
    assert MOST_SHIFT_MM == 1.5


@pytest.mark.parametrize("place", ["file", "file/below", "/proc/study"])
def test_a_folder_that_cannot_be_written_is_rejected_before_the_study(
    place: str,
    design_dir: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("lumitip_fab.cli.tolerance.study", None)
    (tmp_path / "file").write_text("kept", encoding="utf-8")
    out = tmp_path / place
    assert main(["tolerance", str(design_dir / "fingertip.toml"), "--out", str(out)]) == 2
    text = capsys.readouterr().err
    assert text.startswith(f"--out: is {out}, which cannot be written (")
    assert text.rstrip().endswith("Choose another folder.")
    assert (tmp_path / "file").read_text(encoding="utf-8") == "kept"


def test_a_file_that_cannot_be_replaced_is_one_error(alone: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "tolerance.json").mkdir()
    with pytest.raises(OutputError, match="cannot be written"):
        report.write(alone, tmp_path)


def test_cells_on_one_line_are_rejected(design: Resolved) -> None:
    layout = design.design.layout
    line = replace(layout, y_mm=np.zeros(len(layout)))
    with pytest.raises(InputError, match=r"grid\.columns is \[5, 4.*all cells lie on one line"):
        cases_of(design.config, line, FEW)


def test_compliant_fingers_are_rejected(design_dir: Path) -> None:
    flex = load(design_dir / "presets" / "flex.toml")
    with pytest.raises(InputError, match=r'backing\.variant is "flex"; .* allows "rigid" alone'):
        cases_of(flex, derive(flex).layout, FEW)

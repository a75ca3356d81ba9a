"""The rated force of a finger: flare and floor follow from it; forces that are refused."""

import shutil
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.auto.remedies import plan_of
from lumitip_fab.derive.auto.resolve import RuleError

pytestmark = pytest.mark.slow
FRANKA = '[coupling]\ngripper = "franka_hand"\n'
LONG = "[grid]\ncolumns = [20, 19, 20, 19, 20]\n"


def _force(newtons: float) -> str:
    return f"[finger]\nrated_force_n = {newtons}\n"


def test_a_flare_is_as_deep_as_the_force_asks(file: Any) -> None:
    weak, strong = (derive(load(file(_force(n)))) for n in (20.0, 40.0))
    assert weak.mount.flare_depth_mm < strong.mount.flare_depth_mm
    assert weak.stack.floor_mm == strong.stack.floor_mm


def test_a_floor_is_thicker_where_no_flare_is_enough(file: Any) -> None:
    usual, strong = derive(load(file(FRANKA))), derive(load(file(FRANKA + _force(36.5))))
    assert strong.stack.floor_mm > usual.stack.floor_mm
    assert strong.strength.rated_force_n == 36.5


def test_a_force_that_is_not_borne_is_refused_with_one_that_is(file: Any) -> None:
    match = r"finger\.rated_force_n is 100; .* This flare and floor bear"
    with pytest.raises(RuleError, match=match) as refused:
        derive(load(file(_force(100.0))))
    (remedy,) = plan_of(refused.value.verdict).steps[0].remedies
    assert remedy.field == "finger.rated_force_n"
    assert 30 < float(str(remedy.value)) < 50
    words = str(refused.value)
    assert "plastic under the bolts' heads bears" in words
    assert "land round the bolts' heads bears" in words


@pytest.mark.parametrize(
    ("text", "low_n", "high_n"),
    [
        (FRANKA, 30, 40),
        ("[grid]\ncolumns = [12, 11, 12, 11, 12]\n", 20, 40),
        (LONG, 10, 30),
    ],
)
def test_a_long_or_narrow_finger_is_rated_what_it_bears(
    file: Any, text: str, low_n: float, high_n: float
) -> None:
    design = derive(load(file(text)))
    assert low_n <= design.strength.rated_force_n < high_n
    (choice,) = (c for c in design.choices if c.field == "finger.rated_force_n")
    assert "bear at most" in choice.reason


def test_a_long_finger_does_not_bear_what_the_file_asks(file: Any) -> None:
    with pytest.raises(RuleError, match=r"finger\.rated_force_n is 40; "):
        derive(load(file(LONG + _force(40.0))))


def test_a_finger_longer_than_a_flare_may_be_is_refused_in_words(file: Any) -> None:
    with pytest.raises(RuleError, match="does not fit"):
        derive(load(file("[grid]\ncolumns = [34, 33, 34]\n")))


def test_a_flare_ends_where_the_counterbores_open_into_the_ramp(file: Any) -> None:
    # Their outer edge is 13.5 mm behind the board; 11 mm behind the plate left a skin of 0.03 mm.
    jaw = '[coupling]\ngripper = "two_hole_jaw"\n'
    with pytest.raises(RuleError, match=r"at most 10\.7 is allowed, below the ramp and the edge"):
        derive(load(file(jaw + "[backing]\nflare_depth_mm = 11.0\n")))
    long = derive(load(file(jaw + "[grid]\ncolumns = [12, 11, 12, 11, 12]\n")))
    edge_mm = long.mount.bolt_w_mm + long.mount.counterbore_mm / 2 - long.stack.plate_mm
    assert long.mount.flare_depth_mm < edge_mm


def test_a_file_of_before_has_no_load_case(design_dir: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(design_dir, tmp_path / "design")
    file = folder / "fingertip.toml"
    text = file.read_text(encoding="utf-8")
    start = text.index("[finger]")
    file.write_text(text[:start] + text[text.index("[tip]") :], encoding="utf-8")
    assert derive(load(file)).strength.rated_force_n == 40.0

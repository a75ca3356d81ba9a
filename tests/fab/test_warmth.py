"""The heat of a finger's own LEDs, against a correlation of another source."""

import math
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
import shapely

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.making.warmth import in_use_c
from lumitip_fab.design import Design
from lumitip_fab.errors import InputError

ROOM_K = 298.15
FOR = 'extends = "fingertip.toml"\n'


@pytest.fixture(scope="module")
def design(design_dir: Path) -> Design:
    return derive(load(design_dir / "fingertip.toml"))


def of_lines(design_dir: Path, folder: Path, text: str) -> Design:
    file = Path(shutil.copytree(design_dir, folder / "design")) / "mine.toml"
    file.write_text(text, encoding="utf-8")
    return derive(load(file))


def churchill_chu_w_m2k(rise_k: float, length_m: float) -> float:
    """Natural convection of an upright plate (Churchill and Chu, 1975), with air at 300 K."""
    conductivity, viscosity, diffusivity, prandtl = 0.0263, 15.9e-6, 22.5e-6, 0.707
    film_k = ROOM_K + rise_k / 2
    rayleigh = 9.81 / film_k * rise_k * length_m**3 / (viscosity * diffusivity)
    lowered = (1 + (0.492 / prandtl) ** (9 / 16)) ** (4 / 9)
    nusselt = 0.68 + 0.670 * rayleigh**0.25 / lowered
    return float(nusselt * conductivity / length_m)


@pytest.mark.parametrize("heat_w", [0.5, 0.9, 1.4, 2.0])
def test_the_heat_leaves_by_another_correlation_too(design: Design, heat_w: float) -> None:
    figures = replace(design.electrical, heat_w=heat_w, ambient=None)
    rise_k = in_use_c(figures, design.outline) - 25
    area_m2 = 2e-6 * shapely.Polygon(design.outline.polygon()).area
    radiated_w = 0.9 * 5.67e-8 * ((ROOM_K + rise_k) ** 4 - ROOM_K**4)
    convected_w = churchill_chu_w_m2k(rise_k, design.outline.length_mm / 1000) * rise_k
    assert area_m2 * (radiated_w + convected_w) == pytest.approx(heat_w, rel=0.15)


def test_leds_that_are_switched_heat_for_their_share_of_a_frame(design: Design) -> None:
    scan = design.electrical.ambient
    assert scan is not None
    on_us = scan.period_us - scan.light_us - scan.scan_us
    assert design.electrical.mean_heat_w == pytest.approx(1.39 * on_us / scan.period_us, rel=0.01)
    always_on = replace(design.electrical, ambient=None)
    assert in_use_c(always_on, design.outline) > design.heat_steps["use"].temperature_c


def test_what_its_own_heat_softens_is_refused_with_what_it_bears(
    design_dir: Path, tmp_path: Path
) -> None:
    always_on = FOR + "[emitter]\nswitch = 'none'\ncurrent_ma = {}\n"
    with pytest.raises(InputError, match="slow two-part epoxy withstands 45") as refused:
        of_lines(design_dir, tmp_path / "hot", always_on.format(19.2))
    (problem,) = refused.value.problems
    assert problem.field == "emitter.max_heat_w"
    (most_w,) = re.findall(r"Choose ([\d.]+) or less", problem.message)
    most_ma = math.floor(190 * float(most_w) / 1.39) / 10
    design = of_lines(design_dir, tmp_path / "cooler", always_on.format(most_ma))
    assert design.heat_steps["use"].temperature_c == 45
    assert design.electrical.heat_w <= float(most_w)


def test_an_automatic_current_falls_with_the_pull_up_that_keeps_the_range(
    design_dir: Path, tmp_path: Path
) -> None:
    design = of_lines(design_dir, tmp_path, FOR + "[emitter]\nswitch = 'none'\n")
    usual = derive(load(design_dir / "fingertip.toml"))
    assert design.electrical.ambient is None
    assert design.heat_steps["use"].temperature_c <= 45
    current_ma, full_ma = (d.electrical.strings.target_ma for d in (design, usual))
    assert 0.9 * full_ma < current_ma < full_ma
    (choice,) = [c for c in design.choices if c.field == "receiver.pull_up_ohm"]
    (set_ma,) = re.findall(r"uses nearly all of its range at ([\d.]+) mA", choice.reason)
    assert float(set_ma) == pytest.approx(current_ma, abs=0.2)


def test_a_switch_without_use_is_left_out_and_the_current_falls(
    design_dir: Path, tmp_path: Path
) -> None:
    design = of_lines(design_dir, tmp_path, FOR + "[receiver]\nload = 'shared'\n")
    assert design.electrical.ambient is None
    assert design.heat_steps["use"].temperature_c <= 45


def test_a_weaker_glue_is_refused_sooner(design_dir: Path, tmp_path: Path) -> None:
    lines = "[emitter]\nswitch = 'none'\ncurrent_ma = 17.5\n[backing]\nglue = '{}'\n"
    slow = of_lines(design_dir, tmp_path / "slow", FOR + lines.format("epoxy"))
    assert slow.heat_steps["use"].temperature_c <= 45
    with pytest.raises(InputError, match="fast two-part epoxy withstands 40"):
        of_lines(design_dir, tmp_path / "fast", FOR + lines.format("epoxy fast"))


def test_an_automatic_current_falls_to_what_the_weakest_part_bears(design_dir: Path) -> None:
    design = derive(load(design_dir / "presets" / "dense.toml"))
    use = design.heat_steps["use"]
    assert design.electrical.strings.target_ma < 8
    assert use.limit_c - 1 <= use.temperature_c <= use.limit_c

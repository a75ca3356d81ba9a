"""Pull of the bolts by levers, and the seats of their heads by a coupling's figures."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Mount
from lumitip_fab.design.seat import Foot, designed_foot, designed_seat, pull_n


@pytest.fixture(scope="module")
def mount(design_dir: Path) -> Mount:
    """The published coupling: one M5 bolt between two pins."""
    return derive(load(design_dir / "presets" / "published.toml")).mount


def test_one_bolt_pulls_two_thirds_of_its_way_from_the_edge(mount: Mount) -> None:
    away = mount.block_back_w_mm - mount.bolt_w_mm
    expected = 40.0 * 51.7 / (2 / 3 * away)
    assert pull_n(40.0, 51.7, mount, designed_foot(mount)) == pytest.approx(expected)
    narrow = Foot(mount.block_back_w_mm, 4.0)  # now sideways is worse
    assert pull_n(40.0, 51.7, mount, narrow) == pytest.approx(40.0 * 51.7 / (2 / 3 * 4.0))


def test_a_seat_that_ends_before_the_block_pulls_the_bolt_harder(mount: Mount) -> None:
    assert mount.seat_back_w_mm == mount.block_back_w_mm  # of the catalogue, assumed
    assert "seat_back_w_mm" in {figure.name for figure in mount.unsure}
    short = designed_foot(replace(mount, seat_back_w_mm=mount.bolt_w_mm + 3.0))
    assert pull_n(40.0, 51.7, mount, short) == pytest.approx(40.0 * 51.7 / (2 / 3 * 3.0))
    long = designed_foot(replace(mount, seat_back_w_mm=mount.block_back_w_mm + 3.0))
    assert long == designed_foot(mount)


def test_of_two_bolts_the_farther_pulls_more(mount: Mount) -> None:
    two, far = replace(mount, bolt_u_mm=(-6.0, 6.0)), Foot(mount.bolt_w_mm + 90.0, 9.0)
    assert pull_n(1.0, 30.0, two, far) == pytest.approx(30.0 * 14.0 / (14.0**2 + 2.0**2))


def test_a_foot_that_ends_at_its_bolt_holds_nothing(mount: Mount) -> None:
    assert pull_n(1.0, 30.0, mount, Foot(mount.bolt_w_mm, 8.0)) == math.inf


def test_a_sleeve_thins_the_land_under_a_head(mount: Mount) -> None:
    plain = designed_seat(mount, 8.5, 100.0)
    assert plain.bearing_mpa == pytest.approx(100.0 / (math.pi / 4 * (8.5**2 - 5.3**2)))
    sleeved = replace(mount, pin_u_mm=mount.bolt_u_mm, pin_mm=7.5, pin_depth_mm=2.6)
    assert designed_seat(sleeved, 8.5, 100.0).shear_mpa > 1.5 * plain.shear_mpa

"""The backing's geometry for designs that are far from the published one."""

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.frames import applied
from lumitip_fab.parts.backing import backing, backing_solid


def solid_of(design: Design, which: int = 1) -> object:
    finger = design.fingers[which]
    return backing_solid(
        finger,
        design.stack,
        design.outline,
        design.tip,
        design.board,
        design.mount,
        (),
        design.keys,
    )


@pytest.fixture
def changed(design_dir: Path, tmp_path: Path) -> Callable[[str], Design]:
    """The published design with some tables of its file added to."""

    def get(text: str) -> Design:
        folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
        file = folder / "changed.toml"
        file.write_text(f'extends = "fingertip.toml"\n{text}', encoding="utf-8")
        return derive(load(file))

    return get


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        "[stack]\nfloor_mm = 2.4",  # a blind relief, and tails within the plate
        "[tip]\nslant_start_mm = 2.5",
        "[outline]\nwaist_margin_mm = 7.5",  # straight sides
        "[stack]\npcb_mm = 0.8",
    ],
)
def test_other_designs_make_one_valid_solid(changed: Callable[[str], Design], text: str) -> None:
    solid = solid_of(changed(text), which=0)
    assert solid.is_valid
    assert solid.volume > 4000


def test_files_carry_the_way_back_to_the_sensor_frame(design_dir: Path) -> None:
    design = derive(load(design_dir / "presets" / "published.toml"))
    made = backing(design, design.receiver)
    assert [a.path for a in made] == [
        f"backing/receiver_backing.{e}" for e in ("step", "stl", "3mf")
    ]
    foot = applied(made[1].to_sensor, np.zeros((1, 3)))[0]
    assert foot == pytest.approx((0.0, design.mount.origin_y_mm, design.stack.rim_z_mm))
    assert (made[0].to_sensor == np.eye(4)).all()


@pytest.mark.slow
def test_each_board_has_its_own_pins(design_dir: Path) -> None:
    design = derive(load(design_dir / "presets" / "asymmetric.toml"))
    emitter, receiver = solid_of(design, 0), solid_of(design, 1)
    assert (emitter - receiver).volume > 1.0

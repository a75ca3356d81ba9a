"""Thick tip edges are measured as far as they reach, and a thin one among them is still seen."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import trimesh

from damages import box, carve
from lumitip_fab.checks import backing as checks
from lumitip_fab.checks.walls import Exempt, walls
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive, resolve
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text
from lumitip_fab.design.frames import mount_to_sensor
from lumitip_fab.parts.backing import backing

STL = "backing/receiver_backing.stl"


@pytest.mark.parametrize(("thick_mm", "passed"), [(2.4, True), (2.5, True), (2.2, False)])
def test_a_region_thicker_than_twice_the_least_wall_is_measured(
    thick_mm: float, passed: bool
) -> None:
    slab = trimesh.creation.box((30.0, 30.0, thick_mm))
    region = Exempt("edge", 2.4, lambda points: abs(points[:, 0]) < 10)
    edge, rest = walls("x.wall", "slab.stl", slab, 0.8, [region])
    assert edge.passed == passed
    assert edge.measured == pytest.approx(thick_mm, abs=0.01)
    assert rest.passed


@pytest.fixture
def with_edge(design_dir: Path, tmp_path: Path) -> Callable[[float], tuple[Path, Design]]:
    """`with_edge(1.5)`: a folder with the receiver's backing of the published design, its tip edge
    that thick, and the design."""

    def make(edge_mm: float) -> tuple[Path, Design]:
        config = resolve(load(design_dir / "presets" / "published.toml")).config
        tip = config.parameters.tip.model_copy(update={"edge_mm": edge_mm})
        mould = config.parameters.mould.model_copy(update={"tip_lip_mm": 0.0})
        changed = config.parameters.model_copy(update={"tip": tip, "mould": mould})
        design = derive(replace(config, parameters=changed))
        for made in backing(design, design.receiver):
            path = tmp_path / made.path
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(made.data)
        (tmp_path / "design.json").write_text(design_text(design), encoding="utf-8")
        return tmp_path, design

    return make


def failing(out: Path, design: Design) -> set[str]:
    found = checks.measure(out, design)
    return {m.check for m in found if m.subject.startswith(STL) and not m.passed}


@pytest.mark.slow
@pytest.mark.parametrize("edge_mm", [1.0, 1.5, 2.4])
def test_a_thick_tip_edge_passes(
    edge_mm: float, with_edge: Callable[[float], tuple[Path, Design]]
) -> None:
    assert failing(*with_edge(edge_mm)) == set()


@pytest.mark.slow
def test_a_tip_that_is_thinner_than_its_edge_fails(
    with_edge: Callable[[float], tuple[Path, Design]],
) -> None:
    out, design = with_edge(1.5)
    y = design.outline.tip_y_mm
    cut = box((-5, y - 2.5, -4.5), (5, y - 1.0, -2.8))
    carve(out / STL, lambda part: part - cut, mount_to_sensor(design.mount, design.stack))
    assert "backing.min_wall" in failing(out, design)

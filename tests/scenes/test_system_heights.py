"""The heights and steps that are written in the drawing of the whole system."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lumitip_fab.checks.readers.drawing import read_drawing
from lumitip_fab.checks.readers.scene import read_scene
from lumitip_fab.design.encoding import read_design

DRAWING = "assembly/system.svg"
WITHIN_MM = 0.02
_CLIMB = re.compile(r"^\+ ([\d.]+) = ([\d.]+) mm")


def heights_mm(folder: Path) -> list[float]:
    """Upwards in the scene: faces of coupling and flange, mount plane, tool centre point."""
    design, scene = read_design(folder / "design.json"), read_scene(folder / "assembly/system.glb")
    faces = [
        float(scene.nodes[name].in_scene_mm[:, 2].max())
        for flange in design.flanges
        for name in ("coupling.body", f"{flange.name}.upper")
    ]
    foot = float(scene.nodes[f"emitter.{design.held}"].in_scene_mm[:, 2].min())
    return [*faces, foot, scene.extras["tcp_mm"]]


def off_mm(folder: Path) -> float:
    """How far the worst written height or step is from the bodies; infinite if one is missing."""
    words = [text for text, _ in read_drawing(folder / DRAWING).words]
    climbs = [match.groups() for text in words if (match := _CLIMB.match(text))]
    written = sorted((float(height), float(step)) for step, height in climbs)
    heights = heights_mm(folder)
    if len(written) != len(heights):
        return float("inf")
    wanted = np.column_stack([heights, np.diff((0.0, *heights))])
    return float(np.abs(np.array(written) - wanted).max())


@pytest.mark.parametrize("preset", ["published", pytest.param("flex", marks=pytest.mark.slow)])
def test_heights_and_steps_are_those_of_the_bodies(
    preset: str, built: Callable[[str], Path]
) -> None:
    assert off_mm(built(preset)) <= WITHIN_MM


@pytest.mark.parametrize("preset", ["published", pytest.param("flex", marks=pytest.mark.slow)])
def test_the_holder_s_height_on_the_gripper_is_that_of_the_bodies(
    preset: str, built: Callable[[str], Path]
) -> None:
    folder = built(preset)
    design, nodes = (
        read_design(folder / "design.json"),
        read_scene(folder / "assembly/system.glb").nodes,
    )
    (holder,) = design.system.holders
    low = [float(nodes[n].in_scene_mm[:, 2].min()) for n in ("gripper.envelope", f"{holder}.tray")]
    words = [text for text, _ in read_drawing(folder / "manual/mounted.svg").words]
    assert f"{low[1] - low[0]:.0f} mm" in words
    html = " ".join((folder / "manual/manual.html").read_text(encoding="utf-8").split())
    assert f"Clip the arms round the gripper, {low[1] - low[0]:.0f} mm from the flange" in html


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (r"= 25\.30 mm", "= 25.40 mm"),
        (r"\+ 14\.30 ", "+ 14.20 "),
        (r"\+ 14\.30 = 25\.30 mm", "printed"),
    ],
)
def test_a_wrong_or_missing_height_is_seen(before: str, after: str, damaged: Path) -> None:
    file = damaged / DRAWING
    text, count = re.subn(before, after, file.read_text(encoding="utf-8"), count=1)
    assert count == 1
    file.write_text(text, encoding="utf-8")
    assert off_mm(damaged) > WITHIN_MM

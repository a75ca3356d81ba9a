"""Turn the fit test plate or the part that it stands for, and exactly the right checks fail."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

from damages import failing, passing
from lumitip_fab.checks import fit_orientation
from lumitip_fab.design.encoding import read_design

pytestmark = pytest.mark.slow

PLATE, BACKING = "fit/fit_plate.stl", "backing/receiver_backing.stl"
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def turned(file: str, axis: str, at: tuple[float, float, float]) -> Callable[[Path], None]:
    """Turn a part by 2 degrees about an axis through a place on its bed."""
    matrix = trimesh.transformations.rotation_matrix(np.radians(2.0), AXES[axis], at)

    def turn(folder: Path) -> None:
        mesh = trimesh.load(folder / file, force="mesh")
        mesh.apply_transform(matrix).export(folder / file)

    return turn


def frame_of_a_plate_that_lies(folder: Path) -> None:
    """The matrix of a plate that is printed on its back."""
    file = folder / "manifest.json"
    manifest = json.loads(file.read_text(encoding="utf-8"))
    manifest["files"][PLATE]["to_sensor"] = np.eye(4).tolist()
    file.write_text(json.dumps(manifest), encoding="utf-8")


DAMAGES: dict[str, tuple[Callable[[Path], None], set[str]]] = {
    "the plate tipped": (turned(PLATE, "x", (0, 5, 0)), {"floor", "roof", "pin", "bolt"}),
    "the backing tipped": (turned(BACKING, "x", (0, 5, 50)), {"floor", "roof", "pin", "bolt"}),
    "the backing askew": (turned(BACKING, "y", (0, 5, 50)), {"roof", "wall", "bolt"}),
    "the backing about": (turned(BACKING, "z", (0, 0, 0)), {"floor", "roof", "wall", "pin"}),
    "another frame": (frame_of_a_plate_that_lies, {"frame"}),
    "no plate": (lambda folder: (folder / PLATE).unlink(), {"readable"}),
    "no backing": (lambda folder: (folder / BACKING).unlink(), {"readable"}),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_a_part_that_is_turned(name: str, damaged: Path) -> None:
    damage, wrong = DAMAGES[name]
    damage(damaged)
    assert failing(damaged, "fit_orientation") == wrong


def test_every_check_fails_for_some_damage(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    names = {m.check.partition(".")[2] for m in fit_orientation.measure(outputs, design)}
    assert names == set().union(*(wrong for _, wrong in DAMAGES.values()))


def test_a_plate_of_a_compliant_finger_has_the_slices_alone(built: Callable[[str], Path]) -> None:
    folder = built("flex")
    assert read_design(folder / "design.json").fit_plate.corners == ()
    assert passing(folder, "fit_orientation", lambda _: True) == {"readable", "bolt"}

"""What the damage tests share: ways to hurt a built file, and the checks that then fail."""

import shutil
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import numpy as np
import trimesh
from manifold3d import Manifold, Mesh
from numpy.typing import NDArray

from lumitip_fab.design.encoding import read_design

Corner = tuple[float, float, float]
Body = Manifold


def failing(folder: Path, module: str, board: str = "") -> set[str]:
    """Names, without the module's own, of its checks that fail on a folder of outputs; of one
    board alone where that is what was damaged."""
    design = read_design(folder / "design.json")
    checks = import_module(f"lumitip_fab.checks.{module}")
    found = checks.measure_board(folder, design, board) if board else checks.measure(folder, design)
    return {m.check.removeprefix(f"{module}.") for m in found if not m.passed}


def passing(folder: Path, module: str, told_of: Callable[[str], bool]) -> set[str]:
    """Names of the module's checks of the files that are asked for, all of which must pass."""
    design = read_design(folder / "design.json")
    found = list(import_module(f"lumitip_fab.checks.{module}").measure(folder, design))
    assert not [m for m in found if not m.passed]
    return {m.check.removeprefix(f"{module}.") for m in found if told_of(m.subject)}


def excerpt(outputs: Path, folder: Path, *names: str) -> Path:
    """A folder with the design and some of its outputs, by folder or file."""
    for name in ("design.json", *names):
        source, target = outputs / name, folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target)
        else:
            shutil.copy(source, target)
    return folder


def edit(path: Path, old: str, new: str) -> None:
    """Replace a text where it first is in a file."""
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def carve(
    file: Path, damage: Callable[[Body], Body], frame: NDArray[np.float64] | None = None
) -> None:
    """Change the body of an STL file.

    Args:
        file: the file.
        damage: makes another body from it.
        frame: from the file's frame to the one in which `damage` works.
    """
    frame = np.eye(4) if frame is None else frame
    mesh = trimesh.load(file, force="mesh").apply_transform(frame)
    whole = Manifold(Mesh(np.float32(mesh.vertices), np.uint32(mesh.faces)))
    hurt = damage(whole).to_mesh()
    told = trimesh.Trimesh(hurt.vert_properties[:, :3], hurt.tri_verts)
    told.apply_transform(np.linalg.inv(frame)).export(file)


def box(low: Corner, high: Corner) -> Body:
    """A block between two corners."""
    size = [b - a for a, b in zip(low, high, strict=True)]
    return Manifold.cube(size).translate(low)


def flip_a_triangle(file: Path) -> None:
    """Turn the smallest triangle of an STL file inside out."""
    mesh = trimesh.load(file, force="mesh")
    faces = mesh.faces.copy()
    smallest = int(mesh.area_faces.argmin())
    faces[smallest] = faces[smallest][::-1]
    trimesh.Trimesh(mesh.vertices, faces, process=False).export(file)


def swap(one: Path, other: Path) -> None:
    """Put each file in the other's place."""
    first, second = one.read_bytes(), other.read_bytes()
    one.write_bytes(second)
    other.write_bytes(first)


def cut_short(file: Path, size: int = 1500) -> None:
    """Keep only the beginning of a file."""
    file.write_bytes(file.read_bytes()[:size])

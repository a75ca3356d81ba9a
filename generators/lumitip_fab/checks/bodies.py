"""STL, 3MF and STEP of a part are one body: whichever is printed or opened, it is the same."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePath

import numpy as np

from lumitip_fab.checks.readers.solids import Vectors, bodies, read_mesh
from lumitip_fab.checks.readers.step import StepShape, step_shapes
from lumitip_fab.checks.readers.surfaces import surfaces_apart_mm, volume_mm3
from lumitip_fab.checks.readers.three_mf import three_mf_triangles
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.design import Design
from lumitip_fab.design.frames import applied
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest

READS = ("*.stl", "*.3mf", "*.step", "assembly/assembly.glb", "manifest.json")
_PRINTED = (".stl", ".3mf")
_SHOWN = "robot/"
"""Meshes for a robot's software, which nobody prints."""
_CUT = "mask/"
"""Flat pieces: nobody goes on with them in CAD."""
AGREE_MM = 0.05
VOLUME = 0.002  # of chords on curved faces
_SCENE = 0.0002  # the same: a hole of another width is seen in the volume of all bodies
Files = Mapping[str, manifest.Entry]
Shapes = Mapping[Path, StepShape | OutputError]
_held: dict[str, tuple[Measurement, ...]] = {}
"""Of groups of files that held together before in this process, with the same bytes and entries:
most parts stay as they were when one file has changed, and the CAD kernel is slow."""


def measure(outputs: Path, _design: Design) -> Iterator[Measurement]:
    """Hold every 3MF and STEP that has an STL beside it against that."""
    files = manifest.read(outputs).files
    if not files:
        yield unreadable("bodies.stl", manifest.NAME, "lists no file")
    keys = {group: _key(outputs, group, files) for group in _groups(files)}
    new = [path for group, key in keys.items() if key not in _held for path in group]
    steps = [outputs / path for path in new if path.endswith(".step") and path in files]
    shapes = step_shapes(steps) if steps else {}
    for group, key in keys.items():
        if key in _held:
            yield from _held[key]
            continue
        measured = tuple(_group(outputs, group, files, shapes))
        if key and all(one.passed for one in measured):
            _held[key] = measured
        yield from measured


def _groups(files: Files) -> Iterator[tuple[str, ...]]:
    """Files of each body: the STL of a printed part and what must stand beside it, or a STEP file
    that no STL stands for."""
    parts = {PurePath(path).with_suffix("").as_posix() for path in files if path.endswith(_PRINTED)}
    for part in sorted(parts):
        if not part.startswith(_SHOWN):
            ends = (".stl", ".3mf") if part.startswith(_CUT) else (".stl", ".3mf", ".step")
            yield tuple(f"{part}{end}" for end in ends)
    for path in sorted(files):
        if path.endswith(".step") and path.removesuffix(".step") not in parts:
            yield (path, path.replace(".step", ".glb"))


def _key(outputs: Path, group: tuple[str, ...], files: Files) -> str:
    """Stands for the bytes and entries of some files; empty if one cannot be read."""
    hashes = [manifest.sha256_of(outputs / path) for path in group]
    return repr([(path, files.get(path)) for path in group] + hashes) if all(hashes) else ""


def _group(
    outputs: Path, group: tuple[str, ...], files: Files, shapes: Shapes
) -> Iterator[Measurement]:
    first, *others = group
    if first.endswith(".stl"):
        yield from _part(outputs, first, others, files, shapes)
    else:
        yield from _alone(outputs, first, files, shapes[outputs / first])


def _alone(
    outputs: Path, path: str, files: Files, shape: StepShape | OutputError
) -> Iterator[Measurement]:
    """A STEP file that no STL stands for: whole, and of one size with the scene beside it."""
    of, scene = Subject("bodies", path), path.replace(".step", ".glb")
    if isinstance(shape, OutputError):
        yield unreadable("bodies.solids", path, str(shape))
        return
    yield of.figure("solids", shape.solids, 1, math.inf, "solids")
    if scene not in files:
        return
    try:
        mesh = read_mesh(outputs / scene)
        seen = (np.asarray(mesh.triangles, dtype=np.float64), files[scene])
        ours, theirs = _in_one_frame(seen, (shape.triangles, files[path]))
        share = _share(volume_mm3(theirs), ours)
    except OutputError as error:
        yield unreadable("bodies.scene", path, str(error))
        return
    boxes = [np.array([s.min(axis=(0, 1)), s.max(axis=(0, 1))]) for s in (ours, theirs)]
    off = float(np.abs(boxes[0] - boxes[1]).max())
    yield of.figure("scene", off, 0.0, AGREE_MM, note=f"off the box round {scene}", at="box")
    yield of.near("scene", share, 1.0, _SCENE, f"of the volume of {scene}", unit="", at="volume")


def _part(
    outputs: Path, stl: str, paths: list[str], files: Files, shapes: Shapes
) -> Iterator[Measurement]:
    """Everything about the other files of one part."""
    try:
        if stl not in files:
            raise OutputError("is not in the manifest: it was not written")
        mesh = read_mesh(outputs / stl)
    except OutputError as error:
        yield unreadable("bodies.stl", stl, str(error))
        return
    surface, count = np.asarray(mesh.triangles, dtype=np.float64), bodies(mesh)
    for path in paths:
        of = Subject("bodies", path)
        try:
            if path not in files:
                raise OutputError("is not in the manifest: it was not written")
            found, found_mm3 = _surface(outputs / path, shapes)
            ours, theirs = _in_one_frame((surface, files[stl]), (found, files[path]))
            share = _share(found_mm3, ours)
        except OutputError as error:
            yield unreadable("bodies.surface", path, str(error))
            continue
        off = surfaces_apart_mm(ours, theirs, 2 * AGREE_MM)
        yield of.figure("surface", off, 0.0, AGREE_MM, note=f"off the surface of {stl}")
        yield of.near("volume", share, 1.0, VOLUME, f"of that of {stl}", unit="")
        step = shapes.get(outputs / path)
        if isinstance(step, StepShape):
            yield of.figure("solids", step.solids, count, count, "solids")


def _surface(path: Path, shapes: Shapes) -> tuple[Vectors, float]:
    """Triangles of a file, and its volume: of a STEP file that of the exact solids.

    Raises:
        OutputError: if it cannot be read.
    """
    shape = shapes.get(path)
    if isinstance(shape, OutputError):
        raise shape
    if isinstance(shape, StepShape):
        return shape.triangles, shape.volume_mm3
    triangles = three_mf_triangles(path)
    return triangles, volume_mm3(triangles)


def _share(found_mm3: float, surface: Vectors) -> float:
    """A volume as a share of that inside a surface.

    Raises:
        OutputError: if that has none.
    """
    whole = volume_mm3(surface)
    if not whole:
        raise OutputError("the mesh that it is held against has no volume")
    return found_mm3 / whole


def _in_one_frame(*placed: tuple[Vectors, manifest.Entry]) -> Iterator[Vectors]:
    """Surfaces moved by the manifest's matrices; left as they lie where one has no frame.

    Raises:
        OutputError: if they are in different frames, or a matrix is none.
    """
    frames = {str(entry.frame) for _, entry in placed}
    if len(frames - {""}) > 1:
        raise OutputError(f"is in another frame: {', '.join(sorted(frames))}")
    for triangles, entry in placed:
        matrix = entry.matrix
        if matrix is None:
            raise OutputError("the manifest has no matrix of it")
        moved = triangles if "" in frames else applied(matrix, triangles.reshape(-1, 3))
        yield moved.reshape(-1, 3, 3)

"""STL, 3MF and STEP of a part are one body: whichever is printed or opened, it is the same."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from lumitip_fab.checks.readers.solids import Vectors, bodies, read_mesh
from lumitip_fab.checks.readers.step import StepShape, step_shapes
from lumitip_fab.checks.readers.surfaces import apart_mm, volume_mm3
from lumitip_fab.checks.readers.three_mf import three_mf_triangles
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.design import Design
from lumitip_fab.design.frames import applied
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest

READS = ("*.stl", "*.3mf", "*.step", "assembly/assembly.glb", "manifest.json")
AGREE_MM = 0.05
VOLUME = 0.002  # of chords on curved faces
_SCENE = 0.0002  # the same: a hole of another width is seen in the volume of all bodies
Files = Mapping[str, manifest.Entry]
Shapes = Mapping[Path, StepShape | OutputError]


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:  # noqa: ARG001
    """Hold every 3MF and STEP that has an STL beside it against that."""
    files = manifest.read(outputs).files
    if not files:
        yield unreadable("bodies.stl", manifest.NAME, "lists no file")
    stems = [path.removesuffix(".stl") for path in sorted(files) if path.endswith(".stl")]
    parts = {s: [f"{s}{end}" for end in (".3mf", ".step") if f"{s}{end}" in files] for s in stems}
    steps = [path for path in sorted(files) if path.endswith(".step")]
    shapes = step_shapes([outputs / path for path in steps])
    for part, paths in parts.items():
        if paths:
            yield from _part(outputs, f"{part}.stl", paths, files, shapes)
    for path in steps:
        if path.removesuffix(".step") not in stems:
            yield from _alone(outputs, path, files, shapes[outputs / path])


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
    except OutputError as error:
        yield unreadable("bodies.scene", path, str(error))
        return
    boxes = [np.array([s.min(axis=(0, 1)), s.max(axis=(0, 1))]) for s in (ours, theirs)]
    off = float(np.abs(boxes[0] - boxes[1]).max())
    yield of.figure("scene", off, 0.0, AGREE_MM, note=f"off the box round {scene}", at="box")
    share = volume_mm3(theirs) / volume_mm3(ours)
    yield of.near("scene", share, 1.0, _SCENE, f"of the volume of {scene}", unit="", at="volume")


def _part(
    outputs: Path, stl: str, paths: list[str], files: Files, shapes: Shapes
) -> Iterator[Measurement]:
    """Everything about the other files of one part."""
    try:
        mesh = read_mesh(outputs / stl)
    except OutputError as error:
        yield unreadable("bodies.stl", stl, str(error))
        return
    surface, count = np.asarray(mesh.triangles, dtype=np.float64), bodies(mesh)
    for path in paths:
        of = Subject("bodies", path)
        try:
            shape = shapes.get(outputs / path) or three_mf_triangles(outputs / path)
            if isinstance(shape, OutputError):
                raise shape
            if isinstance(shape, StepShape):
                yield of.figure("solids", shape.solids, count, count, "solids")
                shape = shape.triangles
            ours, theirs = _in_one_frame((surface, files[stl]), (shape, files[path]))
        except OutputError as error:
            yield unreadable("bodies.surface", path, str(error))
            continue
        off = apart_mm(ours, theirs, 2 * AGREE_MM)
        yield of.figure("surface", off, 0.0, AGREE_MM, note=f"off the surface of {stl}")
        share = volume_mm3(theirs) / volume_mm3(ours)
        yield of.near("volume", share, 1.0, VOLUME, f"of that of {stl}", unit="")


def _in_one_frame(*placed: tuple[Vectors, manifest.Entry]) -> Iterator[Vectors]:
    """Surfaces moved by the manifest's matrices; left as they lie where one has no frame.

    Raises:
        OutputError: if they are in different frames, or a matrix is none.
    """
    frames = {entry.frame for _, entry in placed}
    if len(frames - {""}) > 1:
        raise OutputError(f"is in another frame: {', '.join(sorted(frames))}")
    for triangles, entry in placed:
        matrix = np.array(entry.to_sensor, dtype=np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
            raise OutputError("the manifest has no matrix of it")
        moved = triangles if "" in frames else applied(matrix, triangles.reshape(-1, 3))
        yield moved.reshape(-1, 3, 3)

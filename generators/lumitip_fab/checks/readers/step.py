"""Read solids from STEP files with the CAD kernel.

The kernel runs in a process of its own, since a damaged file may stop it.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.errors import OutputError

Vectors = NDArray[np.float64]  # not of `solids`: its libraries are not needed here
_CHORD_MM, _ANGLE_RAD = 0.01, 0.2
_END = b"END-ISO-10303-21;"
_LARGEST_MM3 = 1e9  # chords of 0.01 mm on a part in metres would take hours
_LONGEST_S = 120  # a damaged file may keep the kernel for ever


@dataclass(frozen=True, eq=False)
class StepShape:
    """All solids of a STEP file."""

    triangles: Vectors
    """Of the surface, shape `(n, 3, 3)`, mm; no farther than 0.01 mm off a curved face."""
    volume_mm3: float
    """Of the exact solids; below zero if their faces look inwards."""
    solids: int


def step_shapes(paths: Sequence[Path]) -> dict[Path, StepShape | OutputError]:
    """The solids of each file, or the error that tells why it cannot be read."""
    found = _kernel(paths)
    if found is None and len(paths) > 1:  # one of them stops the kernel: the others are read
        return {path: shape for one in paths for path, shape in step_shapes([one]).items()}
    stopped = OutputError("cannot be read: it stops the CAD kernel")
    return found or dict.fromkeys(paths, stopped)


def _kernel(paths: Sequence[Path]) -> dict[Path, StepShape | OutputError] | None:
    """The files as the kernel reads them; none if it stopped."""
    with tempfile.TemporaryDirectory() as folder:
        written = Path(folder) / "shapes.npz"
        try:
            subprocess.run(
                [sys.executable, "-P", "-m", __name__, str(written)],
                input=json.dumps([str(path.absolute()) for path in paths]).encode(),
                env=os.environ
                | {"PYTHONPATH": os.pathsep.join(entry or str(Path.cwd()) for entry in sys.path)},
                capture_output=True,
                timeout=_LONGEST_S,
                check=True,
            )
        except (OSError, subprocess.SubprocessError):
            return None
        with np.load(written) as kept:
            return {path: _shape(kept, str(k)) for k, path in enumerate(paths)}


def _shape(kept: "np.lib.npyio.NpzFile", name: str) -> StepShape | OutputError:
    if name not in kept:
        return OutputError(f"cannot be read: {kept[f'{name} error']}")
    volume, solids = kept[f"{name} figures"]
    return StepShape(kept[name], float(volume), int(solids))


def _main() -> None:
    """Read the files that standard input lists; write their arrays to the file that is named."""
    arrays: dict[str, object] = {}
    for k, path in enumerate(json.load(sys.stdin)):
        try:
            shape = _read(Path(path))
        except OutputError as error:
            arrays[f"{k} error"] = str(error)
        else:
            arrays[str(k)] = shape.triangles
            arrays[f"{k} figures"] = (shape.volume_mm3, shape.solids)
    np.savez(sys.argv[1], **arrays)  # type: ignore[arg-type]


def _read(path: Path) -> StepShape:
    try:
        from OCP.BRepGProp import BRepGProp
        from OCP.BRepMesh import BRepMesh_IncrementalMesh
        from OCP.GProp import GProp_GProps
        from OCP.IFSelect import IFSelect_RetDone
        from OCP.STEPControl import STEPControl_Reader
        from OCP.TopAbs import TopAbs_SOLID
        from OCP.TopExp import TopExp_Explorer

        reader = STEPControl_Reader()
        if not path.read_bytes().rstrip().endswith(_END):
            raise OutputError("it is cut short")
        if reader.ReadFile(str(path)) != IFSelect_RetDone or not reader.TransferRoots():
            raise OutputError("no STEP file with a shape in it")
        shape = reader.OneShape()
        mass = GProp_GProps()
        BRepGProp.VolumeProperties_s(shape, mass)
        if not abs(mass.Mass()) < _LARGEST_MM3:
            raise OutputError(f"{mass.Mass():g} mm³, no printed part is so large")
        BRepMesh_IncrementalMesh(shape, _CHORD_MM, False, _ANGLE_RAD, False)
        explorer, solids = TopExp_Explorer(shape, TopAbs_SOLID), 0
        while explorer.More():
            solids += 1
            explorer.Next()
        return StepShape(_triangles(shape), mass.Mass(), solids)
    except ImportError as error:
        raise OutputError(f"the CAD kernel cannot be loaded: {error!s:.200}") from error
    except (OSError, *MALFORMED) as error:  # whatever the kernel stumbles over
        raise OutputError(f"{error!r:.200}") from error


def _triangles(shape: object) -> Vectors:
    """Triangles of all faces, shape `(n, 3, 3)`."""
    from OCP.BRep import BRep_Tool
    from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS

    found = []
    faces = TopExp_Explorer(shape, TopAbs_FACE)
    while faces.More():
        face, place = TopoDS.Face(faces.Current()), TopLoc_Location()
        facets = BRep_Tool.Triangulation_s(face, place)
        faces.Next()
        if facets is None:
            raise OutputError("a face that has no surface")
        move = place.Transformation()
        nodes = [facets.Node(k).Transformed(move) for k in range(1, facets.NbNodes() + 1)]
        corners = [facets.Triangle(k).Get() for k in range(1, facets.NbTriangles() + 1)]
        points = np.array([(node.X(), node.Y(), node.Z()) for node in nodes])
        flipped = face.Orientation() == TopAbs_REVERSED
        found.append(points[np.array(corners)[:, :: -1 if flipped else 1] - 1])
    return np.concatenate(found)


if __name__ == "__main__":
    _main()

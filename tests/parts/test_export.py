"""The same shape gives the same bytes, and the files hold what was asked for."""

import io
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from build123d import Box, Color, Compound, Cylinder, Pos, Solid

from lumitip_fab.parts import export

pytestmark = pytest.mark.slow

MAKE = """
import hashlib, os
import numpy as np
from build123d import Box, Color, Compound, Cylinder, Pos
from lumitip_fab.parts import export
part = Box(10, 8, 4) - Cylinder(2, 10)
lid = Pos(0, 0, 5) * Box(10, 8, 1)
part.label, lid.label, lid.color = "part", "lid", Color("red")
both = Compound(label="both", children=[part, lid])
files = export.part_files("a/part", part, np.eye(4))
for data in (*(file.data for file in files), export.step(both, "both"), export.step(both, "both")):
    print(hashlib.sha256(data).hexdigest())
"""


def made(seed: str, folder: Path) -> list[str]:
    folder.mkdir()
    environment = {**os.environ, "PYTHONHASHSEED": seed}
    told = subprocess.run(
        [sys.executable, "-c", MAKE],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return told.stdout.split()


@pytest.fixture(scope="module")
def part() -> Solid:
    return (Box(10, 8, 4) - Cylinder(2, 10)).solids()[0]


def test_bytes_are_the_same_in_any_process_folder_and_hash_seed(tmp_path: Path) -> None:
    first, second = made("1", tmp_path / "a"), made("2", tmp_path / "b")
    assert len(first) == 5
    assert first == second


def test_an_assembly_written_twice_is_the_same() -> None:
    both = Compound(children=[Box(1, 1, 1), Pos(3, 0, 0) * Box(1, 1, 1)])
    both.children[0].color = Color("red")
    assert export.step(both, "both") == export.step(both, "both")


def test_the_stl_is_closed_and_close_to_the_shape(part: Solid) -> None:
    _, stl, _ = export.part_files("a/part", part, np.eye(4))
    mesh = trimesh.load(io.BytesIO(stl.data), file_type="stl")
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(part.volume, rel=1e-3)
    assert stl.facts["volume_mm3"] == pytest.approx(mesh.volume, rel=1e-6)


def test_the_package_opens_in_the_library_that_slicers_use(part: Solid, tmp_path: Path) -> None:
    from lib3mf import Lib3MF

    path = tmp_path / "part.3mf"
    path.write_bytes(export.three_mf(export.mesh(part), 'a "part" & more'))
    wrapper = Lib3MF.Wrapper(str(Path(Lib3MF.__file__).parent / "lib3mf"))
    model = wrapper.CreateModel()
    reader = model.QueryReader("3mf")
    reader.ReadFromFile(str(path))
    objects = model.GetMeshObjects()
    assert model.GetUnit() == Lib3MF.ModelUnit.MilliMeter
    assert objects.Count() == 1
    assert objects.MoveNext()
    held = objects.GetCurrentMeshObject()
    assert held.GetName() == 'a "part" & more'
    assert held.IsManifoldAndOriented()
    assert reader.GetWarningCount() == 0


def test_step_leaves_the_shape_as_it_was(part: Solid) -> None:
    before = part.label
    assert b"PRODUCT('named','named'" in export.step(part, "named")
    assert part.label == before

"""Every file of a part that a printer or a CAD program opens holds the same body."""

import json
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

from damages import cut_short, excerpt, failing, passing, swap
from lumitip_fab.checks.readers.step import step_shapes
from lumitip_fab.checks.readers.surfaces import surfaces_apart_mm, volume_mm3
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest

pytestmark = pytest.mark.slow
STL, PROP = "mould/clamp.stl", "mould/prop.stl"
THREE_MF, STEP = STL.replace(".stl", ".3mf"), STL.replace(".stl", ".step")
ENDS = (".stl", ".3mf", ".step")
Damage = Callable[[Path], None]


def in_model(path: Path, change: Callable[[str], str]) -> None:
    """Rewrite the model inside a 3MF file."""
    with zipfile.ZipFile(path) as package:
        entries = {name: package.read(name) for name in package.namelist()}
    before = entries["3D/3dmodel.model"].decode()
    entries["3D/3dmodel.model"] = change(before).encode()
    assert entries["3D/3dmodel.model"] != before.encode()
    with zipfile.ZipFile(path, "w") as package:
        for name, data in entries.items():
            package.writestr(name, data)


def model(old: str, new: str, count: int = 0) -> Damage:
    """Replace a pattern in the model of the clamp's 3MF."""
    return lambda folder: in_model(
        folder / THREE_MF, lambda text: re.sub(old, new, text, count=count)
    )


def a_vertex_moved(folder: Path) -> None:
    def change(text: str) -> str:
        return re.sub(r'x="([-\d.]+)"', lambda m: f'x="{float(m[1]) + 0.2:.5f}"', text, count=1)

    in_model(folder / THREE_MF, change)


def an_arm_moved(folder: Path) -> None:
    """Corners of one side of the clamp, by 0.3 mm."""

    def move(found: re.Match[str]) -> str:
        x = float(found[1])
        return f'x="{x + 0.3 * (x > 30.0):.5f}"'

    in_model(folder / THREE_MF, lambda text: re.sub(r'x="([-\d.]+)"', move, text))


def spoilt(folder: Path) -> None:
    data = (folder / THREE_MF).read_bytes()
    (folder / THREE_MF).write_bytes(data[:400] + b"\xff" * 200 + data[600:])


def packages_gone(folder: Path) -> None:
    (folder / THREE_MF).unlink()
    (folder / STEP).unlink()


def parts_swapped(folder: Path) -> None:
    for end in (".3mf", ".step"):
        swap((folder / STL).with_suffix(end), (folder / PROP).with_suffix(end))


def step_changed(old: str, new: str, count: int = 0) -> Damage:
    """Replace a pattern in the clamp's STEP file."""

    def damage(folder: Path) -> None:
        text = (folder / STEP).read_text(encoding="ascii")
        changed = re.sub(old, new, text, count=count)
        assert changed != text
        (folder / STEP).write_text(changed, encoding="ascii")

    return damage


def step_moved(folder: Path) -> None:
    """All points 1 mm to the right."""
    text = (folder / STEP).read_text(encoding="ascii")
    point = r"(CARTESIAN_POINT\('',\()(-?[\d.]+(?:E[-+]?\d+)?)(,[^,)]*,)"
    moved = re.sub(point, lambda m: f"{m[1]}{float(m[2]) + 1.0!r}{m[3]}", text)
    assert moved != text
    (folder / STEP).write_text(moved, encoding="ascii")


def second_model(folder: Path) -> None:
    with zipfile.ZipFile(folder / THREE_MF, "a") as package:
        package.writestr("3D/other.model", "<model/>")


def not_written(path: str) -> Damage:
    """A file that is neither there nor in the manifest."""

    def damage(folder: Path) -> None:
        record = json.loads((folder / manifest.NAME).read_text())
        del record["files"][path]
        (folder / manifest.NAME).write_text(json.dumps(record))
        (folder / path).unlink()

    return damage


def in_manifest(**values: object) -> Damage:
    """Other values for the STEP file in the manifest."""

    def damage(folder: Path) -> None:
        record = json.loads((folder / manifest.NAME).read_text())
        record["files"][STEP].update(values)
        (folder / manifest.NAME).write_text(json.dumps(record))

    return damage


def flat(folder: Path) -> None:
    mesh = trimesh.load(folder / STL, force="mesh")
    mesh.vertices[:, 2] = 0.0
    mesh.export(folder / STL)


DAMAGES: dict[str, tuple[Damage, set[str]]] = {
    "3MF in inches": (model("millimeter", "inch"), {"surface"}),
    "3MF shifted": (
        model('objectid="1"/', 'objectid="1" transform="1 0 0 0 1 0 0 0 1 0.2 0 0"/'),
        {"surface"},
    ),
    "3MF mirrored": (
        model('objectid="1"/', 'objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/'),
        {"surface"},
    ),
    "3MF twice": (
        model(
            '<item objectid="1"/>',
            '<item objectid="1"/><item objectid="1" transform="1 0 0 0 1 0 0 0 1 90 0 0"/>',
        ),
        {"surface", "volume"},
    ),
    "3MF without items": (model('<item objectid="1"/>', ""), {"surface"}),
    "3MF without triangles": (model("<triangle [^>]*>", ""), {"surface"}),
    "3MF inside out": (
        model(r'v1="(\d+)" v2="(\d+)"', r'v1="\2" v2="\1"'),
        {"volume"},
    ),
    "3MF with a triangle turned over": (
        model(r'triangle v1="(\d+)" v2="(\d+)"', r'triangle v1="\2" v2="\1"', 1),
        {"surface"},
    ),
    "3MF with a triangle lost": (model("<triangle [^>]*>", "", 1), {"surface"}),
    "3MF not a number": (model(r'x="[-\d.]+"', 'x="nan"'), {"surface"}),
    "3MF support only": (model('type="model"', 'type="support"'), {"surface"}),
    "a vertex moved": (a_vertex_moved, {"surface"}),
    "an arm moved": (an_arm_moved, {"surface", "volume"}),
    "spoilt": (spoilt, {"surface"}),
    "gone": (packages_gone, {"surface"}),
    "parts swapped": (parts_swapped, {"surface", "volume"}),
    "STEP moved": (step_moved, {"surface"}),
    "STEP in metres": (step_changed(r"SI_UNIT\(\.MILLI\.,", "SI_UNIT($,"), {"surface"}),
    "STEP of a surface": (
        step_changed("MANIFOLD_SOLID_BREP", "SHELL_BASED_SURFACE_MODEL"),
        {"solids", "surface", "volume"},
    ),
    "STEP without its end": (step_changed(r"ENDSEC;\s*END-ISO-10303-21;\s*$", ""), {"surface"}),
    "STEP cut short": (lambda folder: cut_short(folder / STEP, 20000), {"surface"}),
    "STEP empty": (lambda folder: (folder / STEP).write_text(""), {"surface"}),
    "3MF with a second model": (second_model, {"surface"}),
    "3MF not written": (not_written(THREE_MF), {"surface"}),
    "STEP not written": (not_written(STEP), {"surface"}),
    "STL not written": (not_written(STL), {"stl"}),
    "STL flat": (flat, {"surface", "solids", "volume"}),
    "matrix ragged": (in_manifest(to_sensor=[[1.0], [2.0, 3.0]]), {"surface"}),
    "matrix not a number": (in_manifest(to_sensor=[[float("nan")] * 4] * 4), {"surface"}),
    "matrix of another part": (
        in_manifest(to_sensor=np.diag([1.0, -1.0, 1.0, 1.0]).tolist()),
        {"surface"},
    ),
    "frame": (in_manifest(frame="tool"), {"surface"}),
    "STL gone": (lambda folder: (folder / STL).unlink(), {"stl"}),
}


@pytest.fixture
def parts(outputs: Path, tmp_path: Path) -> Path:
    """The clamp and the prop, with their lines of the manifest, to damage."""
    folder = excerpt(outputs, tmp_path / "parts", "manifest.json")
    path = folder / manifest.NAME
    record = json.loads(path.read_text())
    kept = {f"{part.removesuffix('.stl')}{end}" for part in (STL, PROP) for end in ENDS}
    record["files"] = {name: entry for name, entry in record["files"].items() if name in kept}
    path.write_text(json.dumps(record))
    return excerpt(outputs, folder, *sorted(kept))


@pytest.mark.parametrize("case", DAMAGES)
def test_a_damaged_file(case: str, parts: Path) -> None:
    damage, wanted = DAMAGES[case]
    damage(parts)
    found = failing(parts, "bodies")
    assert found and found <= wanted


def test_undamaged_parts_pass(outputs: Path) -> None:
    assert len(passing(outputs, "bodies", lambda subject: subject.endswith(".step"))) == 3


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        (r"((?:CIRCLE|CYLINDRICAL_SURFACE)\('',#\d+,)1\.5\)", r"\g<1>1.06)", {"scene"}),
        (r"(CARTESIAN_POINT\('',\()(-?[\d.]+)", r"\g<1>1\g<2>", {"solids"}),
        (r"END-ISO-10303-21;", "", {"solids"}),
    ],
)
def test_a_damaged_step_file_that_no_stl_stands_for(
    old: str, new: str, wanted: set[str], outputs: Path, tmp_path: Path
) -> None:
    folder = excerpt(outputs, tmp_path / "alone", "manifest.json", "assembly", "boards/models")
    record = json.loads((folder / manifest.NAME).read_text())
    kept = ("assembly/assembly", "boards/models/")
    record["files"] = {p: e for p, e in record["files"].items() if p.startswith(kept)}
    (folder / manifest.NAME).write_text(json.dumps(record))
    assert failing(folder, "bodies") == set()
    path = folder / "assembly/assembly.step"
    text = path.read_text(encoding="latin-1")
    changed = re.sub(old, new, text)
    if changed == text:
        pytest.fail(f"{old} is not in it")
    path.write_text(changed, encoding="latin-1")
    assert failing(folder, "bodies") & wanted


def test_a_damage_after_a_good_check_is_seen_and_so_is_its_repair(parts: Path) -> None:
    assert failing(parts, "bodies") == set()
    step = (parts / STL).with_suffix(".step")
    good = step.read_bytes()
    step.write_bytes((parts / PROP).with_suffix(".step").read_bytes())
    assert failing(parts, "bodies")
    step.write_bytes(good)
    assert failing(parts, "bodies") == set()


def test_one_spoilt_step_file_does_not_hide_the_others(outputs: Path, tmp_path: Path) -> None:
    spoilt_file = tmp_path / "spoilt.step"
    spoilt_file.write_text("ISO-10303-21;\nHEADER;\n")
    good = outputs / "mould/prop.step"
    found = step_shapes([spoilt_file, good])
    assert isinstance(found[spoilt_file], OutputError)
    shape = found[good]
    assert not isinstance(shape, OutputError)
    assert shape.solids == 1 and shape.volume_mm3 == pytest.approx(volume_mm3(shape.triangles))


def plate(holes: int) -> np.ndarray:
    """Triangles of a plate with holes through it."""
    from manifold3d import Manifold

    body = Manifold.cube([20.0, 10.0, 3.0])
    for k in range(holes):
        body -= Manifold.cylinder(9.0, 1.0, circular_segments=32).translate([4.0 * k + 3, 5, -3])
    mesh = body.to_mesh()
    return np.asarray(mesh.vert_properties[:, :3], dtype=np.float64)[mesh.tri_verts]


def test_distances_of_surfaces() -> None:
    whole, drilled = plate(0), plate(1)
    assert surfaces_apart_mm(whole, whole, 0.1) == 0.0
    assert surfaces_apart_mm(whole, drilled, 0.1) > 0.5
    assert surfaces_apart_mm(drilled, plate(2), 0.1) > 0.5
    assert surfaces_apart_mm(drilled, drilled + np.array([0.0, 0.04, 0.0]), 0.1) == pytest.approx(
        0.04, abs=1e-3
    )
    assert surfaces_apart_mm(whole, plate(0)[::-1], 0.1) == 0.0

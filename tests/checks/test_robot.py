"""Damage the robot's model, and exactly the right checks fail."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
import trimesh

from lumitip_fab.checks import robot

pytestmark = pytest.mark.slow

URDF, MACROS = "robot/lumitip.urdf", "robot/lumitip.xacro"
FILM = "robot/meshes/emitter_film.stl"
PLATE = "robot/meshes/receiver_collision_plate.stl"
BLOCK = "robot/meshes/receiver_collision_block.stl"
EVERY = {
    "tree",
    "facing",
    "tcp",
    "seat",
    "closed",
    "open",
    "mass",
    "centre",
    "inertia",
    "reach",
    "bulk",
    "macros",
    "slide",
    "limits",
    "colours",
}
Damage = Callable[[Path], None]


def edited(file: str, old: str, new: str, count: int = 1) -> Damage:
    """Replace the first occurrence of a text, of which there must be one."""

    def damage(folder: Path) -> None:
        text = (folder / file).read_text()
        assert old in text
        (folder / file).write_text(text.replace(old, new, count))

    return damage


def scaled(file: str, by: float) -> Damage:
    """Another size for a mesh."""

    def damage(folder: Path) -> None:
        trimesh.load(folder / file, force="mesh").apply_scale(by).export(folder / file)

    return damage


def raised(file: str, by_mm: float) -> Damage:
    """Another height for a mesh."""

    def damage(folder: Path) -> None:
        mesh = trimesh.load(folder / file, force="mesh")
        mesh.apply_translation((0, 0, by_mm)).export(folder / file)

    return damage


def removed(file: str) -> Damage:
    return lambda folder: (folder / file).unlink()


def in_both(old: str, new: str) -> Damage:
    """The same fault in the URDF and in its macros, which then agree."""

    def damage(folder: Path) -> None:
        for file in (URDF, MACROS):
            edited(file, old, new)(folder)

    return damage


def substituted(pattern: str, by: str, *files: str, count: int = 1) -> Damage:
    """Replace what a pattern finds, in each file, with which they agree again."""

    def damage(folder: Path) -> None:
        for file in files or (URDF, MACROS):
            text, found = re.subn(pattern, by, (folder / file).read_text(), count=count)
            assert found
            (folder / file).write_text(text)

    return damage


def placed(kind: str, place: str) -> Damage:
    """The first body of a kind somewhere else, in the URDF and in its macros."""
    name = rf'(<{kind} name="[^"]*">)'
    return substituted(name, rf"\1<origin {place} />")


def heavier(folder: Path) -> None:
    """The first finger's mass times ten."""
    text = (folder / URDF).read_text()
    mass = text.split('<mass value="')[1].split('"')[0]
    in_both(f'<mass value="{mass}"', f'<mass value="{10 * float(mass):g}"')(folder)


def _first_pose(folder: Path, tag: str) -> str:
    """The place of the first thing with this text before it."""
    text = (folder / URDF).read_text()
    return text.split(tag)[1].split('<origin xyz="')[1].split('"')[0]


def moved(tag: str, by_m: tuple[float, float, float]) -> Damage:
    def damage(folder: Path) -> None:
        told = _first_pose(folder, tag)
        values = [float(v) + d for v, d in zip(told.split(), by_m, strict=True)]
        edited(URDF, f'"{told}"', '"' + " ".join(f"{v:.9g}" for v in values) + '"')(folder)

    return damage


RECEIVER = 'joint name="lumitip_receiver_joint"'
TCP = 'joint name="lumitip_tcp_joint"'
DAMAGES: tuple[tuple[str, Damage, set[str]], ...] = (
    ("no file", removed(URDF), EVERY),
    ("no xml", edited(URDF, "</robot>", ""), EVERY),
    ("a mesh is missing", removed(FILM), EVERY),
    ("no macros", removed(MACROS), {"macros"}),
    ("a joint renamed", edited(URDF, "lumitip_emitter_joint", "emitter_joint"), {"tree"}),
    ("nothing mimics", edited(URDF, '<mimic joint="lumitip_receiver_joint" />', ""), {"tree"}),
    ("one finger towards the other", moved(RECEIVER, (0.001, 0, 0)), {"tcp", "closed", "open"}),
    ("one finger up", moved(RECEIVER, (0, 0, 0.0003)), {"tcp", "seat"}),
    ("tool centre point", moved(TCP, (0, 0, 0.0001)), {"tcp"}),
    (
        "without the lean",
        edited(URDF, 'rpy="1.59', 'rpy="1.57'),
        {"facing", "seat", "closed", "open", "slide"},
    ),
    ("slides aside", edited(URDF, '<axis xyz="0 ', '<axis xyz="0.1 '), {"slide"}),
    ("short travel", edited(URDF, 'upper="0.039', 'upper="0.038', 2), {"open", "limits"}),
    ("weaker", edited(URDF, 'effort="235"', 'effort="23"'), {"limits"}),
    ("one faster", edited(URDF, 'velocity="0.15"', 'velocity="0.2"'), {"limits"}),
    ("both faster", edited(URDF, 'velocity="0.15"', 'velocity="0.45"', 2), {"limits"}),
    (
        "one ends late, one early",
        substituted(r'upper="0\.039(?s:(.*?))upper="0\.039', r'upper="0.038\1upper="0.040', URDF),
        {"limits"},
    ),
    ("mimics backwards", edited(URDF, "<mimic ", '<mimic multiplier="-1" '), {"tree"}),
    ("mimics with an offset", edited(URDF, "<mimic ", '<mimic offset="0.01" '), {"tree"}),
    ("another robot", edited(URDF, 'robot name="lumitip"', 'robot name="other"'), {"tree"}),
    ("MuJoCo forgets folders", edited(URDF, 'path="false"', 'path="true"'), {"tree"}),
    (
        "tool turned",
        substituted(r'(tcp"(?s:.{0,99}?)rpy=")0 0 0', r"\g<1>0 0 1.5", URDF),
        {"tcp"},
    ),
    ("twice the inertia", substituted(r'ixx="', 'ixx="1'), {"inertia"}),
    ("inertia in g mm2", substituted(r"e-0(\d)\" i(?=[xyz])", r'e-03" i', count=0), {"inertia"}),
    (
        "inertia turned",
        substituted(r'rpy="0 0 0"( />\s*<mass)', r'rpy="0 0 1"\1'),
        {"inertia"},
    ),
    (
        "inertia of the other axes",
        substituted(r'iyy="(.*?)"(.*)izz=".*?"', r'iyy="\1"\2izz="\1"'),
        {"inertia"},
    ),
    (
        "seen elsewhere",
        placed("visual", 'xyz="0 0 0.01"'),
        {"seat", "closed", "open", "centre", "inertia", "reach"},
    ),
    (
        "a layer of another name",
        substituted('<visual name="emitter_board"', '<visual name="emitter_plate"'),
        {"tree"},
    ),
    ("touches elsewhere", placed("collision", 'xyz="0 0 0.01"'), {"reach"}),
    ("touches turned", placed("collision", 'rpy="0 0 0.1"'), {"reach"}),
    ("another macro", edited(MACROS, 'name="lumitip_emitter"', 'name="emitter"'), {"macros"}),
    ("a macro's parameters", edited(MACROS, "prefix:=lumitip_", "prefix:=tip_"), {"macros"}),
    ("xacro of another robot", edited(MACROS, 'name="lumitip"', 'name="other"'), {"macros"}),
    ("in mm/s", edited(URDF, 'velocity="0.15"', 'velocity="150"', 2), {"limits"}),
    ("from the middle", edited(URDF, 'lower="0"', 'lower="-0.01"'), {"limits"}),
    ("a macro's parent", edited(MACROS, 'link="${parent}"', 'link="world"'), {"macros"}),
    ("a macro's joint", edited(MACROS, "receiver_mount", "receiver"), {"macros"}),
    ("a macro's place", edited(MACROS, 'name="origin" />', 'name="place" />'), {"macros"}),
    (
        "a macro's link is written out",
        edited(MACROS, 'link name="${prefix}receiver"', 'link name="lumitip_receiver"'),
        {"macros"},
    ),
    (
        "a macro's joint is written out",
        edited(MACROS, '"${prefix}emitter_mount"', '"lumitip_emitter_mount"'),
        {"macros"},
    ),
    (
        "a macro's child is written out",
        edited(MACROS, 'child link="${prefix}emitter"', 'child link="lumitip_emitter"'),
        {"macros"},
    ),
    (
        "a macro's material is written out",
        edited(MACROS, '"${prefix}receiver_film"', '"lumitip_receiver_film"'),
        {"macros"},
    ),
    ("a macro's meshes are elsewhere", edited(MACROS, "${meshes}/", "meshes/", 99), {"macros"}),
    (
        "a link that no macro has",
        edited(MACROS, "</robot>", '<link name="world" /></robot>'),
        {"macros"},
    ),
    (
        "a macro that skips its link",
        substituted(r"(<link(?s:.*?)</link>)", r'<xacro:if value="0">\1</xacro:if>', MACROS),
        {"macros"},
    ),
    (
        "mass in one file",
        edited(URDF, '<mass value="0.01', '<mass value="0.02'),
        {"mass", "macros"},
    ),
    ("ten times the mass", heavier, {"mass"}),
    ("centre of mass", moved('link name="lumitip_receiver"', (0, 0.001, 0)), {"centre", "macros"}),
    ("a macro's mesh", edited(MACROS, "receiver_film.stl", "emitter_film.stl"), {"macros"}),
    ("no materials", substituted(r"<material[\s\S]*?</material>", "", count=0), {"colours"}),
    (
        "one material for two layers",
        substituted(r'(<material name="[^"]*)receiver_film', r"\1receiver_board"),
        {"colours"},
    ),
    ("a colour lost", substituted(r"<color [^>]*/>", ""), {"colours"}),
    ("another colour", in_both('rgba="0.82 ', 'rgba="0.1 '), {"colours"}),
    ("a colour none can see", in_both("0.86 1", "0.86 0"), {"colours"}),
    ("an opaque silicone", in_both("0.95 0.35", "0.95 1"), {"colours"}),
    ("film too large", scaled(FILM, 1.02), {"reach"}),
    ("film too high", raised(FILM, 0.3), {"closed", "open", "reach"}),
    ("too small to touch", scaled(PLATE, 0.98), {"reach"}),
    ("touches far out", scaled(BLOCK, 3.0), {"bulk", "reach"}),
)


@pytest.mark.parametrize(
    ("damage", "wanted"), [d[1:] for d in DAMAGES], ids=[d[0] for d in DAMAGES]
)
def test_damage(
    damaged: Path, failing: Callable[[Path], set[str]], damage: Damage, wanted: set[str]
) -> None:
    damage(damaged)
    assert failing(damaged) == {f"robot.{name}" for name in wanted}


def test_every_check_fails_for_some_damage(outputs: Path) -> None:
    from lumitip_fab.design.encoding import read_design

    told = {m.check for m in robot.measure(outputs, read_design(outputs / "design.json"))}
    assert told == {f"robot.{name}" for name in EVERY}
    one_by_one = [wanted for _, _, wanted in DAMAGES if wanted != EVERY]
    assert set().union(*one_by_one) == EVERY

"""Damage the view of the whole system, and exactly the right checks fail."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from damages import failing
from glb_damages import COLOURS, Scene, move, node, opened, rewritten, shift
from lumitip_fab.checks import system
from lumitip_fab.design.encoding import read_design
from lumitip_fab.docs.spec import rows

GLB, SVG = "assembly/system.glb", "assembly/system.svg"
SCENE = {"bodies", "stack", "place", "fingers", "tcp", "interference", "axis", "colours"}
DRAWING = {"drawing", "drawing_page"}


def robot_away(scene: Scene) -> None:
    shift(scene, "robot", z=-0.1)


def coupling_low(scene: Scene) -> None:
    shift(scene, "coupling", z=-0.1)


def lower_part_high(scene: Scene) -> None:
    shift(scene, "flange_lower", z=0.1)


def upper_part_high(scene: Scene) -> None:
    shift(scene, "flange_upper", z=0.1)


def upper_part_askew(scene: Scene) -> None:
    shift(scene, "flange_upper", x=0.1)


def board_in_the_wall(scene: Scene) -> None:
    shift(scene, "flange_board", x=0.4)


def coupling_without_its_recess(scene: Scene) -> None:
    primitive = scene["meshes"][node(scene, "coupling.body")["mesh"]]["primitives"][0]
    scene["accessors"][primitive["indices"]]["count"] = 3  # one triangle of its wall is left


def gripper_high(scene: Scene) -> None:
    shift(scene, "gripper", z=0.1)


def holder_high(scene: Scene) -> None:
    shift(scene, "holder", z=0.1)


def holder_off_its_board(scene: Scene) -> None:
    move(scene, "holder.tray", z=0.5)


def emitter_aside(scene: Scene) -> None:
    shift(scene, "emitter", x=0.1)


def emitter_in_the_receiver(scene: Scene) -> None:
    shift(scene, "emitter", x=-36.0)


def fingers_high(scene: Scene) -> None:
    for finger in ("emitter", "receiver"):
        shift(scene, finger, z=0.1)


def led_moved(scene: Scene) -> None:
    move(scene, "emitter.D7", x=0.1)


def centre_edited(scene: Scene) -> None:
    scene["scenes"][0]["extras"]["tcp_mm"] += 0.1


def centre_unstated(scene: Scene) -> None:
    del scene["scenes"][0]["extras"]["tcp_mm"]


def centre_in_words(scene: Scene) -> None:
    scene["scenes"][0]["extras"]["tcp_mm"] = "100 mm"


def centre_null(scene: Scene) -> None:
    scene["scenes"][0]["extras"]["tcp_mm"] = None


def body_renamed(scene: Scene) -> None:
    node(scene, "holder.tray")["name"] = "tray"


def no_nodes(scene: Scene) -> None:
    del scene["nodes"]


def gripper_aside(scene: Scene) -> None:
    move(scene, "gripper.envelope", y=0.36)


def robot_aside(scene: Scene) -> None:
    move(scene, "robot.flange", x=0.36)


MOVED = {
    **{damage: {"colours"} for damage in COLOURS},
    gripper_aside: {"axis"},
    robot_aside: {"axis"},
    robot_away: {"stack"},
    coupling_low: {"stack"},
    lower_part_high: {"stack", "place", "interference"},
    upper_part_high: {"stack", "place"},
    upper_part_askew: {"place"},
    board_in_the_wall: {"place", "interference"},
    coupling_without_its_recess: {"stack"},
    gripper_high: {"stack"},
    holder_high: {"place"},
    holder_off_its_board: {"place", "interference"},
    emitter_aside: {"fingers", "tcp"},
    emitter_in_the_receiver: {"fingers", "tcp", "interference"},
    fingers_high: {"stack", "fingers", "tcp"},
    led_moved: {"fingers"},
    centre_edited: {"tcp"},
    centre_unstated: {"tcp"},
    centre_in_words: {"tcp"},
    centre_null: {"tcp"},
    body_renamed: SCENE,
    no_nodes: SCENE,
}


@pytest.mark.parametrize("damage", MOVED, ids=lambda d: d.__name__)
def test_a_damaged_scene(damage: Callable[[Scene], None], damaged: Path) -> None:
    file = damaged / GLB
    file.write_bytes(rewritten(file.read_bytes(), damage))
    assert failing(damaged, "system") == MOVED[damage]


def truncated(data: bytes) -> bytes:
    return data[: len(data) // 2]


def tray_opened(data: bytes) -> bytes:
    return opened(data, "holder.tray")


BYTES = {truncated: SCENE, tray_opened: {"interference"}}


@pytest.mark.parametrize("damage", BYTES, ids=lambda d: d.__name__)
def test_damaged_bytes(damage: Callable[[bytes], bytes], damaged: Path) -> None:
    file = damaged / GLB
    file.write_bytes(damage(file.read_bytes()))
    assert failing(damaged, "system") == BYTES[damage]


MISSING = {
    GLB: SCENE,
    SVG: DRAWING,
    "assembly/assembly.glb": {"fingers"},
    "flange/flange_lower.stl": {"place"},
    "holder/holder.stl": {"place"},
}


@pytest.mark.parametrize("path", MISSING)
def test_a_missing_file(path: str, damaged: Path) -> None:
    (damaged / path).unlink()
    assert failing(damaged, "system") == MISSING[path]


def drawn(before: str, after: str) -> Callable[[str], str]:
    def edit(text: str) -> str:
        assert re.search(before, text, re.DOTALL)
        return re.sub(before, after, text, count=1, flags=re.DOTALL)

    return edit


def exchanged(text: str) -> str:
    """The names of coupling and gripper."""
    swapped = text.replace('id="coupling.body"', 'id="x"')
    swapped = swapped.replace('id="gripper.envelope"', 'id="coupling.body"')
    return swapped.replace('id="x"', 'id="gripper.envelope"')


DRAWN: dict[str, tuple[Callable[[str], str], set[str]]] = {
    "body missing": (drawn(r'<g id="holder.tray">.*?</g>', ""), {"drawing"}),
    "bodies exchanged": (exchanged, {"drawing"}),
    "page cut": (drawn(r'viewBox="(\S+)', 'viewBox="-40'), {"drawing_page"}),
    "not 1:1": (drawn(r'width="[\d.]+mm"', 'width="300mm"'), DRAWING),
    "truncated": (lambda text: text[: len(text) // 2], DRAWING),
}


@pytest.mark.parametrize("name", DRAWN)
def test_a_damaged_drawing(name: str, damaged: Path) -> None:
    damage, expected = DRAWN[name]
    file = damaged / SVG
    file.write_text(damage(file.read_text(encoding="utf-8")), encoding="utf-8")
    assert failing(damaged, "system") == expected


def test_every_check_fails_alone_or_among_few(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    scene = {m.check.removeprefix("system.") for m in system.measure(outputs, design)}
    assert scene == SCENE | DRAWING
    assert failing(outputs, "system") == set()
    few = [names for names in MOVED.values() if names != SCENE]
    few += [names for _, names in DRAWN.values() if names != DRAWING]
    assert set().union(*few) == scene - {"bodies"}


def test_the_figure_that_spec_tells_is_that_of_the_scene(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    (scene,) = [row for row in rows(design) if row.quantity == "... from the robot's flange"]
    (measured,) = [
        m for m in system.measure(outputs, design) if m.check == "system.tcp" and m.subject == GLB
    ]
    assert scene.computed == f"{measured.measured:.1f} mm"


def test_without_a_coupling_it_begins_at_the_gripper(design_dir: Path, tmp_path: Path) -> None:
    from lumitip_fab.config.load import load
    from lumitip_fab.derive import derive

    (tmp_path / "presets").mkdir()
    (tmp_path / "parts").mkdir()
    published = (design_dir / "presets/published.toml").read_bytes()
    (tmp_path / "presets/published.toml").write_bytes(published)
    file = tmp_path / "presets/mine.toml"
    file.write_text('extends = "published.toml"\n[flange]\nenabled = false\n')
    bare = derive(load(file))
    assert (bare.system.gripper_z_mm, bare.system.robot_mm, bare.flanges) == (0.0, 0.0, ())


def test_a_holder_is_shown_only_on_a_body_that_it_goes_round(design_dir: Path) -> None:
    from lumitip_fab.config.load import load
    from lumitip_fab.derive import derive

    shown = {
        name: derive(load(design_dir / f"presets/{name}.toml")).system.holders
        for name in ("published", "integrated", "wsg50")
    }
    assert shown == {"published": ("holder",), "integrated": (), "wsg50": ()}

"""Damage the assembly's GLB file, and exactly the right checks fail."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from damages import failing
from glb_damages import COLOURS, Scene, move, node, opened, rewritten
from lumitip_fab.checks import assembly, drawings

pytestmark = pytest.mark.slow

GLB = "assembly/assembly.glb"
SVG = "assembly/receiver_exploded.svg"
EVERY = {name.removeprefix("assembly.") for name in assembly.NAMES}


def led_moved(scene: Scene) -> None:
    move(scene, "emitter.D7", x=0.1)


def photodetector_moved(scene: Scene) -> None:
    move(scene, "receiver.Q32", y=-0.1)


def multiplexer_raised(scene: Scene) -> None:
    move(scene, "receiver.U1", z=0.6)


def multiplexer_through_the_skin(scene: Scene) -> None:
    move(scene, "receiver.U1", z=3.0)


def finger_shifted(scene: Scene) -> None:
    node(scene, "receiver")["matrix"][12] += 0.0001


def finger_nearer(scene: Scene) -> None:
    node(scene, "receiver")["matrix"][14] += 0.0001


def lean_removed(scene: Scene) -> None:
    matrix = node(scene, "receiver")["matrix"]
    matrix[:12] = np.eye(4).ravel()[:12].tolist()


def opening_edited(scene: Scene) -> None:
    scene["scenes"][0]["extras"]["opening_mm"] += 0.1


def opening_unstated(scene: Scene) -> None:
    del scene["scenes"][0]["extras"]


def film_lifted(scene: Scene) -> None:
    move(scene, "receiver.film", z=0.2)


def film_moved_back(scene: Scene) -> None:
    move(scene, "receiver.film", y=-1.5)


def film_behind_the_pads(scene: Scene) -> None:
    """The skin so far back that the gripper is closed before the fingers meet."""
    move(scene, "receiver.film", z=-12.0)


def backing_sunk(scene: Scene) -> None:
    move(scene, "emitter.backing", z=-0.2)


def board_turned_out(scene: Scene) -> None:
    move(scene, "emitter.board", x=0.3)


def part_renamed(scene: Scene) -> None:
    node(scene, "receiver.Q3")["name"] = "receiver.Q33"


def layer_missing(scene: Scene) -> None:
    node(scene, "emitter.silicone")["name"] = "silicone"


def no_nodes(scene: Scene) -> None:
    del scene["nodes"]


SCENE = {
    **{damage: {"colours"} for damage in COLOURS},
    led_moved: {"facing"},
    photodetector_moved: {"facing"},
    multiplexer_raised: {"interference"},
    multiplexer_through_the_skin: {"interference"},
    finger_shifted: {"facing"},
    finger_nearer: {"opening"},
    lean_removed: {"lean", "opening", "skew", "stroke"},
    opening_edited: {"opening"},
    opening_unstated: {"opening"},
    film_lifted: {"opening", "stroke"},
    film_moved_back: {"first_contact", "opening", "interference"},
    film_behind_the_pads: {"opening", "stroke", "closes", "interference"},
    backing_sunk: {"stroke", "interference"},
    board_turned_out: {"interference"},
    part_renamed: EVERY,
    layer_missing: EVERY,
    no_nodes: EVERY,
}


@pytest.mark.parametrize("damage", SCENE, ids=lambda d: d.__name__)
def test_a_damaged_scene(damage: Callable[[Scene], None], damaged: Path) -> None:
    file = damaged / GLB
    file.write_bytes(rewritten(file.read_bytes(), damage))
    assert failing(damaged, "assembly") == SCENE[damage]


def truncated(data: bytes) -> bytes:
    return data[: len(data) // 2]


def foreign(_: bytes) -> bytes:
    return b"solid nothing"


def film_opened(data: bytes) -> bytes:
    return opened(data, "emitter.film")


BYTES = {truncated: EVERY, foreign: EVERY, film_opened: {"interference"}}


@pytest.mark.parametrize("damage", BYTES, ids=lambda d: d.__name__)
def test_damaged_bytes(damage: Callable[[bytes], bytes], damaged: Path) -> None:
    file = damaged / GLB
    file.write_bytes(damage(file.read_bytes()))
    assert failing(damaged, "assembly") == BYTES[damage]


def step_truncated(text: str) -> str:
    return text[: len(text) - 100]


def step_without_a_part(text: str) -> str:
    return text.replace("MANIFOLD_SOLID_BREP(", "BREP_WITH_VOIDS(", 1)


def step_without_a_name(text: str) -> str:
    return text.replace("'receiver.film'", "'film'")


def step_in_inches(text: str) -> str:
    return text.replace(".MILLI.", "$")


@pytest.mark.parametrize(
    "damage", [step_truncated, step_without_a_part, step_without_a_name, step_in_inches]
)
def test_a_damaged_step(damage: Callable[[str], str], damaged: Path) -> None:
    file = damaged / "assembly/assembly.step"
    file.write_text(damage(file.read_text(encoding="ascii")), encoding="ascii")
    assert failing(damaged, "assembly") == {"step"}


def test_a_missing_step(damaged: Path) -> None:
    (damaged / "assembly/assembly.step").unlink()
    assert failing(damaged, "assembly") == {"step"}


def test_a_missing_file_fails_every_check(damaged: Path) -> None:
    (damaged / GLB).unlink()
    assert failing(damaged, "assembly") == EVERY


def drawn(before: str, after: str) -> Callable[[str], str]:
    def edit(text: str) -> str:
        assert re.search(before, text, re.DOTALL)
        return re.sub(before, after, text, count=1, flags=re.DOTALL)

    return edit


def silicone_blank(text: str) -> str:
    """The group is there, but nothing in it."""
    return drawn(r'(<g id="silicone">).*?</g>', r"\1</g>")(text)


def film_over_the_board(text: str) -> str:
    """The names of two layers exchanged."""
    swapped = text.replace('id="film"', 'id="x"').replace('id="board"', 'id="film"')
    return swapped.replace('id="x"', 'id="board"')


def smaller(text: str) -> str:
    return re.sub(r"(-?[\d.]+),(-?[\d.]+)", lambda m: f"{float(m[1]) * 0.99:.2f},{m[2]}", text)


def part_astray(text: str) -> str:
    """All of Q5 half a millimetre to the right."""
    start = text.index('<g id="Q5">')
    end = text.index("</g>", start)
    scene = re.sub(r"([ML])(-?[\d.]+)", lambda m: f"{m[1]}{float(m[2]) + 0.5:.2f}", text[start:end])
    return text[:start] + scene + text[end:]


EVERY_DRAWING = {name.removeprefix("assembly.") for name in drawings.NAMES}
DRAWINGS: dict[str, tuple[Callable[[str], str], set[str]]] = {
    "part missing": (drawn(r'<g id="Q7">.*?</g>', ""), {"drawing"}),
    "part astray": (part_astray, {"drawing"}),
    "layer missing": (drawn(r'<g id="film">', "<g>"), EVERY_DRAWING),
    "layer blank": (silicone_blank, EVERY_DRAWING),
    "layers exchanged": (film_over_the_board, {"drawing"}),
    "drawn smaller": (smaller, {"drawing"}),
    "page cut": (drawn(r'viewBox="(\S+)', 'viewBox="-40'), {"drawing_page"}),
    "label off the page": (
        drawn(r'x="[-\d.]+"( y="[-\d.]+" text-anchor="end")', r'x="-80"\1'),
        {"drawing_page"},
    ),
    "not 1:1": (drawn(r'width="[\d.]+mm"', 'width="300mm"'), EVERY_DRAWING),
    "truncated": (lambda text: text[: len(text) // 2], EVERY_DRAWING),
}


@pytest.mark.parametrize("name", DRAWINGS)
def test_a_damaged_drawing(name: str, damaged: Path) -> None:
    damage, expected = DRAWINGS[name]
    file = damaged / SVG
    file.write_text(damage(file.read_text(encoding="utf-8")), encoding="utf-8")
    assert failing(damaged, "assembly") == expected


def test_the_undamaged_assembly_passes(outputs: Path) -> None:
    assert failing(outputs, "assembly") == set()


def test_every_check_fails_alone_or_among_few() -> None:
    scene = [names for names in SCENE.values() if names != EVERY]
    assert set().union(*scene) == EVERY - {"bodies"}

"""What PCB fabs get: layers, drills and lists, and what each house makes of an angle."""

import dataclasses
import io
import math
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import shapely
from gerbonara.layers import LayerStack

from lumitip_fab.boards.fab import gerber as objects
from lumitip_fab.boards.fab.order import angle_at
from lumitip_fab.boards.placed import placed_pads
from lumitip_fab.checks.readers.gerber import drilled, gerber_area
from lumitip_fab.design import Box, Component, Fab, Footprint, Pad

pytestmark = pytest.mark.slow

BOX = Box(-1, 1, -1, 1)
MUX = Footprint("SOP65P640X110-16N", (Pad("1", -2, -3, 1, 1),), BOX, 1.1)
SOT = Footprint("SOT95P360X100-6N", (Pad("1", -1, -1, 1, 1),), BOX, 1.0)
SOT23 = Footprint("SOT190P320X110-3N", (Pad("1", -1, -1, 1, 1),), BOX, 1.1)
ARRAY = Footprint("RESCAV80P320160X60-8N", (Pad("1", -1, -1, 1, 1),), BOX, 0.6)
CHIP = Footprint("LEDC1608X60N", (Pad("1", -0.6, 0, 0.8, 1.0),), BOX, 0.6)


def part(shape: Footprint, angle: float, side: str) -> Component:
    return Component("U1", "", "x", "led", shape, 0, 0, angle, side, ())  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def fabs(designs: Callable[..., object]) -> dict[str, Fab]:
    return {fab.name: fab for fab in designs("small").fabs}  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("fab", "shape", "angle", "side", "told"),
    [
        # Lead 1 of ours is at the lower left, which is where this house has it.
        ("jlcpcb", MUX, 0, "front", 0),
        # By IPC-7351 it is at the upper left: ours is that, turned by 90°.
        ("pcbway", MUX, 0, "front", 90),
        ("generic", MUX, 90, "front", 180),
        # Its TSOT-26 too; of SOT-23 it has lead 1 at the lower right, along the right side.
        ("jlcpcb", SOT, 0, "front", 0),
        ("jlcpcb", SOT23, 0, "front", 270),
        ("pcbway", SOT, 0, "front", 90),
        ("pcbway", SOT23, 0, "front", 90),
        ("generic", SOT, 270, "front", 0),
        ("jlcpcb", ARRAY, 270, "front", 270),
        ("pcbway", ARRAY, 270, "front", 0),
        ("jlcpcb", CHIP, 270, "front", 270),
        ("pcbway", CHIP, 270, "front", 270),
        # Seen from behind, counter-clockwise is the other way.
        ("jlcpcb", CHIP, 30, "back", 330),
        ("generic", CHIP, 30, "back", 210),
    ],
)
def test_angles(
    fabs: dict[str, Fab], fab: str, shape: Footprint, angle: float, side: str, told: float
) -> None:
    assert angle_at(part(shape, angle, side), fabs[fab]) == told


def test_the_longest_beginning_of_a_name_counts(fabs: dict[str, Fab]) -> None:
    table = dataclasses.replace(fabs["generic"], rotations=(("S", 10.0), ("SOP65", 20.0)))
    assert angle_at(part(MUX, 0, "front"), table) == 20


def package(folder: Path, fab: str, finger: str = "receiver") -> dict[str, bytes]:
    path = folder / "boards" / finger / "order" / f"{fab}_{finger}.zip"
    with zipfile.ZipFile(path) as opened:
        assert opened.testzip() is None
        assert {i.date_time for i in opened.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        return {name: opened.read(name) for name in opened.namelist()}


@pytest.mark.parametrize("fab", ["generic", "jlcpcb", "pcbway"])
def test_a_zip_is_understood_by_its_names_alone(
    boards: Callable[[str], Path], tmp_path: Path, fab: str
) -> None:
    """A reader that knows nothing of the board finds every layer among the files."""
    for name, data in package(boards("small"), fab).items():
        (tmp_path / name).write_bytes(data)
    stack = LayerStack.open(tmp_path)
    for side in ("top", "bottom"):
        for use in ("copper", "mask", "paste", "silk"):
            assert (side, use) in stack.graphic_layers
    assert stack.outline is not None
    left, low, right, high = (v for p in stack.board_bounds() for v in p)
    assert right - left == pytest.approx(32.4 + 0.1, abs=0.01)
    assert high > low
    assert len(list(stack.drill_layers)) == 2


def test_every_layer_says_what_it_is(boards: Callable[[str], Path]) -> None:
    files = package(boards("small"), "generic")
    told = {
        name.partition("-")[2]: re.search(rb"TF\.FileFunction,([^*\n]+)", data)
        for name, data in files.items()
        if not name.endswith(".csv")
    }
    functions = {name: match[1].decode() for name, match in told.items() if match}
    assert functions == {
        "F_Cu.gbr": "Copper,L1,Top",
        "B_Cu.gbr": "Copper,L2,Bot",
        "F_Mask.gbr": "Soldermask,Top",
        "B_Mask.gbr": "Soldermask,Bot",
        "F_Paste.gbr": "Paste,Top",
        "B_Paste.gbr": "Paste,Bot",
        "F_Silkscreen.gbr": "Legend,Top",
        "B_Silkscreen.gbr": "Legend,Bot",
        "Edge_Cuts.gbr": "Profile,NP",
        "PTH.drl": "Plated,1,2,PTH",
        "NPTH.drl": "NonPlated,1,2,NPTH",
    }


def test_every_command_of_a_gerber_is_whole(boards: Callable[[str], Path]) -> None:
    for name, data in package(boards("small"), "generic").items():
        if name.endswith(".gbr"):
            lines = data.decode().splitlines()
            assert [line for line in lines if not re.fullmatch(r"%?[^*%]+\*%?", line)] == []
            assert lines[-1] == "M02*"


def test_copper_names_its_nets_and_pins(boards: Callable[[str], Path]) -> None:
    copper = package(boards("small"), "generic")["receiver-F_Cu.gbr"].decode()
    assert "%TO.P,U1,13*%" in copper
    assert {"GND", "3V3", "Q1", "N/C"} <= set(re.findall(r"%TO\.N,([^*]+)\*%", copper))


def test_a_turned_pad_is_painted_as_it_lies() -> None:
    from gerbonara.rs274x import GerberFile

    for angle in (0, 30, 90, 200, 270):
        (pad,) = placed_pads(part(CHIP, angle, "front"))
        painted = gerber_area(GerberFile(objects=[objects.flashed(pad)]).write_to_bytes().decode())
        assert painted.symmetric_difference(pad.area).area < 1e-3


def test_drills_are_the_holes_of_the_board(boards: Callable[[str], Path]) -> None:
    files = package(boards("small"), "generic")
    unplated = drilled(files["receiver-NPTH.drl"].decode())
    assert {d for *_, d in unplated} == {2.1}
    plated = np.array(drilled(files["receiver-PTH.drl"].decode()))
    assert sorted(set(plated[:, 2].tolist())) == [0.3, 1.2]


def test_the_reader_understands_clear_objects_and_arcs() -> None:
    text = (
        "%FSLAX46Y46*%\n%MOMM*%\n%LPD*%\n%ADD10C,1.0*%\n%ADD11C,2.0*%\nD11*\nX0Y0D03*\n"
        "%LPC*%\nD10*\nX0Y0D03*\n%LPD*%\nD10*\nG75*\nX10000000Y0D02*\nG03*\n"
        "X-10000000Y0I-10000000J0D01*\nM02*\n"
    )
    ring, bow = math.pi * (1 - 0.25), math.pi * 10 * 1.0 + math.pi / 4
    assert gerber_area(text).area == pytest.approx(ring + bow, rel=1e-3)
    assert shapely.get_num_geometries(gerber_area(text)) == 2


def test_pictures_are_pictures(boards: Callable[[str], Path]) -> None:
    from PIL import Image

    folder = boards("small") / "boards" / "receiver"
    with Image.open(io.BytesIO((folder / "receiver_front.png").read_bytes())) as picture:
        assert picture.size == pytest.approx(((32.4 + 2) * 32, (31.6 + 2) * 32), abs=40)
        colours = {c for _, c in picture.convert("RGB").getcolors(1 << 24) or []}
    assert {(25, 27, 29), (48, 51, 54), (216, 180, 101), (243, 242, 234)} <= colours
    assert (folder / "receiver_back.svg").read_text().count("<path") == 6

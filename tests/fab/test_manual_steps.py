"""The words of the manual's steps: needs, signs, order, names of things, tools and parts."""

import csv
import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip_fab.design.encoding import read_design
from lumitip_fab.docs.casting import casting_steps
from lumitip_fab.docs.mounting import mounting_steps
from manual_reader import read_pdf

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
HTML, PDF = "manual/manual.html", "manual/manual.pdf"
PRESETS = sorted(file.stem for file in (ROOT / "design/presets").glob("*.toml"))


def test_each_step_says_what_is_needed_and_what_the_signs_mean(outputs: Path) -> None:
    steps = re.findall(
        r"<h2>\d+\. (.*?)</h2>(.*?)(?=<h2>|</body>)",
        (outputs / HTML).read_text(encoding="utf-8"),
        re.DOTALL,
    )
    titles = [title for title, _ in steps]
    assert (titles[0], titles[-1]) == ("Parts", "What wears")  # a list, and advice
    for title, text in steps[1:-1]:
        assert "<strong>You need:</strong>" in text, title
        assert "<strong>Time:</strong>" in text, title
        assert "<th>what it means, what to do</th>" in text, title
    first, last = titles.index("Put the board in"), titles.index("Wrap the finger")
    assert last - first == 9
    for title, text in steps[first : last + 1]:
        assert "data-file=" in text or title == "Try the silicone"


def test_the_force_that_a_finger_bears_is_named_before_the_gripper_closes(outputs: Path) -> None:
    strength = read_design(outputs / "design.json").strength
    text = (outputs / HTML).read_text(encoding="utf-8")
    assert f"<td>{strength.rated_force_n:g} N</td>" in text[: text.index("<h2>1. Parts</h2>")]
    mount = " ".join(
        (chapter(outputs, "Mount the controller") + chapter(outputs, "Mount the fingers")).split()
    )
    limit = mount.index(f"Limit the force of the gripper to {strength.rated_force_n:g} N")
    assert f"up to {strength.gripper_n:g} N, which can break a finger" in mount
    assert limit < mount.index("Many grippers are activated") < mount.index("screw each finger")
    assert mount.index("screw each finger on") < mount.index("Open and close the gripper")


@pytest.mark.parametrize("preset", PRESETS)
def test_a_thing_has_one_name(built: Callable[[str], Path], preset: str) -> None:
    folder = built(preset)
    design = read_design(folder / "design.json")
    front, *steps = plain(folder).split("You need:")
    assert ("coupling" in " ".join([front, *steps])) == bool(design.flanges)
    assert ("on the gripper: " in front) and "finger bolt" in front
    for text in steps:
        assert not re.search(r"gripper's (own )?bolts?\b|the coupling towards", text)
    printed = next(text for text in steps if "fit/fit_plate.3mf" in text)
    assert ("a board goes into a coupon" in printed) == bool(design.fit_plate.corners)


def test_what_cuts_and_what_looks_closer_is_among_the_tools(outputs: Path) -> None:
    tools = plain(outputs).partition("Used up.")[0]
    needs = " ".join(re.findall(r"You need:(.*?)Time:", plain(outputs)))
    for tool in ("a lens", "safety glasses", "thin sheet metal", "calipers"):
        assert tool in tools and tool in needs, tool
    run = " ".join(chapter(outputs, "Warm-up and calibration").split())
    assert "the gauge card, thin sheet metal" in run and "25 min" in run
    assert "calipers" in chapter(outputs, "Mount the fingers").partition("Time:")[0]


def plain(folder: Path) -> str:
    text = (folder / HTML).read_text(encoding="utf-8")
    return " ".join(re.sub(r"<style>.*?</style>|<[^>]*>", " ", text, flags=re.DOTALL).split())


def test_heat_and_spare_parts_are_named_where_boards_are_made(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    solder, boards = design.heat_steps["solder"], " ".join(_boards(outputs).split())
    joint, limit = f"{solder.temperature_c:g} °C", f"{solder.limit_c:g} °C"
    assert f"Joints reach {joint}, and the board of FR-4 bears {limit}" in boards
    cells = sum(part.kind == "led" for part in design.emitter.parts)
    assert f"({cells} LEDs, {cells} photodetectors) all go onto the boards" in boards


def test_parts_without_a_number_are_named_with_what_to_do(outputs: Path) -> None:
    boards = " ".join(_boards(outputs).split())
    without = set()
    for board in ("emitter", "receiver", "breakout", "flange"):
        path = outputs / f"boards/{board}/order/jlcpcb_{board}_bom.csv"
        with path.open(encoding="utf-8") as file:
            rows = [*csv.reader(file)]
        number = next(i for i, head in enumerate(rows[0]) if "LCSC" in head or "JLCPCB" in head)
        without |= {board for row in rows[1:] if not row[number]}
    assert "emitter" in without, "of the published LED no number is known"
    found = re.search(r"No number of JLCPCB's distributor is known for (.*?): buy", boards)
    assert found and read_design(outputs / "design.json").packages.led_name in found[1]


@pytest.mark.parametrize("preset", PRESETS)
def test_cells_are_counted_as_the_parts_but_from_0(
    built: Callable[[str], Path], preset: str
) -> None:
    folder = built(preset)
    assert "cell 0 is D1 and Q1, cell 1 is D2 and Q2" in plain(folder)
    for finger, letter in zip(read_design(folder / "design.json").fingers, "DQ", strict=True):
        parts = {part.name: part for part in finger.parts}
        for number, (x_mm, y_mm) in enumerate(finger.cells, 1):
            part = parts[f"{letter}{number}"]
            assert math.hypot(part.x_mm - x_mm, part.y_mm - y_mm) < 1.0


def test_the_windows_that_are_closed_are_those_of_the_finger_that_has_them(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    assert [bool(finger.reliefs) for finger in design.fingers] == [True, False]
    board = " ".join(chapter(outputs, "Put the board in").split())
    assert "On the emitter, close every window on the back" in board
    assert "but not the wire notch" in board
    assert "and all tape off" in " ".join(chapter(outputs, "Take the finger out").split())


def test_faces_that_lean_touch_near_the_tip_first(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    assert design.mount.tilt_deg > 0
    assert "the faces touch near the tip first" in " ".join(
        chapter(outputs, "Mount the fingers").split()
    )
    upright = replace(design, mount=replace(design.mount, tilt_deg=0.0))
    assert "both faces are parallel" in "".join(mounting_steps(upright))


def test_how_long_the_silicone_is_worked_and_how_a_skin_comes_off(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    filled = " ".join(chapter(outputs, "Fill the mould").split())
    assert f"worked for some {design.mould.pot_life_min:g} min" in filled
    unknown = replace(design, mould=replace(design.mould, pot_life_min=0.0))
    (step,) = (s for s in casting_steps(unknown, unknown.fingers) if s.title == "Fill the mould")
    assert "is in its data sheet" in step.text and " 0 min" not in step.text
    skin = " ".join(chapter(outputs, "What wears").split())
    assert f"Push the {len(design.keys)} plugs of silicone" in skin
    flange = " ".join(chapter(outputs, "Put the flange in").split())
    assert f"Let the glue harden for {design.mould.glue_hard_h:g} h" in flange


@pytest.mark.parametrize(
    ("gripper_n", "said"),
    [(0.0, "is in its maker's data sheet"), (30.0, "closes with up to 30 N.")],
    ids=["not known", "weaker"],
)
def test_a_gripper_that_breaks_nothing_is_not_said_to(
    outputs: Path, gripper_n: float, said: str
) -> None:
    design = read_design(outputs / "design.json")
    other = replace(design, strength=replace(design.strength, gripper_n=gripper_n))
    assert said in "".join(mounting_steps(other))
    assert "break a finger" not in "".join(mounting_steps(other))


def _boards(outputs: Path) -> str:
    return chapter(outputs, "Order the boards") + chapter(outputs, "Solder the boards")


def chapter(outputs: Path, title: str) -> str:
    text = (outputs / HTML).read_text(encoding="utf-8")
    found = re.search(rf"<h2>\d+\. {title}</h2>(.*?)(?=<h2>|</body>)", text, re.DOTALL)
    assert found
    return found[1]


def test_what_a_step_uses_up_is_in_the_list_of_parts(outputs: Path) -> None:
    text = (outputs / HTML).read_text(encoding="utf-8")
    needs = re.findall(r"<strong>You need:</strong>(.*?)<strong>", text, re.DOTALL)
    needed = {
        re.sub(r"^an? (new )?", "", n.strip(" .\n")) for all_ in needs for n in all_.split(",")
    }
    design = read_design(outputs / "design.json")
    supplies = {p.item for p in design.purchase.pieces if p.group == "supplies"}
    shared = {" ".join(need.split()) for need in needed} & supplies
    assert {"isopropanol", "nitrile gloves", "wooden stick", "knife blade", "plain paper"} <= shared
    listed = set(re.findall(r"<td>(.*?)</td>", chapter(outputs, "Parts")))
    assert supplies <= listed


def test_flange_and_mounting_are_numbered_lists_from_the_robot_to_the_fingers(
    outputs: Path,
) -> None:
    orders = {
        "Look at the coupling": [
            "tool output off",
            "Take the gripper off",
            "carry what the drawing",
        ],
        "Try the flange board": [
            "Press the socket",
            "spring contacts",
            "Try the board on the bench",
        ],
        "Put the flange in": ["flange_upper", "Put the flange"],
        "Mount the controller": [
            "stay off",
            "holder.3mf",
            "Connect the gripper",
            "plug the socket of W3",
            "activate the gripper",
        ],
        "Mount the fingers": [
            "along the outside of its cable lugs",
            "Many grippers are activated",
            "screw each finger",
            "Open and close",
        ],
    }
    titles = re.findall(r"<h2>\d+\. (.*?)</h2>", (outputs / HTML).read_text(encoding="utf-8"))
    assert [title for title in titles if title in orders] == list(orders)
    for title, order in orders.items():
        (work,) = re.findall(r"<ol>(.*?)</ol>", chapter(outputs, title), re.DOTALL)
        assert sorted(order, key=work.index) == order
        assert work.count("<li>") >= len(order) - 1


def test_the_gripper_s_bolts_have_a_standard_length(outputs: Path) -> None:
    (flange,) = read_design(outputs / "design.json").flanges
    _, lengths = chapter(outputs, "Look at the coupling").split("Length of the flange bolts")
    cells = re.findall(r"<td[^>]*>([^<]*)</td>", lengths)
    rows = [cells[at : at + 4] for at in range(0, 16, 4)]
    for own, least, ordered, deeper in rows:
        least_mm, length_mm = float(least.split()[0]), float(ordered.split()[-1])
        assert least_mm == pytest.approx(float(own.split()[0]) + flange.top_z_mm, abs=0.05)
        assert length_mm % 5 == 0 and -0.5 <= length_mm - least_mm < 5
        assert float(deeper.split()[0]) == pytest.approx(length_mm - least_mm, abs=0.05)
        assert ordered.startswith(f"{flange.bolt} x ")


def test_protection_is_tested_before_the_wires_go_in(outputs: Path) -> None:
    sheets, _ = read_pdf(outputs / PDF)
    text = "".join(sheets)
    said = (
        "no short.",
        "Measure that no wire",
        "Try the board on the bench",
        "peaks of the supply.",
    )
    at = [text.rindex(words.replace(" ", "")) for words in said]
    assert at == sorted(at)

"""The manual has the design's figures and drawings; each comparison sees a damage."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pikepdf
import pytest

from damages import edit, excerpt
from lumitip_fab.design.encoding import read_design
from lumitip_fab.docs.casting import casting_steps
from lumitip_fab.docs.mounting import mounting
from manual_figures import measure, read_pdf

pytestmark = pytest.mark.slow

_NEEDED = (
    "assembly",
    "backing",
    "boards",
    "firmware",
    "fit",
    "flange",
    "gauge",
    "holder",
    "manual",
    "mask",
    "mould",
    "print",
    "wiring",
)
ROOT = Path(__file__).parents[2]
HTML, PDF = "manual/manual.html", "manual/manual.pdf"


@pytest.fixture
def copied(outputs: Path, tmp_path: Path) -> Path:
    """The manual of the published design and all that it names, to damage."""
    return excerpt(outputs, tmp_path / "told", "bom.csv", *_NEEDED)


def failing(folder: Path) -> set[str]:
    found = measure(folder, read_design(folder / "design.json"))
    return {m.check.removeprefix("manual.") for m in found if not m.passed}


# What is replaced in the HTML, by what, and the checks that then fail: the PDF says it still.
EDITS = [
    ("<td>24 h</td>", "<td>12 h</td>", {"figures", "units", "pdf"}),
    ("Leave it for 24 h", "Leave it for 2 h", {"units", "pdf"}),
    ("alone to 90 °C", "alone to 190 °C", {"units", "pdf"}),
    ("<td>24 V</td>", "<td>5 V</td>", {"figures"}),
    ("<td>1 x M5 x 12</td>", "<td>1 x M4 x 12</td>", {"figures", "pdf"}),
    ("<td>warm-up</td>", "<td>cool-down</td>", {"figures", "pdf"}),
    ("<code>fit/fit_plate.3mf</code>", "<code>fit/plate.3mf</code>", {"files", "pdf"}),
    ('data-file="wiring/wiring.svg"', 'data-file="wiring/cables.svg"', {"drawings"}),
    ('data-file="assembly/system.svg"', 'data-file="assembly/robot.svg"', {"drawings"}),
    ("2.53 g", "3.53 g", {"amounts", "pdf"}),
    ("<td>W2.3</td>", "<td>W2.4</td>", {"wires"}),
    ("<td>used by one pair of fingers</td>", "<td>altogether</td>", {"parts", "pdf"}),
]


PRESETS = sorted(file.stem for file in (ROOT / "design/presets").glob("*.toml"))


@pytest.mark.parametrize("preset", PRESETS)
def test_the_manual_of_a_preset_agrees_with_its_design(
    built: Callable[[str], Path], preset: str
) -> None:
    assert failing(built(preset)) == set()


@pytest.mark.parametrize(("old", "new", "expected"), EDITS)
def test_a_damage_fails_its_check(copied: Path, old: str, new: str, expected: set[str]) -> None:
    edit(copied / HTML, old, new)
    assert failing(copied) == expected


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        ("manual/lowered.svg", "mm", "cm", {"drawings"}),
        ("mould/receiver_casting.md", "part A | **", "part A | **1", {"amounts"}),
        ("wiring/cables.md", "| W1.2 | RD red", "| W1.2 | BU blue", {"wires"}),
        ("wiring/wiring.svg", "Emitter", "Radiator", {"drawings"}),
        ("bom.csv", "Solaris", "Lunaris", {"parts"}),
    ],
)
def test_a_manual_of_another_build_is_seen(
    copied: Path, file: str, old: str, new: str, expected: set[str]
) -> None:
    edit(copied / file, old, new)
    assert failing(copied) == expected


def test_a_picture_of_another_board_is_seen(copied: Path) -> None:
    other = (copied / "boards/receiver/receiver_back.png").read_bytes()
    (copied / "boards/emitter/emitter_back.png").write_bytes(other)
    assert failing(copied) == {"drawings"}


def test_the_back_of_the_emitter_is_shown_where_parts_are_there(copied: Path) -> None:
    text = (copied / HTML).read_text(encoding="utf-8")
    back = re.compile(r'<span class="pair"><img [^>]*emitter_back.png[^>]*>.*?</span>', re.DOTALL)
    (copied / HTML).write_text(back.sub("", text, count=1), encoding="utf-8")
    assert failing(copied) == {"drawings"}


def test_a_page_that_is_lost_is_seen(copied: Path) -> None:
    with pikepdf.open(copied / PDF, allow_overwriting_input=True) as document:
        assert len(document.pages) > 6
        del document.pages[6]
        document.save(copied / PDF)
    assert failing(copied) == {"pdf"}


def test_a_font_that_is_left_out_is_seen(copied: Path) -> None:
    with pikepdf.open(copied / PDF, allow_overwriting_input=True) as document:
        font = next(iter(document.pages[0].resources.Font.values()))
        del font["/FontDescriptor"]["/FontFile2"]
        document.save(copied / PDF)
    assert failing(copied) == {"fonts"}


def test_lost_files_are_told(copied: Path) -> None:
    (copied / PDF).unlink()
    assert failing(copied) == {"pdf", "fonts"}
    (copied / HTML).write_bytes(b"\xff\xfe")
    assert failing(copied) == {"readable"}


def test_the_pdf_tells_no_day(outputs: Path) -> None:
    data = (outputs / PDF).read_bytes()
    assert b"D:20000101000000" in data
    assert not re.search(rb"D:(?!20000101)\d{8}", data)


def test_each_step_says_what_is_needed_and_what_the_signs_mean(copied: Path) -> None:
    steps = re.findall(
        r"<h2>\d+\. (.*?)</h2>(.*?)(?=<h2>|</body>)",
        (copied / HTML).read_text(encoding="utf-8"),
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


def test_the_force_that_a_finger_bears_is_named_before_the_gripper_closes(copied: Path) -> None:
    strength = read_design(copied / "design.json").strength
    text = (copied / HTML).read_text(encoding="utf-8")
    assert f"<td>{strength.rated_force_n:g} N</td>" in text[: text.index("<h2>1. Parts</h2>")]
    mount = chapter(copied, "Mount")
    mount = " ".join(mount.split())
    limit = mount.index(f"Limit the force of the gripper to {strength.rated_force_n:g} N")
    assert f"up to {strength.gripper_n:g} N, which can break a finger" in mount
    assert limit < mount.index("screw each finger on") < mount.index("open and close the gripper")


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


def test_what_cuts_and_what_looks_closer_is_among_the_tools(copied: Path) -> None:
    tools = plain(copied).partition("Used up.")[0]
    needs = " ".join(re.findall(r"You need:(.*?)Time:", plain(copied)))
    for tool in ("a lens", "safety glasses", "thin sheet metal", "calipers"):
        assert tool in tools and tool in needs, tool
    run = " ".join(chapter(copied, "Warm-up and calibration").split())
    assert "the gauge card, thin sheet metal, calipers" in run and "25 min" in run


def plain(folder: Path) -> str:
    text = (folder / HTML).read_text(encoding="utf-8")
    return " ".join(re.sub(r"<style>.*?</style>|<[^>]*>", " ", text, flags=re.DOTALL).split())


def test_heat_and_spare_parts_are_named_where_boards_are_made(copied: Path) -> None:
    design = read_design(copied / "design.json")
    solder, boards = design.heat_steps["solder"], " ".join(chapter(copied, "Boards").split())
    joint, limit = f"{solder.temperature_c:g} °C", f"{solder.limit_c:g} °C"
    assert f"Joints reach {joint}, and the board of FR-4 bears {limit}" in boards
    cells = sum(part.kind == "led" for part in design.emitter.parts)
    assert f"({cells} LEDs, {cells} photodetectors) all go onto the boards" in boards


def test_how_long_the_silicone_is_worked_and_how_a_skin_comes_off(copied: Path) -> None:
    design = read_design(copied / "design.json")
    filled = " ".join(chapter(copied, "Fill the mould").split())
    assert f"worked for some {design.mould.pot_life_min:g} min" in filled
    unknown = replace(design, mould=replace(design.mould, pot_life_min=0.0))
    (step,) = (s for s in casting_steps(unknown, unknown.fingers) if s.title == "Fill the mould")
    assert "is in its data sheet" in step.text and " 0 min" not in step.text
    skin = " ".join(chapter(copied, "What wears").split())
    assert f"Push the {len(design.keys)} plugs of silicone" in skin
    flange = " ".join(chapter(copied, "Flange").split())
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
    assert said in mounting(other)
    assert "break a finger" not in mounting(other)


def chapter(copied: Path, title: str) -> str:
    text = (copied / HTML).read_text(encoding="utf-8")
    found = re.search(rf"<h2>\d+\. {title}</h2>(.*?)(?=<h2>|</body>)", text, re.DOTALL)
    assert found
    return found[1]


def test_what_a_step_uses_up_is_in_the_list_of_parts(copied: Path) -> None:
    text = (copied / HTML).read_text(encoding="utf-8")
    needs = re.findall(r"<strong>You need:</strong>(.*?)<strong>", text, re.DOTALL)
    needed = {
        re.sub(r"^an? (new )?", "", n.strip(" .\n")) for all_ in needs for n in all_.split(",")
    }
    design = read_design(copied / "design.json")
    supplies = {p.item for p in design.purchase.pieces if p.group == "supplies"}
    shared = {" ".join(need.split()) for need in needed} & supplies
    assert {"isopropanol", "nitrile gloves", "wooden stick", "knife blade", "plain paper"} <= shared
    listed = set(re.findall(r"<td>(.*?)</td>", chapter(copied, "Parts")))
    assert supplies <= listed


def test_flange_and_mounting_are_numbered_lists_from_the_robot_to_the_fingers(
    copied: Path,
) -> None:
    orders = {
        "Flange": [
            "Choose the gripper's cable",
            "Press the socket",
            "tool output off",
            "Take the gripper off",
            "flange_upper",
            "Put the flange",
        ],
        "Mount": [
            "stay off",
            "holder.3mf",
            "Connect the gripper",
            "plug the socket of W3",
            "activate the gripper",
            "Tie each finger",
            "screw each finger",
            "open and close",
        ],
    }
    for title, order in orders.items():
        (work,) = re.findall(r"<ol>(.*?)</ol>", chapter(copied, title), re.DOTALL)
        assert sorted(order, key=work.index) == order
        assert work.count("<li>") >= len(order) - 1


def test_the_gripper_s_bolts_have_a_standard_length(copied: Path) -> None:
    (flange,) = read_design(copied / "design.json").flanges
    _, lengths = chapter(copied, "Flange").split("Length of the flange bolts")
    cells = re.findall(r"<td[^>]*>([^<]*)</td>", lengths)
    rows = [cells[at : at + 4] for at in range(0, len(cells), 4)]
    assert len(rows) == 4
    for own, least, ordered, deeper in rows:
        least_mm, length_mm = float(least.split()[0]), float(ordered.split()[-1])
        assert least_mm == pytest.approx(float(own.split()[0]) + flange.top_z_mm, abs=0.05)
        assert length_mm % 5 == 0 and -0.5 <= length_mm - least_mm < 5
        assert float(deeper.split()[0]) == pytest.approx(length_mm - least_mm, abs=0.05)
        assert ordered.startswith(f"{flange.bolt} x ")


def test_nothing_stands_twice(copied: Path) -> None:
    text = (copied / HTML).read_text(encoding="utf-8")
    blocks = re.findall(r"<(?:p|li)>(.*?)</(?:p|li)>", text, re.DOTALL)
    long = [block for block in blocks if len(block) > 60 and "<img" not in block]
    assert len(long) > 60
    assert sorted(block for block in set(long) if long.count(block) > 1) == []
    plain = (re.sub(r"<.*?>", "", block) for block in blocks)
    sentences = [" ".join(s.split()) for block in plain for s in re.split(r"(?<=[.:?]) ", block)]
    said = [sentence for sentence in sentences if len(sentence) > 32]
    assert sorted(sentence for sentence in set(said) if said.count(sentence) > 1) == []


def lowest_of(page: pikepdf.Page) -> float:
    """Height of the lowest words of a page over its edge, without the two at its foot (points)."""
    now, kept, heights = np.eye(3), [np.eye(3)], list[float]()
    line = np.eye(3)
    for operands, operator in pikepdf.parse_content_stream(page):
        match str(operator):
            case "q":
                kept.append(now)
            case "Q":
                now = kept.pop()
            case "cm" | "Tm" as kind:
                a, b, c, d, e, f = map(float, operands)
                matrix = np.array([[a, b, 0], [c, d, 0], [e, f, 1]])
                now, line = (matrix @ now, line) if kind == "cm" else (now, matrix)
            case "Tj":
                heights.append(float((line @ now)[2, 1]))
    return min(heights[2:])


def test_pages_but_the_last_are_used(outputs: Path) -> None:
    with pikepdf.open(outputs / PDF) as document:
        *pages, _last = document.pages
        margin, high = 51.0, float(pages[0].mediabox[3])
        for number, page in enumerate(pages, 1):
            assert lowest_of(page) - margin < 0.4 * (high - 2 * margin), f"page {number}"


def test_a_step_that_fits_on_a_page_is_not_broken(copied: Path) -> None:
    sheets, _ = read_pdf(copied / PDF)
    for title, end in (("Lower the finger", "the plate rocks"), ("Wrap the finger", "comes loose")):
        (page,) = [words for words in sheets if title.replace(" ", "") in words]
        assert end.replace(" ", "") in page


def test_protection_is_tested_before_the_wires_go_in(outputs: Path) -> None:
    sheets, _ = read_pdf(outputs / PDF)
    text = "".join(sheets)
    at = [
        text.rindex(w.replace(" ", "")) for w in ("no short.", "peaks of the supply.", "1. Measure")
    ]
    assert at == sorted(at)

"""The step of mounting and the wiring note, for designs with other boards, supplies and wires."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.cabling import front_headers, plugged_headers
from lumitip_fab.docs.bring_up import bring_up_steps
from lumitip_fab.docs.flange import flange_board_step
from lumitip_fab.docs.protection import protection_note
from lumitip_fab.docs.spec import choice_rows, rows
from lumitip_fab.docs.wiring import wiring_note
from mounting_text import steps, words, work

Written = Callable[..., Design]


def test_each_contact_of_a_socket_has_what_it_carries_and_its_wire(written: Written) -> None:
    for preset in ("published", "integrated"):
        design = written({}, preset)
        board = next(b for b in design.auxiliary_boards if b.name == "flange")
        (flange,) = design.flanges
        table = flange_board_step(design, flange, "").split("### Contacts of the sockets")[1]
        rows = re.findall(r"^\| (J\d+) \| (.*?) \| (.*?) \| (.*?) \|$", table, re.MULTILINE)
        shown = {(ref, pin): net for ref, pins, net, _ in rows for pin in pins.split(", ")}
        headers = front_headers(board)
        assert shown == {(part.ref, pin): net for part in headers for pin, net in part.nets}
        ends = {
            (wire.end.connector, f"{wire.number} at {wire.end.pin}")
            for cable in design.cabling.cables
            for wire in cable.wires
            if wire.end.board == "flange" and wire.end.connector in {part.ref for part in headers}
        }
        named = {(ref, f) for ref, _, _, all_ in rows for f in all_.split(", ") if " at " in f}
        assert named == ends
        assert bool(ends) != ("has a triangle" in table)


@pytest.mark.parametrize("preset", ["published", "flex", "integrated", "wsg50"])
def test_the_way_of_each_cable_has_all_its_ties(written: Written, preset: str) -> None:
    design = written({}, preset)
    table = work(design).split("### Ways of the cables")[1]
    rows = re.findall(r"^\| (W\d): .*? \| (.*?) \| (.*?) \| (.*?) \|$", table, re.MULTILINE)
    assert [row[0] for row in rows] == [cable.name for cable in design.cabling.cables]
    places = [place for _, start, _, end in rows for place in f"{start}, {end}".split(", ")]
    boards = [*design.fingers, *design.auxiliary_boards]
    wires = [wire for cable in design.cabling.cables for wire in cable.wires]
    ends = {(end.board, end.connector) for wire in wires for end in (wire.start, wire.end)}
    ties_at = [tie.ref for board in boards for tie in board.ties if (board.name, tie.ref) in ends]
    threads = [f"thread beside {ref}" for ref in ties_at]
    assert sorted(p for p in places if p.startswith("thread")) == sorted(threads)
    lugs = [f"cable lug {lug.name}" for h in design.holders for lug in h.lugs]
    assert sorted(p for p in places if p.startswith("cable lug")) == sorted(lugs)
    ties = next(p.quantity for p in design.purchase.pieces if p.item.startswith("cable tie"))
    assert sum(place.startswith(("tie", "cable lug", "block")) for place in places) <= ties
    headers = plugged_headers(design.cabling.cables, design.auxiliary_boards)
    sockets = [place.removeprefix("socket at ") for place in places if "socket" in place]
    assert sorted(sockets) == headers
    free = {loop.cable: f"{loop.length_mm:.0f} mm" for loop in design.cabling.loops}
    assert {name: way for name, _, way, _ in rows if "mm" in way} == free


@pytest.mark.parametrize(("preset", "robot"), [("published", "J7"), ("mux16", "J7")])
def test_ties_close_the_arms_from_outside(written: Written, preset: str, robot: str) -> None:
    design = written({}, preset)
    (holder,) = design.holders
    step = work(design)
    first, clipped, closed = (
        step.index(text)
        for text in ("tie through each arm lug", "Clip the arms", "to a loop of some")
    )
    assert first < clipped < closed
    assert f"The edge of {robot} is towards the robot, that of J5 towards the fingers" in " ".join(
        step.split()
    )
    apart = [holder.cradle_mm + holder.wall_mm - holder.body_mm / 2, holder.arm_lugs[0].face_mm]
    assert apart[0] > 3 and apart[1] == pytest.approx(holder.cradle_mm + holder.wall_mm)
    ties = next(p.quantity for p in design.purchase.pieces if p.item.startswith("cable tie"))
    others = len(design.fingers) * bool(design.mount.lugs) + len(holder.lugs)
    assert ties - others == 2 * 2  # two loops of 280 mm, of ties of 200 mm


@pytest.mark.parametrize(
    ("changes", "preset", "sockets"),
    [
        ({}, "published", 1),
        ({}, "integrated", 0),
        ({"breakout.enabled": False}, "published", 0),
    ],
)
def test_a_socket_is_pressed_where_a_cable_is_plugged_in(
    written: Written, changes: dict[str, Any], preset: str, sockets: int
) -> None:
    design = written(changes, preset)
    step = steps(design)
    assert step.count("Press the socket") == step.count("plug the socket") == sockets
    assert step.count("a small vice") == len(design.flanges)
    assert step.count("press the cover down") == max(sockets, len(design.flanges))


def test_without_a_flange_nothing_is_said_of_it(written: Written) -> None:
    step = steps(written({"flange.enabled": False}))
    assert not re.search(r"flange|J3|the glue|soldering iron", step)


def test_wires_that_are_too_thick_go_to_a_flat_cable(written: Written) -> None:
    light = {"finger.rated_force_n": 30.0}  # the flare is that of thin wires, whose slot is narrow
    thin, thick = (steps(written({"wiring.section_mm2": s} | light)) for s in (0.08, 0.2))
    assert "at most 1.25 mm thick" in thin and "flat cable of 14 wires" not in thin
    assert "flat cable of 14 wires" in thick and "across the slot" not in thick


@pytest.mark.parametrize("preset", ["published", "integrated"])
def test_points_of_the_wiring_note_stand_apart(written: Written, preset: str) -> None:
    note = wiring_note(written({}, preset))
    points = re.findall(r"^- ", note, re.MULTILINE)
    assert len(points) >= 3
    assert not re.search(r"\.- |\S- [A-Z]", note)


def test_the_gripper_moves_alone_before_the_fingers_are_on(written: Written) -> None:
    for preset in ("published", "integrated", "flex"):
        step = steps(written({}, preset))
        assert step.index("activate the gripper") < step.index("screw each finger on")
        if "plug the socket" in step:
            assert step.index("plug the socket") < step.index("activate the gripper")


@pytest.mark.parametrize(
    ("diode", "preset", "warned"),
    [("none", "published", True), ("1N5819HW", "published", False), ("none", "integrated", False)],
)
def test_usb_is_out_before_the_flange_feeds_the_controller(
    written: Written, diode: str, preset: str, warned: bool
) -> None:
    """Without a diode the plug of USB and the flange's supply feed each other."""
    step = steps(written({"breakout.feed_diode": diode}, preset))
    assert step.count("Unplug USB from the controller first") == warned


def test_a_flange_is_tried_with_twice_the_load(written: Written) -> None:
    step = steps(written())
    assert step.index("flange bolts") < step.index("hang twice your load on the gripper once")
    assert "twice your load" not in steps(written({"flange.enabled": False}))


def test_the_flange_is_measured_where_it_can_be_reached(written: Written) -> None:
    step = steps(written({}, "flex"))
    board = next(b for b in written({}, "flex").auxiliary_boards if b.name == "flange")
    found = re.search(r"in the contacts of (J\d+): 5 V from \1\.(\d+) to \1\.(\d+)\.", step)
    assert found
    nets = dict(next(part for part in board.components if part.ref == found[1]).nets)
    assert (nets[found[2]], nets[found[3]]) == ("5V", "GND")


@pytest.mark.parametrize(("preset", "light"), [("dense", ""), ("flex", " D2 on the front lights ")])
def test_the_flange_s_board_is_tried_before_it_meets_the_robot(
    written: Written, preset: str, light: str
) -> None:
    text = words(steps(written({}, preset)))
    tried = text.index("with a limit of 100 mA, its plus on the test point 24V_IN")
    shown = "The meter shows 24 V at the test point 24V and 5 V at the test point 5V."
    assert tried < text.index(shown + light) < text.index("In its test it stays cold.")
    assert "a bench supply" in text[:tried]
    assert text.index("TVS diode") < text.index("measure in the contacts of J3: 5 V from")


@pytest.mark.parametrize("preset", ["published", "integrated"])
def test_firmware_and_program_are_named_with_their_place(preset: str, written: Written) -> None:
    test = words(" ".join(bring_up_steps(written({}, preset))))
    assert (
        "`firmware/firmware.ino` of the outputs" in test
        or "folder `firmware` of the outputs" in test
    )
    assert "`lumitip`" in test and "with `pyproject.toml`" in test
    assert test.index("`pip install '.[readout]'`") < test.index("`lumitip scan`")
    assert re.findall(r"`lumitip (?!scan)\w+`", test) == []


@pytest.mark.parametrize(
    ("preset", "changes", "said", "unsaid"),
    [
        (
            "flex",
            {},
            [
                "On the breakout board the ESD diodes Z1 to Z10",
                "the resistors R1 to R8 in series",
                "the diode has failed",
                "the diode VD1 (1N5819HW) keeps USB from the robot's supply",
                "its red probe on 5V of J7 and its black one on VIN of J1",
                "On the flange board the TVS diode D1 (SMBJ24A)",
                "the fuse F1 melts",
            ],
            [],
        ),
        (
            "wsg50",
            {},
            ["ESD diodes Z1 to Z10", "fuse F1", "The MOSFET Q1 blocks a reversed supply"],
            ["flange"],
        ),
        ("published", {}, ["TVS diode D1"], ["ESD", "diode test"]),
        ("published", {"flange.enabled": False}, [], ["ESD", "TVS", "fuse", "diode test"]),
    ],
)
def test_protection_is_said_where_a_design_has_it(
    preset: str, changes: dict[str, Any], said: list[str], unsaid: list[str], written: Written
) -> None:
    design = written(changes, preset)
    note = words(" ".join(protection_note(board, design) for board in design.auxiliary_boards))
    assert [text for text in said if text not in note] == []
    assert [text for text in unsaid if text in note] == []


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["wsg50", "franka_hand"])
def test_other_grippers_have_no_word_of_the_flange(
    preset: str, inputs: dict[str, Input], built: Callable[[str], Path]
) -> None:
    design = derive(inputs[preset])
    assert not design.flanges and not design.system.coupling_mm
    made = [(r.quantity, r.computed, r.reason) for r in (*rows(design), *choice_rows(design))]
    texts = [" ".join(part) for part in made]
    out = built(preset)
    for file in ("manual/manual.html", "wiring/cables.md", "assembly/system.svg", "bom.csv"):
        texts.append((out / file).read_text(encoding="utf-8"))
    found = re.findall(r".{0,40}(?:flange|Robotiq).{0,40}", "\n".join(texts), re.IGNORECASE)
    assert found == []

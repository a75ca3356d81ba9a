"""Glue, tape, primer, thread and ties that a design uses follow from its geometry."""

import re
from dataclasses import replace
from typing import Any

import pytest

from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive
from lumitip_fab.design import Bought
from lumitip_fab.docs.bill import loose_parts
from lumitip_fab.docs.orders import orders
from lumitip_fab.docs.wiring import wiring_note
from lumitip_fab.text import passage


def test_supplies_follow_the_design(inputs: dict[str, Input]) -> None:
    def used(preset: str) -> dict[str, float]:
        found = [p for p in derive(inputs[preset]).purchase.pieces if p.group == "supplies"]
        return {piece.pack: piece.quantity for piece in found}

    rigid, flex = used("published"), used("flex")
    board = derive(inputs["published"]).board
    width, length = board.box.width_mm, board.box.length_mm
    slit = 2 * (width + length) * board.pocket_clearance_mm * 1.6
    wedge = board.pocket.width_mm * board.roof_mm * 1.6 / 2
    assert wedge == pytest.approx(58, abs=1), "the pocket is 1.9 mm wider at the rim than the board"
    glue_mm3 = 2 * (width * length * 0.1 + slit + wedge)
    assert rigid["epoxy"] == pytest.approx(glue_mm3 / 1000, abs=0.006)
    fingers = derive(inputs["published"]).fingers
    windows = sum(relief.through for finger in fingers for relief in finger.reliefs)
    design = derive(inputs["published"])
    finger_mm = 2 * max(x for x, _ in design.outline.polygon()) + design.stack.thickness_mm
    wires = [wire for cable in design.cabling.cables for wire in cable.wires]
    free = sum(wire.start.board == "breakout" or wire.end.board == "supply" for wire in wires)
    # Films on the paper that carries them, flaps while they are bonded, wires in the first test.
    others_m = 0.6 + 2 * 3 * 2 * finger_mm / 1000 + 0.03 * free
    closed_m = rigid["polyimide tape"] - others_m
    assert free and (closed_m > 0.01) == bool(windows), "strips only without a clamp"
    assert flex["polyimide tape"] > 0 and "epoxy" not in flex


@pytest.mark.parametrize("preset", ["published", "dense", "integrated"])
def test_each_wire_has_a_colour_of_the_set_or_a_mark(inputs: dict[str, Input], preset: str) -> None:
    design = derive(inputs[preset])
    pack = design.purchase.pack("stranded wire")
    assert pack and len(pack.colours) == 10 and "10 colours" in pack.pack
    note = " ".join(wiring_note(design).split())
    marked = note.partition("at both ends: ")[2].partition(". ")[0]
    wires = [wire for cable in design.cabling.cables for wire in cable.wires]
    others = [wire.number for wire in wires if wire.colour not in pack.colours]
    assert [each.split()[0] for each in marked.split("; ") if each] == others
    assert (preset == "published") == (marked == "W3.3 white, marked pink")


def test_parts_whose_mark_is_not_known_are_bought_loose_for_the_test(
    inputs: dict[str, Input],
) -> None:
    design = derive(inputs["published"])
    packages = design.packages
    led, detector = loose_parts(design)
    assert (led.part, detector.part) == ("15406085BA300", packages.photodetector.order_number)
    assert (led.quantity, detector.quantity) == (2, 2)
    assert None not in (led.price, detector.price)
    known = packages.led.model_copy(update={"marked_confidence": "measured"})
    measured = replace(design, packages=replace(packages, led=known))
    assert [each.part for each in loose_parts(measured)] == [detector.part]


LINES = ("GND", "CASING", "Von", "485+", "485-", "3V3_out", "485GND")
BEHIND = ("REGULATED", "REGULATED", "SUPPLY", "SUPPLY", "GND", "GND", "GND")
CLOSED = ("GND", "GND", "SUPPLY", *["NC"] * 7)


@pytest.mark.parametrize(
    ("preset", "changes", "sockets", "cable", "fuses"),
    [
        ("published", {}, ["J2", "J3"], ["J2", "J3"], [1]),
        ("integrated", {}, ["J2", "J3"], ["J2", "J3"], [1]),
        ("published", {"flange.headers": (LINES, BEHIND)}, ["J2", "J3"], ["J2"], []),
        (
            "published",
            {"flange.headers": (("GND",) * 7, BEHIND), "flange.signals": CLOSED},
            ["J3"],
            [],
            [],
        ),
        ("wsg50", {}, [], [], []),
    ],
)
def test_the_grippers_own_cable_is_in_the_bill(
    preset: str,
    changes: dict[str, Any],
    sockets: list[str],
    cable: list[str],
    fuses: list[int],
    inputs: dict[str, Input],
    vary: Any,
) -> None:
    pieces = derive(vary(inputs[preset], changes)).purchase.pieces
    mates = [p for p in pieces if p.pack.endswith("mate")]
    assert [re.findall(r"J\d", p.where) for p in mates] == [sockets] * bool(sockets)
    assert [p.quantity for p in mates] == [len(sockets)] * bool(sockets)
    own = [p for p in pieces if p.item == "cable of the gripper"]
    assert [re.findall(r"J\d", p.where) for p in own] == [cable] * bool(cable)
    assert [(p.quantity, p.each) for p in own] == [(1, 25.0)] * bool(cable)
    assert [p.quantity for p in pieces if p.pack == "gripper fuse"] == fuses


def test_wires_of_two_sections_are_two_sets(inputs: dict[str, Input]) -> None:
    purchase = derive(inputs["published"]).purchase
    thin = Bought("wiring", "stranded wire, 0.08 mm²", "", "", "", 3.0, 0.3, "m", "stranded wire")
    thick = replace(thin, item="stranded wire, 0.25 mm²")
    assert [order.packs for order in orders(purchase, [thin, thick])] == [1, 1]


def test_consumables_have_an_amount_a_pack_and_a_price(inputs: dict[str, Input], vary: Any) -> None:
    purchase = derive(inputs["published"]).purchase
    found = {piece.item: piece for piece in purchase.pieces if piece.group == "supplies"}
    for item in ("isopropanol", "nitrile gloves", "clean cup", "plain paper"):
        pack = purchase.pack(found[item].pack)
        assert pack and found[item].quantity <= pack.holds and found[item].price, item
        assert pack.confidence == "assumed" and not pack.manufacturer, item
    adhesive = purchase.pack("silicone adhesive")
    assert adhesive and found["silicone adhesive"].quantity <= adhesive.holds
    filmed = derive(vary(inputs["published"], {"mould.insert": "PET 100um"}))
    cloths = next(p for p in filmed.purchase.pieces if p.item == "lint-free cloth")
    assert cloths.quantity == found["lint-free cloth"].quantity + 2


@pytest.mark.parametrize("route", ["film", "cut", "tpu"])
def test_a_tape_that_is_not_in_the_bill_is_called_so(route: str) -> None:
    needs = passage("docs/wrapping.md", f"{route}_wrap").partition("**Time:**")[0]
    assert "(or double-sided tape, which is not in the list of parts)" in " ".join(needs.split())

"""Glue, tape, primer, thread and ties that a design uses follow from its geometry."""

import pytest

from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive


def test_supplies_follow_the_design(inputs: dict[str, Input]) -> None:
    def used(preset: str) -> dict[str, float]:
        found = [p for p in derive(inputs[preset]).purchase.pieces if p.group == "supplies"]
        return {piece.pack: piece.quantity for piece in found}

    rigid, flex = used("published"), used("flex")
    board = derive(inputs["published"]).board
    width, length = board.box.width_mm, board.box.length_mm
    slit = 2 * (width + length) * board.pocket_clearance_mm * 1.6
    assert rigid["epoxy"] == pytest.approx(2 * (width * length * 0.1 + slit) / 1000, abs=0.006)
    fingers = derive(inputs["published"]).fingers
    windows = sum(relief.through for finger in fingers for relief in finger.reliefs)
    assert ("polyimide tape" in rigid) == bool(windows), "strips only without a printed clamp"
    assert flex["polyimide tape"] > 0 and "epoxy" not in flex

"""Glue, tape, primer, thread and ties that a design uses follow from its geometry."""

from collections.abc import Callable

import pytest

from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive


def test_supplies_follow_the_design(inputs: dict[str, Input], vary: Callable[..., Input]) -> None:
    def used(preset: str, **changes: object) -> dict[str, float]:
        config = vary(inputs[preset], {f.replace("__", "."): v for f, v in changes.items()})
        found = [p for p in derive(config).purchase.pieces if p.group == "supplies"]
        return {piece.pack: piece.quantity for piece in found}

    rigid, flex = used("published"), used("flex")
    board = derive(inputs["published"]).board
    width, length = board.box.width_mm, board.box.length_mm
    slit = 2 * (width + length) * board.pocket_clearance_mm * 1.6
    assert rigid["epoxy"] == pytest.approx(2 * (width * length * 0.1 + slit) / 1000, abs=0.006)
    assert "polyimide tape" in rigid, "resistors stand in a window on the back"
    assert flex["polyimide tape"] > 0 and "epoxy" not in flex
    assert "DOWSIL PR-1200" not in used("published", mould__primer="none")

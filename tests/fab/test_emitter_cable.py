"""The emitter's cable goes past the controller's board to its pads at the far end."""

from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.derive.wiring.cabling import reach_mm
from lumitip_fab.docs.wiring import wiring_steps

DESIGN = Path(__file__).parents[2] / "design"


def test_it_is_longer_by_the_way_along_the_board() -> None:
    design = derive(load(DESIGN / "fingertip.toml"))
    (board,) = (b for b in design.auxiliary_boards if b.name == "breakout")
    y = {part.ref: part.y_mm for part in board.components}
    beyond_mm = design.cabling.beyond_mm
    assert beyond_mm == pytest.approx(y["J6"] - y["J5"]) and beyond_mm > 30.0
    emitter, receiver = design.cabling.cables[:2]
    assert (emitter.end.connector, receiver.end.connector) == ("J6", "J5")
    reach = [reach_mm(finger, design.outline) for finger in (design.emitter, design.receiver)]
    longer_mm = emitter.least_mm - receiver.least_mm
    assert longer_mm == pytest.approx(beyond_mm + reach[0] - reach[1])
    loops = {loop.cable: loop.run_mm for loop in design.cabling.loops}
    assert loops["W1"] - loops["W2"] == pytest.approx(beyond_mm)
    cut, _ = wiring_steps(design)
    assert f"the emitter's {beyond_mm:.0f} mm more" in " ".join(cut.text.split())


def test_a_controller_on_the_flange_has_both_cables_at_one_end() -> None:
    design = derive(load(DESIGN / "presets" / "integrated.toml"))
    assert design.cabling.beyond_mm == 0.0
    assert "mm more" not in wiring_steps(design)[0].text

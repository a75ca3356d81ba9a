"""Share of the boards' lines with a number at LCSC, with an LED that LCSC sells."""

from collections.abc import Callable

import pytest

from lumitip_fab.boards.fab.order import assembled, bom_rows
from lumitip_fab.boards.placement import place
from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive

SOLD = {
    "asymmetric": "VSMY1850",
    "dense": "APT1608F3C",
    "flex": "VSMY1850",
    "franka_hand": "VSMY1850",
    "integrated": "VSMY1850",
    "mux16": "VSMB1940X01",
    "robotiq_2f140": "VSMY1850",
    "wsg50": "VSMY1850",
}
"""An LED that LCSC sells, by preset; the resistors of the published one suit its own LED."""


@pytest.mark.slow
@pytest.mark.parametrize(("preset", "led"), SOLD.items())
def test_every_line_has_a_number(
    inputs: dict[str, Input], vary: Callable[..., Input], preset: str, led: str
) -> None:
    design = derive(vary(inputs[preset], {"emitter.led": led}))
    boards = (*design.fingers, *design.auxiliary_boards)
    rows = [row for board in boards for row in bom_rows(assembled(place(design, board)))]
    assert len(rows) > 10
    assert {row["part"] for row in rows if not row["lcsc"]} == set()

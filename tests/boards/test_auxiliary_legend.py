"""What is printed beside the pads of auxiliary boards."""

import dataclasses
from collections.abc import Callable

import pytest

from lumitip_fab.boards.files import board_files
from lumitip_fab.design import Design
from lumitip_fab.errors import BuildError
from lumitip_fab.pipeline.artefact import Artefact

pytestmark = pytest.mark.slow

AUXILIARY_BOARDS = ("breakout", "flange")


def _made(design: Design, name: str, supply: str) -> tuple[int, tuple[Artefact, ...]]:
    """An auxiliary board with another name for its 12 V: pads of that name, and the files."""
    (auxiliary,) = (auxiliary for auxiliary in design.auxiliary_boards if auxiliary.name == name)
    devices = tuple(
        dataclasses.replace(
            device, pins=tuple(supply if pin == "12V" else pin for pin in device.pins)
        )
        for device in auxiliary.components
    )
    renamed = dataclasses.replace(auxiliary, components=devices)
    files = board_files(design, renamed)
    return sum(device.pins.count(supply) for device in devices), files


@pytest.mark.parametrize("name", AUXILIARY_BOARDS)
def test_a_supply_with_a_fraction_is_printed_beside_its_pads(
    name: str, designs: Callable[[str], Design]
) -> None:
    """A little aside where there is no room at the pad's middle."""
    pads, files = _made(designs("small"), name, "13.8V")
    (board,) = (file for file in files if file.path.endswith(".kicad_pcb"))
    assert board.data.decode().count('(gr_text "13.8V"') == pads > 0


@pytest.mark.parametrize("name", AUXILIARY_BOARDS)
def test_what_helps_a_name_without_room_is_told(
    name: str, designs: Callable[[str], Design]
) -> None:
    with pytest.raises(BuildError, match=r"'J\d 13\.8125V', .* fewer digits in supply\.voltage_v"):
        _made(designs("small"), name, "13.8125V")

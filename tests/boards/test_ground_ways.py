"""How far it is along ground: pads that are joined may still be joined round the whole board."""

import dataclasses
from pathlib import Path

import pytest

from ground_ways import ground_ways_mm
from lumitip_fab.checks.readers.kicad_board import KicadBoard, read_board

pytestmark = pytest.mark.slow

CAPACITOR_MM = 30.0
"""Assumed: a tenth of the cable, whose ground the multiplexers share."""


@pytest.fixture(scope="module")
def receiver(outputs: Path) -> KicadBoard:
    """A receiver board."""
    return read_board(outputs / "boards/receiver/receiver.kicad_pcb")


def test_each_multiplexer_has_a_capacitor_near_along_ground(receiver: KicadBoard) -> None:
    ways = ground_ways_mm(receiver, "U", "C")
    assert len(ways) == 12, "three leads of each of four multiplexers"
    assert max(ways.values()) <= CAPACITOR_MM, ways


def test_tracks_of_ground_are_what_keeps_it_near(receiver: KicadBoard) -> None:
    """The pour alone goes round the inputs' tracks."""
    loose = tuple(c for c in receiver.loose if not (c.kind == "track" and c.net == "GND"))
    ways = ground_ways_mm(dataclasses.replace(receiver, loose=loose), "U", "C")
    assert max(ways.values()) > 1.3 * CAPACITOR_MM

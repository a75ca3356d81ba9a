"""Random grids and parts for the boards: `board_design(seed, index)` is always the same."""

from random import Random

from acceptance.generator import Design
from acceptance.grids import draw_columns
from acceptance.limits import BENCH, Values, crossed
from acceptance.parts import BASE, Table, entries

CELLS = (8, 257)
PITCH_MM = (3.0, 8.0)
HOLE_SHARE = 0.42
"""Of the pitch; an aperture is nothing on a board."""


def board_design(seed: int, index: int) -> Design:
    """A grid of any columns, with any LED, photodetector and multiplexer, that crosses no
    physical limit."""
    random = Random(f"corpus {seed} {index}")
    while True:
        pitch_mm = round(random.uniform(*PITCH_MM), 1)
        edits: Table = {
            "grid.columns": draw_columns(random, random.randint(*CELLS)),
            "grid.pitch_mm": pitch_mm,
            "emitter.led": random.choice(list(entries("leds"))),
            "receiver.photodetector": random.choice(list(entries("photodetectors"))),
            "receiver.multiplexer": random.choice(list(entries("multiplexers"))),
            "mask.hole_mm": round(HOLE_SHARE * pitch_mm, 1),
            # "auto": the default's circuit, with a pull-up for each photodetector and a source for
            # each string, where the board has room for it.
            "receiver.load": random.choice(["auto", "shared"]),
            "emitter.drive": random.choice(["auto", "resistor"]),
            # It has pins for any number of multiplexers.
            "controller.board": BENCH,
        }
        if sum(edits["grid.columns"]) >= CELLS[0] and not crossed(Values(edits, BASE)):
            return Design(f"{seed}_{index}", BASE, ("board",), edits)

"""Values of fields that a user left to follow from others, with which a refused file is accepted.

A refusal that such values avoid is no confirmed one: the choice could have been made for the user.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from random import Random

from acceptance.generator import Design
from acceptance.parts import Table, bypasses, entries
from acceptance.trial import Trial, derive_file, design_folder

TRIES = 150
CURRENTS_MA = (19.2, 18.0, 16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 5.0, 4.0, 3.0, 2.0)


def free_values() -> dict[str, list[object]]:
    """Allowed values of each dependent field, by field."""
    return {
        "emitter.current_ma": [*CURRENTS_MA],
        "emitter.string_leds": [*range(16, 0, -1)],
        "emitter.resistor": [*entries("resistors")],
        "emitter.resistor_side": ["back", "front"],
        "receiver.multiplexer": [*entries("multiplexers")],
        "receiver.resistor": [*entries("resistors")],
        "receiver.capacitor": [*bypasses()],
        "board.tip_margin_mm": [3.65, 4.0, 4.5, 5.0, 5.5, 6.0, 7.0, 8.0],
        "board.end_margin_mm": [1.9, 2.2, 2.6, 3.0],
        "board.hole_mm": [2.1, 1.9, 1.7, 1.5],
        "board.hole_edge_mm": [2.15, 1.8, 1.6, 2.5],
        "board.clearance_mm": [0.25, 0.2, 0.15, 0.1],
        "board.channel_mm": [2.2, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 14.0],
        "tip.slant_start_mm": [6.0, 5.5, 5.0, 4.5, 4.0, 8.0, 14.0],
        "stack.film_mm": sorted({film["thickness_mm"] for film in entries("films").values()}),
        "printer.min_wall_mm": [0.8, 0.9, 1.0, 1.2],
        "tip.edge_mm": [0.45, 0.5, 0.6, 0.7, 0.8],
        "mould.wall_mm": [2.4, 2.8, 3.2, 4.0],
        "mould.draft_deg": [3.0, 2.5, 2.0, 4.0],
        "mould.taper_length_mm": [3.0, 2.5, 2.0],
        "flex.standoff_mm": [2.0, 2.5, 3.0, 3.5, 4.0, 5.0],
        "breakout.hole_mm": [2.1, 2.7, 3.2, 3.7],
        "breakout.board_mm": [[45.72, 33.02], [50.8, 35.56], [60.96, 38.1], [45.72, 38.1]],
        "flange.gate_ohm": [100000, 47000, 220000, 470000],
        "flange.fuse": [*entries("fuses")],
        "flange.tvs": [*entries("tvs_diodes")],
        "flange.inrush_ohm": [4.7, 10.0, 2.2, 22.0],
        "mask.flap_mm": [13.0, 11.0, 9.0, 16.0],
    }


def way_out(design: Design) -> Table | None:
    """Values with which a refused design is accepted; none where the search found no such."""
    random = Random(design.name)
    free = {f: v for f, v in free_values().items() if f not in design.edits}
    with design_folder() as folder:
        found: Table = {}
        best = _cost(_try(design, found, folder))
        for moves, sideways in _moves(random, free):
            cost = _cost(_try(design, found | moves, folder))
            if cost < best or (sideways and cost == best):
                best, found = cost, found | moves
            if best == 0:
                return _needed(design, found, folder)
    return None


def _moves(random: Random, free: dict[str, list[object]]) -> Iterator[tuple[Table, bool]]:
    """First each value alone, then up to four at random, by which no worse is enough."""
    for field, values in free.items():
        for value in values:
            yield {field: value}, False
    for _ in range(TRIES):
        fields = random.sample(list(free), min(random.randint(1, 4), len(free)))
        yield {field: random.choice(free[field]) for field in fields}, True


def _needed(design: Design, found: Table, folder: Path) -> Table:
    """The values without those that are not needed."""
    for field in found:
        less = {f: v for f, v in found.items() if f != field}
        if _cost(_try(design, less, folder)) == 0:
            return _needed(design, less, folder)
    return found


def _try(design: Design, more: Table, folder: Path) -> Trial:
    file = folder / "tried.toml"
    file.write_text(replace(design, edits=design.edits | more).text, encoding="utf-8")
    return derive_file(file)


def _cost(trial: Trial) -> int:
    """How far from accepted: a crash is farther than any number of problems."""
    return 1000 if trial.crash else len(trial.refusals)

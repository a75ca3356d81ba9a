"""Room behind a finger's board for the wires that its LEDs need, and for the thread round them."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive

Write = Callable[[str], Path]
THREAD_MM = 0.5
OUTER_MM = {0.08: 1.129, 0.14: 1.248, 0.25: 1.411}
"""Of stranded wire with 15 mils of PVC: 1.15 times the diameter of solid copper, and the walls."""
LOW_SUPPLY = '[emitter]\ndrive = "auto"\n[supply]\nvoltage_v = 5.0\n'


@pytest.mark.parametrize(
    ("text", "section_mm2"),
    [
        ("", 0.08),
        (LOW_SUPPLY, 0.14),
        (LOW_SUPPLY + "[wiring]\ncontroller_mm = 900.0\n", 0.25),
        (LOW_SUPPLY + "[grid]\ncolumns = [9, 8, 9, 8, 9, 8]\n", 0.25),
    ],
)
def test_the_block_leaves_room_for_thicker_wires(
    file: Write, text: str, section_mm2: float
) -> None:
    design = derive(load(file(text)))
    wires = [c.section_mm2 for c in design.cabling.cables if c.start.board == "emitter"]
    assert max(wires) == section_mm2
    (tie,) = design.emitter.ties
    from_end_mm = tie.holes[0][1] - design.outline.end_y_mm
    room_mm = design.mount.block_front_w_mm - design.stack.pcb_mm
    room_mm += from_end_mm * math.tan(math.radians(design.mount.tilt_deg))
    assert room_mm >= OUTER_MM[section_mm2] + THREAD_MM

"""The published design against figures measured from the published fingertip.

Figures: arXiv 2306.05902 and its public hardware files. PCB frame: x from the board's centreline,
y from its tip edge, so that the sensor frame's y is 15.65 - y.
"""

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lumitip.grid import hexagonal_grid
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text

TIP_OF_BOARD_Y_MM = 15.65
PRESETS = Path(__file__).parents[2] / "design" / "presets"


@pytest.fixture
def design(designs: dict[str, Design]) -> Design:
    """The published design."""
    return designs["published"]


def test_the_board_has_the_published_size_and_place(design: Design) -> None:
    box = design.board.box
    assert (box.width_mm, box.length_mm) == pytest.approx((42.8, 43.1))
    assert box.y_max_mm == pytest.approx(TIP_OF_BOARD_Y_MM)
    assert box.x_min_mm == -box.x_max_mm


def test_the_stack_is_four_millimetres(design: Design) -> None:
    stack = design.stack
    assert stack.thickness_mm == pytest.approx(4.0)
    assert stack.plate_mm == pytest.approx(2.4)
    assert (stack.silicone_z_mm, stack.rim_z_mm, stack.pocket_z_mm, stack.back_z_mm) == (
        pytest.approx((-0.1, -1.6, -3.2, -4.0))
    )


def test_holes_and_pins_follow_the_published_pattern(design: Design) -> None:
    published = [(-10.388, 2.15), (0.0, 2.15), (10.392, 2.15), (-15.588, 41.237), (15.588, 41.237)]
    for (x, y), (u, v) in zip(design.receiver.holes, published, strict=True):
        assert x == pytest.approx(u, abs=0.01)
        assert TIP_OF_BOARD_Y_MM - y == pytest.approx(v, abs=0.15)
    assert design.board.hole_mm == 2.1
    assert design.board.pin_mm == pytest.approx(1.8)
    assert sorted(design.emitter.holes) == sorted((-x + 0.0, y) for x, y in design.receiver.holes)


def test_the_receivers_connector_is_the_published_one(design: Design) -> None:
    wires = design.receiver.connector
    assert wires.signals == ("GND", "3V3", "S0", "S1", "S2", "A0", "A1", "A2", "A3")
    assert [x for x, _ in wires.pads] == pytest.approx([2.54 * i for i in range(-4, 5)])
    assert TIP_OF_BOARD_Y_MM - wires.pads[0][1] == pytest.approx(41.237, abs=0.15)
    assert (wires.pitch_mm, wires.pad_mm, wires.drill_mm) == (2.54, 2.286, 1.2)
    assert design.emitter.connector.signals == ("GND", "24V")


def test_the_outline_follows_the_published_silhouette(design: Design) -> None:
    outline = design.outline
    widths = outline.polygon()[:, 0]
    assert outline.length_mm == pytest.approx(54.708, abs=0.1)
    assert 2 * widths.max() == pytest.approx(57.91, abs=0.2)
    assert outline.tip_width_mm == pytest.approx(28.1, abs=0.1)
    # half the width at distances from the tip edge
    for v_mm, half_mm in (
        (5, 27.61),
        (10, 28.94),
        (15, 28.11),
        (20, 26.35),
        (30, 24.05),
        (35, 23.88),
        (45, 23.96),
    ):
        assert outline.half_width_at(outline.tip_y_mm - v_mm) == pytest.approx(half_mm, abs=0.8)


def test_the_coupling_is_the_published_one(design: Design) -> None:
    mount = design.mount
    assert mount.tilt_deg == 1.5
    assert (mount.block_width_mm, mount.block_back_w_mm, mount.bolt_w_mm) == (16.2, 19.1, 13.8)
    assert (mount.bolt_hole_mm, mount.counterbore_mm, mount.land_mm) == (5.3, 9.0, 4.34)
    assert (mount.pin_mm, mount.pin_u_mm, mount.pin_depth_mm) == (2.4, (-4.5, 4.5), 2.84)
    assert mount.nose is not None
    assert mount.origin_y_mm == design.outline.end_y_mm


def test_the_lean_brings_tip_and_grid_inward_as_published(design: Design) -> None:
    # Published: 1.44 mm at the tip and 0.87 mm at the grid's centre, for the same lean.
    sine = math.sin(math.radians(design.mount.tilt_deg))
    tip = (design.outline.tip_y_mm - design.mount.origin_y_mm) * sine
    assert tip == pytest.approx(1.44, abs=0.02)
    assert -design.mount.origin_y_mm * sine == pytest.approx(0.87, abs=0.03)


def test_the_fingers_touch_near_the_tip_and_open_far(design: Design) -> None:
    closing = design.closing
    assert design.outline.tip_y_mm - closing.contact_y_mm == pytest.approx(3.0)
    assert 75 < closing.max_opening_mm < design.mount.stroke_mm
    reach = closing.contact_z_mm
    cells = np.array(design.receiver.cells)[:, 1] * math.sin(math.radians(design.mount.tilt_deg))
    assert cells.max() < reach


def test_the_wedge_begins_at_the_pocket_and_ends_in_one_printed_line(design: Design) -> None:
    assert design.tip.edge_mm == design.printing.line_mm == 0.45
    rise = design.stack.plate_mm - design.tip.edge_mm
    run = design.outline.tip_y_mm - design.tip.slant_start_y_mm
    assert design.tip.angle_deg == pytest.approx(math.degrees(math.atan2(rise, run)))
    assert run == pytest.approx(6.0)


def test_the_electronics_are_the_published_ones(design: Design) -> None:
    wiring = design.wiring
    assert wiring.muxes == 4
    assert wiring.select_pins == ("D6", "D7", "D8")
    assert wiring.adc_pins == ("A0", "A1", "A2", "A3")
    assert [len(s) for s in wiring.strings] == [16, 16]
    assert wiring.resistor_ohm == (150.0, 150.0)
    assert sum(wiring.current_ma) == pytest.approx(38.4)
    assert np.bincount(design.layout.mux).tolist() == [8, 8, 8, 8]


def test_silicone_over_the_dies_is_what_light_crosses(design: Design) -> None:
    assert design.layout.optics.emitter_depth_mm == pytest.approx(0.9)
    assert design.layout.optics.detector_depth_mm == pytest.approx(0.9)
    assert design.layout.optics.silicone_index == 1.41


def test_resistors_on_the_back_get_windows_where_the_floor_would_be_too_thin(
    design: Design,
) -> None:
    assert len(design.emitter.reliefs) == 2
    assert all(r.through and r.depth_mm == 0.8 for r in design.emitter.reliefs)
    assert design.receiver.reliefs == ()


def test_the_asymmetric_preset_mirrors_between_the_fingers(designs: dict[str, Design]) -> None:
    design = designs["asymmetric"]
    assert design.grid.columns == (4, 5, 6, 5)
    grid = hexagonal_grid((4, 5, 6, 5), 5.0)
    assert [x for x, _ in design.receiver.cells] == pytest.approx(grid.x_mm.tolist(), abs=1e-6)
    assert [x for x, _ in design.emitter.cells] == pytest.approx((-grid.x_mm).tolist(), abs=1e-6)
    assert set(design.receiver.cells) != set(design.emitter.cells)
    assert design.board.box.x_max_mm == -design.board.box.x_min_mm


def test_the_dense_preset_reads_124_cells_through_16_inputs_each(
    designs: dict[str, Design],
) -> None:
    design = designs["dense"]
    assert len(design.layout) == 124
    assert design.wiring.muxes == 8
    assert design.layout.channel.max() == 15
    assert design.receiver.turned
    assert design.emitter.turned


@pytest.mark.slow
def test_every_process_derives_the_same_text() -> None:
    code = (
        "import sys; from pathlib import Path\n"
        "from lumitip_fab.derive import derive\n"
        "from lumitip_fab.design.encoding import design_text\n"
        "from lumitip_fab.config.load import load\n"
        "for f in sorted(Path(sys.argv[1]).glob('*.toml')): print(design_text(derive(load(f))))"
    )

    def text(seed: str) -> str:
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        done = subprocess.run(
            [sys.executable, "-c", code, str(PRESETS)],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
            cwd="/",
        )
        return done.stdout

    first = text("1")
    assert len(first) > 10_000
    assert text("31337") == first


@pytest.mark.slow
def test_this_process_derives_the_same_text_twice(
    inputs: dict[str, object], designs: dict[str, Design]
) -> None:
    from lumitip_fab.config.load import load
    from lumitip_fab.derive import derive

    for name in inputs:
        assert design_text(derive(load(PRESETS / f"{name}.toml"))) == design_text(designs[name])


def test_limits_that_checks_take_from_the_design(design: Design) -> None:
    cabling, closing, (flange, *_) = design.cabling, design.closing, design.flanges
    assert (cabling.step_mm, cabling.most_a_per_mm2, cabling.most_drop) == (10.0, 3.0, 0.02)
    assert closing.most_from_tip_mm == 4.0
    assert (flange.pin_play_mm, flange.socket_play_mm) == (0.1, 0.2)
    assert [finger.cells_hold.x_sign for finger in design.fingers] == [-1.0, 1.0]
    assert [finger.cells_hold.ref(4) for finger in design.fingers] == ["D5", "Q5"]

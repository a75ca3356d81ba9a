"""Automatic values: any grid derives, what a user wrote stays, ratings hold at the worst case."""

import math
from typing import Any

import pytest

from lumitip_fab.cli.fix import fix
from lumitip_fab.config.automatic import automatic_fields
from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import derive, resolve
from lumitip_fab.derive.auto.remedies import plan_of
from lumitip_fab.derive.auto.resolve import RuleError
from lumitip_fab.design import Design
from lumitip_fab.docs.spec_circuit import pulled_up

pytestmark = pytest.mark.slow


def _columns(cells: int) -> list[int]:
    """Alternating columns of a number of cells, as square as there are."""
    found = [
        (abs(rows - count), [rows - (i + first) % 2 for i in range(count)])
        for rows in range(2, 40)
        for count in range(2, 40)
        for first in (0, 1)
        if sum(rows - (i + first) % 2 for i in range(count)) == cells
    ]
    return min(found)[1]


@pytest.mark.parametrize("cells", [3, 4, 5, 7, 9, 13, 17, 19, 23, 29, 31, 37, 41, 47, 53, 59, 63])
def test_any_number_of_cells_derives_at_first_try(file: Any, cells: int) -> None:
    design = derive(load(file(f"[grid]\ncolumns = {_columns(cells)}\n")))
    assert len(design.layout) == cells
    _assert_rated(design)


@pytest.mark.parametrize("volts", [5, 9, 12, 24])
@pytest.mark.parametrize("flange", ["true", "false"])
def test_usual_supplies_derive_with_and_without_the_flange(
    file: Any, volts: int, flange: str
) -> None:
    text = f"[supply]\nvoltage_v = {volts}.0\n[flange]\nenabled = {flange}\n"
    design = derive(load(file(text)))
    _assert_rated(design)
    assert bool(design.electrical.supplies) == (flange == "true" and volts > 5)


def _assert_rated(design: Design) -> None:
    """Resistors within 80 % of their rating at the worst case, by a calculation of our own: the
    current that the whole rest of the supply drives through the resistor alone, with every LED at
    its lowest forward voltage, at 60 °C, is above the current that flows."""
    strings, wiring = design.electrical.strings, design.wiring
    assert strings.resistor_high_w <= 0.8 * strings.resistor_rated_w + 1e-12
    for ohm, cells, high in zip(wiring.resistor_ohm, wiring.strings, strings.high_ma, strict=True):
        lowest_v = strings.forward_v - 0.1 - 35 * strings.forward_v_per_k
        left = wiring.supply_v * 1.05 - len(cells) * lowest_v
        bound = 1000 * left / (0.99 * ohm)
        assert wiring.current_ma[0] < high <= bound


@pytest.mark.parametrize("pitch", [3.5, 4.0, 5.0, 7.0, 8.0, 10.0])
def test_any_pitch_derives(file: Any, pitch: float) -> None:
    design = derive(load(file(f"[grid]\npitch_mm = {pitch}\n[mask]\nhole_mm = {0.4 * pitch:g}\n")))
    assert design.layout.pitch_mm == pitch


def test_the_published_grid_keeps_the_published_values(inputs: dict[str, Input]) -> None:
    published = inputs["published"]
    moved = {f for f, a in automatic_fields().items() if published.value(f) != a.start}
    pull_ups = {"receiver.load", "receiver.pull_up_ohm"}
    added = {"emitter.drive", "emitter.switch", "flange.indicator", "receiver.bulk_capacitor"}
    added |= {
        "breakout.feed_diode",
        "breakout.indicator",
        "protection.diode",
        "backing.flare_mm",
        "backing.flare_depth_mm",
    }
    apart = {"wiring.order"}
    assert moved == pull_ups | added | apart, "new designs have more parts and a flare"


def test_every_choice_has_a_value_and_a_reason_in_one_line(file: Any) -> None:
    design = derive(load(file("[grid]\npitch_mm = 3.5\n[mask]\nhole_mm = 1.4\n")))
    choices = {choice.field: choice for choice in design.choices}
    stated = {"receiver.load", "emitter.drive", "emitter.switch", "flange.indicator"}
    stated |= {"breakout.indicator", "receiver.bulk_capacitor", "wiring.order", "protection.diode"}
    stated |= {"breakout.feed_diode", "receiver.pull_up_ohm"}
    assert set(choices) == set(automatic_fields()) - stated, "published.toml states these"
    assert choices["receiver.photodetector"].value == "'PT19-21C'"
    assert "needs a pitch of at least 3.70 mm" in choices["receiver.photodetector"].reason
    assert all(c.reason and "\n" not in c.reason for c in design.choices)


FLEX = '[stack]\nfloor_mm = 2.0\npcb_mm = 0.2\n[backing]\nvariant = "flex"\nmaterial = "TPU 98A"\n'


@pytest.mark.parametrize(("cells", "pitch"), [([3] * 11, 4.0), ([8] * 4, 7.0), ([6, 5] * 3, 6.0)])
def test_the_interface_of_a_compliant_finger_holds_its_multiplexers(
    file: Any, cells: list[int], pitch: float
) -> None:
    grid = f"[grid]\ncolumns = {cells}\npitch_mm = {pitch}\n[mask]\nhole_mm = {0.4 * pitch:g}\n"
    design = derive(load(file(FLEX + grid)))
    assert design.board.flexible
    bend = design.board.flexible.bend
    for part in (p for p in design.receiver.parts if p.name.startswith("U")):
        assert part.box.y_max_mm < bend.y_min_mm


@pytest.mark.parametrize(("rows", "channel_mm"), [(7, "4.0"), (9, "5.0")])
def test_a_board_that_bends_has_a_channel_to_sort_its_lines(
    file: Any, rows: int, channel_mm: str
) -> None:
    bends = '[backing]\nvariant = "flex"\nmaterial = "TPU 95A"\n'
    bends += "[stack]\npcb_mm = 0.17\nfloor_mm = 2.5\n"
    design = derive(load(file(f"[grid]\ncolumns = {[rows] * 8}\n{bends}")))
    chosen = {choice.field: choice.value for choice in design.choices}
    assert chosen["board.channel_mm"] == channel_mm


def test_a_wide_corner_leaves_a_wall_beside_the_groove(file: Any) -> None:
    outline = "[outline]\nshoulder_margin_mm = 10.2\nwaist_margin_mm = 2.7\n"
    grid = "[grid]\ncolumns = [4, 5, 4, 5]\npitch_mm = 8.7\n"
    design = derive(load(file(FLEX + grid + outline)))
    wall_mm = design.outline.end_width_mm / 2 - design.interfaces[0].groove.x_max_mm
    assert wall_mm >= design.printing.min_wall_mm - 1e-6


def test_a_written_interface_takes_no_room_from_the_tracks(file: Any) -> None:
    """It ends among the multiplexers: a narrower channel before them would not help."""
    grid = '[grid]\ncolumns = [6, 5, 6, 5, 6, 5]\n[receiver]\nload = "auto"\n'
    text = FLEX + grid + "[flex]\ninterface_mm = 26.0\n"
    with pytest.raises(RuleError, match=r"at least 3\d\.\d is needed to hold the multiplexers"):
        derive(load(file(text)))


def test_what_a_user_wrote_is_never_altered(file: Any) -> None:
    text = '[emitter]\nresistor = "0603"\n[board]\ntip_margin_mm = 3.65\n'
    resolved = resolve(load(file(text)))
    assert resolved.config.value("emitter.resistor") == "0603"
    assert "emitter.resistor" not in {c.field for c in resolved.design.choices}
    assert resolved.design.electrical.strings.resistor_high_w <= 0.08


REFUSED = {
    "film": "[mask]\nhole_mm = 5.8\n",
    "silicone": "[stack]\nsilicone_mm = 1.0\n",
    "overload": '[emitter]\ncurrent_ma = 22.0\nresistor = "0603"\nstring_leds = 16\n',
    "supply": "[supply]\nmax_ma = 20.0\n[emitter]\ncurrent_ma = 19.0\n",
    "slant": "[tip]\nslant_start_mm = 9.0\n[outline]\ntip_margin_mm = 6.2\n",
    "mux": "[grid]\ncolumns = [9, 8, 9, 8, 9, 8, 9, 8]\npitch_mm = 4.0\n[mask]\nhole_mm = 1.6\n"
    '[receiver]\nmultiplexer = "74HC4051PW"\n',
}


@pytest.mark.parametrize("name", REFUSED)
def test_each_remedy_that_is_named_mends_its_rule(file: Any, name: str) -> None:
    with pytest.raises(RuleError) as caught:
        resolve(load(file(REFUSED[name])))
    plan = plan_of(caught.value.verdict)
    assert plan.complete
    for remedy in plan.steps[0].remedies:
        config = load(file(REFUSED[name])).with_values({remedy.field: remedy.value})
        try:
            left = [p.message for p in ()] if resolve(config) else []
        except RuleError as error:
            left = [p.message for p in error.problems]
        assert plan.steps[0].message not in left


@pytest.mark.parametrize("name", REFUSED)
def test_fix_writes_a_file_that_is_accepted_and_keeps_its_comments(file: Any, name: str) -> None:
    path = file("# mine\n" + REFUSED[name])
    plan, _ = fix(path)
    assert plan.complete and plan.steps
    derive(load(path))
    assert "# mine" in path.read_text(encoding="utf-8")
    assert fix(path)[0].steps == ()


def test_fix_leaves_a_file_that_it_cannot_mend_as_it_was(file: Any) -> None:
    path = file("[grid]\ncolumns = [40, 41, 40]\npitch_mm = 10.0\n")
    before = path.read_bytes()
    plan, _ = fix(path)
    assert not plan.complete
    assert path.read_bytes() == before


def test_a_smaller_change_does_not_mend(file: Any) -> None:
    with pytest.raises(RuleError) as caught:
        resolve(load(file(REFUSED["silicone"])))
    remedy = plan_of(caught.value.verdict).steps[0].remedies[0]
    assert remedy.field == "stack.silicone_mm"
    value = float(str(remedy.value))
    assert math.isclose(value, 1.4)
    with pytest.raises(RuleError):
        resolve(load(file(f"[stack]\nsilicone_mm = {value - 0.05:g}\n")))


def test_copper_follows_what_is_written_of_it(file: Any) -> None:
    for text, field, least in (
        ("track_mm = 0.8", "board.supply_track_mm", 0.8),
        ("via_drill_mm = 0.5", "board.via_mm", 0.7),
        ("via_mm = 0.45", "board.via_mm", 0.45),
    ):
        config = resolve(load(file(f"[board]\n{text}\n"))).config
        assert config.value(field) == least
        assert config.value("board.via_mm") - config.value("board.via_drill_mm") >= 0.2 - 1e-9


@pytest.mark.parametrize(("panel", "gap_mm"), [("none", 0.25), ("rails", 0.5)])
def test_a_narrow_receiver_keeps_room_for_the_mouse_bites_of_a_panel(
    file: Any, panel: str, gap_mm: float
) -> None:
    text = f'[grid]\ncolumns = [9, 8]\n[board]\npanel = "{panel}"\n'
    design = derive(load(file(text)))
    assert design.rules.track_mm < 0.2
    assert design.rules.edge_gap_mm == gap_mm


def test_a_module_reads_as_many_cells_as_its_wires_allow(file: Any) -> None:
    text = '[controller]\nboard = "nrf52840_module"\n[grid]\ncolumns = [8, 8, 8, 8, 8, 8]\n'
    design = derive(load(file(text)))
    assert len(design.layout) == 48
    assert design.wiring.multiplexer == "74HC4067PW"


def test_too_many_cells_are_compared_with_the_largest_multiplexer(file: Any) -> None:
    with pytest.raises(RuleError, match="Use 128 cells or fewer"):
        resolve(
            load(
                file(
                    "[grid]\ncolumns = [16, 17, 16, 17, 16, 17, 16, 17]\npitch_mm = 4.0\n"
                    "[mask]\nhole_mm = 1.6\n"
                )
            )
        )


OWN_PULL_UPS = '[receiver]\npull_up_ohm = "auto"\n'


def test_light_is_never_given_up_for_supply_or_heat(file: Any) -> None:
    """19.2 mA gives 300 µA of light current; 3.1 V over twice 75 kΩ take 20.7 µA, 1.3 mA, of which
    a bare cell takes 95 %, but for half a step of the E24 series."""
    for text in ("[supply]\nmax_ma = 5.0\n", "[emitter]\nmax_heat_w = 0.12\n"):
        design = derive(load(file(text + OWN_PULL_UPS)))
        assert 300 * min(design.wiring.current_ma) / 19.2 > 0.9 * 3.1e6 / design.wiring.pull_up_ohm
    with pytest.raises(RuleError):
        resolve(load(file("[emitter]\nmax_heat_w = 0.05\n" + OWN_PULL_UPS)))


def test_a_range_that_is_not_used_is_not_said_to_be(file: Any) -> None:
    for current, used in ((1.0, False), (2.0, True), (10.0, True)):
        choices = derive(load(file(f"[emitter]\ncurrent_ma = {current}\n{OWN_PULL_UPS}"))).choices
        (reason,) = [c.reason for c in choices if c.field == "receiver.pull_up_ohm"]
        assert ("nearly all of its range" in reason) == used, reason


def test_a_thick_plate_slants_from_farther_back(file: Any) -> None:
    design = derive(load(file("[stack]\nfloor_mm = 5.0\n")))
    assert design.tip.angle_deg <= 45 + 1e-9
    assert design.board.pocket.y_max_mm <= design.tip.slant_start_y_mm + 1e-6


@pytest.mark.parametrize(
    ("columns", "multiplexer", "pins", "weak"),
    [
        (6, "auto", ["A0", "A1", "A2", "A3", "A6", "A7"], ""),
        (8, "auto", ["A0", "A1", "A2", "A3"], ""),  # of 16 inputs each
        (7, "74HC4051PW", ["A0", "A1", "A2", "A3", "A6", "A7", "A4"], "A4: 4700 Ω"),
        (16, "auto", ["A0", "A1", "A2", "A3", "A6", "A7", "A4", "A5"], "A4 and A5: 4700 Ω"),
    ],
)
def test_inputs_with_pull_ups_are_used_when_no_other_is_left_and_then_stated(
    file: Any, columns: int, multiplexer: str, pins: list[str], weak: str
) -> None:
    text = f"[grid]\ncolumns = {[8] * columns}\npitch_mm = 5.0\n"
    text += f'[receiver]\nmultiplexer = "{multiplexer}"\n'
    wiring = derive(load(file(text))).wiring
    assert list(wiring.adc_pins) == pins
    assert pulled_up(wiring).startswith(weak)
    assert bool(pulled_up(wiring)) == bool(weak)

"""Random user files: always the same for a seed, within the ranges, and no more than edits."""

import tomllib
from itertools import pairwise
from pathlib import Path

import pytest

from acceptance.generator import COUNTS, Design, design
from acceptance.grids import LEAST_CELLS, MOST_CELLS, USUAL_CELLS
from acceptance.kinds import KINDS
from acceptance.limits import Values, crossed
from acceptance.parts import BASE, DEFAULT, entries, preset, preset_file
from acceptance.trial import derive_file, fill

DEPENDENT = {
    "emitter.current_ma",
    "emitter.string_leds",
    "emitter.resistor_side",
    "board.tip_margin_mm",
    "board.end_margin_mm",
    "board.hole_mm",
    "board.hole_edge_mm",
    "board.channel_mm",
    "board.track_mm",
    "board.supply_track_mm",
    "board.copper_gap_mm",
    "board.via_mm",
    "board.via_drill_mm",
    "board.clearance_mm",
    "stack.film_mm",
    "mould.wall_mm",
    "mould.draft_deg",
    "mould.taper_length_mm",
    "tip.slant_start_mm",
    "backing.density_g_ml",
}


@pytest.fixture(scope="module", params=[BASE, DEFAULT])
def designs(request: pytest.FixtureRequest) -> list[Design]:
    return [design(3, i, request.param) for i in range(400)]


def test_a_seed_and_an_index_make_the_same_file_again(designs: list[Design]) -> None:
    (usual,) = {d.base for d in designs if "preset" not in d.kinds}
    assert [design(3, i, usual).text for i in range(40)] == [d.text for d in designs[:40]]
    assert {design(4, i, usual).text.split("\n", 2)[2] for i in range(40)} != {
        d.text.split("\n", 2)[2] for d in designs[:40]
    }


def test_a_file_says_what_its_edits_are_and_nothing_else(designs: list[Design]) -> None:
    for drawn in designs:
        table = tomllib.loads(drawn.text)
        assert table.pop("extends") == preset_file(drawn.base)
        fields = {k: v for k, v in table.items() if not isinstance(v, dict)}
        for section, values in table.items():
            if isinstance(values, dict):
                fields |= {f"{section}.{key}": value for key, value in values.items()}
        assert fields == drawn.edits


def test_each_edit_changes_something_that_does_not_follow_from_others(
    designs: list[Design],
) -> None:
    for drawn in designs:
        assert len(drawn.kinds) in COUNTS
        assert not DEPENDENT & set(drawn.edits)
        assert all(value != preset(drawn.base)[f] for f, value in drawn.edits.items())
        assert len(drawn.edits) >= len(drawn.kinds) - ("preset" in drawn.kinds)


def test_every_kind_is_drawn_and_no_value_leaves_its_range(designs: list[Design]) -> None:
    drawn = {kind for d in designs for kind in d.kinds}
    assert drawn - {"preset"} >= {k.name for k in KINDS} - {"flange", "casting", "optics"}
    for field, low, high in (
        ("grid.pitch_mm", 3.5, 10),
        ("stack.silicone_mm", 0.8, 4),
        ("tip.edge_mm", 0.5, 1.6),
        ("tip.angle_deg", 0, 45),
        ("outline.tip_margin_mm", 5.5, 9),
        ("supply.voltage_v", 5, 24),
        ("mask.flap_mm", 12, 16),
    ):
        values = [d.edits[field] for d in designs if field in d.edits]
        assert low <= min(values) and max(values) <= high, field
        assert len(set(values)) >= 3, field
    shares = [
        d.edits["mask.hole_mm"] / Values(d.edits, d.base)["grid.pitch_mm"]
        for d in designs
        if "mask.hole_mm" in d.edits
    ]
    assert 0.3 <= min(shares) < 0.35 and 0.5 < max(shares) <= 0.55


def test_grids_are_of_every_kind_and_most_are_of_a_usual_size(designs: list[Design]) -> None:
    grids = [d.edits["grid.columns"] for d in designs if "grid.columns" in d.edits]
    cells = [sum(columns) for columns in grids]
    assert all(LEAST_CELLS <= count <= MOST_CELLS for count in cells)
    assert max(cells) > 150
    usual = sum(USUAL_CELLS[0] <= n <= USUAL_CELLS[1] for n in cells)
    assert usual > 0.6 * len(cells)
    steps = [{b - a for a, b in pairwise(c)} for c in grids]
    assert any(s == {1, -1} for s in steps)
    assert any(s == {0} for s in steps)
    assert any(s == set() for s in steps)
    assert any(s & {2, 3, -2, -3} for s in steps)


def test_no_design_crosses_a_physical_limit(designs: list[Design]) -> None:
    assert [d.name for d in designs if crossed(Values(d.edits, d.base))] == []


@pytest.mark.parametrize(
    ("edits", "limit"),
    [
        ({"stack.silicone_mm": 0.8}, "cover"),
        ({"supply.voltage_v": 5.0}, "step-down"),
        ({"grid.columns": [16] * 16, "grid.pitch_mm": 10.0}, "page"),
        ({"grid.columns": [13, 12, 9, 6, *[1] * 15], "grid.pitch_mm": 6.0}, "page"),
        ({"grid.columns": [15] * 11}, "inputs"),
        ({"grid.pitch_mm": 3.6}, "land patterns"),
        ({"grid.pitch_mm": 3.8, "grid.columns": [14, 13, 14]}, "lines"),
        ({"flange.enabled": False, "controller.board": "nrf52840_module"}, "module"),
        ({"tip.edge_mm": 1.5, "stack.floor_mm": 0.8, "stack.pcb_mm": 0.8}, "plate"),
        ({"holder.screw": "M5"}, "nut"),
        ({"backing.material": "TPU 98A"}, "bending"),
    ],
)
def test_what_cannot_exist_crosses_its_limit(edits: dict[str, object], limit: str) -> None:
    assert crossed(Values(edits, "published")).partition(":")[0] == limit


def test_the_presets_cross_no_limit_but_the_pitch_of_the_dense_one() -> None:
    for name in ("published", "flex", "integrated", "mux16", "wsg50", "franka_hand", "asymmetric"):
        assert crossed(Values({}, name)) == ""


def test_every_entry_of_the_kinds_that_a_user_chooses_from_is_drawn() -> None:
    drawn = [design(5, i) for i in range(3000)]
    for field, kind, left_out in (
        ("coupling.gripper", "grippers", set()),
        ("controller.board", "controllers", set()),
        ("emitter.resistor", "resistors", set()),
        ("mould.silicone", "silicones", set()),
        ("mask.film", "films", {n for n, f in entries("films").items() if f.get("opaque")}),
        ("printer.profile", "printers", set()),
        ("backing.material", "filaments", set()),
        ("emitter.led", "leds", set()),
        ("receiver.photodetector", "photodetectors", set()),
        ("flange.fuse", "fuses", set()),
        ("holder.screw", "fasteners", {"M4", "M5", "M6", "M8"}),
    ):
        drawn_names = {d.edits[field] for d in drawn if field in d.edits}
        used = (drawn_names | {preset("published")[field]}) - {"auto"}
        assert used == set(entries(kind)) - left_out, field


@pytest.mark.slow
def test_edits_of_the_default_design_are_accepted(tmp_path: Path) -> None:
    """A switch of the LEDs that another edit leaves no room for, too, is no reason to refuse."""
    fill(tmp_path)
    refused = {}
    for drawn in (design(11, i, DEFAULT) for i in range(30)):
        file = tmp_path / f"{drawn.name}.toml"
        file.write_text(drawn.text, encoding="utf-8")
        trial = derive_file(file)
        if not trial.accepted:
            refused[drawn.kinds] = trial
    assert not refused

"""What fingers, flange and holder weigh, told from the files that were built."""

import csv
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from lumitip_fab.cli import main
from lumitip_fab.cli.built import built_rows
from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import read_design
from lumitip_fab.errors import OutputError


def test_the_payload_is_both_fingers(outputs: Path) -> None:
    rows = {
        r.quantity: r.computed for r in built_rows(outputs, read_design(outputs / "design.json"))
    }
    told = [
        float(rows[f"mass of the {f} finger"].removesuffix(" g")) for f in ("emitter", "receiver")
    ]
    assert all(10 < mass < 40 for mass in told)
    assert float(rows["payload of both fingers"].removesuffix(" g")) == pytest.approx(
        sum(told), abs=0.11
    )


@pytest.mark.slow
def test_flange_and_holder_weigh_what_their_filament_and_boards_do(outputs: Path) -> None:
    rows = {
        r.quantity: r.computed for r in built_rows(outputs, read_design(outputs / "design.json"))
    }
    with (outputs / "bom.csv").open(encoding="utf-8", newline="") as file:
        printed = {
            row["item"]: float(row["quantity"])
            for row in csv.DictReader(file)
            if row["group"] == "prints"
        }
    areas = {"flange": 30.8 * 54.0, "holder": 45.72 * 33.02}
    g_mm2 = 1.6 * 1.85e-3 + 0.7 * 2 * 0.035 * (8.96 - 1.85) * 1e-3  # FR-4, 70 % under copper
    for name, area_mm2 in areas.items():
        solid = sum(grams for item, grams in printed.items() if item.startswith(f"{name}/"))
        told = float(rows[f"mass of the {name}"].removesuffix(" g"))
        assert told == pytest.approx(solid + area_mm2 * g_mm2, abs=0.2)


@pytest.mark.slow
def test_the_flanges_safety_is_told_as_an_estimate(outputs: Path) -> None:
    rows = {r.quantity: r for r in built_rows(outputs, read_design(outputs / "design.json"))}
    layers, heads = (
        rows[name] for name in ("safety of the flange's layers", "... right under its bolts' heads")
    )
    assert (float(layers.computed), float(heads.computed)) == pytest.approx((10.5, 3.4), abs=0.11)
    for row in (layers, heads):
        assert "5.9 kg of gripper and payload" in row.reason
        assert "an estimate, not tested" in row.reason


@pytest.mark.slow
def test_the_orientation_of_the_print_has_both_figures(outputs: Path) -> None:
    design = read_design(outputs / "design.json")
    rows = {r.quantity: r for r in built_rows(outputs, design)}
    safety = rows["safety of a finger's layers"].computed
    row = rows["orientation of the backings' print"]
    assert row.computed == "standing"
    found = re.search(r"bear (\S+) times the load standing, and (\S+) times lying", row.reason)
    assert found and found[1] == safety and float(found[2]) > 1.5 * float(safety)
    assert "needs support: at least 43 mm hang over nothing" in row.reason
    assert f"the printer bridges {design.printing.bridge_mm:g} mm" in row.reason
    weak = replace(design.slicing.backing, plane_mpa=5.0)
    other = replace(design, slicing=replace(design.slicing, backing=weak))
    (row,) = (r for r in built_rows(outputs, other) if r.quantity == row.quantity)
    assert "standing, and no more lying: 0.5 times" in row.reason


def test_a_filament_without_a_strength_within_its_layers_has_that_between_them(
    inputs: dict[str, Input],
) -> None:
    config = inputs["published"]
    known = config.catalogue.filaments
    bare = known["PETG"].model_copy(update={"plane_mpa": None})
    catalogue = config.catalogue.model_copy(update={"filaments": {**known, "PETG": bare}})
    filament = derive(replace(config, catalogue=catalogue)).slicing.backing
    assert filament.plane_mpa == filament.layer_mpa == 15.0
    assert derive(config).slicing.backing.plane_mpa == known["PETG"].plane_mpa == 30.0


def test_boards_weigh_by_their_laminate_and_copper(inputs: dict[str, Input]) -> None:
    """g/mL of 1.6 mm FR-4 under 35 µm, and of 0.2 mm polyimide under 18 µm on 70 % of each side."""
    rigid, flex = (derive(inputs[name]).densities for name in ("published", "flex"))
    fr4 = 1.85 + 0.7 * 0.07 / 1.6 * (8.96 - 1.85)
    polyimide = 1.42 + 0.7 * 0.036 / 0.2 * (8.96 - 1.42)
    assert (rigid.board_g_ml, rigid.auxiliary_g_ml) == pytest.approx((fr4, fr4), abs=1e-6)
    assert (flex.board_g_ml, flex.auxiliary_g_ml) == pytest.approx((polyimide, fr4), abs=1e-6)


@pytest.mark.slow
def test_boards_outside_compliant_fingers_weigh_what_stiff_ones_do(
    built: Callable[[str], Path], outputs: Path
) -> None:
    told = [
        {r.quantity: r.computed for r in built_rows(out, read_design(out / "design.json"))}
        for out in (outputs, built("flex"))
    ]
    rigid, flex = (float(rows["mass of the flange"].removesuffix(" g")) for rows in told)
    assert flex == pytest.approx(rigid, abs=0.11)


@pytest.mark.slow
def test_a_printed_part_that_is_missing_is_told(damaged: Path) -> None:
    design = read_design(damaged / "design.json")
    (damaged / "flange/flange_upper.stl").unlink()
    with pytest.raises(OutputError):
        built_rows(damaged, design)


def test_files_of_another_design_are_refused(
    outputs: Path, design_dir: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = design_dir / "presets" / "dense.toml"
    assert main(["spec", str(file), "--out", str(outputs)]) == 2
    assert "not built from these values: run lumitip-fab build first" in capsys.readouterr().err


@pytest.mark.slow
def test_the_command_adds_the_rows(
    outputs: Path, design_dir: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        main(["spec", str(design_dir / "presets/published.toml"), "--out", str(outputs), "--json"])
        == 0
    )
    assert "payload of both fingers" in capsys.readouterr().out


@pytest.mark.slow
def test_a_model_that_is_missing_is_told(damaged: Path) -> None:
    design = read_design(damaged / "design.json")
    (damaged / "flange/flange_lower.stl").unlink()
    with pytest.raises(OutputError, match="no such file"):
        built_rows(damaged, design)

"""Damage the slicer's settings, and exactly the right checks fail; filaments and their rules."""

import dataclasses
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.checks.printing import measure
from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text, read_design
from lumitip_fab.errors import InputError
from lumitip_fab.parts.settings import print_settings


def _written(design: Design, out: Path) -> Path:
    (out / "print").mkdir(parents=True)
    (out / "design.json").write_text(design_text(design), encoding="utf-8")
    for artefact in print_settings(design):
        (out / artefact.path).write_bytes(artefact.data)
    return out


@pytest.fixture(scope="module")
def config(design_dir: Path) -> Input:
    return load(design_dir / "presets" / "published.toml")


@pytest.fixture(scope="module")
def settings(config: Input, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Settings of the published design and `design.json`. Do not change them."""
    return _written(derive(config), tmp_path_factory.mktemp("settings") / "out")


def failing(folder: Path) -> set[str]:
    design = read_design(folder / "design.json")
    return {m.check.removeprefix("printing.") for m in measure(folder, design) if not m.passed}


INI, MOULD, NOTE = "petg.ini", "petg_mould.ini", "printing.md"
SHEET = "tpu_95a_mask.ini"
EDITS = [
    (INI, "\nlayer_height = 0.2", "\nlayer_height = 0.3", {"settings"}),
    (INI, "first_layer_height = 0.2", "first_layer_height = 0.35", {"settings"}),
    (MOULD, "\nlayer_height = 0.15", "\nlayer_height = 0.2", {"settings", "mould_layers"}),
    (MOULD, "\nlayer_height = 0.15", "\nlayer_height = 0", {"settings", "mould_layers"}),
    (MOULD, "\nlayer_height = 0.15", "\nlayer_height = nan", {"settings", "mould_layers"}),
    (MOULD, "\nlayer_height = 0.15", "\nlayer_height = 1e-310", {"settings", "mould_layers"}),
    (MOULD, "\ntemperature = 240", "\ntemperature = 204", {"settings"}),
    (INI, "\nextrusion_width = 0.45", "\nextrusion_width = 0.6", {"settings"}),
    (
        INI,
        "external_perimeter_extrusion_width = 0.45",
        "external_perimeter_extrusion_width = 0",
        {"settings"},
    ),
    (INI, "first_layer_extrusion_width = 0.45", "first_layer_extrusion_width = 0.9", {"settings"}),
    (INI, "\nperimeter_extrusion_width = 0.45", "\nperimeter_extrusion_width = 0", {"settings"}),
    (INI, "\ninfill_extrusion_width = 0.45", "\ninfill_extrusion_width = 0.9", {"settings"}),
    (INI, "\nsolid_infill_extrusion_width", "\nsolid_infill_width", {"settings"}),
    (INI, "top_infill_extrusion_width = 0.45", "top_infill_extrusion_width = 1", {"settings"}),
    (INI, "perimeter_generator = arachne", "perimeter_generator = classic", {"settings"}),
    (INI, "filament_diameter = 1.75", "filament_diameter = 2.85", {"settings"}),
    (INI, "\nperimeter_speed = 45", "\nperimeter_speed = 450", {"settings"}),
    (INI, "first_layer_bed_temperature = 85", "first_layer_bed_temperature = 0", {"settings"}),
    (INI, "nozzle_diameter = 0.4", "nozzle_diameter = 0.6", {"settings"}),
    (INI, "support_material = 0", "support_material = 1", {"settings"}),
    (INI, "fill_density = 100%", "fill_density = 15%", {"settings"}),
    (INI, "250x210", "180x180", {"settings"}),
    (INI, "max_print_height = 210", "max_print_height = 21", {"settings"}),
    (INI, "filament_density = 1.27", "filament_density = 1.72", {"settings"}),
    (INI, "filament_type = PET", "filament_type = PLA", {"settings"}),
    (INI, "filament_max_volumetric_speed = 8", "filament_max_volumetric_speed = 80", {"settings"}),
    (INI, "\ntemperature = 240", "\ntemperature = 204", {"settings"}),
    (INI, "\nbed_temperature = 85\n", "\n", {"settings"}),
    (INI, "min_fan_speed = 30", "min_fan_speed = 100", {"settings"}),
    (INI, "max_fan_speed = 50", "max_fan_speed = 0", {"settings"}),
    (INI, "retract_length = 0.8", "retract_length = 8", {"settings"}),
    (INI, "first_layer_temperature = 245", "first_layer_temperature = 145", {"settings"}),
    (INI, "\nperimeters = 3", "\nperimeters = 0", {"settings"}),
    (INI, "brim_width = 3", "brim_width = 0", {"settings"}),
    (SHEET, "brim_width = 0", "brim_width = 3", {"settings"}),
    (INI, "\nskirts = 0\n", "\n", {"settings"}),
    (INI, "\nskirts = 0\n", "\nskirts = 0\nspiral_vase = 1\n", {"settings"}),
    (INI, "\nskirts = 0\n", "\nskirts = 0\nxy_size_compensation = -0.3\n", {"settings"}),
    (INI, "\nskirts = 0\n", "\nskirts = 0\nskirts = 0\n", {"settings"}),
    (INI, "first_layer_speed = 20", "first_layer_speed = 200", {"settings"}),
    (INI, "bridge_fan_speed = 50", "bridge_fan_speed = 0", {"settings"}),
    (INI, "fan_always_on = 1", "fan_always_on = 0", {"settings"}),
    (NOTE, "| `mould/emitter_mould.3mf`", "| `mould/emitter_cast.3mf`", {"parts"}),
    (NOTE, "| `gauge/gauge_card.3mf`", "| `gauge/card.3mf`", {"parts"}),
    (NOTE, "petg.ini` | PETG | 0.2 mm | on", "pla.ini` | PLA | 0.2 mm | on", {"parts"}),
    (NOTE, "`print/petg_mould.ini` | PETG | 0.15", "`print/petg.ini` | PETG | 0.2", {"parts"}),
    (NOTE, "petg_mould.ini` | PETG | 0.15", "petg_mould.ini` | PETG | 0.2", {"parts"}),
    (NOTE, "petg_mould.ini` | PETG | 0.15", "petg_mould.ini` | PLA | 0.15", {"parts"}),
    (NOTE, "feet up; print 2", "feet up; print 1", {"parts"}),
    (NOTE, "stop up; print 2", "stop up", {"parts"}),
    (NOTE, "open side up", "open side down", {"parts"}),
    (NOTE, "mount face, tip up", "mount face, on its back", {"parts"}),
    (SHEET, "layer_height = 0.2", "layer_height = 0.3", {"settings"}),
    (SHEET, "filament_type = FLEX", "filament_type = PLA", {"settings"}),
    (NOTE, "tpu_95a_mask.ini` | TPU 95A", "petg.ini` | PETG", {"parts"}),
    (NOTE, "| `backing/receiver_backing.3mf`", "`backing/receiver_backing.3mf`", {"parts"}),
]


def test_nothing_fails_as_it_is_written(settings: Path) -> None:
    assert failing(settings) == set()


@pytest.mark.parametrize(("file", "old", "new", "expected"), EDITS)
def test_a_damage_fails_its_check(
    settings: Path, tmp_path: Path, file: str, old: str, new: str, expected: set[str]
) -> None:
    damaged = Path(shutil.copytree(settings, tmp_path / "damaged"))
    path = damaged / "print" / file
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    assert failing(damaged) == expected


def test_a_file_that_no_filament_has(settings: Path, tmp_path: Path) -> None:
    damaged = Path(shutil.copytree(settings, tmp_path / "damaged"))
    (damaged / "print/petg.ini~").write_text("an editor's copy")
    assert failing(damaged) == set()
    shutil.copy(damaged / "print" / INI, damaged / "print/petg_fast.ini")
    assert failing(damaged) == {"files"}


def test_lost_files_are_told(settings: Path, tmp_path: Path) -> None:
    damaged = Path(shutil.copytree(settings, tmp_path / "damaged"))
    (damaged / "print" / INI).unlink()
    assert failing(damaged) == {"settings"}
    (damaged / "print" / NOTE).write_bytes(b"\xff\xfe")
    assert failing(damaged) == {"settings", "parts"}
    (damaged / "print" / MOULD).unlink()
    assert failing(damaged) == {"settings", "parts", "mould_layers"}


def _with(config: Input, material: str, **filament: Any) -> Input:
    """A compliant finger of a material, with other figures in the filament's entry."""
    compliant = config.with_values(
        {
            "backing.variant": "flex",
            "backing.material": material,
            "stack.floor_mm": 2.0,
            "stack.pcb_mm": 0.2,
        }
    )
    known = dict(config.catalogue.filaments)
    known[material] = known[material].model_copy(update=filament)
    catalogue = config.catalogue.model_copy(update={"filaments": known})
    return dataclasses.replace(compliant, catalogue=catalogue)


@pytest.mark.slow
def test_what_must_not_bend_is_printed_from_another_filament(config: Input, tmp_path: Path) -> None:
    design = derive(_with(config, "TPU 98A"))
    told = design.slicing
    assert (told.backing.name, told.rigid.name) == ("TPU 98A", "PETG")
    tpu = config.catalogue.filaments["TPU 98A"]
    assert told.backing.density_g_ml == tpu.density_g_ml
    out = _written(design, tmp_path / "out")
    assert failing(out) == set()
    assert sorted(p.name for p in (out / "print").iterdir()) == [
        "petg.ini",
        "petg_mould.ini",
        "printing.md",
        "tpu_95a_mask.ini",
        "tpu_98a.ini",
    ]
    note = (out / "print/printing.md").read_text(encoding="utf-8")
    assert re.search(r"emitter_backing.3mf` \| `print/tpu_98a.ini", note)
    assert re.search(r"emitter_mould.3mf` \| `print/petg_mould.ini", note)


@pytest.mark.slow
@pytest.mark.parametrize("other", ["TPU 98A", "wood"])
def test_a_filament_for_rigid_parts_must_be_one(config: Input, other: str) -> None:
    with pytest.raises(InputError, match=f"whose rigid_parts is '{other}'; the name of a filament"):
        derive(_with(config, "TPU 98A", rigid_parts=other))


def test_no_file_of_their_own_where_the_moulds_are_whole_layers(
    config: Input, tmp_path: Path
) -> None:
    stack = config.parameters.stack.model_copy(update={"silicone_mm": 1.4})
    parameters = config.parameters.model_copy(update={"stack": stack})
    design = derive(dataclasses.replace(config, parameters=parameters))
    assert design.slicing.mould == design.slicing.rigid
    out = _written(design, tmp_path / "out")
    assert failing(out) == set()
    files = sorted(p.name for p in (out / "print").iterdir())
    assert files == ["petg.ini", "printing.md", "tpu_95a_mask.ini"]


def test_heights_that_no_layer_divides_are_told(config: Input, tmp_path: Path) -> None:
    stack = config.parameters.stack.model_copy(update={"silicone_mm": 1.53})
    parameters = config.parameters.model_copy(update={"stack": stack})
    design = derive(dataclasses.replace(config, parameters=parameters))
    assert design.slicing.mould.layer_mm == 0.2
    assert design.mould.off_layer_mm == pytest.approx(0.07)
    assert failing(_written(design, tmp_path / "out")) == set()

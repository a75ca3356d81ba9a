"""The printed mask: its body, what refuses it, and how PrusaSlicer lays its lines."""

import dataclasses
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree

from lumitip.grid import Floats
from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design, Finger
from lumitip_fab.errors import InputError
from lumitip_fab.parts import slicing
from lumitip_fab.parts.settings import print_settings
from lumitip_fab.parts.sheet import sheet_files
from programs import program

pytestmark = pytest.mark.slow


@pytest.fixture
def by_route(design_dir: Path) -> Callable[..., Input]:
    """The published design with a printed mask and other values."""

    def vary(**values: object) -> Input:
        config = load(design_dir / "presets/published.toml")
        named = {key.replace("__", "."): value for key, value in values.items()}
        return config.with_values({"mask.route": "tpu", **named})

    return vary


def test_thickness_holes_and_grooves_follow_printer_and_filament(
    by_route: Callable[..., Input],
) -> None:
    design = derive(by_route(printer__profile="fdm 0.25", mask__layers=3))
    sheet = design.mask.sheet
    assert (sheet.thickness_mm, design.stack.film_mm) == (0.3, 0.3)
    assert design.layout.optics.film_mm == 0.3
    assert sheet.fold_mm == 2 * sheet.line_mm == 0.56
    assert design.densities.film_g_ml == design.slicing.sheet.density_g_ml
    single = derive(by_route(mask__layers=1)).mask.sheet
    assert (single.fold_mm, single.letter) == (0.0, False)


def test_holes_are_drawn_larger_by_what_the_print_loses(by_route: Callable[..., Input]) -> None:
    lossy = with_entry(by_route(mask__hole_mm=2.4), "filaments", "TPU 95A", hole_loss_mm=0.2)
    design = derive(lossy)
    assert (set(design.mask.holes_mm), design.mask.sheet.hole_loss_mm) == ({2.4}, 0.2)
    assert design.layout.optics.hole_mm == 2.4
    with pytest.raises(
        InputError, match=r"is 5\.4 and drawn 0\.2 mm wider, which leaves webs of 0\.40 mm"
    ):
        derive(lossy.with_values({"mask.hole_mm": 5.4}))


def with_entry(config: Input, kind: str, name: str, **values: object) -> Input:
    """The same input with other figures in an entry of the catalogue."""
    table = getattr(config.catalogue, kind)
    entries = {**table, name: table[name].model_copy(update=values)}
    return dataclasses.replace(
        config, catalogue=config.catalogue.model_copy(update={kind: entries})
    )


def test_a_sheet_that_cannot_be_printed_is_refused(by_route: Callable[..., Input]) -> None:
    with pytest.raises(
        InputError, match=r"at least one printed line of 0\.45 is needed, or the holes"
    ):
        derive(by_route(mask__hole_mm=0.4))
    with pytest.raises(InputError, match=r"which does not bend; a filament with rigid_parts in"):
        derive(by_route(mask__filament="PLA"))
    narrow = with_entry(by_route(), "printers", "fdm 0.4", bed_mm=(84.5, 210.0, 210.0))
    with pytest.raises(InputError, match=r"a bed of 84\.5 x 210 mm; a mask of 8\d x 8\d mm"):
        derive(narrow)
    assert derive(narrow.with_values({"mask.route": "film"})).mask.route == "film"


def test_the_same_design_gives_the_same_bytes(by_route: Callable[..., Input]) -> None:
    one, other = (derive(by_route()) for _ in range(2))
    for finger, again in zip(one.fingers, other.fingers, strict=True):
        first, second = sheet_files(one, finger), sheet_files(other, again)
        assert [a.data for a in first] == [a.data for a in second]


def open_mm(design: Design, folder: Path, finger: Finger) -> list[Floats]:
    """Diameter within the lines round each hole of a finger, for each layer (mm)."""
    for artefact in (*print_settings(design), *sheet_files(design, finger)):
        path = folder / artefact.path
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(artefact.data)
    stem, code = folder / f"mask/{finger.name}_sheet", folder / "sheet.gcode"
    command = [program("prusa-slicer"), "--export-gcode", "--load"]
    command += [folder / design.slicing.sheet.file, "--output", code, stem.with_suffix(".3mf")]
    subprocess.run(command, check=True, capture_output=True)
    layers = slicing.layers_of(code.read_text(encoding="utf-8"))
    assert len(layers) == design.mask.sheet.layers
    # The slicer puts the middle of the part onto the middle of the bed.
    middle = trimesh.load(stem.with_suffix(".stl"), force="mesh").bounds[:, :2].mean(axis=0)
    cells = np.array(finger.cells) * (-1.0, 1.0) - middle + np.array(design.printing.bed_mm[:2]) / 2
    trees = [cKDTree(layer.points_mm) for layer in layers]
    return [2 * tree.query(cells)[0] - design.printing.line_mm for tree in trees]


@pytest.mark.parametrize(
    ("preset", "values"),
    [
        ("published", {}),
        ("flex", {}),
        ("dense", {"mask.layers": 1}),
        ("asymmetric", {"mask.hole_mm": 0.6, "mask.hole_shape": "circle"}),
        ("published", {"printer.profile": "fdm 0.6"}),
    ],
)
def test_every_hole_stays_open_between_the_lines_of_each_layer(
    design_dir: Path, tmp_path: Path, preset: str, values: dict[str, object]
) -> None:
    config = load(design_dir / "presets" / f"{preset}.toml")
    design = derive(config.with_values({"mask.route": "tpu", **values}))
    for finger in design.fingers:
        for diameters in open_mm(design, tmp_path, finger):
            assert len(diameters) == len(design.layout)
            assert diameters.min() > min(design.mask.holes_mm) - 0.1
            assert diameters.max() < max(design.mask.holes_mm) + 0.25  # the first layer is set back

"""A hole size for each cell: where it arrives, and what is refused."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lumitip import Layout
from lumitip_fab.checks.run import run_checks
from lumitip_fab.cli.build import build
from lumitip_fab.config.load import Input, load
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import design_text
from lumitip_fab.errors import InputError
from lumitip_fab.mask.artwork import artwork_of

SIZES = tuple(np.random.default_rng(2).uniform(1.8, 3.4, 32).round(2).tolist())
MASK_CHECKS = {"mask.size", "mask_cut.size", "mask_sheet.size"}


@pytest.fixture(scope="module")
def published(design_dir: Path) -> Input:
    return load(design_dir / "presets/published.toml")


@pytest.mark.parametrize("shape", ["hexagon", "circle"])
def test_each_cell_has_its_size_over_led_and_detector(published: Input, shape: str) -> None:
    design = derive(published.with_values({"mask.cell_holes_mm": SIZES, "mask.hole_shape": shape}))
    assert design.layout.hole_mm == pytest.approx(SIZES)
    assert Layout.from_json(design.layout.to_json()).hole_mm == pytest.approx(SIZES)
    for finger in design.fingers:
        for cell, path, size in zip(
            finger.cells, artwork_of(design, finger, design.mask).apertures, SIZES, strict=True
        ):
            corners = np.array(path.corners)
            assert corners.mean(axis=0) == pytest.approx(cell, abs=1e-9)
            across = np.ptp(corners[:, 1])
            assert across == pytest.approx(size, abs=1e-9)


def other(sizes: tuple[float, ...], n: int, size: float) -> tuple[float, ...]:
    return (*sizes[:n], size, *sizes[n + 1 :])


ALIKE = (2.5,) * 32
REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "too few": ({"mask.cell_holes_mm": ALIKE[:31]}, "has 31 sizes, but grid.columns has 32 cells"),
    "another grid": ({"grid.columns": (5, 4, 5), "mask.cell_holes_mm": ALIKE}, "has 14 cells"),
    "neighbours meet": (
        {"mask.cell_holes_mm": other(other(ALIKE, 6, 6.5), 7, 5.5)},
        "has 2.5 to 6.5, which leaves 0.00 mm between apertures 6 mm apart",
    ),
    "two cells apart": (
        {"mask.cell_holes_mm": other(other((2.0,) * 32, 2, 9.2), 11, 9.2)},
        "wide apertures two cells apart",
    ),
    "closed in print": (
        {"mask.cell_holes_mm": other(ALIKE, 3, 0.4), "mask.route": "tpu"},
        "or the holes of the printed sheet close",
    ),
}


@pytest.mark.slow_cases
@pytest.mark.parametrize(("changes", "text"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_made_is_refused_with_its_field(
    published: Input, changes: dict[str, Any], text: str
) -> None:
    with pytest.raises(InputError) as refusal:
        derive(published.with_values(changes))
    found = {p.field: p.message for p in refusal.value.problems if text in p.message}
    assert set(found) == {"mask.cell_holes_mm"}, refusal.value


def test_two_wide_holes_may_be_apart(published: Input) -> None:
    """The web counts between neighbours, not between the widest two."""
    assert derive(published.with_values({"mask.cell_holes_mm": other(ALIKE, 6, 6.5)}))


@pytest.mark.slow
def test_every_file_of_the_masks_is_held_against_each_cells_size(
    design_dir: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "design"
    (folder / "presets").mkdir(parents=True)
    for name in ("parts", "presets"):
        for file in (design_dir / name).glob("*.toml"):
            (folder / name).mkdir(exist_ok=True)
            (folder / name / file.name).write_bytes(file.read_bytes())
    file = folder / "presets/sized.toml"
    file.write_text(f'extends = "published.toml"\n[mask]\ncell_holes_mm = {list(SIZES)}\n')
    out = tmp_path / "out"
    build(file, out)
    assert [m.check for m in run_checks(out).failed] == []
    design = derive(load(file))
    swapped = replace(design, mask=replace(design.mask, holes_mm=(SIZES[1], SIZES[0], *SIZES[2:])))
    (out / "design.json").write_text(design_text(swapped))
    modules = ["mask", "mask_cut", "mask_sheet"]
    assert {m.check for m in run_checks(out, modules).failed} == MASK_CHECKS

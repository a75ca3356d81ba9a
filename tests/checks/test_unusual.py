"""Designs far from the published one: built whole and held against every check, or refused."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.checks.run import run_checks
from lumitip_fab.cli.build import build
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.errors import FabError

Changes = dict[str, object]

THICK: Changes = {
    "stack.pcb_mm": 3.2,
    "stack.silicone_mm": 6.0,
    "mould.draft_deg": 4.7,
    "mould.wall_mm": 1.6,
    "mould.tip_silicone_mm": 1.5,
    "mask.flap_mm": 25.0,
}
WIDE: Changes = {"grid.pitch_mm": 10.0, "stack.floor_mm": 2.5}
UPRIGHT: Changes = {
    "coupling.gripper": "upright",
    "printer.profile": "small",
    "mask.hole_shape": "circle",
    "stack.floor_mm": 2.4,
    "stack.silicone_mm": 3.0,
    "backing.tail_mm": 4.0,
    "backing.pocket_clearance_mm": 0.3,
    "tip.slant_start_mm": 5.9,
    "mould.wall_gap_mm": 0.28,
    "mould.taper_length_mm": 3.9,
}


@pytest.fixture
def changed(design_dir: Path, tmp_path: Path) -> Callable[[Changes], Path]:
    """`changed({"mask.hole_mm": 2.0})`: the published design with other values, and with a
    gripper that does not lean and printers with small beds to choose from."""

    def write(changes: Changes) -> Path:
        folder = Path(shutil.copytree(design_dir, tmp_path / "design"))
        grippers, printers = folder / "parts/grippers.toml", folder / "parts/printers.toml"
        text = grippers.read_text(encoding="utf-8")
        entry = text[text.index("[robotiq_2f85]") : text.index("[robotiq_2f140]")]
        entry = entry.replace("robotiq_2f85", "upright")
        grippers.write_text(text + entry.replace("tilt_deg = 1.5", "tilt_deg = 0.0"), "utf-8")
        text = printers.read_text(encoding="utf-8")
        entry = text[text.index('["fdm 0.4"]') : text.index('["fdm 0.25"]')].replace(
            "250.0, 210.0, 210.0", "90.0, 90.0, 90.0"
        )
        small, tiny = (entry.replace("fdm 0.4", name) for name in ("small", "tiny"))
        printers.write_text(text + small + tiny.replace("90.0", "60.0"), "utf-8")
        return _edited(folder / "presets/published.toml", changes)

    return write


def _edited(file: Path, changes: Changes) -> Path:
    section, left, lines = "", dict(changes), []
    for line in file.read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            section = line.strip("[] ").split("]")[0]
        name = f"{section}.{line.partition('=')[0].strip()}"
        if name in left:
            value = left.pop(name)
            told = f'"{value}"' if isinstance(value, str) else value
            lines.append(f"{name.partition('.')[2]} = {told}")
        else:
            lines.append(line)
    assert not left, f"not in the file: {left}"
    file.write_text("\n".join(lines), encoding="utf-8")
    return file


@pytest.mark.slow
@pytest.mark.parametrize("changes", [THICK, WIDE, UPRIGHT], ids=["thick", "wide", "upright"])
def test_an_unusual_design_passes_every_check(
    changes: Changes, changed: Callable[[Changes], Path], tmp_path: Path
) -> None:
    build(changed(changes), tmp_path / "out")
    failed = run_checks(tmp_path / "out").failed
    assert [f"{m.check} {m.subject}: {m.measured} {m.limit}" for m in failed] == []


@pytest.mark.slow_cases
@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"mould.draft_deg": 20.0}, "0.50 mm is allowed. Use 18.4° or less"),
        ({"mould.wall_mm": 1.0}, "at least 1.6 is needed"),
        ({"mould.tip_silicone_mm": 4.0}, "less than stack.silicone_mm = 1.5 is allowed"),
        ({"mould.taper_length_mm": 6.0}, "at most 3.9 is allowed"),
        ({"mould.wall_gap_mm": 0.4}, "at most 0.28 is allowed"),
        (
            {
                "backing.pocket_clearance_mm": 0.3,
                "tip.slant_start_mm": 6.0,
                "outline.tip_margin_mm": 6.2,
            },
            "at most 5.900 is allowed, up to the pocket",
        ),
        ({"printer.profile": "tiny"}, "60 x 60 x 60 mm; a mould of 65 x 69 mm"),
        (
            THICK | {"stack.silicone_mm": 1.1, "mould.tip_silicone_mm": 0.2, "mask.flap_mm": 13.0},
            "which leaves 1.60 mm for the letter",
        ),
    ],
)
def test_what_cannot_be_made_is_refused_with_the_numbers(
    changes: Changes, told: str, changed: Callable[[Changes], Path]
) -> None:
    with pytest.raises(FabError) as refusal:
        derive(load(changed(changes)))
    assert told in str(refusal.value)

"""Which change makes which task run again."""

from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.derive import derive
from lumitip_fab.graph import STEPS, argument_names, tasks
from lumitip_fab.load import load

Keys = Callable[..., dict[str, str]]


@pytest.fixture
def keys(design_dir: Path, tmp_path: Path) -> Keys:
    """Key of every task of the published design with some lines added."""

    def of(text: str = "") -> dict[str, str]:
        file = tmp_path / "presets" / "changed.toml"
        file.parent.mkdir(exist_ok=True)
        published = design_dir / "presets" / "published.toml"
        (file.parent / "published.toml").write_bytes(published.read_bytes())
        (tmp_path / "parts").mkdir(exist_ok=True)
        file.write_text('extends = "published.toml"\n' + text)
        return {task.name: task.key for task in tasks(derive(load(file)))}

    return of


def changed(before: dict[str, str], after: dict[str, str]) -> set[str]:
    assert before.keys() == after.keys()
    return {name.partition(".")[0] for name in before if before[name] != after[name]}


def test_controller_name_touches_the_firmware_alone(keys: Keys) -> None:
    assert changed(keys(), keys('[controller]\nname = "Other"\n')) == {"firmware_files"}


def test_mask_hole_touches_the_mask_and_what_reads_the_layout(keys: Keys) -> None:
    assert changed(keys(), keys("[mask]\nhole_mm = 2.0\n")) == {"mask_files", "firmware_files"}


def test_waste_of_silicone_touches_the_mould_and_what_shares_its_figures(keys: Keys) -> None:
    assert "backing" not in changed(keys(), keys("[mould]\nwaste_fraction = 0.5\n"))


def test_pitch_touches_everything_of_the_fingers(keys: Keys) -> None:
    # What the slicer is told, what holds the controller, and wires know nothing of the cells.
    outside = {"holder_files", "print_settings", "wiring_files"}
    assert changed(keys(), keys("[grid]\npitch_mm = 6.1\n")) == {s.name for s in STEPS} - outside


def test_what_is_outside_touches_no_finger(keys: Keys) -> None:
    after = keys("[breakout]\nhole_spacing_mm = 34.0\n")
    assert changed(keys(), after) == {"carrier_files", "holder_files"}
    assert changed(keys(), keys("[holder]\nbody_mm = 76.0\n")) == {"holder_files"}


def test_lengths_of_wires_touch_the_wiring_alone(keys: Keys) -> None:
    assert changed(keys(), keys("[wiring]\nslack_mm = 60.0\n")) == {"wiring_files"}


def test_every_step_names_real_arguments(keys: Keys) -> None:
    assert all(argument_names(step) for step in STEPS)
    twice = {"finger", "carrier"}  # emitter and receiver, breakout and flange
    assert len(keys()) == sum(1 + bool(twice & {*argument_names(step)}) for step in STEPS)

"""Boards by themselves: every file of both boards of a preset, without the printed parts."""

import os
import shutil
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip_fab.boards.files import board_files
from lumitip_fab.cli.steps import STEPS
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design
from lumitip_fab.design.encoding import design_text
from lumitip_fab.models.files import model_files
from lumitip_fab.pipeline.workers import tasks
from panelled_boards import PANELLED

Boards = Callable[[str], Path]


SMALL = """\
extends = "published.toml"
name = "Small"
[grid]
columns = [3, 2, 3, 2, 3]
[board]
tip_margin_mm = 4.6
[supply]
voltage_v = 12.0
[emitter]
current_ma = 12.0
"""
SWITCHED = f"""\
{SMALL}switch = "AO3400A"
[receiver]
load = "each"
pull_up_ohm = 27000.0
[flange]
indicator = "auto"
[wiring]
order = "auto"
[protection]
diode = "auto"
[breakout]
board_mm = [45.72, 38.1]
indicator = "auto"
"""
DEFAULT = "fingertip"


@pytest.fixture(scope="session")
def designs(design_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Design]:
    """`designs("dense")`: a preset's design; `"fingertip"` is the default's, `"small"` a grid of 13
    cells on two muxes, `"switched"` the same with a transistor that switches the LEDs, power LEDs
    and protected pins, `"panelled"` with panels."""
    folder = tmp_path_factory.mktemp("designs") / "design"
    shutil.copytree(design_dir, folder)
    (folder / "presets" / "small.toml").write_text(SMALL)
    (folder / "presets" / "switched.toml").write_text(SWITCHED)
    (folder / "presets" / "panelled.toml").write_text(PANELLED)
    own = {DEFAULT: folder / f"{DEFAULT}.toml"}
    return lambda preset: derive(load(own.get(preset, folder / "presets" / f"{preset}.toml")))


@pytest.fixture(scope="session")
def boards(
    once: Callable[[str, Callable[[Path], object]], Path],
    built: Callable[[str], Path],
    designs: Callable[[str], Design],
) -> Boards:
    """`boards("dense")`: a folder with a preset's boards and design. Do not change it."""
    return lambda preset: (
        once(f"boards-{preset}", lambda out: _write(designs(preset), out))
        if preset in ("small", "switched", DEFAULT)
        else built(preset)
    )


@pytest.fixture(scope="module")
def kicad(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., str]:
    """Runs a command of KiCad with a home of its own."""
    home = tmp_path_factory.mktemp("kicad_home")

    def run(*command: str | Path) -> str:
        environment = {**os.environ, "HOME": str(home), "XDG_CONFIG_HOME": str(home)}
        for _ in range(3):  # KiCad's own crashes are rare and come at random: a fault of ours stays
            done = subprocess.run(
                [str(word) for word in command],
                env=environment,
                capture_output=True,
                text=True,
                check=False,
            )
            if done.returncode != -signal.SIGSEGV:
                break
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    return run


def _write(design: Design, out: Path) -> None:
    (out / "design.json").write_text(design_text(design), encoding="utf-8")
    for task in tasks(STEPS, design):
        make = {
            "finger_board": board_files,
            "other_board": board_files,
            "models": model_files,
        }.get(task.step.name)
        for artefact in make(design, *task.item) if make else ():
            path = out / artefact.path
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(artefact.data)


@pytest.fixture
def damaged_boards(boards: Boards, tmp_path: Path) -> Path:
    """A copy of the small design's boards, to damage."""
    return Path(shutil.copytree(boards("small"), tmp_path / "damaged"))

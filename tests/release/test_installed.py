"""The wheel in fresh environments: on the robot with numpy alone, and on the maker's computer."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from markdown_pages import README, code_blocks

pytestmark = pytest.mark.slow

NEWER = ("python3.12", "python3.13", "python3.14")


def _run(*command: str | Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """A command that sees nothing of this checkout and of pytest's environment."""
    left_out = {"PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV"}
    environment = {name: value for name, value in os.environ.items() if name not in left_out}
    return subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def _pythons() -> list[str]:
    """This interpreter, and newer ones of this computer that can make environments."""
    found = [sys.executable]
    for name in NEWER:
        path = shutil.which(name)
        if (
            path
            and not subprocess.run(
                [path, "-c", "import ensurepip, venv"], capture_output=True, check=False
            ).returncode
        ):
            found.append(path)
    return found


@pytest.fixture(scope="session", params=_pythons(), ids=lambda path: Path(path).name)
def robot(
    request: pytest.FixtureRequest,
    dist: tuple[Path, Path],
    tmp_path_factory: pytest.TempPathFactory,
) -> Path:
    """Folder of the programs of an environment that pip has installed the wheel into."""
    folder = tmp_path_factory.mktemp("robot")
    venv = _run(request.param, "-m", "venv", "venv", folder=folder)
    assert venv.returncode == 0, venv.stderr
    python = folder / "venv/bin/python"
    reached = _run(python, "-m", "pip", "download", "-q", "numpy", "-d", "wheels", folder=folder)
    if reached.returncode:
        pytest.skip(f"pip reaches no package index: {reached.stderr.strip()[-200:]}")
    installed = _run(python, "-m", "pip", "install", "-q", dist[1], folder=folder)
    assert installed.returncode == 0, installed.stderr
    return python.parent


def test_the_robot_gets_numpy_and_nothing_else(robot: Path, tmp_path: Path) -> None:
    listed = _run(robot / "python", "-m", "pip", "list", "--format=json", folder=tmp_path)
    names = {package["name"] for package in json.loads(listed.stdout)}
    assert names - {"pip", "setuptools"} == {"lumitip", "numpy"}
    assert _run(robot / "python", "-m", "pip", "check", folder=tmp_path).returncode == 0


def test_readme_runs_on_the_robot(robot: Path, tmp_path: Path) -> None:
    (code,) = code_blocks(README.read_text("utf-8"), "python")
    ended = _run(robot / "python", "-W", "error", "-c", code, folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    kind, *numbers = ended.stdout.split()
    assert kind == "cable"
    assert len([float(number) for number in numbers]) == 3


def test_the_command_runs_on_the_robot(robot: Path, tmp_path: Path) -> None:
    ended = _run(robot / "lumitip", "--help", folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "record" in ended.stdout


def test_a_missing_extra_is_named_on_the_robot(robot: Path, tmp_path: Path) -> None:
    ended = _run(robot / "lumitip", "view", "twin://demo", folder=tmp_path)
    assert ended.returncode == 2
    assert "[view]" in ended.stderr
    assert "Traceback" not in ended.stderr
    ended = _run(robot / "lumitip-fab", "build", "a.toml", "--out", "out", folder=tmp_path)
    assert ended.returncode == 2
    assert "[fab]" in ended.stderr
    assert "Traceback" not in ended.stderr


@pytest.fixture(scope="session")
def maker(dist: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the programs of an environment that has the wheel, and the libraries of this one:
    the editable checkout of this one is not visible there."""
    folder = tmp_path_factory.mktemp("maker")
    assert _run(sys.executable, "-m", "venv", "venv", folder=folder).returncode == 0
    python = folder / "venv/bin/python"
    wanted = "import sysconfig; print(sysconfig.get_path('purelib'))"
    site = Path(_run(python, "-c", wanted, folder=folder).stdout.strip())
    (site / "libraries.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    options = ["-q", "--no-deps", "--no-index", "--ignore-installed"]
    installed = _run(python, "-m", "pip", "install", *options, dist[1], folder=folder)
    assert installed.returncode == 0, installed.stderr
    return python.parent


def test_the_maker_starts_from_an_empty_folder(maker: Path, tmp_path: Path) -> None:
    where = "import lumitip, lumitip_fab; print(lumitip.__file__, lumitip_fab.__file__)"
    found = _run(maker / "python", "-c", where, folder=tmp_path).stdout.split()
    assert all(Path(path).is_relative_to(maker.parent) for path in found)
    assert _run(maker / "lumitip-fab", "init", "my-finger", folder=tmp_path).returncode == 0
    ended = _run(maker / "lumitip-fab", "spec", "my-finger/fingertip.toml", folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert _run(maker / "lumitip-fab", "schema", folder=tmp_path).returncode == 0


def test_the_wheel_builds_the_same_files_as_the_source(
    maker: Path, outputs: Path, tmp_path: Path
) -> None:
    preset = next(maker.parent.glob("lib/*/site-packages/lumitip_fab/_design/presets"))
    build = [maker / "lumitip-fab", "build", preset / "published.toml", "--out", "out", "--quiet"]
    ended = _run(*build, folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    files = (p.relative_to(outputs) for p in outputs.rglob("*") if p.is_file())
    expected = {path for path in files if not path.name.startswith(".")}  # without the cache
    assert expected
    made = tmp_path / "out"
    assert {p.relative_to(made) for p in made.rglob("*") if p.is_file()} >= expected
    different = [p for p in expected if (made / p).read_bytes() != (outputs / p).read_bytes()]
    assert different == []

"""What needs an extra says which; what needs none loads none."""

import subprocess
import sys

import pytest


def _python(code: str) -> str:
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize(
    ("library", "room", "extra"),
    [
        ("mcap", "recording", "record"),
        ("zstandard", "recording", "record"),
        ("gymnasium", "tasks.vector", "gym"),
        ("mujoco", "mujoco", "mujoco"),
        ("mcap", "foxglove", "foxglove"),
        ("mcap_protobuf", "foxglove", "foxglove"),
        ("foxglove_schemas_protobuf", "foxglove", "foxglove"),
    ],
)
def test_without_its_libraries_a_room_names_the_extra(library: str, room: str, extra: str) -> None:
    code = f"""
import sys
sys.modules[{library!r}] = None
from lumitip import LumitipError
try:
    import lumitip.{room}
except LumitipError as error:
    print(error)
"""
    assert f"pip install '.[{extra}]'" in _python(code)


def test_without_pyarrow_parquet_names_the_extra() -> None:
    code = """
import sys, tempfile
from importlib.resources import files
sys.modules["pyarrow"] = None
from pathlib import Path
from lumitip import Layout
from lumitip.cli import main
from lumitip.recording import Writer
layout = Layout.load(files("lumitip.links") / "published_layout.json")
folder = Path(tempfile.mkdtemp())
Writer(folder / "a.mcap", layout, device_id="x").close()
assert main(["export", str(folder / "a.mcap"), str(folder / "a.csv")]) == 0
sys.stderr = sys.stdout
assert main(["export", str(folder / "a.mcap"), str(folder / "a.parquet")]) == 2
"""
    assert "pip install '.[export]'" in _python(code)


def test_processing_needs_numpy_alone_and_the_commands_load_nothing_heavy() -> None:
    code = """
import sys
import lumitip.processing
from lumitip.commands import devices, record, recordings, simulation, view
print(*sorted({m.partition(".")[0] for m in sys.modules}))
"""
    loaded = set(_python(code).split())
    assert "numpy" in loaded
    assert not loaded & {"mcap", "zstandard", "pyarrow", "scipy", "bleak", "rosbags"}

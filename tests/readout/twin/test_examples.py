"""The example programs of the twin run and say what is so."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]
LAYOUT = ROOT / "readout/lumitip/links/published_layout.json"


def _run(name: str) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "error", ROOT / "examples" / name, LAYOUT],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    return done.stdout


def test_twin_values_are_recognised() -> None:
    told = _run("twin_values.py")
    for scene, shape in (("Cable", "cable"), ("HalfPlane", "edge"), ("Corner", "corner")):
        assert f"{scene:<10} read as {shape} " in told


def test_what_if_tells_that_wide_holes_and_gaps_blur() -> None:
    lines = _run("twin_what_if.py").splitlines()
    widths = [float(line.split()[-2]) for line in lines]
    assert len(widths) == 9
    for three in (widths[:3], widths[3:6], widths[6:], widths[1::3]):
        assert three == sorted(three)

"""`watch` rebuilds on save and says what changed."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from lumitip_fab.cli import main
from lumitip_fab.cli.watch import differences


def test_differences_name_what_changed() -> None:
    before = {"parameters.grid.pitch_mm": 6.0, "parts.emitter.led.exponent": 1.0}
    after = {"parameters.grid.pitch_mm": 5.0, "parts.emitter.led.exponent": 1.0, "new": 1}
    assert list(differences(before, after)) == ["new: None → 1", "grid.pitch_mm: 6.0 → 5.0"]


@pytest.mark.slow
def test_saving_rebuilds_and_a_fault_is_waited_out(outputs: Path, tmp_path: Path) -> None:
    main(["init", str(tmp_path / "design"), "--quiet"])
    file = tmp_path / "design" / "presets" / "published.toml"
    out = tmp_path / "out"
    subprocess.run(["cp", "-r", outputs, out], check=True)
    log = tmp_path / "log"
    with log.open("w") as told:
        command = [sys.executable, "-m", "lumitip_fab", "watch", str(file), "--out", str(out)]
        command.append("--page")
        running = subprocess.Popen(
            command, stdout=told, stderr=told, env={**os.environ, "PYTHONUNBUFFERED": "1"}
        )
        try:
            _wait_for(log, "watching")
            text = file.read_text()
            file.write_text(text.replace('name = "Lumitip"  ', "name = 7  "))
            _wait_for(log, "controller.name is 7")
            file.write_text(text.replace('name = "Lumitip"  ', 'name = "Other"  '))
            _wait_for(log, "controller.name: Lumitip → Other")
            _wait_for(log, "design.json")
            _wait_for(log, "checks passed; page", times=2)
        finally:
            running.send_signal(signal.SIGINT)
            assert running.wait(timeout=20) == 0
    assert '"Other"' in (out / "design.json").read_text()
    assert "backing" not in log.read_text()
    page, stamp = (out / "index.html").read_text(), (out / ".page.js").read_text()
    assert "Lumitip published" in page
    (written,) = re.findall(r'"stamp": ?"(\w+)"', page)
    assert stamp == f'written("{written}");\n'


def _wait_for(log: Path, text: str, times: int = 1) -> None:
    end = time.monotonic() + 300
    while log.read_text().count(text) < times:
        assert time.monotonic() < end, f"{text!r} never came:\n{log.read_text()}"
        time.sleep(0.1)

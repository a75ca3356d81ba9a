"""From a saved edit to the checked page, as `lumitip-fab watch --page` does it.

python benchmarks/bench_watch.py

The default design is edited three times: where solids and boards stay, where solids change, and
where all changes. Each edit is made twice, and the second time back, so that nothing is remembered
from a build of the same design but one. Wall times depend on the machine and its load.
"""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from common import Goals

EDITS = {
    "name of the sensor": (("controller", "name", '"Another"'), 5.0),
    "wall of the moulds": (("mould", "wall_mm", "3.4"), 15.0),
    "pitch of the grid": (("grid", "pitch_mm", "5.7"), 40.0),
}
"""Table, key and value of each edit, and the seconds until its page is there, at most."""
STARTED_S, PAGE_S = 900.0, 600.0


def main() -> int:
    """Print the times; the exit code, 0 if all goals are met."""
    goals = Goals()
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "lumitip_fab"]
        subprocess.run([*command, "init", folder, "--quiet"], check=True)
        file, log = Path(folder) / "fingertip.toml", Path(folder) / "log"
        watch = [*command, "watch", str(file), "--out", f"{folder}/out", "--page"]
        with _running(watch, log):
            _pages(log, 1, STARTED_S)
            for name, (edit, most_s) in EDITS.items():
                seconds = _seconds(file, log, edit)
                print(f"{name}: {seconds:.1f} s", flush=True)
                goals.at_most(f"edit to checked page, {name}", seconds, most_s, "s")
    return goals.exit_code()


@contextmanager
def _running(command: list[str], log: Path) -> Iterator[None]:
    with log.open("w") as out:
        process = subprocess.Popen(
            command, stdout=out, stderr=out, env={**os.environ, "PYTHONUNBUFFERED": "1"}
        )
        try:
            yield
        finally:
            process.send_signal(signal.SIGINT)
            try:
                process.wait(60)
            except subprocess.TimeoutExpired:
                process.kill()


def _seconds(file: Path, log: Path, edit: tuple[str, str, str]) -> float:
    """Save an edit and wait for its page; then the file as it was."""
    before = file.read_text(encoding="utf-8")
    times = []
    for text in (_edited(before, *edit), before):
        pages = log.read_text().count("; page ")
        begun = time.perf_counter()
        file.write_text(text, encoding="utf-8")
        _pages(log, pages + 1, PAGE_S)
        times.append(time.perf_counter() - begun)
    return times[0]


def _edited(text: str, table: str, key: str, value: str) -> str:
    pattern = rf"(?ms)(^\[{table}\]$.*?^{key} *= *)[^\s#]+"
    edited, count = re.subn(pattern, lambda match: match[1] + value, text, count=1)
    if not count:
        raise LookupError(f"{table}.{key} is not in the file")
    return edited


def _pages(log: Path, count: int, most_s: float) -> None:
    """Wait until so many pages are written."""
    end = time.monotonic() + most_s
    while log.read_text().count("; page ") < count:
        if time.monotonic() > end:
            raise TimeoutError(log.read_text())
        time.sleep(0.05)


if __name__ == "__main__":
    sys.exit(main())

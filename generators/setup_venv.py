"""Install this folder with some of its extras into `.venv`, and show progress.

`make` runs it with the system's Python, so it imports the standard library alone:

    python3 generators/setup_venv.py fab,dev

Everything that pip prints is in `.venv/setup.log`; the screen shows large downloads, the time and,
where pip fails, its errors.
"""

import re
import subprocess
import sys
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
VENV = ROOT / ".venv"
LOG = VENV / "setup.log"
SIZES = {
    "fab": "the CAD kernel, the board router and their libraries; 0.36 GB to download, "
    "1.2 GB in .venv, 2 to 5 minutes",
    "readout": "live view, Bluetooth and serial line; 20 MB to download",
    "dev": "tests, linters and a second opinion on every format; 0.5 GB to download, "
    "1.2 GB in .venv, 2 to 5 minutes",
    "site": "MkDocs, for the documentation site; 20 MB to download",
    "docs": "VTK for the documents' pictures; 0.1 GB to download",
}
LARGE_MB = 5
# What pip says of a wheel differs between its versions and sources; the size is not always there.
_FETCHED = re.compile(r"\s*(?:Downloading|Using cached|Processing) (\S+\.whl)")
_SIZE = re.compile(r"\((\d+(?:\.\d+)?) (bytes|kB|MB|GB)\)")
_UNITS_MB = {"bytes": 1e-6, "kB": 1e-3, "MB": 1.0, "GB": 1e3}
_FAILED, _REFUSED = 1, 2


class Progress:
    """One status line on a terminal; in a log a line for each event and every 15 seconds."""

    def __init__(self) -> None:
        self._terminal = sys.stdout.isatty()
        self._began = time.monotonic()
        self._status = "asking for the packages"
        self._ended = threading.Event()
        self._ticker = threading.Thread(target=self._tick, daemon=True)
        self._ticker.start()

    def status(self, text: str) -> None:
        """Replace what is going on now."""
        self._status = text
        if self._terminal:
            self._show()

    def event(self, text: str) -> None:
        """A line that stays."""
        print(f"\r\033[K  {text}" if self._terminal else f"  {text}", flush=True)

    def end(self) -> float:
        """Stop; returns the seconds that passed."""
        self._ended.set()
        self._ticker.join()
        if self._terminal:
            print("\r\033[K", end="", flush=True)
        return time.monotonic() - self._began

    def _tick(self) -> None:
        while not self._ended.wait(1 if self._terminal else 15):
            self._show()

    def _show(self) -> None:
        seconds = time.monotonic() - self._began
        line = f"  {seconds:3.0f} s  {self._status}"
        if self._terminal:
            print(f"\r\033[K{line[:78]}", end="", flush=True)
        else:
            print(line, flush=True)


def main(extras: str) -> int:
    """Install; returns 0, 1 if pip failed, 2 if this computer lacks something that pip does not
    install."""
    names = extras.split(",")
    if set(names) - set(SIZES):
        print(f"unknown extra in {extras!r}; known are {', '.join(SIZES)}", file=sys.stderr)
        return _REFUSED
    fault = lacking()
    if fault:
        print(fault, file=sys.stderr)
        return _REFUSED
    for name in names:
        print(f"Setting up .venv for {name}: {SIZES[name]}.", flush=True)
    progress = Progress()
    try:
        errors = _install(extras, progress)
    finally:
        seconds = progress.end()
    if errors is not None:
        where = LOG.relative_to(ROOT)
        print(f"{errors}\npip failed after {seconds:.0f} s; its output: {where}", file=sys.stderr)
        return _FAILED
    print(f"Set up .venv in {seconds:.0f} s.", flush=True)
    return 0


def lacking() -> str:
    """Missing programs and libraries, with a remedy; empty if there are none."""
    if sys.version_info < (3, 11):  # noqa: UP036
        return (
            f"Lumitip needs Python 3.11 or newer, this is {sys.version.split()[0]}: "
            "make PYTHON=python3.11"
        )
    try:
        import ensurepip  # noqa: F401
        import venv  # noqa: F401
    except ModuleNotFoundError:
        return "Python's venv is missing; on Debian and Ubuntu: apt-get install python3-venv"
    from lumitip_fab.system_libraries import libraries_message, missing_libraries

    missing = missing_libraries()
    return libraries_message(missing) if missing else ""


def _install(extras: str, progress: Progress) -> str | None:
    """Run pip; returns its errors, `None` if there were none."""
    python = VENV / "bin" / "python"
    if not python.exists():
        progress.status("making .venv")
        subprocess.run([sys.executable, "-m", "venv", str(VENV)], check=True)
    # Python compiles what it imports when it first does; half of what comes is never imported.
    options = "--progress-bar off --no-compile --disable-pip-version-check -c constraints.txt"
    command = [str(python), "-m", "pip", "install", *options.split(), "-e", f".[{extras}]"]
    packages, total_mb, lines = 0, 0.0, []
    with (
        LOG.open("w", encoding="utf-8") as log,
        subprocess.Popen(
            command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        ) as pip,
    ):
        assert pip.stdout
        for line in pip.stdout:
            log.write(line)
            lines.append(line.rstrip())
            fetched = _FETCHED.match(line)
            if fetched:
                package = Path(fetched[1]).name.split("-")[0]
                size_mb = _megabytes(line, Path(fetched[1]))
                packages, total_mb = packages + 1, total_mb + size_mb
                progress.status(f"{packages} packages, {total_mb:.0f} MB: {package}")
                if size_mb >= LARGE_MB:
                    progress.event(f"{package} ({size_mb:.0f} MB)")
            elif line.startswith("Installing collected packages"):
                progress.event(f"unpacking {line.count(',') + 1} packages")
                progress.status("unpacking")
    if pip.returncode == 0:
        return None
    errors = [line.strip() for line in lines if line.strip().startswith("ERROR: ")]
    return "\n".join(dict.fromkeys(errors or lines[-10:]))


def _megabytes(line: str, file: Path) -> float:
    """Size of a wheel: what pip's line says of it, else that of the file on this computer, else
    0."""
    said = _SIZE.search(line)
    if said:
        return float(said[1]) * _UNITS_MB[said[2]]
    return file.stat().st_size * 1e-6 if file.is_file() else 0.0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))

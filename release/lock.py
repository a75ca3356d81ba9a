"""Write the lock files: the versions of constraints.txt with the hashes of all their files.

    python -m release.lock

It asks the package index. A version that constraints.txt does not have yet is the newest there, and
is added to constraints.txt.
"""

import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

from packaging.requirements import Requirement

from release.changes import ReleaseError

ROOT = Path(__file__).resolve().parents[1]
LOCKS = {
    "requirements.lock": ("--all-extras",),
    "requirements-fab.lock": ("--extra", "fab"),
    "requirements-readout.lock": ("--extra", "readout"),
}
"""Lock files, and the extras that each is for."""
_PIN = re.compile(r"^([A-Za-z0-9][\w.-]*)==([^\s;\\]+)", re.MULTILINE)


def pins(text: str) -> dict[str, str]:
    """Version of each package of a constraints or lock file, by its normalised name."""
    found = {normalised(name): version for name, version in _PIN.findall(text)}
    if not found:
        raise ReleaseError("no line such as 'numpy==2.0.0' was found. Run: make lock")
    return found


def lock_faults(root: Path) -> Iterator[str]:
    """What does not agree between pyproject.toml, constraints.txt and the lock files."""
    wanted = pins((root / "constraints.txt").read_text(encoding="utf-8"))
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    for name, options in LOCKS.items():
        text = (root / name).read_text(encoding="utf-8")
        locked = pins(text)
        for package, version in locked.items():
            if wanted.get(package) != version:
                yield f"{name}: {package} is {version}, in constraints.txt {wanted.get(package)}"
        for entry in re.split(r"\n(?=\S)", text.strip()):
            if not re.search(r"--hash=sha256:[0-9a-f]{64}\b", entry):
                yield f"{name}: {entry.split()[0]} has no hash"
        chosen = list(extras) if options == ("--all-extras",) else [options[1]]
        for line in (*project["dependencies"], *_requirements(extras, chosen)):
            asked = Requirement(line)
            version = locked.get(normalised(asked.name), "")
            if not (version and asked.specifier.contains(version)):
                yield f"{name}: {line} is asked for, {version or 'nothing'} is locked"
        if options == ("--all-extras",):
            yield from (f"{name}: {p} is missing" for p in wanted if p not in locked)


def _requirements(extras: dict[str, list[str]], chosen: list[str]) -> Iterator[str]:
    """Requirements of some extras, and of the own extras that these name."""
    for line in (line for extra in chosen for line in extras[extra]):
        asked = Requirement(line)
        if asked.name == "lumitip":
            yield from _requirements(extras, sorted(asked.extras))
        else:
            yield line


def normalised(name: str) -> str:
    """A package's name as package indexes compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def write_locks(root: Path) -> None:
    """Write all lock files, and add to constraints.txt what it lacks.

    Raises:
        ReleaseError: if uv fails, as without a package index.
    """
    for name, extras in LOCKS.items():
        command = [sys.executable, "-m", "uv", "pip", "compile", "pyproject.toml", *extras]
        command += ["-c", "constraints.txt", "--generate-hashes", "--universal", "--no-annotate"]
        command += ["--python-version", "3.11", "--no-header", "--quiet", "-o", name]
        done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
        if done.returncode:
            raise ReleaseError(f"uv failed for {name}:\n{done.stderr[-2000:]}")
    file = root / "constraints.txt"
    lines = file.read_text(encoding="utf-8").splitlines()
    known = pins("\n".join(lines))
    locked = pins((root / "requirements.lock").read_text(encoding="utf-8"))
    lines += [f"{name}=={version}" for name, version in locked.items() if name not in known]
    lines.sort(key=lambda line: line.partition("==")[0].lower())
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    try:
        write_locks(ROOT)
    except ReleaseError as error:
        sys.exit(str(error))

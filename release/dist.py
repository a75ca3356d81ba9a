"""Build sdist and wheel; the same source makes the same bytes.

    python -m release.dist dist

Every file in them has the date of the newest release in CHANGELOG.md, and permissions that do not
depend on this computer. The wheel is built from the sdist, so the sdist is proved complete. The
compressed bytes are those of this computer's zlib: with another zlib they may differ.
"""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

from release.changes import ReleaseError, newest_release, release_time_s

ROOT = Path(__file__).resolve().parents[1]


def build_dist(root: Path, folder: Path) -> tuple[Path, Path]:
    """Build the package of `root` into `folder`; returns sdist and wheel.

    Raises:
        ReleaseError: if the build fails, or if its version is not that of CHANGELOG.md.
    """
    version, _ = newest_release(root)
    sdist = folder / f"lumitip-{version}.tar.gz"
    wheel = folder / f"lumitip-{version}-py3-none-any.whl"
    for old in (sdist, wheel):
        old.unlink(missing_ok=True)
    command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(folder), str(root)]
    environment = {**os.environ, "SOURCE_DATE_EPOCH": str(release_time_s(root))}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ReleaseError(f"build failed:\n{(done.stdout + done.stderr)[-2000:]}")
    if not (sdist.is_file() and wheel.is_file()):
        raise ReleaseError(
            f"CHANGELOG.md's newest release is {version}, pyproject.toml has another version. "
            "Make them equal."
        )
    return sdist, wheel


def main(folder: Path) -> int:
    """Build, and print the SHA-256 of each file; returns 0, 1 if it failed."""
    try:
        built = build_dist(ROOT, folder)
    except ReleaseError as error:
        print(error, file=sys.stderr)
        return 1
    for file in built:
        print(f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file}")
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))

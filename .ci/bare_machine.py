"""Run a command on a bare Debian, as a new user would: README's first one, on Debian 12.

debootstrap makes a root file system with the packages that README's install line names, and those
they depend on. The committed state of this repository is cloned into it, and an ordinary user runs
the command. The exit code is the command's. Another release of Debian has another Python.

Needs root, debootstrap, unshare and git. The mirror is the one that this machine's apt uses, or
`DEBIAN_MIRROR`; pip's configuration is this machine's.

    sudo -E python3 .ci/bare_machine.py [--folder FOLDER] [--release RELEASE]
        [--if-there] [COMMAND …]

FOLDER is where the file system is made.
"""

import argparse
import ast
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from http import HTTPStatus
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RELEASES = ("bookworm", "trixie")
"""Debian 12 and 13."""
USER = "maker"
_PASSED_ON = re.compile(r"(PIP_.*|(https?|no|all)_proxy)", re.IGNORECASE)


class SetupError(Exception):
    """This machine or README lacks what the run needs."""


def install_line(readme: str) -> list[str]:
    """The packages of README's `apt-get install` line."""
    found = re.search(r"^(?:sudo )?apt-get install ([^#\n]+)", readme, re.MULTILINE)
    if not found:
        raise SetupError("README.md has no line that begins with 'apt-get install'")
    return found[1].split()


def first_command(readme: str) -> list[str]:
    """README's first command after the install line."""
    found = re.search(r"^make [^#\n]+", readme, re.MULTILINE)
    if not found:
        raise SetupError("README.md has no line that begins with 'make '")
    return shlex.split(found[0])


def mirror() -> str:
    """Where this machine's apt has its Debian from; a mirror has all releases."""
    if "DEBIAN_MIRROR" in os.environ:
        return os.environ["DEBIAN_MIRROR"]
    formatted = ["--format", "$(RELEASE) $(REPO_URI)", "Created-By: Packages"]
    for line in _output("apt-get", "indextargets", *formatted).splitlines():
        release, _, uri = line.partition(" ")
        if release in RELEASES:
            return uri
    raise SetupError(
        f"apt of this machine has none of {', '.join(RELEASES)}: set DEBIAN_MIRROR to a Debian "
        "mirror"
    )


def has_release(uri: str, release: str) -> bool:
    """Whether a mirror has a release of Debian.

    Raises:
        OSError: if the mirror does not answer.
    """
    try:
        with urllib.request.urlopen(f"{uri.rstrip('/')}/dists/{release}/Release", timeout=60):
            return True
    except urllib.error.HTTPError as error:
        if error.code == HTTPStatus.NOT_FOUND:
            return False
        raise


def pip_settings(listed: str) -> dict[str, str]:
    """Settings of pip's configuration files, from what `pip config list` prints."""
    settings = {}
    for line in listed.splitlines():
        name, _, value = line.partition("=")
        section, _, key = name.rpartition(".")
        if section != ":env:":  # the environment is passed on as it is
            settings[key] = str(ast.literal_eval(value))
    return settings


def local_paths(values: list[str]) -> list[Path]:
    """Files and folders of this machine that settings name: certificates, wheels, indexes. The
    pages of an index on this machine link to files beside it, so its parent folder counts."""
    paths = set()
    for word in " ".join(values).split():
        path = Path(word.removeprefix("file://"))
        if word.startswith("file:///") and len(path.parts) > 2:
            paths.add(path.parent)
        elif word.startswith("/"):
            paths.add(path)
    return sorted(path for path in paths if path.exists())


def main(folder: Path, release: str, command: list[str]) -> int:
    """Make the file system, run the command in it, remove it; returns the command's exit code.
    Without a command README's first one is run."""
    if os.geteuid() != 0:
        raise SetupError("needs root, because debootstrap makes a root file system: sudo -E …")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    packages, command = install_line(readme), command or first_command(readme)
    print(f"Bare Debian {release} with {' '.join(packages)}: {shlex.join(command)}", flush=True)
    root = folder / "root"
    began = time.monotonic()
    try:
        _bootstrap(root, release, packages)
        shown = f"{time.monotonic() - began:.0f} s"
        print(f"{shown}: the file system is made, {_size_mb(root):.0f} MB", flush=True)
        code = _run(root, command)
    finally:
        shutil.rmtree(root, ignore_errors=True)
    print(f"{time.monotonic() - began:.0f} s: exit code {code}", flush=True)
    return code


def _bootstrap(root: Path, release: str, packages: list[str]) -> None:
    """A root file system of minimal size with some packages, and this repository in it."""
    names = ",".join(packages)
    options = root / "etc/dpkg/dpkg.cfg.d"
    options.mkdir(parents=True)
    (options / "unsafe-io").write_text("force-unsafe-io\n", encoding="ascii")  # four times faster
    _output("debootstrap", "--variant=minbase", f"--include={names}", release, str(root), mirror())
    shutil.copy("/etc/hosts", root / "etc/hosts")
    _output("chroot", str(root), "useradd", "--create-home", "--shell", "/bin/sh", USER)
    home = root / "home" / USER
    _output("git", "-c", "safe.directory=*", "clone", "-q", str(ROOT), str(home / "lumitip"))
    _output("chroot", str(root), "chown", "-R", f"{USER}:{USER}", f"/home/{USER}")


def _run(root: Path, command: list[str]) -> int:
    """Run a command in the clone, as the user. What is mounted for it, in a mount namespace of its
    own, is gone when it ends."""
    passed_on = {k: v for k, v in os.environ.items() if _PASSED_ON.fullmatch(k)}
    settings = pip_settings(_output(sys.executable, "-m", "pip", "config", "list"))
    lines = [f"{key} = {' '.join(value.split())}\n" for key, value in settings.items()]
    (root / "etc/pip.conf").write_text("[global]\n" + "".join(lines), encoding="utf-8")
    script = [
        "set -e",
        f"mount -t proc proc {root}/proc",
        f"mkdir -p {root}/dev/shm",
        f"mount -t tmpfs tmpfs {root}/dev/shm",
    ]
    for path in local_paths([*settings.values(), *passed_on.values()]):
        inside = root / path.relative_to("/")
        inside.parent.mkdir(parents=True, exist_ok=True)
        inside.mkdir(exist_ok=True) if path.is_dir() else inside.touch()
        script.append(f"mount --bind {shlex.quote(str(path))} {shlex.quote(str(inside))}")
        script.append(f"mount -o remount,bind,ro {shlex.quote(str(inside))}")
    variables = {"HOME": f"/home/{USER}", "PATH": "/usr/bin:/bin", "CI": "true", **passed_on}
    inner = f"cd /home/{USER}/lumitip && exec {shlex.join(command)}"
    environment = ["env", "-i", *(f"{name}={value}" for name, value in variables.items())]
    chroot = ["/usr/sbin/chroot", f"--userspec={USER}:{USER}", str(root)]
    script.append(shlex.join(["exec", *environment, *chroot, "/bin/sh", "-c", inner]))
    unshared = ["unshare", "--mount", "--propagation", "private", "sh", "-c", "\n".join(script)]
    return subprocess.run(unshared, stdin=subprocess.DEVNULL, check=False).returncode


def _output(*command: str) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        said = (done.stdout + done.stderr)[-3000:].strip()
        raise SetupError(f"{command[0]} failed with exit code {done.returncode}:\n{said}")
    return done.stdout


def _size_mb(root: Path) -> float:
    return int(_output("du", "-sk", str(root)).split()[0]) / 1000


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--folder", type=Path)
    parser.add_argument("--release", choices=RELEASES, default=RELEASES[0])
    parser.add_argument(
        "--if-there", action="store_true", help="pass where the mirror has no such release"
    )
    parser.add_argument("command", nargs="*")
    asked = parser.parse_args()
    try:
        if asked.if_there and not has_release(mirror(), asked.release):
            print(f"bare machine: {mirror()} has no {asked.release}; nothing is tried")
            sys.exit(0)
        with tempfile.TemporaryDirectory(dir=asked.folder) as made:
            sys.exit(main(Path(made), asked.release, asked.command))
    except (SetupError, OSError) as error:
        sys.exit(f"bare machine: {error}")

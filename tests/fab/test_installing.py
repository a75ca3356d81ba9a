"""Installation: what the Makefile's setup refuses and reports, and what the documents advertise."""

import importlib.util
import os
import re
import subprocess
import sys
import tomllib
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from types import ModuleType

import pytest

from lumitip_fab import cli, system_libraries
from lumitip_fab.system_libraries import LIBRARIES, SystemLibrary, libraries_message

ROOT = Path(__file__).parents[2]
ABSENT = SystemLibrary("libNoSuchThing.so.9", "libno9", "no-glvnd", "no")
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
RUN = (ROOT / ".ci/run").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")
READING = (ROOT / "docs/reading.md").read_text(encoding="utf-8")
START = (ROOT / "docs/start.md").read_text(encoding="utf-8")


def _script(path: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(Path(path).stem, ROOT / path)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def setup() -> ModuleType:
    return _script("generators/setup_venv.py")


@pytest.fixture
def bare() -> ModuleType:
    return _script(".ci/bare_machine.py")


def test_a_missing_library_stops_the_setup_before_anything_is_installed(
    setup: ModuleType,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(system_libraries, "LIBRARIES", (*LIBRARIES, ABSENT))
    monkeypatch.setattr(setup, "VENV", tmp_path / ".venv")
    assert setup.main("fab") == 2
    assert not (tmp_path / ".venv").exists()
    lines = capsys.readouterr().err.splitlines()
    assert lines[0].startswith("libNoSuchThing.so.9 is missing")
    assert [line.split(":")[0].strip() for line in lines[1:]] == [
        "Debian, Ubuntu",
        "Fedora",
        "Arch",
    ]
    assert lines[1].endswith("apt-get install libno9")


def test_every_library_of_the_kernel_has_a_package_on_every_distribution() -> None:
    message = libraries_message(LIBRARIES)
    for library in LIBRARIES:
        for name in (library.debian, library.fedora, library.arch):
            assert name in message


def test_the_page_on_the_start_names_the_packages_of_opengl() -> None:
    """Those that a system without a desktop lacks; libx11 comes with libgl1 on Debian."""
    gl, x11, *_ = LIBRARIES
    for name in (gl.soname, gl.debian, gl.fedora, gl.arch, x11.fedora, x11.arch):
        assert f"`{name}`" in START


def test_the_kernel_needs_no_other_library() -> None:
    """The NEEDED entries of the wheel's files, but for those of libc and what the wheel brings."""
    bundled = importlib.util.find_spec("OCP")
    assert bundled
    assert bundled.submodule_search_locations
    folder = Path(bundled.submodule_search_locations[0]).parent
    files = [f for f in folder.glob("cadquery_ocp*.libs/*") if f.is_file()]
    names = {library.soname for library in LIBRARIES}
    found = {
        n
        for f in files
        for n in re.findall(rb"lib(?:GL|X|ICE|SM|EGL|OSMesa)[\w+]*\.so\.\d+", f.read_bytes())
    }
    assert found
    assert {name.decode() for name in found} <= names


def test_without_the_library_a_build_names_its_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(system_libraries, "LIBRARIES", (ABSENT,))
    design = ROOT / "design" / "fingertip.toml"
    assert cli.main(["build", str(design), "--out", str(tmp_path / "out")]) == 2
    assert "apt-get install libno9" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    assert cli.main(["schema"]) == 0, "commands that load no CAD kernel work without it"


def test_an_unknown_extra_is_refused(setup: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    assert setup.main("fab,nonsense") == 2
    assert "known are fab" in capsys.readouterr().err


def test_progress_begins_before_pip_and_names_large_downloads(
    setup: ModuleType,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert _installs(setup, tmp_path, monkeypatch, "exit 0") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("Setting up .venv for fab: ")
    assert "  big (67 MB)" in lines
    assert not any("far (" in line for line in lines), "its size is not said"
    assert not any("WARNING" in line or "small" in line for line in lines)
    assert "  unpacking 4 packages" in lines
    assert any(line.startswith("  stored (6 MB)") for line in lines), "read from the file"
    assert "WARNING" in (tmp_path / ".venv" / "setup.log").read_text()


def test_a_failure_of_pip_is_reported_with_its_errors_alone(
    setup: ModuleType,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert _installs(setup, tmp_path, monkeypatch, "echo 'ERROR: no network'; exit 1") == 1
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "ERROR: no network"
    assert lines[1].endswith("its output: .venv/setup.log")


def _installs(setup: ModuleType, folder: Path, monkeypatch: pytest.MonkeyPatch, last: str) -> int:
    """Run the setup with a `python` that prints what pip prints."""
    python = folder / ".venv" / "bin" / "python"
    python.parent.mkdir(parents=True)
    stored = folder / "stored-1.0-py3-none-any.whl"
    stored.write_bytes(bytes(6_000_000))
    python.write_text(
        "#!/bin/sh\n"
        "echo \"WARNING: Location 'file:///x' is ignored\"\n"
        "echo '  Downloading small-1.0-py3-none-any.whl (20 kB)'\n"
        "echo '  Downloading big-2.0-cp311-cp311-linux_x86_64.whl (66.6 MB)'\n"
        "echo '  Downloading https://x.invalid/far-1.0-py3-none-any.whl (from y (z))'\n"
        f"echo 'Processing {stored} (from lumitip==1.0)'\n"
        "echo 'Installing collected packages: small, big, far, stored'\n" + last + "\n"
    )
    python.chmod(0o755)
    monkeypatch.setattr(setup, "ROOT", folder)
    monkeypatch.setattr(setup, "VENV", folder / ".venv")
    monkeypatch.setattr(setup, "LOG", folder / ".venv" / "setup.log")
    return int(setup.main("fab"))


def test_outputs_install_nothing_of_the_tests() -> None:
    assert re.search(r"^outputs: \$\(FAB\) ", MAKEFILE, re.MULTILINE)
    assert re.search(r"^check: \$\(FAB\) ", MAKEFILE, re.MULTILINE)
    assert re.search(r"^test: \$\(DEV\) ", MAKEFILE, re.MULTILINE)
    recipe = MAKEFILE.partition("$(FAB): ")[2].partition("\n\n")[0]
    assert recipe.splitlines()[1].startswith("\t@$(PYTHON) generators/setup_venv.py fab ")


def test_extras_that_the_setup_knows_exist(setup: ModuleType) -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"][
        "optional-dependencies"
    ]
    assert set(setup.SIZES) <= set(extras)


def test_no_install_line_names_an_index_that_does_not_have_this_package() -> None:
    advertised = re.compile(r"pip install [^`\n]*(?<![\w/.-])lumitip(?![\w.-])")
    places = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "outputs").glob("*.md")]
    for folder in ("generators", "readout", "examples"):
        places += (ROOT / folder).rglob("*.py")
        places += (ROOT / folder).rglob("*.md")
    found = [f"{f}: {hit}" for f in places for hit in advertised.findall(f.read_text("utf-8"))]
    assert found == []
    assert advertised.search("pip install 'lumitip[fab]'")
    assert advertised.search("pip install lumitip")


def test_the_wheel_that_the_page_on_reading_names_is_of_this_version() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert set(re.findall(r"lumitip-([\d.]+)-py3", READING)) == {version}


def test_the_bare_machine_has_what_readme_names_and_runs_its_command(bare: ModuleType) -> None:
    packages = bare.install_line(README)
    assert {"make", "git", "python3", "python3-venv", "libgl1"} == set(packages)
    assert bare.first_command(README) == ["make", "outputs"]
    with pytest.raises(bare.SetupError, match="apt-get install"):
        bare.install_line("nothing")
    with pytest.raises(bare.SetupError, match="make"):
        bare.first_command("nothing")


def test_the_build_server_tries_the_wheel_on_a_newer_python(bare: ModuleType) -> None:
    command = re.search(r"bare_machine\.py --if-there --release (\w+) (\S+)$", RUN, re.MULTILINE)
    assert command
    assert command[1] in bare.RELEASES[1:]
    assert os.access(ROOT / command[2], os.X_OK)


def test_a_release_that_the_mirror_lacks_is_known(bare: ModuleType, tmp_path: Path) -> None:
    (tmp_path / "dists/trixie").mkdir(parents=True)
    (tmp_path / "dists/trixie/Release").touch()
    handler = partial(SimpleHTTPRequestHandler, directory=str(tmp_path))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        uri = f"http://127.0.0.1:{server.server_port}/"
        assert bare.has_release(uri, "trixie")
        assert not bare.has_release(uri, "bookworm")
        server.shutdown()
    with pytest.raises(OSError):
        bare.has_release(uri, "trixie")


def test_settings_of_pip_reach_the_bare_machine(bare: ModuleType, tmp_path: Path) -> None:
    (tmp_path / "mirror" / "simple").mkdir(parents=True)
    cert = tmp_path / "cert.pem"
    cert.touch()
    listed = f":env:.timeout='9'\nglobal.cert='{cert}'\nglobal.index-url='file://{tmp_path}/mirror/simple'"
    settings = bare.pip_settings(listed)
    assert settings == {"cert": str(cert), "index-url": f"file://{tmp_path}/mirror/simple"}
    paths = bare.local_paths([*settings.values(), "https://packages.invalid /no/such/file"])
    assert paths == [cert, tmp_path / "mirror"], "an index's pages link to files beside it"


def test_the_setup_says_which_python_it_needs() -> None:
    script = ROOT / "generators" / "setup_venv.py"
    code = (
        "import sys; sys.version_info = (3, 10, 0); sys.argv = ['setup_venv.py', 'fab']\n"
        f"import runpy; runpy.run_path({str(script)!r}, run_name='__main__')"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 2
    assert "make PYTHON=python3.11" in ended.stderr

"""The command line: exit codes, messages, and how quickly it answers."""

import json
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest

from lumitip_fab.cli import main
from lumitip_fab.cli.build import shortened
from lumitip_fab.config.schema import schema_text
from lumitip_fab.pipeline.manifest import content_hash

pytestmark = pytest.mark.slow

Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def fresh(tmp_path: Path) -> Run:
    """Run Python in a fresh interpreter."""

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, *arguments], capture_output=True, text=True, cwd=tmp_path, check=False
        )

    return run


def test_help_imports_nothing_heavy(fresh: Run) -> None:
    code = (
        "import sys\nfrom lumitip_fab.cli import main\n"
        "try: main(['--help'])\nexcept SystemExit: pass\n"
        "print(sorted(m for m in ('numpy', 'pydantic', 'rich', 'build123d') if m in sys.modules))"
    )
    ended = fresh("-c", code)
    assert "COMMAND" in ended.stdout
    assert ended.stdout.splitlines()[-1] == "[]"


def test_without_the_extra_one_line_names_it(fresh: Run, design_dir: Path) -> None:
    code = (
        "import sys\nfor name in ('pydantic', 'rich', 'build123d', 'tomli_w'):\n"
        "    sys.modules[name] = None\n"
        "from lumitip_fab.cli import main\n"
        f"sys.exit(main(['build', {str(design_dir / 'fingertip.toml')!r}, '--out', 'out']))"
    )
    ended = fresh("-c", code)
    assert ended.returncode == 2
    assert ended.stderr.count("\n") == 1
    assert "pip install '.[fab]'" in ended.stderr


def test_init_copies_the_design_folder_and_overwrites_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / ("long " * 20) / "[red]mine :smile:"  # wider than a terminal
    assert main(["init", str(target)]) == 0
    said = capsys.readouterr().out
    assert said.count("\n") == 1
    assert said.startswith(f"{target}: edit fingertip.toml")
    command = shlex.split(said.partition("then: ")[2])
    assert command[2] == str(target / "fingertip.toml"), "a name with spaces is one word"
    assert (target / "fingertip.toml").is_file()
    assert (target / "parts" / "leds.toml").is_file()
    (target / "fingertip.toml").write_text("mine")
    assert main(["init", str(target)]) == 2
    assert (target / "fingertip.toml").read_text() == "mine"
    assert "not empty" in capsys.readouterr().err


def test_a_refused_input_is_told_with_exit_code_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["init", str(tmp_path / "d"), "--quiet"])
    file = tmp_path / "d" / "fingertip.toml"
    file.write_text(file.read_text().replace("pitch_mm", "pich_mm"))
    assert main(["build", str(file), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr()
    assert "grid.pich_mm is not a known key. Did you mean 'pitch_mm'?" in told.err
    assert not (tmp_path / "out").exists()
    assert main(["build", str(file), "--out", str(tmp_path / "out"), "--json"]) == 2
    problems = json.loads(capsys.readouterr().out)["problems"]
    assert {p["field"] for p in problems} == {"grid.pich_mm", "grid.pitch_mm"}


def test_check_reads_only_and_reports(
    outputs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = {f: f.stat().st_mtime_ns for f in outputs.rglob("*")}
    xml, report = tmp_path / "checks.xml", tmp_path / "checks.json"
    told = ["check", "--out", str(outputs), "--junit", str(xml), "--report", str(report)]
    assert main(told) == 0
    lines = capsys.readouterr().out.splitlines()
    assert 8 <= len(lines) <= 12, "the end of `make outputs` fits a screen"
    assert lines[1].endswith(" checks passed")
    assert {f: f.stat().st_mtime_ns for f in outputs.rglob("*")} == before
    suite = ElementTree.parse(xml).getroot()
    record = json.loads(report.read_text())
    assert record["content_sha256"] == content_hash(outputs)
    measured = record["measurements"]
    assert int(suite.attrib["tests"]) == len(measured) > 30
    assert suite.attrib["failures"] == "0"


def test_a_failed_check_exits_1_and_says_which(
    damaged: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    layout = damaged / "layout.json"
    layout.write_text(layout.read_text().replace('"channel": [', '"channel": [9, ', 1))
    assert main(["check", "--out", str(damaged), "--quiet", "--junit", str(tmp_path / "x")]) == 1
    assert "layout.wiring" in capsys.readouterr().out
    assert ElementTree.parse(tmp_path / "x").find(".//failure") is not None


def test_check_is_not_asked_for_all_lines_and_for_none(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["check", "--out", str(tmp_path), "--quiet", "--verbose"])
    assert "--verbose: not allowed with argument --quiet" in capsys.readouterr().err


def test_a_report_that_cannot_be_written_is_told(
    outputs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    told = ["check", "--out", str(outputs), "--quiet", "--junit", str(tmp_path / "file" / "x.xml")]
    assert main(told) == 2
    assert "cannot be written" in capsys.readouterr().err


def test_check_of_an_empty_folder_says_what_to_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", "--out", str(tmp_path)]) == 2
    assert "build the design first" in capsys.readouterr().err


def test_spec_prints_table_1_beside_the_design(
    design_dir: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["spec", str(design_dir / "presets" / "published.toml")]) == 0
    told = capsys.readouterr().out
    for figure in ("42.8 x 43.1 mm", "3.21 per cm²", "38.4 mA", "4.0 mm"):
        assert figure in told
    assert main(["spec", str(design_dir / "fingertip.toml"), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert all(r["reason"] for r in rows if r["published"] != r["computed"])


def test_the_committed_schema_is_true(design_dir: Path) -> None:
    assert (design_dir / "schema.json").read_text(encoding="utf-8") == schema_text()


def test_every_field_of_the_schema_is_described() -> None:
    schema = json.loads(schema_text())
    missing = [
        f"{name}.{field}"
        for name, model in schema["$defs"].items()
        for field, told in model["properties"].items()
        if "description" not in told
    ]
    assert missing == []


def test_many_files_are_counted_by_folder_and_few_are_named() -> None:
    few = tuple(f"mask/{i}.svg" for i in range(3))
    assert shortened(Path("out"), few) == [f"out/{name}" for name in few]
    many = (*(f"boards/order/{i}.csv" for i in range(30)), "a.csv", "b.csv", "mask/a.pdf")
    told = ["out/boards/order: 30 files", "out: 2 files", "out/mask/a.pdf"]
    assert shortened(Path("out"), many) == told

"""Options of `open`: checked by mypy and at run time."""

import asyncio
import os
import subprocess
import sys
from pathlib import Path

import pytest

from lumitip import AsyncFingertip, Fingertip, FingertipGroup, OpenOptions
from lumitip.errors import LumitipError, UnknownOption

ROOT = Path(__file__).parents[3]
PROGRAM = """
from lumitip import AsyncFingertip, Fingertip, FingertipGroup, OpenOptions

options: OpenOptions = {"timeout": 5.0, "buffer": 8}
Fingertip.open("twin://disc", **options)
FingertipGroup.open({"one": "twin://disc"}, **options)
AsyncFingertip.open("twin://disc", **options)
Fingertip.open("twin://disc", timeot=5.0)
Fingertip.open("twin://disc", timeout="5")
FingertipGroup.open({"one": "twin://disc"}, timeot=5.0)
AsyncFingertip.open("twin://disc", timeot=5.0)
AsyncFingertip.open("twin://disc", buffer="many")
frame = Fingertip.open("twin://disc").latest(max_age_s=0.1)
frame.seq
maybe = Fingertip.open("twin://disc").latest()
maybe.seq
"""
WRONG = {7: "arg-type", 8: "arg-type", 9: "call-arg", 10: "call-arg", 11: "arg-type", 15: "union"}
"""The lines of the program with errors, and their kinds."""


@pytest.mark.slow
def test_mypy_shows_wrong_options(tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(PROGRAM.lstrip(), encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent"]
    environment = os.environ | {"MYPYPATH": str(ROOT / "readout")}
    done = subprocess.run(
        [*command, "--config-file=", f"--cache-dir={tmp_path / 'cache'}", str(program)],
        check=False,
        env=environment,
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    errors = [line for line in done.stdout.splitlines() if ": error:" in line]
    found = {int(line.split(":")[1]): line for line in errors}
    assert found.keys() == WRONG.keys(), done.stdout
    assert all(f"[{code}" in found[at] for at, code in WRONG.items()), done.stdout


@pytest.mark.parametrize(
    "opened",
    [
        lambda: Fingertip.open("twin://disc", timeot=5.0),
        lambda: FingertipGroup.open({"one": "twin://disc"}, timeot=5.0),  # type: ignore[call-arg]
        lambda: AsyncFingertip.open("twin://disc", timeot=5.0),  # type: ignore[call-arg]
    ],
)
def test_a_wrong_option_is_an_error_that_lists_the_allowed(opened) -> None:
    names = "timeout, buffer, any_design, calibrated, on_event"
    with pytest.raises(TypeError, match=f"no option 'timeot'; allowed are {names}") as caught:
        opened()
    assert isinstance(caught.value, UnknownOption) and isinstance(caught.value, LumitipError)
    assert caught.value.allowed == tuple(names.split(", "))


def test_options_reach_every_kind_of_fingertip() -> None:
    events: list[str] = []
    options: OpenOptions = {"buffer": 2, "on_event": lambda event: events.append(event.kind)}
    with FingertipGroup.open({"one": "twin://disc", "two": "twin://edge"}, **options) as group:
        assert {tip._buffer for tip in group.tips.values()} == {2}

    async def main() -> None:
        async with AsyncFingertip.open("twin://disc", **options) as tip:
            assert tip.fingertip._buffer == 2

    asyncio.run(main())
    assert events == ["connected"] * 3

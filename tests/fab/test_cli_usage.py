"""Help and usage errors of every command of both programs."""

import argparse
from collections.abc import Callable

import pytest

from lumitip import cli as readout
from lumitip_fab import cli as fab

PROGRAMS = {"lumitip-fab": fab, "lumitip": readout}


def _commands() -> list[tuple[str, str]]:
    """Every command, as the parsers themselves list them."""
    pairs = []
    for program, module in PROGRAMS.items():
        (choices,) = (
            action.choices
            for action in module.command_parser()._actions
            if isinstance(action, argparse._SubParsersAction)
        )
        pairs += [(program, command) for command in choices]
    return pairs


def _ends(main: Callable[[list[str]], int], *arguments: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    assert isinstance(ended.value.code, int)
    return ended.value.code


def test_no_command_is_missed() -> None:
    found = _commands()
    assert {("lumitip-fab", "channel-map"), ("lumitip-fab", "schema"), ("lumitip", "scan")} < {
        *found
    }
    assert len(found) == len(set(found)) >= 20


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_program_explains_itself(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    main = PROGRAMS[program].main
    assert _ends(main, "--help") == 0
    assert f"usage: {program}" in capsys.readouterr().out
    assert _ends(main) == 2
    assert f"usage: {program}" in capsys.readouterr().err
    assert _ends(main, "no-such-command") == 2
    assert "invalid choice: 'no-such-command'" in capsys.readouterr().err


@pytest.mark.parametrize(("program", "command"), _commands())
def test_a_command_explains_itself(
    program: str, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _ends(PROGRAMS[program].main, command, "--help") == 0
    assert capsys.readouterr().out.startswith(f"usage: {program} {command} [-h]")


@pytest.mark.parametrize(("program", "command"), _commands())
def test_a_wrong_option_of_a_command_is_one_usage_error(
    program: str, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _ends(PROGRAMS[program].main, command, "--no-such-option") == 2
    error = capsys.readouterr().err
    assert error.startswith("usage: ")
    assert f"{program}" in error
    assert "error: " in error.splitlines()[-1]

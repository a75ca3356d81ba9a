"""The references of both programs, from their parsers."""

import argparse
from collections.abc import Iterator

from lumitip.cli import command_parser as readout_parser
from lumitip_fab.cli import command_parser as fab_parser
from markdown_text import code, prose, table

PARSERS = {"lumitip": readout_parser, "lumitip-fab": fab_parser}
_ABOUT = {
    "lumitip": "The robot's side. It exits with 0; 1 if what it tests is not good, or what it "
    "reads is cut short; 2 if the input cannot be used; 130 after Ctrl-C.",
    "lumitip-fab": "The maker's side. It exits with 0; 1 if a check or a build failed, or what "
    "was searched or measured does not fit; 2 if the input is rejected.",
}


def command_pages() -> Iterator[tuple[str, str]]:
    """Path and Markdown of the page of each program."""
    for name, parser in PARSERS.items():
        parts = [f"# {name}\n\n{_ABOUT[name]}\n\n", _described(parser())]
        for command, inner in commands(parser()).items():
            parts.append(f"## {command}\n\n{_described(inner)}")
        yield f"reference/{name}.md", "".join(parts)


def commands(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    """The subcommands of a program."""
    actions = parser._actions  # argparse has no other way to list them
    (found,) = (a for a in actions if isinstance(a, argparse._SubParsersAction))
    return dict(found.choices)


def _described(parser: argparse.ArgumentParser) -> str:
    parser.formatter_class = lambda prog: argparse.HelpFormatter(prog, width=80)
    usage = parser.format_usage().removeprefix("usage: ")
    rows = [_row(action, parser) for action in parser._actions if action.help]
    shown = table(("argument", "default", "meaning"), rows)
    return f"{prose(parser.description or '')}\n\n```text\n{usage}```\n\n{shown}"


def _row(action: argparse.Action, parser: argparse.ArgumentParser) -> tuple[str, str, str]:
    value = action.metavar or ("" if action.nargs == 0 else action.dest.upper())
    if action.choices and not action.metavar:
        value = "{" + ",".join(map(str, action.choices)) + "}"
    name = ", ".join(action.option_strings)
    default = action.default if action.option_strings and action.nargs != 0 else None
    shown = "" if default in (None, [], argparse.SUPPRESS) else code(str(default))
    text = (action.help or "") % {**vars(action), "prog": parser.prog}
    return code(f"{name} {value}".strip()), shown, prose(text)

"""Consoles and exit codes of the commands."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

FAILED, REFUSED = 1, 2
"""Exit codes: a check or a build failed; the input is rejected."""
_WIDTH = None if sys.stdout.isatty() else 200  # a file or a log has no edge to fold at
# Names of files and designs are printed as they are, with brackets and colons in them.
OUT = Console(highlight=False, markup=False, emoji=False, width=_WIDTH)
ERR = Console(stderr=True, highlight=False, markup=False, emoji=False)


@contextmanager
def counted(name: str, silent: bool) -> Iterator[Callable[[int, int], None]]:
    """A bar of progress; gives the function that is called with how many are done, and of how many.

    Args:
        name: of what is counted.
        silent: show nothing.
    """
    columns = (TextColumn(name), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=ERR, disable=silent, transient=True) as bar:
        shown = bar.add_task(name, total=None)
        yield lambda done, total: bar.update(shown, completed=done, total=total)

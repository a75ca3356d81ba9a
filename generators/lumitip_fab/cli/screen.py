"""Consoles and exit codes of the commands."""

import sys

from rich.console import Console

FAILED, REFUSED = 1, 2
"""Exit codes: a check or a build failed; the input is rejected."""
_WIDTH = None if sys.stdout.isatty() else 200  # a file or a log has no edge to fold at
# Names of files and designs are printed as they are, with brackets and colons in them.
OUT = Console(highlight=False, markup=False, emoji=False, width=_WIDTH)
ERR = Console(stderr=True, highlight=False, markup=False, emoji=False)

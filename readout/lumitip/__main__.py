"""`python -m lumitip`: the command `lumitip`."""

from lumitip.cli import run

run()

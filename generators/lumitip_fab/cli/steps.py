"""The steps of a build: every generator, and the tools that it is made with, by `steps.toml`."""

from typing import Any

from lumitip_fab.pipeline.workers import Step
from lumitip_fab.text import table_of

_TABLE = table_of("cli/steps.toml")


def _step(name: str, entry: dict[str, Any]) -> Step:
    tools = [tool for kind in entry.get("tools", ()) for tool in _TABLE["tools"][kind]]
    return Step(name, **entry | {"tools": tuple(tools)})


STEPS = tuple(_step(name, entry) for name, entry in _TABLE["steps"].items())

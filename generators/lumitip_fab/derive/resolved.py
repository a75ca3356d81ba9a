"""`resolved.toml`: every value in force, and the parts that the parameters name."""

import tomli_w

from lumitip_fab.config.load import Input
from lumitip_fab.config.parts import NAMED
from lumitip_fab.design.encoding import encoded

_HEAD = """\
# Every value in force: the parameter file with its bases. Can itself be built.
"""
_PARTS = """
# The parts that are named above, as they stand in the catalogue.
"""


def resolved_text(config: Input) -> str:
    """The file of a parameter file with its bases; it can itself be built, and gives itself."""
    parts = {field: encoded(e.model_dump()) for field, e in config.parts_by_field().items()}
    tables = {f"{NAMED[field]} for {field}": _without_none(entry) for field, entry in parts.items()}
    listed = "".join(f"# {line}".rstrip() + "\n" for line in tomli_w.dumps(tables).splitlines())
    return _HEAD + tomli_w.dumps(encoded(config.parameters.model_dump())) + _PARTS + listed


def _without_none(table: dict[str, object]) -> dict[str, object]:
    return {key: value for key, value in table.items() if value is not None}

"""`lumitip-fab schema`: the JSON Schema of parameter files."""

import argparse

from lumitip_fab.config.schema import schema_text


def run(_: argparse.Namespace) -> int:
    """Print the schema."""
    print(schema_text(), end="")
    return 0

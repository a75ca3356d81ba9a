"""Building the documentation site, and its navigation."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from markdown_pages import ROOT

CONFIG = yaml.safe_load((ROOT / "mkdocs.yml").read_text("utf-8"))


def build_site(root: Path, out: Path) -> subprocess.CompletedProcess[str]:
    """Build the site of a repository, as `make site` does."""
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(out)]
    packages = os.pathsep.join(str(root / name) for name in ("generators", "readout"))
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": packages}
    return subprocess.run(
        command, cwd=root, env=environment, capture_output=True, text=True, check=False
    )


def nav_pages(node: Any = None) -> Iterator[str]:
    """Paths in the site of the pages of the navigation, in order."""
    node = CONFIG["nav"] if node is None else node
    if isinstance(node, str):
        yield node
    else:
        for inner in node.values() if isinstance(node, dict) else node:
            yield from nav_pages(inner)

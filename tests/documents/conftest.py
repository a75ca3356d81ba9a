"""The built documentation site."""

from collections.abc import Callable
from pathlib import Path

import pytest

from documentation_site import build_site
from markdown_pages import ROOT


@pytest.fixture(scope="session")
def doc_site(once: Callable[..., Path]) -> Path:
    """The built documentation site. Do not change it."""

    def fill(folder: Path) -> None:
        done = build_site(ROOT, folder)
        assert done.returncode == 0, done.stdout + done.stderr

    return once("documentation", fill)

"""The manual's drawings of the work, as they were written."""

from pathlib import Path
from typing import Any
from xml.etree import ElementTree as XmlTree

import pytest

SVG = "{http://www.w3.org/2000/svg}"


def drawn(folder: Path, name: str) -> XmlTree.Element:
    """A drawing of a built folder."""
    return XmlTree.parse(folder / f"manual/{name}.svg").getroot()


def words(root: XmlTree.Element) -> set[str]:
    """All that is written on a drawing."""
    return {str(text.text) for text in root.iter(f"{SVG}text")}


def published_and(*slow: str) -> list[Any]:
    """The published design, and presets that are built by slow tests alone."""
    return ["published", *(pytest.param(name, marks=pytest.mark.slow) for name in slow)]

"""Twins of the published sensor."""

from collections.abc import Callable
from functools import cache

import pytest

from lumitip.links.twin import published_layout
from lumitip.twin import Model, Twin


@cache
def _twin(gap_mm: float = 3.0) -> Twin:
    layout = published_layout()
    return Twin(layout, Model.from_layout(layout, gap_mm))


@pytest.fixture(scope="session")
def twin_at() -> Callable[..., Twin]:
    """`twin_at(6.0)`: a twin at that gap, made once."""
    return _twin


@pytest.fixture
def twin() -> Twin:
    """A twin at a gap of 3 mm."""
    return _twin()

"""`Row`: a figure beside the published one, by the table `spec.toml`."""

from collections.abc import Iterator
from dataclasses import dataclass

from lumitip_fab.text import table_of


@dataclass(frozen=True)
class Row:
    """One figure: published, computed, and the reason where they differ."""

    quantity: str
    published: str
    computed: str
    reason: str = ""


def rows_of(group: str, **values: object) -> Iterator[Row]:
    """Rows of a group of `spec.toml`, with these values in the braces of its texts.

    Raises:
        KeyError: if there is no such group, or if a value of it is missing.
    """
    for texts in table_of("docs/spec.toml")[group]:
        row = Row(**{"published": "not stated", **texts})
        yield Row(**{name: text.format(**values) for name, text in vars(row).items()})

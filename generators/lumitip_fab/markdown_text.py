"""Texts of a user in pages of Markdown: shown as they were written, whatever signs are in them."""

import re

_SIGNS = re.compile(r"[\\`*\[\]<>&|#~!]|(?<![A-Za-z0-9])_|_(?![A-Za-z0-9])")
"""What Markdown reads within a line; of a `_` only one that is not between letters or digits."""


def as_written(text: str) -> str:
    """A text for a heading, a sentence or a cell of a table, not for the beginning of a line."""
    return _SIGNS.sub(r"\\\g<0>", text)

"""Text and tables as Markdown."""

import re
from collections.abc import Iterable, Sequence

_BACKTICKS = re.compile(f"&#{ord('`')};(.+?)&#{ord('`')};")
_SPECIAL = {ord(c): f"&#{ord(c)};" for c in "&<>|*_`[]{}~\\#"}


def plain(text: str) -> str:
    """A text on one line, shown as it stands."""
    return " ".join(text.split()).translate(_SPECIAL)


def prose(text: str) -> str:
    """A text on one line, with what is between backticks in the font of code."""
    return _BACKTICKS.sub(r"<code>\1</code>", plain(text))


def code(text: str) -> str:
    """A name or value in the font of code, also in a table."""
    return f"<code>{plain(text)}</code>"


def table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table, followed by an empty line."""
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines) + "\n\n"

"""The catalogue of parts, from `design/parts/*.toml`: a page for each file, and their list."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from markdown_text import code, plain, prose, table
from repository_pages import ROOT

FOLDER = "reference/parts"
FILES = sorted((ROOT / "design/parts").glob("*.toml"))
_INTRO = """# Parts

Entries of `design/parts/*.toml`, which parameter files name. Each has a source and a level of
confidence; what is `inferred` or `assumed` has no data sheet behind it: measure yours.
[Extending](../../extending.md#a-part-of-the-catalogue) says how to add one.

"""


def catalogue_pages() -> Iterator[tuple[str, str]]:
    """Path and Markdown of each page."""
    rows = []
    for file in FILES:
        entries = {n: e for n, e in read(file).items() if isinstance(e, dict)}
        rows.append([f"[{file.stem}]({file.stem}.md)", str(len(entries)), prose(about(file))])
        yield f"{FOLDER}/{file.stem}.md", _page(file)
    yield f"{FOLDER}/index.md", _INTRO + table(("file", "entries", "about"), rows)


def read(file: Path) -> dict[str, Any]:
    """The contents of a file."""
    return tomllib.loads(file.read_text("utf-8"))


def about(file: Path) -> str:
    """The comment that a file begins with."""
    head = re.match(r"(?:#[^\n]*\n)*", file.read_text("utf-8"))
    assert head is not None
    return " ".join(line.lstrip("# ") for line in head[0].splitlines())


def _page(file: Path) -> str:
    contents = read(file)
    top = {name: value for name, value in contents.items() if not isinstance(value, dict)}
    title = file.stem.replace("_", " ").capitalize().replace("Led", "LED").replace("Esd", "ESD")
    parts = [f"# {title}\n\n{prose(about(file))}\n\nFile: `design/parts/{file.name}`.\n\n"]
    parts += [_figures(top)] if top else []
    for name, entry in contents.items():
        if isinstance(entry, dict):
            parts.append(f"## {plain(name)}\n\n{_entry(entry)}")
    return "".join(parts)


def _entry(entry: dict[str, Any]) -> str:
    """Title, confidence and source in words, the other figures as a table."""
    figures = {n: v for n, v in entry.items() if n not in ("title", "confidence", "source")}
    said = []
    if "title" in entry:
        said.append(f"{plain(entry['title'])}.")
    if "confidence" in entry:
        said.append(f"Confidence: **{plain(entry['confidence'])}**.")
    if "source" in entry:
        said.append(f"Source: {plain(entry['source'])}.")
    return "\n".join(said) + "\n\n" * bool(said) + _figures(figures)


def _figures(figures: dict[str, Any]) -> str:
    return table(("figure", "value"), _rows("", figures))


def _rows(before: str, figures: dict[str, Any]) -> Iterator[tuple[str, str]]:
    for name, value in figures.items():
        if isinstance(value, dict):
            yield from _rows(f"{before}{name}.", value)
        else:
            yield code(before + name), plain(_shown(value))


def _shown(value: Any) -> str:
    if isinstance(value, list):
        inner = [f"({_shown(v)})" if isinstance(v, list) else _shown(v) for v in value]
        return ", ".join(inner)
    if isinstance(value, dict):
        return ", ".join(f"{n} {_shown(v)}" for n, v in value.items())
    return str(value).lower() if isinstance(value, bool) else str(value)

"""Files outside `docs/` as pages of the site, and links that lead to them.

Markdown files keep their path below `project/`. Any other file that a page links becomes a page
below `source/` with its text, and a folder one with the list of its files, so that every link
works without a repository server.
"""

import posixpath
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
PROJECT = (
    "README.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "CHANGELOG.md",
    "outputs/README.md",
    "readout/firmware/README.md",
    "readout/ros2/README.md",
    "readout/lerobot/README.md",
)
"""Markdown files outside `docs/` that are pages."""
_CODE = re.compile(r"(^ *(```+|~~~+).*?^ *\2 *$|(?<!`)(`+)(?!`).+?(?<!`)\3(?!`))", re.M | re.S)
_LINK = re.compile(r"(?<=\]\()([^)\s#:]+)(#[^)\s]*)?(?=\))")
_LANGUAGES = {".py": "python", ".toml": "toml", ".yaml": "yaml", ".msg": "text"}


def linked(text: str, origin: Path) -> set[Path]:
    """Existing files and folders that a page links.

    Args:
        text: its Markdown.
        origin: its file, which links are relative to.
    """
    found = (origin.parent / match[1] for part in _prose(text) for match in _LINK.finditer(part))
    return {path.resolve() for path in found if path.exists()}


def page_of(path: Path) -> str | None:
    """The path in the site of a file or folder of the repository; `None` for a file of `docs/`."""
    if path.is_relative_to(DOCS):
        return None
    name = path.relative_to(ROOT).as_posix()
    if name in PROJECT:
        return f"project/{name}"
    return f"source/{name}/index.md" if path.is_dir() else f"source/{name}.md"


def rewritten(text: str, origin: Path, uri: str) -> str:
    """The Markdown of a page with its links as the site needs them.

    Args:
        text: its Markdown.
        origin: its file in the repository.
        uri: its path in the site.
    """

    def moved(match: re.Match[str]) -> str:
        path = (origin.parent / match[1]).resolve()
        if not path.exists() or not path.is_relative_to(ROOT):
            return match[0]  # mkdocs reports it
        target = page_of(path) or path.relative_to(DOCS).as_posix()
        return posixpath.relpath(target, posixpath.dirname(uri)) + (match[2] or "")

    return "".join(
        part if number % 2 else _LINK.sub(moved, part) for number, part in enumerate(_split(text))
    )


def source_pages(paths: set[Path]) -> Iterator[tuple[str, str]]:
    """Path in the site and Markdown of each file and folder, and of the files of each folder."""
    files = {file for path in paths for file in _files(path)}
    for path in sorted(paths | files):
        uri = page_of(path)
        if uri is None or uri.startswith("project/"):
            continue
        name = path.relative_to(ROOT).as_posix()
        head = f"---\nsearch:\n  exclude: true\n---\n\n# {name}\n\n"
        if path.is_dir():
            listed = "".join(f"- [{file.name}]({file.name}.md)\n" for file in _files(path))
            yield uri, head + listed
        else:
            language = _LANGUAGES.get(path.suffix, "text")
            yield uri, f"{head}~~~~~{language}\n{path.read_text('utf-8')}\n~~~~~\n"


def _files(folder: Path) -> list[Path]:
    """Files of a folder; none of a file."""
    return sorted(file for file in folder.glob("*.*") if file.is_file())


def _split(text: str) -> list[str]:
    """Prose and code, in turn."""
    parts, at = [], 0
    for match in _CODE.finditer(text):
        parts += [text[at : match.start()], match[0]]
        at = match.end()
    return [*parts, text[at:]]


def _prose(text: str) -> list[str]:
    return _split(text)[::2]

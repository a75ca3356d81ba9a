"""The hook of `mkdocs.yml`: pages that are written while the site is built, and links."""

import re
from collections.abc import Iterator
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from api_pages import api_pages
from catalogue_pages import catalogue_pages
from command_pages import command_pages
from gallery_page import gallery_pages
from parameter_pages import parameter_pages
from repository_pages import DOCS, PROJECT, ROOT, linked, rewritten, source_pages


def github_slug(text: str, separator: str) -> str:
    """Anchor of a heading as GitHub forms it."""
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", separator)


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Let headings have the anchors that the pages have on GitHub."""
    config.mdx_configs["toc"]["slugify"] = github_slug
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are no file of `docs/`."""
    for uri, text in _pages():
        files.append(File.generated(config, uri, content=text))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Turn links that leave `docs/` into links within the site."""
    uri = page.file.src_uri
    name = uri.removeprefix("project/")
    origin = ROOT / name if name in PROJECT and name != uri else DOCS / uri
    return rewritten(markdown, origin, uri) if origin.is_file() else markdown


def _pages() -> Iterator[tuple[str, str]]:
    """Path and Markdown of each."""
    project = {ROOT / name: f"project/{name}" for name in PROJECT}
    found = set()
    for page in (*sorted(DOCS.rglob("*.md")), *project):
        text = page.read_text("utf-8")
        found |= linked(text, page)
        if page in project:
            yield project[page], text
    yield from source_pages(found)
    yield from parameter_pages()
    yield from catalogue_pages()
    yield from gallery_pages()
    yield from command_pages()
    yield from api_pages()

"""The manual as one HTML file that needs nothing else: pictures are inside."""

from base64 import b64encode
from collections.abc import Sequence
from html import escape
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.token import Token

from lumitip_fab.pipeline.artefact import Files

_KINDS = {"svg": "image/svg+xml", "png": "image/png"}


def markdown() -> MarkdownIt:
    """The reader of the manual's text: CommonMark with tables."""
    return MarkdownIt("commonmark", {"html": False}).enable("table")


def html_page(name: str, text: str, files: Files) -> str:
    """The whole page.

    Args:
        name: its title.
        text: in Markdown.
        files: for the pictures.
    """
    reader = markdown()

    def image(_self: object, tokens: Sequence[Token], at: int, *_: object) -> str:
        path = str(tokens[at].attrs["src"])
        data = b64encode(files.read(path)).decode()
        caption = escape(tokens[at].content)
        shown = "pair" if sum(token.type == "image" for token in tokens) > 1 else "alone"
        return (
            f'<span class="{shown}"><img alt="{caption}" data-file="{escape(path)}" '
            f'src="data:{_KINDS[path.rpartition(".")[2]]};base64,{data}">'
            f"<br><small>{caption}</small></span>"
        )

    reader.add_render_rule("image", image)
    style = Path(__file__).with_name("page.css").read_text(encoding="utf-8")
    return (
        f'<!doctype html>\n<html lang="en">\n<head><meta charset="utf-8"><title>{escape(name)}'
        f'</title>\n<meta name="viewport" content="width=device-width">\n<style>\n{style}</style>'
        f"</head>\n<body>\n{reader.render(text)}</body>\n</html>\n"
    )

"""The manual as one HTML file that needs nothing else: pictures are inside."""

from base64 import b64encode
from collections.abc import Sequence
from html import escape

from markdown_it import MarkdownIt
from markdown_it.token import Token

from lumitip_fab.pipeline.artefact import Files

_KINDS = {"svg": "image/svg+xml", "png": "image/png"}
_STYLE = """\
body { font: 16px/1.5 Helvetica, Arial, sans-serif; color: #1a1a1a; max-width: 50rem;
  margin: 2rem auto; padding: 0 1rem; }
h1, h2 { line-height: 1.2; }
h2 { border-bottom: 2px solid #d9dee3; padding-bottom: .2rem; margin-top: 3rem; }
table { border-collapse: collapse; margin: 1rem 0; font-size: .9rem; }
th, td { border: 1px solid #cfd6dc; padding: .25rem .6rem; text-align: left; }
th { background: #f4f6f8; }
.alone, .pair { text-align: center; vertical-align: bottom; }
.alone { display: block; margin: 1.5rem 0; }
.pair { display: inline-block; width: 49%; margin-bottom: 1rem; }
img { max-width: 100%; max-height: 40rem; }
.pair img { max-height: 24rem; }
small { color: #5a6b7a; font-size: .85rem; }
code { background: #f4f6f8; padding: 0 .2rem; font-size: .9em; }
@media print { h2 { break-before: page; } .alone, .pair, tr { break-inside: avoid; } }
"""


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
    return (
        f'<!doctype html>\n<html lang="en">\n<head><meta charset="utf-8"><title>{escape(name)}'
        f'</title>\n<meta name="viewport" content="width=device-width">\n<style>\n{_STYLE}</style>'
        f"</head>\n<body>\n{reader.render(text)}</body>\n</html>\n"
    )

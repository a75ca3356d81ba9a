"""The page that shows what to measure on a gripper: one HTML file that needs nothing else."""

from html import escape

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.docs.page import markdown
from lumitip_fab.grippers.figures import TEXTS, figures, value_of
from lumitip_fab.text import as_written, data_file, table_of


def page(name: str, answers: str, shown: Gripper, title: str, drawings: dict[str, str]) -> str:
    """The whole page.

    Args:
        name: of the new gripper.
        answers: name of the answers file.
        shown: the gripper whose figures are drawn and listed.
        title: its title; empty if it is an example.
        drawings: SVG by heading.
    """
    texts = table_of(TEXTS)["page"]
    marks = {f"[[{number}]]": svg for number, svg in enumerate(drawings.values())}
    sections = (
        f"## {as_written(head)}\n\n{mark}" for head, mark in zip(drawings, marks, strict=True)
    )
    rows = "\n".join(
        f"| `{f.name}` | {as_written(f.how)} | {as_written(f.allowed)} | {_shown(shown, f.name)} |"
        for f in figures()
    )
    text = texts["body"].format(
        name=name,
        answers=answers,
        shown=as_written(title or texts["example"]),
        sections="\n\n".join(sections),
        like=as_written(title or "example"),
        rows=rows,
    )
    body = markdown().render(text)
    for mark, svg in marks.items():
        body = body.replace(f"<p>{mark}</p>", f'<div class="drawing">{svg}</div>')
    style = data_file("docs/page.css") + texts["style"]
    return (
        f'<!doctype html>\n<html lang="en">\n<head><meta charset="utf-8"><title>{escape(name)}'
        f'</title>\n<meta name="viewport" content="width=device-width">\n<style>\n{style}</style>'
        f"</head>\n<body>\n{body}</body>\n</html>\n"
    )


def _shown(gripper: Gripper, name: str) -> str:
    value = value_of(gripper, name)
    return "–" if value is None else f"{value:g}" if isinstance(value, float) else str(value)

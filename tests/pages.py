"""Edit the operators of a mask's page, as a wrong program would have written them."""

from collections.abc import Callable, Iterator
from decimal import Decimal
from pathlib import Path
from typing import Any

import pikepdf

Operation = tuple[list[Any], str]


def edited(file: Path, change: Callable[[list[Operation]], list[Operation]]) -> None:
    """Rewrite the content stream of a file's page."""
    with pikepdf.open(file, allow_overwriting_input=True) as pdf:
        page = pdf.pages[0]
        before = [
            (
                [Decimal(str(v)) if isinstance(v, int | Decimal) else v for v in i.operands],
                str(i.operator),
            )
            for i in pikepdf.parse_content_stream(page)
        ]
        after = [(o, pikepdf.Operator(name)) for o, name in change(before)]
        page.Contents = pdf.make_stream(pikepdf.unparse_content_stream(after))
        pdf.save(file)


def runs(operations: list[Operation]) -> Iterator[tuple[int, int]]:
    """First and last operator of each run of the black: edge, window, then the apertures."""
    start = 0
    for at, (_, name) in enumerate(operations):
        if name == "m":
            start = at
        elif name == "h":
            yield start, at
        elif name == "f*":
            return


def paths(operations: list[Operation]) -> Iterator[tuple[int, int]]:
    """First and last operator of each painted path."""
    start = None
    for at, (_, name) in enumerate(operations):
        if name in ("m", "re") and start is None:
            start = at
        elif name in ("S", "s", "f", "f*", "n") and start is not None:
            yield start, at
            start = None


def registration(operations: list[Operation]) -> tuple[int, int]:
    """First and last operator of the first registration mark's ring."""
    return next(
        (a, b) for a, b in paths(operations) if [n for _, n in operations[a:b]].count("c") == 4
    )


def page_damage(file: str, change: Callable[..., Any]) -> Callable[[Path], None]:
    """The damage of one file in a folder of outputs."""
    return lambda out: edited(out / file, change)

"""The differences as one HTML page that needs nothing else."""

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from typing import Any

from lumitip_fab.diff.copper import LEAST_MM2
from lumitip_fab.diff.report import FAILS, Difference, percent, shown, summary
from lumitip_fab.diff.solids import LEAST_MM3
from lumitip_fab.diff.values import Shape
from lumitip_fab.text import data_file

_NUMBERS = {"A", "B", "B − A", "margin A", "margin B", "only A", "only B", "A xor B"}
"""Headings of columns that are set to the right."""
_KEY = (
    '<p class="soft"><span class="key both"></span>in both<span class="key only-a"></span>only in A'
    '<span class="key only-b"></span>only in B</p>'
)
_SOLIDS = (
    "Volumes in mm³ of the STL files, as they are written or in their place in the design, where "
    "less differs. Pictures: from the front above, and from behind below. Differences that are "
    "hidden shine through."
)
_COPPER = "Areas in mm² of the KiCad boards, seen from the front."
_CHECKS = "Margins are shares of the limit, or of half the tolerance: 0 % is at the limit."


def page(found: Difference) -> str:
    """The whole page; the same differences give the same bytes."""
    record = found.record
    sections = {
        "checks": list(_checks(record["checks"])),
        "parameters": [_values(record["parameters"])] if record["parameters"] else [],
        "facts": [_values(record["facts"])] if record["facts"] else [],
        "solids": list(_shapes("part", _SOLIDS, LEAST_MM3, found.parts)),
        "copper": list(_shapes("board and layer", _COPPER, LEAST_MM2, found.layers)),
        "bill": list(_bill(record["bill"])),
        "files": list(_files(record["files"])),
    }
    lines = (_line(head, text, bool(sections.get(head))) for head, text in summary(found))
    body = [
        "<h1>Two designs compared</h1>",
        f'<div class="sides">{_side("a", record["a"])}{_side("b", record["b"])}</div>',
        f"<section><h2>Summary</h2><dl>{''.join(lines)}</dl></section>",
        *(
            f'<section id="{name}"><h2>{name.capitalize()}</h2>{"".join(parts)}</section>'
            for name, parts in sections.items()
            if parts
        ),
    ]
    return (
        '<!doctype html>\n<html lang="en">\n<head><meta charset="utf-8"><title>'
        f"{escape(record['a']['name'])} and {escape(record['b']['name'])} compared</title>\n"
        '<meta name="viewport" content="width=device-width"><link rel="icon" href="data:,">\n'
        f"<style>\n{data_file('diff/page.css')}</style></head>\n<body><main>\n"
        + "\n".join(body)
        + "\n</main></body>\n</html>\n"
    )


def _line(head: str, text: str, linked: bool) -> str:
    """A line of the summary, with a link to its section if there is one."""
    subject = f'<a href="#{head}">{head}</a>' if linked else head
    kind = ' class="bad"' if FAILS in text else ""
    return f"<dt>{subject}</dt><dd{kind}>{escape(text)}</dd>"


def _side(side: str, origin: dict[str, Any]) -> str:
    return (
        f'<div class="side {side}"><p><span class="mark">{side.upper()}</span>&ensp;'
        f"<strong>{escape(origin['name'])}</strong></p><p>{escape(origin['title'])}</p>"
        f'<p class="soft">design <code>{escape(origin["design_hash"][:12])}</code></p></div>'
    )


def _table(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    kinds = [' class="n"' if heading in _NUMBERS else "" for heading in headings]
    head = "".join(f"<th{kind}>{h}</th>" for kind, h in zip(kinds, headings, strict=True))
    body = "".join(
        f"<tr>{''.join(f'<td{k}>{escape(c)}</td>' for k, c in zip(kinds, row, strict=True))}</tr>\n"
        for row in rows
    )
    return f'<div class="wide"><table>\n<tr>{head}</tr>\n{body}</table></div>'


def _values(entries: list[dict[str, Any]]) -> str:
    rows = [
        (e["name"], e["unit"], shown(e["a"]), shown(e["b"]), _more(e["a"], e["b"])) for e in entries
    ]
    return _table(("name", "unit", "A", "B", "B − A"), rows)


def _more(a: Any, b: Any) -> str:
    """The difference of two numbers, with its share of the first; empty for other values."""
    if any(isinstance(v, bool) or not isinstance(v, int | float) for v in (a, b)):
        return ""
    share = f" ({100 * (b - a) / abs(a):+.1f} %)" if a else ""
    return f"{b - a:+.4g}{share}".replace("-", "−").replace(" ", "\u00a0")


def _checks(checks: dict[str, Any] | None) -> Iterator[str]:
    if checks is None:
        return
    for side in "ab":
        if failing := checks[f"fails_{side}"]:
            yield f'<p class="bad">Fails in {side.upper()} alone</p>{_check_table(failing)}'
    if checks["fails_both"]:
        yield f"<p>{checks['fails_both']} fail in both.</p>"
    if checks["margins"]:
        yield f'<p>Margins that differ most</p><p class="soft">{_CHECKS}</p>'
        yield _check_table(checks["margins"])
    for side in "ab":
        if names := checks[f"only_{side}"]:
            yield f"<p>Only in {side.upper()}: {escape(', '.join(names))}</p>"


def _check_table(entries: list[dict[str, Any]]) -> str:
    rows = []
    for entry in entries:
        both = [entry[side] or {} for side in "ab"]
        worst = min((each for each in both if each), key=lambda each: bool(each["passed"]))
        note = f": {worst['note']}" if worst["note"] and not worst["passed"] else ""
        known = [each for each in both if each.get("measured") is not None]
        limits = dict.fromkeys(each["limit"] for each in known or [worst])
        marks = ["" if each.get("passed", True) else f"\u00a0{FAILS}" for each in both]
        measured = [shown(b.get("measured")) + mark for b, mark in zip(both, marks, strict=True)]
        margins = [percent(each.get("margin")) for each in both]
        limit = f"{' → '.join(limits)} {worst['unit']}"
        rows.append((entry["check"], *measured, limit, *margins, f"{worst['subject']}{note}"))
    return _table(("check", "A", "B", "limit", "margin A", "margin B", "file"), rows)


def _shapes(what: str, note: str, least: float, shapes: Sequence[Shape]) -> Iterator[str]:
    """Sizes of parts or layers that differ, their pictures, and the names of the others."""
    differ = [shape for shape in shapes if shape.xor >= least]
    if differ:
        yield f'{_KEY}<p class="soft">{note}</p>'
        rows = (
            [s.name, *("–" if v is None else f"{v:.2f}" for v in (*s.sizes, *s.only, s.xor))]
            for s in differ
        )
        yield _table((what, "A", "B", "only A", "only B", "A xor B"), rows)
    if same := [shape.name for shape in shapes if shape not in differ]:
        yield f'<p class="soft">No difference: {escape(", ".join(same))}</p>'
    drawn = (s for s in differ if s.picture)
    cards = (f'<div class="card"><h3>{escape(s.name)}</h3>{s.picture}</div>' for s in drawn)
    if differ:
        yield f'<div class="cards">{"".join(cards)}</div>'


def _bill(bill: dict[str, Any]) -> Iterator[str]:
    total, currency = bill["total"], bill["currency"]
    if not bill["lines"] and total["a"] == total["b"]:
        return
    sums = " → ".join(f"{total[side]:.2f} {currency[side]}" for side in "ab")
    more = _more(total["a"], total["b"])
    yield f"<p>Sum of what one pair of fingers uses: <strong>{escape(sums)}</strong>, {more}</p>"
    yield f'<p class="soft">Amounts and prices ({escape(currency["a"])}).</p>'
    rows = []
    for line in bill["lines"]:
        both = [line[side] for side in "ab"]
        texts = [
            "–" if row is None else f"{row['quantity']} {row['unit']}, {row['price'] or 'no price'}"
            for row in both
        ]
        made = [f"{r['manufacturer']} {r['part']}".strip() for r in both if r]
        note = " → ".join(dict.fromkeys(made))
        prices = [float(row["price"]) if row and row["price"] else 0.0 for row in both]
        rows.append((line["group"], line["item"], note, *texts, _more(*prices)))
    yield _table(("group", "item", "part", "A", "B", "B − A"), rows)


def _files(files: dict[str, list[str]]) -> Iterator[str]:
    headings = {"only_a": "Only in A", "only_b": "Only in B", "changed": "Bytes differ"}
    for name, heading in headings.items():
        if paths := files[name]:
            listed = "<br>".join(f"<code>{escape(path)}</code>" for path in paths)
            opened = " open" if name != "changed" else ""
            yield f"<details{opened}><summary>{heading}: {len(paths)}</summary>{listed}</details>"

"""Tables of the page: bill, printed parts, orders, files, figures beside the publication."""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from urllib.parse import quote

from lumitip_fab.design.mould import printed_times
from lumitip_fab.design.print_time import print_seconds
from lumitip_fab.pipeline.manifest import NAME as MANIFEST
from lumitip_fab.site.folder import BILL, ORDER, Folder, board_path
from lumitip_fab.site.targets import Targets

PRINTING = "print/printing.md"
_ROW = re.compile(r"^\| `([^`]+)` \| .* \| (.*) \|$", re.MULTILINE)
Figure = tuple[str, str, str, str]
"""Quantity, published, this design, reason."""


@dataclass(frozen=True)
class Print:
    """A printed part."""

    file: str
    """Its STL."""
    filament: str
    number: int
    minutes: float
    """For one of them."""
    grams: float
    """For one of them."""
    lies: str

    @property
    def text(self) -> str:
        """Its print data in words."""
        number = f"{self.number} times, each " if self.number > 1 else ""
        return (
            f"{number}{duration(self.minutes)}, {self.grams:.1f} g of {self.filament}, {self.lies}."
        )


def prints(folder: Folder) -> list[Print]:
    """Every printed part with its print data; masks only where they are printed.

    Raises:
        OutputError: if the manifest lacks the figures of a part.
    """
    design = folder.design
    lies = dict(_ROW.findall(folder.text(PRINTING)))
    found = []
    for path in folder.manifest.files:
        kind = path.partition("/")[0]
        if not path.endswith(".stl") or kind == "robot":
            continue
        if kind == "mask" and design.mask.route != "tpu":
            continue
        facts, filament = folder.facts(path), design.slicing.of(path)
        brim = filament != design.slicing.sheet
        try:
            minutes = print_seconds(facts, filament, design.printing, brim) / 60
            grams = facts["volume_mm3"] / 1000 * filament.density_g_ml
        except (KeyError, TypeError) as error:
            raise folder.damaged(MANIFEST, f"{path} lacks a figure: {error!r}") from error
        number = printed_times(design.mould_accessories, path)
        place = lies.get(path.replace(".stl", ".3mf"), "as its file lies")
        found.append(Print(path, filament.name, number, minutes, grams, place))
    return found


def print_table(parts: Sequence[Print]) -> str:
    """The printed parts."""
    rows = [
        row(
            [
                _link(part.file, part.file),
                escape(part.filament),
                str(part.number),
                duration(part.minutes),
                f"{part.grams:.1f}",
                escape(part.lies),
            ],
            (2, 3, 4),
            [f"print.{part.file}"],
            part.file,
        )
        for part in parts
    ]
    headings = ("part", "filament", "pieces", "time each", "g each", "on the bed")
    return table("Printed parts", headings, rows, (2, 3, 4))


def duration(minutes: float) -> str:
    """Minutes in hours and minutes."""
    hours, rest = divmod(round(minutes), 60)
    return f"{hours} h {rest:02d} min" if hours else f"{rest} min"


def bill_table(folder: Folder, targets: Targets) -> str:
    """The bill: what one pair of fingers uses."""
    rows = []
    for line in folder.rows(BILL):
        if line["group"] == "total":
            continue
        bought = f"{line['manufacturer']} {line['part']}".strip()
        rows.append(
            row(
                [
                    *map(escape, (line["group"], line["item"], bought, line["for"])),
                    escape(f"{line['quantity']} {line['unit']}".removesuffix(" piece")),
                    escape(line["price"]),
                ],
                (4, 5),
                targets.of_line(line["group"], line["item"], line["part"]),
                line["item"],
            )
        )
    headings = ("group", "item", "maker and part", "for", "amount", "price")
    return table("Bill of materials", headings, rows, (4, 5))


def totals(folder: Folder) -> tuple[float, float, str]:
    """Price of one pair, price of whole packs, and the currency with date and level of trust of
    the prices, and how many lines have none.

    Raises:
        OutputError: if a table has no sum.
    """
    stated, _, notes = folder.rows(BILL)[-1]["for"].partition(":")
    unpriced = [note for note in notes.split(";") if note.endswith(" without a price")]
    return _sum(folder, BILL), _sum(folder, ORDER), ",".join([stated, *unpriced])


def _sum(folder: Folder, path: str) -> float:
    """The price in the last row of a table."""
    price = folder.rows(path)[-1]["price"]
    try:
        return float(price)
    except ValueError as error:
        raise folder.damaged(path, f"its last row has no sum but {price!r:.40}") from error


def figure_table(figures: Iterable[Figure]) -> str:
    """Figures beside the published ones."""
    rows = [
        row([escape(quantity), escape(published), escape(own), escape(reason)])
        for quantity, published, own, reason in figures
    ]
    headings = ("figure", "published", "this design", "why")
    return table("Figures beside the publication", headings, rows)


def unmarked(folder: Folder) -> list[str]:
    """Parts whose marked end nobody has measured, in words."""
    return ["an LED" if kind == "LED" else f"a {kind}" for kind in folder.design.packages.unmarked]


def order_table(folder: Folder, targets: Targets) -> str:
    """The packages that a PCB fab needs, a line for each board, and what to do before."""
    names = [fab.name for fab in folder.design.fabs]
    rows = []
    for board in targets.boards:
        files = [f"boards/{board}/order/{name}_{board}.zip" for name in names]
        links = " ".join(_link(f, n) for f, n in zip(files, names, strict=True) if _has(folder, f))
        sources = (board_path(board), board_path(board).replace("_pcb", "_sch"))
        kicad = " ".join(_link(f, f.rpartition(".kicad_")[2]) for f in sources if _has(folder, f))
        cells = [escape(board), links, kicad]
        rows.append(row(cells, (), targets.of_board(board), f"{board} board"))
    orders = table("Order files of the boards", ("board", "for a PCB fab", "KiCad"), rows)
    if not (unknown := unmarked(folder)):
        return orders
    stop = (
        f"Stop: nobody has measured which end of {' and '.join(unknown)} is marked. Try one of "
        'each before you order, as step "Order the boards" of the manual says: boards with these '
        "parts the wrong way round stay dark."
    )
    return f'<p class="stop"><strong>{stop}</strong></p>{orders}'


def file_lists(folder: Folder) -> Iterator[str]:
    """Every file by its folder, as links."""
    by_folder: dict[str, list[str]] = {}
    for path in folder.manifest.files:
        first, slash, _ = path.partition("/")
        by_folder.setdefault(first if slash else "", []).append(path)
    for name, paths in sorted(by_folder.items()):
        items = "".join(
            f"<li>{_link(p, p.removeprefix(f'{name}/'))} "
            f'<span class="soft">{_size(folder.manifest.files[p].bytes)}</span></li>'
            for p in sorted(paths)
        )
        title = f"{name}/" if name else "at the top"
        yield (
            f"<details><summary>{escape(title)} "
            f'<span class="soft">{len(paths)} file{"s" * (len(paths) > 1)}</span></summary>'
            f"<ul>{items}</ul></details>"
        )


def _has(folder: Folder, path: str) -> bool:
    return path in folder.manifest.files


def _link(path: str, text: str) -> str:
    return f'<a href="{quote(path)}">{escape(text)}</a>'


def _size(count: int) -> str:
    return f"{count / 1e6:.1f} MB" if count >= 1e6 else f"{max(count / 1e3, 0.1):.1f} kB"


def row(
    cells: Sequence[str], numbers: Sequence[int] = (), shown: Iterable[str] = (), title: str = ""
) -> str:
    """A row of HTML cells; one that is shown elsewhere has a button for it.

    Args:
        cells: HTML of each cell.
        numbers: columns of numbers.
        shown: names of what the row is about.
        title: what the button shows, in words.
    """
    written = "".join(
        f'<td class="n">{cell}</td>' if column in numbers else f"<td>{cell}</td>"
        for column, cell in enumerate(cells)
    )
    names = " ".join(shown)
    button = (
        f'<td class="go"><button type="button" class="show" data-show="{escape(names)}" '
        f'aria-label="Show {escape(title)}" aria-pressed="false">show</button></td>'
        if names
        else '<td class="go"></td>'
    )
    return f"<tr>{written}{button if title else ''}</tr>"


def table(
    caption: str, headings: Sequence[str], rows: Sequence[str], numbers: Sequence[int] = ()
) -> str:
    """A table that scrolls sideways where there is no room for it."""
    head = "".join(
        f'<th scope="col"{" class=n" if column in numbers else ""}>{escape(heading)}</th>'
        for column, heading in enumerate(headings)
    )
    if any('class="go"' in each for each in rows):
        head += '<th scope="col" class="go"><span class="hidden">place</span></th>'
    return (
        f'<div class="wide" tabindex="0" role="region" aria-label="Table: {escape(caption)}">'
        f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table></div>"
    )

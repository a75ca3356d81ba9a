"""Parameters, facts, lines of the bill, and files that differ; the record of a shape that does."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from lumitip_fab.config.schema import UNITS
from lumitip_fab.diff.folder import BILL, CABLES, ORDER, Folder
from lumitip_fab.docs import spec
from lumitip_fab.pipeline import manifest

Entry = dict[str, Any]
"""`name`, `unit`, and the values `a` and `b`; none where one has no such value."""
Row = dict[str, str]
_UNITS = {
    **UNITS,
    **{"g": "g", "n": "N", "kg": "kg", "mpa": "MPa", "s": "s", "us": "µs", "hz": "Hz", "c": "°C"},
    **{
        "nf": "nF",
        "pf": "pF",
        "ua": "µA",
        "na": "nA",
        "a": "A",
        "uh": "µH",
        "h": "h",
        "min": "min",
    },
    **{"mm_s": "mm/s", "mm3_s": "mm³/s", "k_per_w": "K/W", "per_v": "1/V", "cm2_ml": "cm²/mL"},
}
"""By the end of a field's name, of which the longest counts."""
_TOTAL = "total"
_SAME_LINE: tuple[tuple[str, ...], ...] = (
    ("group", "item", "manufacturer", "part", "for"),
    ("group", "item", "manufacturer", "part"),
    ("group", "item"),
)
"""Columns by which a line of one bill is found in the other, the strictest first."""


@dataclass(frozen=True)
class Shape:
    """A part or a layer of copper whose file differs, or that one design alone has."""

    name: str
    unit: str
    """`"mm3"` or `"mm2"`."""
    sizes: tuple[float | None, float | None]
    """Of A and of B; none where there is no such thing."""
    only: tuple[float, float]
    """Volume or area that A alone fills, and B alone."""
    picture: str = ""
    """HTML; empty where nothing is drawn."""

    @classmethod
    def alone(cls, name: str, unit: str, a: float | None, b: float | None) -> "Shape":
        """A part or layer that one design alone has."""
        return cls(name, unit, (a, b), (a or 0.0, b or 0.0))

    @property
    def xor(self) -> float:
        """Volume or area that exactly one of both fills."""
        return sum(self.only)

    def record(self) -> dict[str, Any]:
        """The figures as JSON."""
        names = (f"{name}_{self.unit}" for name in ("a", "b", "only_a", "only_b", "xor"))
        figures = (*self.sizes, *self.only, self.xor)
        rounded = (None if v is None else round(v, 3) for v in figures)
        return {"name": self.name, **dict(zip(names, rounded, strict=True))}


def parameter_differences(a: Folder, b: Folder) -> list[Entry]:
    """Values in force that differ; last what the catalogues of both say of the same part."""
    found = list(_differing(a.parameters, b.parameters))
    other = {name for name, _, _ in found}
    found += [
        entry
        for entry in _differing(a.parts, b.parts)
        if not any(f" for {name}." in entry[0] for name in other)
    ]
    return [_entry(name, _unit(name), first, second) for name, first, second in found]


def fact_differences(a: Folder, b: Folder) -> list[Entry]:
    """Figures that differ: those that files state as numbers first, then those of `spec`.

    Raises:
        OutputError: if a file cannot be read.
    """
    numbers = _differing(_numbers(a), _numbers(b))
    texts = _differing(_texts(a), _texts(b))
    found = [_entry(name, unit, first, second) for (name, unit), first, second in numbers]
    return found + [_entry(name, "", first, second) for name, first, second in texts]


def bill_differences(a: Folder, b: Folder) -> dict[str, Any]:
    """Lines of the bills of materials that differ, and both sums.

    Raises:
        OutputError: if a bill cannot be read.
    """
    one, other = _lines(a), _lines(b)
    pairs: list[tuple[Row | None, Row | None]] = []
    for columns in _SAME_LINE:
        pairs += _matched(one, other, columns)
    pairs += [*((row, None) for row in one), *((None, row) for row in other)]
    lines = [
        {
            "group": (first or second or {})["group"],
            "item": (first or second or {})["item"],
            "a": first,
            "b": second,
        }
        for first, second in pairs
        if first != second
    ]
    lines.sort(key=lambda line: (line["group"], line["item"], line["a"] is None))
    currencies = [folder.design.purchase.currency for folder in (a, b)]
    return {
        "currency": {"a": currencies[0], "b": currencies[1]},
        "total": {"a": _bill_total(a), "b": _bill_total(b)},
        "lines": lines,
    }


def file_differences(a: Folder, b: Folder) -> dict[str, list[str]]:
    """Files of one alone, and those whose bytes differ."""
    both = a.sha256.keys() & b.sha256.keys()
    return {
        "only_a": sorted(a.sha256.keys() - both),
        "only_b": sorted(b.sha256.keys() - both),
        "changed": sorted(path for path in both if a.sha256[path] != b.sha256[path]),
    }


def _differing(one: Mapping[Any, Any], other: Mapping[Any, Any]) -> Iterator[tuple[Any, Any, Any]]:
    for name in dict.fromkeys((*one, *other)):
        if one.get(name) != other.get(name):
            yield name, one.get(name), other.get(name)


def _entry(name: str, unit: str, a: Any, b: Any) -> Entry:
    return {"name": name, "unit": unit, "a": a, "b": b}


def _unit(name: str) -> str:
    ends = sorted(_UNITS, key=len, reverse=True)
    return next((_UNITS[end] for end in ends if name.endswith(f"_{end}")), "")


def _numbers(folder: Folder) -> dict[tuple[str, str], float]:
    """Masses, counts, lengths and prices by name and unit."""
    try:
        found = dict(_made(folder))
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        raise folder.damaged(manifest.NAME, error) from error
    found["cells", ""] = len(folder.design.layout)
    lengths_mm: dict[str, float] = {}
    rows = folder.rows(CABLES, "length_mm", "wire")
    for row in rows:
        name = row["wire"].partition(".")[0]
        lengths_mm[name] = lengths_mm.get(name, 0.0) + float(row["length_mm"] or 0)
    found["wires", ""] = len(rows)
    found |= {(f"wire in cable {name}", "mm"): length for name, length in lengths_mm.items()}
    currency = folder.design.purchase.currency
    found["sum of the bill, as used", currency] = _bill_total(folder)
    last = folder.rows(ORDER, "price")[-1]
    found["sum of the order, in whole packs", currency] = float(last["price"] or 0)
    return found


def _made(folder: Folder) -> Iterator[tuple[tuple[str, str], float]]:
    """Figures that the manifest keeps of files."""
    files = folder.manifest.files
    for name, grams in files["robot/lumitip.urdf"].facts.items():
        yield (f"mass of the {name.removesuffix('_g')} finger", "g"), round(grams, 2)
    for path, entry in files.items():
        what = path.rpartition("/")[2].partition(".")[0]
        if path.endswith("_casting.md"):
            finger = what.removesuffix("_casting")
            yield (f"silicone to mix for the {finger}", "mL"), round(entry.facts["mix_ml"], 2)
        elif "parts" in entry.facts:
            count = sum(int(part["quantity"]) for part in entry.facts["parts"])
            yield (f"parts on the {what} board", ""), count


def _texts(folder: Folder) -> dict[str, str]:
    return {row.quantity: row.computed for row in spec.rows(folder.design)}


def _lines(folder: Folder) -> list[Row]:
    return [row for row in _bill(folder) if row["group"] != _TOTAL]


def _bill(folder: Folder) -> list[Row]:
    return folder.rows(BILL, "price", *_SAME_LINE[0], "quantity", "unit")


def _bill_total(folder: Folder) -> float:
    totals = [row["price"] for row in _bill(folder) if row["group"] == _TOTAL]
    if not totals:
        raise folder.damaged(BILL, "no total")
    return float(totals[-1] or 0)


def _matched(
    one: list[Row], other: list[Row], columns: Sequence[str]
) -> list[tuple[Row | None, Row | None]]:
    """Pairs of lines with the same values in these columns, which no other line has; they are taken
    out of both lists."""

    def key(row: Row) -> tuple[str, ...]:
        return tuple(row[column] for column in columns)

    firsts, seconds = _unique(one, key), _unique(other, key)
    common = [k for k in firsts if k in seconds]
    for k in common:
        one.remove(firsts[k])
        other.remove(seconds[k])
    return [(firsts[k], seconds[k]) for k in common]


def _unique(rows: list[Row], key: Callable[[Row], Any]) -> dict[Any, Row]:
    counts = Counter(map(key, rows))
    return {key(row): row for row in rows if counts[key(row)] == 1}

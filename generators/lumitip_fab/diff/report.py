"""Everything that differs, as JSON, and as the lines of a summary."""

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from lumitip_fab.diff.checks import check_differences, outcomes
from lumitip_fab.diff.copper import LEAST_MM2, layer_differences
from lumitip_fab.diff.folder import Folder
from lumitip_fab.diff.solids import LEAST_MM3, part_differences
from lumitip_fab.diff.values import (
    Shape,
    bill_differences,
    fact_differences,
    file_differences,
    parameter_differences,
)

SCHEMA_VERSION = 1
NO_DIFFERENCE, FAILS = "no difference", "FAILS"
_NAMED = 3  # of the things that a line counts


@dataclass(frozen=True)
class Difference:
    """How two designs differ."""

    record: dict[str, Any]
    """All figures, as JSON has them."""
    parts: tuple[Shape, ...]
    """Printed parts."""
    layers: tuple[Shape, ...]
    """Layers of copper."""

    def json(self) -> str:
        """The text of `diff.json`."""
        return json.dumps(self.record, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def compare(
    a: Folder, b: Folder, checked: bool = True, progress: Callable[[str], None] = lambda _: None
) -> Difference:
    """Compare two output folders.

    Args:
        a, b: the folders.
        checked: run the checks of both, unless all their files are the same.
        progress: called with the name of each part of the work.

    Raises:
        OutputError: if a file cannot be read.
    """
    files = file_differences(a, b)
    differ = any(files.values())
    progress("values")
    record: dict[str, Any] = {
        "schema_version": SCHEMA_VERSION,
        "a": _origin(a),
        "b": _origin(b),
        "parameters": parameter_differences(a, b),
        "facts": fact_differences(a, b),
        "bill": bill_differences(a, b),
        "files": files,
    }
    progress("solids")
    parts = tuple(part_differences(a, b))
    progress("copper")
    layers = tuple(layer_differences(a, b))
    progress("checks")
    record["checks"] = check_differences(*outcomes(a, b)) if checked and differ else None
    record |= {"solids": [p.record() for p in parts], "copper": [v.record() for v in layers]}
    return Difference(record, parts, layers)


def _origin(folder: Folder) -> dict[str, Any]:
    title = folder.design.title
    return {
        "name": folder.name,
        "title": f"{title.name} {title.revision}",
        "design_hash": folder.manifest.origin.design_hash,
        "edited": folder.edited,
    }


def summary(found: Difference) -> Iterator[tuple[str, str]]:
    """Subject and text of each line, the most important first; what does not differ is last."""
    record, files = found.record, found.record["files"]
    if not any(files.values()):
        yield "all", NO_DIFFERENCE
        return
    lines = {
        "checks": _checks(record["checks"]),
        "parameters": _listed([_value(entry) for entry in record["parameters"]]),
        "facts": _listed([_value(entry) for entry in record["facts"]]),
        "solids": _shapes(found.parts, "mm³", LEAST_MM3),
        "copper": _shapes(found.layers, "mm²", LEAST_MM2),
        "bill": _bill(record["bill"]),
        "files": f"{len(files['changed'])} differ, {len(files['only_a'])} only in A, "
        f"{len(files['only_b'])} only in B",
    }
    yield from ((subject, text) for subject, text in lines.items() if text)
    for side in "ab":
        if edited := record[side]["edited"]:
            yield "edited", f"{side.upper()} is not as it was built: {_listed(edited)}"
    if same := [subject for subject, text in lines.items() if not text]:
        yield NO_DIFFERENCE, ", ".join(same)


def _checks(checks: dict[str, Any] | None) -> str:
    if checks is None:
        return "not run"
    texts = []
    for side in "ab":
        if failing := [entry["check"] for entry in checks[f"fails_{side}"]]:
            texts.append(f"{side.upper()} alone {FAILS} {_listed(failing)}")
    if checks["fails_both"]:
        texts.append(f"{checks['fails_both']} fail in both")
    margins = [
        f"{e['check']} {percent(e['a']['margin'])} → {percent(e['b']['margin'])}"
        for e in checks["margins"]
    ]
    texts = texts or ["none fails in one alone"]
    return "; ".join(texts) + (f"; margins: {_listed(margins)}" if margins else "")


def _shapes(shapes: Iterable[Shape], unit: str, least: float) -> str:
    differ = sorted((s for s in shapes if s.xor >= least), key=lambda s: -s.xor)
    names = [
        f"{s.name} only in {'A' if s.sizes[1] is None else 'B'}"
        if None in s.sizes
        else f"{s.name} {s.xor:.4g} {unit}"
        for s in differ
    ]
    return _listed(names) + (" (in A xor B)" if names else "")


def _bill(bill: dict[str, Any]) -> str:
    total, currency = bill["total"], bill["currency"]
    sums = " → ".join(f"{total[side]:.2f} {currency[side]}" for side in "ab")
    alone = [sum(line[side] is None for line in bill["lines"]) for side in "ba"]
    changed = len(bill["lines"]) - sum(alone)
    if not bill["lines"] and total["a"] == total["b"]:
        return ""
    return f"{sums}; {changed} lines differ, {alone[0]} only in A, {alone[1]} only in B"


def _value(entry: dict[str, Any]) -> str:
    unit = f" {entry['unit']}" if entry["unit"] else ""
    return f"{entry['name']} {shown(entry['a'])} → {shown(entry['b'])}{unit}"


def _listed(names: Sequence[str]) -> str:
    more = f"; {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return "; ".join(names[:_NAMED]) + more


def shown(value: Any) -> str:
    """A value as it is read: a dash for none."""
    if value is None or value == "":
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list):
        return f"[{', '.join(map(shown, value))}]"
    return str(value)


def percent(share: float | None) -> str:
    """A share as a percentage: a dash for none."""
    return "–" if share is None else f"{100 * share:.1f} %"

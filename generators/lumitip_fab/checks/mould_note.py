"""The note for the person who pours: masses and figures against the mould's cavity."""

import re
from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design, Finger

VOLUME_FRACTION = 0.02
_PART = re.compile(r", part ([AB]) \| \*\*([0-9.]+) g\*\*")
_HOW = (
    r"layers of (\S+) mm",
    r"floor at (\S+) mm",
    r"stops\s+at (\S+) mm",
    r"Leave it for (\S+) h",
)
STATED = re.compile(r"stays on the finger \| \*\*([0-9.]+) mL\*\*")


def measure_note(outputs: Path, design: Design, finger: Finger) -> Iterator[Measurement]:
    """The casting note: grams of both parts, layers, heights and hours."""
    file = f"mould/{finger.name}_casting.md"
    try:
        text = (outputs / file).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        yield from (unreadable(f"mould.{name}", file, repr(error)) for name in ("masses", "note"))
        return
    yield _masses(text, file, design)
    yield _figures(text, file, design)


def _masses(text: str, file: str, design: Design) -> Measurement:
    """Grams of parts A and B in the note against its own millilitres and the mixing ratio."""
    mould = design.mould
    stated, grams = STATED.search(text), dict(_PART.findall(text))
    if stated is None or grams.keys() != {"A", "B"}:
        return unreadable("mould.masses", file, "does not state the mass of parts A and B")
    whole = float(stated[1]) * (1 + mould.waste_fraction) * mould.density_g_ml
    wanted = [whole * part / sum(mould.mix_ratio) for part in mould.mix_ratio]
    worst = max(abs(float(grams[p]) / w - 1) for p, w in zip("AB", wanted, strict=True))
    return Measurement(
        "mould.masses",
        file,
        100 * worst,
        0,
        100 * VOLUME_FRACTION,
        "%",
        f"parts of {wanted[0]:.2f} g and {wanted[1]:.2f} g",
    )


def _figures(text: str, file: str, design: Design) -> Measurement:
    """Layers, heights and hours in the note against the design."""
    mould = design.mould
    stops_mm = mould.wall_mm + design.stack.cover_mm
    wanted = [f"{v:g}" for v in (mould.layer_mm, mould.wall_mm, stops_mm, mould.cure_h)]
    matches = [re.findall(pattern, text) for pattern in _HOW]
    wrong = sum(found != [v] for found, v in zip(matches, wanted, strict=True))
    return Measurement(
        "mould.note",
        file,
        float(wrong),
        0,
        0,
        "wrong figures",
        f"of layers, floor, stops and hours: {', '.join(wanted)}",
    )

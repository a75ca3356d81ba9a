"""The report of an acceptance: JSON, HTML, and the frames that it was made from."""

import hashlib
import html
import io
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lumitip.acceptance import findings as limits
from lumitip.acceptance.response import DEVIATIONS
from lumitip.acceptance.steps import Frames
from lumitip.acceptance.verdict import Verdict
from lumitip.errors import LumitipError
from lumitip.frame import Values
from lumitip.layout import Layout

SCHEMA_VERSION = 1
JSON, HTML, FRAMES = "acceptance.json", "acceptance.html", "frames.npz"
_LIMITS = {
    **dict.fromkeys(("receiver_x", "receiver_y", "emitter_x", "emitter_y"), limits.MASK_MM),
    **dict.fromkeys(("receiver_turn", "emitter_turn"), limits.MASK_DEG),
    "gap": limits.GAP_MM,
    "hole": limits.HOLE_MM,
}
"""Of the deviations that are judged; of a mask the way in x and y together."""
_STYLE = """
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif }
body { max-width: 46rem; margin: 2rem auto; padding: 0 1rem }
table { border-collapse: collapse; width: 100% }
td, th { text-align: left; padding: .2rem .6rem .2rem 0; border-bottom: 1px solid #8886 }
td.n { text-align: right; font-variant-numeric: tabular-nums }
.yes { color: #178a3a }
.no { color: #d33 }
code { overflow-wrap: anywhere }
svg { width: 100%; max-width: 24rem; height: auto }
text { fill: #fff; text-anchor: middle }
"""


@dataclass(frozen=True)
class Circumstances:
    """Circumstances of the measurement, for the report."""

    device_id: str
    date: str
    """Start of the protocol, ISO 8601."""
    gauge_sha256: str
    """Of the gauge file."""
    versions: dict[str, str]
    reference: dict[str, float] | None = None
    """Mean deviations of good fingers, if the verdict was made with them."""
    thicker_mm: tuple[float, float] | None = None
    """Silicone of receiver and emitter beyond the drawing, if it was measured."""


def write(
    folder: Path,
    frames: Frames,
    judged: Verdict,
    layout: Layout,
    circumstances: Circumstances,
) -> list[Path]:
    """Write `acceptance.json`, `acceptance.html` and `frames.npz`; the paths written.

    Args:
        folder: made if it does not exist.
        frames: of all steps.
        judged: the verdict on them.
        layout: the cells.
        circumstances: device, date and versions.

    Raises:
        LumitipError: if the folder has a report.
        OSError: if they cannot be written.
    """
    arrays = _arrays(frames)
    packed = io.BytesIO()
    np.savez_compressed(packed, **arrays)  # type: ignore[arg-type]
    record = _record(arrays, packed.getvalue(), judged, layout, circumstances)
    contents = {
        FRAMES: packed.getvalue(),
        HTML: page(record, judged, layout).encode(),
        JSON: (json.dumps(record, indent=1) + "\n").encode(),
    }
    prepare(folder)
    for name, data in contents.items():
        (folder / f"{name}.new").write_bytes(data)
    for name in contents:
        (folder / f"{name}.new").replace(folder / name)
    return [folder / name for name in (HTML, JSON, FRAMES)]


def prepare(folder: Path) -> None:
    """Make the folder of a report.

    Raises:
        LumitipError: if it has one already.
        OSError: if nothing can be written there.
    """
    if (folder / JSON).exists():
        raise LumitipError(f"{folder} has a report already. Choose another folder with --out")
    folder.mkdir(parents=True, exist_ok=True)
    trial = folder / f"{JSON}.new"
    trial.write_bytes(b"")
    trial.unlink()


def _limit(name: str, value: float, circumstances: Circumstances) -> float | None:
    if name == "scatter":
        less, more = limits.SCATTER if circumstances.reference else limits.SCATTER_ALONE
        off = value - (circumstances.reference or {}).get("scatter", 0.0)
        return more if off > 0.0 else less
    if name.endswith("_silicone"):
        return limits.THICK_MM if circumstances.thicker_mm else None
    return _LIMITS.get(name)


def mean_deviations(paths: Sequence[Path], design_hash: str) -> dict[str, float]:
    """Mean deviations of accepted pairs of fingers of one design, by their names.

    Args:
        paths: their reports.
        design_hash: of the design.

    Raises:
        LumitipError: if a file is not such a report.
    """
    each = [_deviations_of(path, design_hash) for path in paths]
    return {name: sum(of[name] for of in each) / len(each) for name in each[0]}


def _deviations_of(path: Path, design_hash: str) -> dict[str, float]:
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        if record["accepted"] is not True or record["design_hash"] != design_hash:
            raise ValueError("not of accepted fingers of this design")
        found = {name: float(of["value"]) for name, of in record["deviations"].items()}
        if not all(map(math.isfinite, found.values())):
            raise ValueError("a deviation is not finite")
        return {each.name: found[each.name] for each in DEVIATIONS}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise LumitipError(
            f"{path}: cannot be read as the report of accepted fingers of this design ({error}). "
            f"`lumitip accept` writes {JSON}"
        ) from error


def _arrays(frames: Frames) -> dict[str, Values]:
    named = {f"gauge_{n}": part for n, part in enumerate(frames.gauge)}
    steps = {"empty": frames.empty, "sheet": frames.sheet, "moving": frames.moving} | named
    return {name: np.asarray(part, np.float32) for name, part in steps.items()}


def _record(
    arrays: dict[str, Values],
    packed: bytes,
    judged: Verdict,
    layout: Layout,
    circumstances: Circumstances,
) -> dict[str, Any]:
    return {
        "schema_version": SCHEMA_VERSION,
        "accepted": judged.accepted,
        "device_id": circumstances.device_id,
        "date": circumstances.date,
        "design_hash": layout.design_hash,
        "findings": [{**asdict(f), "times_limit": _number(f.times_limit)} for f in judged.findings],
        "unseen": judged.unseen,
        "deviations": {
            each.name: {
                "title": each.title,
                "unit": each.unit,
                "value": _number(judged.deviations[each.name]),
                "sd": _number(judged.sd[each.name]),
                "limit": _limit(each.name, judged.deviations[each.name], circumstances),
            }
            for each in DEVIATIONS
            if each.name in judged.deviations
        },
        "misfit_counts": _number(judged.misfit),
        "reference": circumstances.reference,
        "thicker_mm": circumstances.thicker_mm,
        "calibration": {"empty": _listed(judged.empty), "dark": _listed(judged.dark)},
        "gauge_sha256": circumstances.gauge_sha256,
        "frames": {
            "file": FRAMES,
            "sha256": hashlib.sha256(packed).hexdigest(),
            "steps": {
                name: {
                    "frames": len(part),
                    "sha256": hashlib.sha256(part.astype("<f4").tobytes()).hexdigest(),
                }
                for name, part in arrays.items()
            },
        },
        "versions": circumstances.versions,
    }


def _number(value: float) -> float | None:
    return round(float(value), 4) if math.isfinite(value) else None


def _listed(values: Values) -> list[float]:
    return [round(float(v), 3) for v in values]


def page(record: dict[str, Any], judged: Verdict, layout: Layout) -> str:
    """The report as one page without scripts or other files."""
    word = "accepted" if judged.accepted else "not accepted"
    mark = "yes" if judged.accepted else "no"
    title = html.escape(f"{record['device_id']}: {word}")
    findings = [f"<li>{html.escape(f.text)}" for f in judged.findings]
    findings += [f"<li>{html.escape(judged.unseen)}"] if judged.unseen else []
    return "\n".join(
        [
            "<!doctype html>",
            f'<html lang="en"><meta charset="utf-8"><title>{title}</title>',
            '<meta name="viewport" content="width=device-width">',
            f"<style>{_STYLE}</style>",
            f'<h1>{html.escape(record["device_id"])}: <span class="{mark}">{word}</span></h1>',
            f"<p>{html.escape(record['date'])}, design "
            f"<code>{record['design_hash'][:16]}</code></p>",
            f"<ul>{''.join(findings)}</ul>" if findings else "<p>No fault was found.</p>",
            "<h2>Cells</h2><p>Light in the empty grasp, of 255; seen on the receiver, tip up. "
            "Cells with a fault are red.</p>",
            _cells(judged, layout),
            "<h2>Deviations from the drawing</h2>",
            *_table(record["deviations"]),
            "<p>± is one standard deviation. Directions: seen on the receiver's face with the tip "
            "up.</p>",
            f"<p>{_thickness(record['thicker_mm'])}</p>",
            *_reference(record["reference"]),
            "<h2>Made from</h2>",
            f"<p>Gauge <code>{record['gauge_sha256']}</code>; frames in {FRAMES}, "
            f"<code>{record['frames']['sha256']}</code> (SHA-256); "
            + html.escape(", ".join(f"{k} {v}" for k, v in record["versions"].items()))
            + ".</p></html>",
            "",
        ]
    )


def _thickness(thicker_mm: Sequence[float] | None) -> str:
    if thicker_mm is None:
        return "Thickness of the silicone was not measured, and is not judged."
    receiver, emitter = thicker_mm
    return (
        f"Silicone by calliper: receiver {receiver:+.2f} mm, emitter {emitter:+.2f} mm from the "
        f"drawing; at most {limits.THICK_MM:g} mm."
    )


def _reference(reference: dict[str, float] | None) -> Iterator[str]:
    if reference:
        yield (
            "<p>The scattered share was compared with that of good fingers: "
            f"{reference['scatter']:+.2f} from the drawing.</p>"
        )


def _cells(judged: Verdict, layout: Layout) -> str:
    bad = {cell for finding in judged.findings for cell in finding.cells}
    half = 0.48 * layout.pitch_mm
    left, low = layout.x_mm.min() - layout.pitch_mm, layout.y_mm.min() - layout.pitch_mm
    wide, high = (
        np.ptp(layout.x_mm) + 2 * layout.pitch_mm,
        np.ptp(layout.y_mm) + 2 * layout.pitch_mm,
    )
    marks = []
    for cell, (x, y) in enumerate(zip(layout.x_mm.tolist(), layout.y_mm.tolist(), strict=True)):
        colour = (
            "#d33" if cell in bad else f"hsl(210 45% {20 + 30 * judged.empty[cell] / 255:.0f}%)"
        )
        marks.append(
            f'<circle cx="{x:.2f}" cy="{-y:.2f}" r="{half:.2f}" fill="{colour}">'
            f"<title>cell {cell}</title></circle>"
            f'<text x="{x:.2f}" y="{-y + 0.12 * layout.pitch_mm:.2f}" '
            f'font-size="{0.33 * layout.pitch_mm:.2f}">{judged.empty[cell]:.0f}</text>'
        )
    top = -(low + high)
    return f'<svg viewBox="{left:.2f} {top:.2f} {wide:.2f} {high:.2f}">{"".join(marks)}</svg>'


def _table(deviations: dict[str, Any]) -> Iterator[str]:
    yield "<table><tr><th>deviation<th>measured<th>limit</tr>"
    for of in deviations.values():
        unit = {"deg": "°", "mm": " mm"}.get(of["unit"], "")
        limit = "not judged" if of["limit"] is None else f"{of['limit']:g}{unit}"
        yield (
            f'<tr><td>{html.escape(of["title"])}<td class="n">{of["value"]:+.2f} ± '
            f'{of["sd"]:.2f}{unit}<td class="n">{limit}</tr>'
        )
    yield "</table><p>What the gauge measures must be within its limit by half of ±.</p>"

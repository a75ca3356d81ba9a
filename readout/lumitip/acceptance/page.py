"""The report of an acceptance as one page."""

import html
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from lumitip.acceptance import findings as limits
from lumitip.acceptance.verdict import Verdict
from lumitip.layout import Layout

FRAMES = "frames.npz"
"""The file of the frames."""
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
            *_traces(record["traces"]),
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


def _traces(traces: Sequence[dict[str, Any]]) -> Iterator[str]:
    if not traces:
        return
    yield "<h2>The edge on the positioning stage</h2>"
    yield (
        "<table><tr><th>stage<th>places<th>error, rms<th>worst<th>scale<th>turns by<th>to and fro"
        "</tr>"
    )
    for of in traces:
        columns = (
            f"{of['places']}" + (f", {of['missed']} not found" if of["missed"] else ""),
            _figure(of["error_mm"], " mm"),
            _figure(of["worst_mm"], " mm"),
            _figure(of["scale"]),
            _figure(of["turn_deg"], "°"),
            _figure(of["play_mm"], " mm"),
        )
        cells = "".join(f'<td class="n">{column}' for column in columns)
        yield f"<tr><td>{of['direction']}{cells}</tr>"
    yield (
        "</table><p>The way of the edge in the estimates less that of the stage, whose own errors "
        "are part of it; places with the edge over the cells. Not judged.</p>"
    )


def _figure(value: float | None, unit: str = "") -> str:
    return "–" if value is None else f"{value:.3f}{unit}"


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

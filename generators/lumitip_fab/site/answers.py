"""The head of the page: the design in two sentences, and answers to a maker's first questions."""

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any
from urllib.parse import quote

from lumitip_fab.site.folder import Folder
from lumitip_fab.site.tables import Print, duration, totals, unmarked


def lead(folder: Folder) -> str:
    """The design in two sentences."""
    design = folder.design
    return (
        f"Two gripper fingers that see by infrared light: {len(design.layout)} LEDs in one face, "
        f"as many photodetectors straight across, in cells {design.layout.pitch_mm:g} mm apart. "
        f"For {design.mount.title}, read by {design.controller.title}."
    )


def answers(
    folder: Folder,
    checks: Sequence[dict[str, Any]],
    parts: Sequence[Print],
    errors: Mapping[str, float],
) -> list[str]:
    """Answers to the first questions of a maker."""
    design, (used, packs, stated) = folder.design, totals(folder)
    currency, _, trust = stated.partition(", ")
    minutes = sum(part.minutes * part.number for part in parts)
    glue_h, cure_h = design.mould.glue_hard_h, design.mould.cure_h
    glue = f"glue {glue_h:g} h, " if glue_h else ""
    return [
        _answer(
            "What does it cost?",
            f"{used:.0f} {currency}",
            f"At prices of {escape(trust)}. {packs:.0f} {escape(currency)} if whole packs are "
            'bought. <a href="#bill">Bill</a>',
        ),
        _answer(
            "How long does it take?",
            f"{duration(minutes)} of printing",
            f"then {glue_h + 2 * cure_h:g} h of waiting: {glue}silicone {cure_h:g} h for a trial "
            f"and {cure_h:g} h for the skin. "
            '<a href="#prints">Parts</a>',
        ),
        _quality(folder, checks, errors),
        _beginning(folder),
    ]


def _beginning(folder: Folder) -> str:
    """What a maker begins with: what nobody has measured comes before the order."""
    manual = '<a href="manual/manual.html">build manual</a>'
    meanwhile = f'<a href="#boards">Order files</a>. Meanwhile print {_first(folder)}'
    if not (unknown := unmarked(folder)):
        more = f"The {manual} has you measure the gripper before. {meanwhile}."
        return _answer("What is first?", "Order the boards", more)
    more = (
        f"The {manual} has you measure the gripper, and try which end of {' and '.join(unknown)} "
        f"is marked. Then: {meanwhile}."
    )
    return _answer("What is first?", "Measure, then order", more)


def _first(folder: Folder) -> str:
    file = "fit/fit_plate.stl"
    if file in folder.manifest.files:
        return f'the <a href="{quote(file)}">fit test plate</a>'
    return '<a href="#prints">the parts</a>'


def _quality(folder: Folder, checks: Sequence[dict[str, Any]], errors: Mapping[str, float]) -> str:
    names = {entry["check"] for entry in checks}
    failed = {entry["check"] for entry in checks if not entry["passed"]}
    poses = ", ".join(
        f"{kind}s to {errors[f'{kind}_mm']:.2f} mm and {errors[f'{kind}_deg']:.1f}°"
        for kind in ("edge", "cable")
        if f"{kind}_mm" in errors
    )
    simulated = f"Expected errors, simulated: {poses}. " if poses else ""
    more = (
        f"{simulated}No finger was measured. Rated force: "
        f'{escape(folder.design.strength.rating)}. <a href="#checks">Checks</a>'
    )
    if not checks:
        since = "" if folder.checked is None else " since the files changed"
        run = (
            "Run make outputs; or lumitip-fab check with --report checks.json in this folder, and "
            "lumitip-fab page."
        )
        return _answer("How good is it?", f"Not checked{since}", f"{run} {more}")
    if failed:
        return _answer("How good is it?", f"{len(failed)} of {len(names)} checks fail", more, "bad")
    measured = f"{len(checks)} measurements of the files are within their limits. {more}"
    return _answer("How good is it?", f"{len(names)} checks pass", measured, "good")


def _answer(question: str, answer: str, more: str, kind: str = "") -> str:
    return (
        f'<div class="answer {kind}"><h2>{escape(question)}</h2>'
        f'<p class="big">{escape(answer)}</p><p>{more}</p></div>'
    )

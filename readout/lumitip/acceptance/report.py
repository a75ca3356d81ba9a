"""The report of an acceptance: JSON, HTML, and the frames that it was made from."""

import hashlib
import io
import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lumitip.acceptance import findings as limits
from lumitip.acceptance.page import FRAMES, page
from lumitip.acceptance.response import DEVIATIONS
from lumitip.acceptance.steps import Frames
from lumitip.acceptance.verdict import Verdict
from lumitip.errors import LumitipError
from lumitip.frame import Values
from lumitip.layout import Layout

SCHEMA_VERSION = 1
JSON, HTML = "acceptance.json", "acceptance.html"
_LIMITS = {
    **dict.fromkeys(("receiver_x", "receiver_y", "emitter_x", "emitter_y"), limits.MASK_MM),
    **dict.fromkeys(("receiver_turn", "emitter_turn"), limits.MASK_DEG),
    "gap": limits.GAP_MM,
    "hole": limits.HOLE_MM,
}
"""Of the deviations that are judged; of a mask the way in x and y together."""


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
    moved = {f"moved_mm_{n}": part.moved_mm for n, part in enumerate(frames.traverses)}
    return {name: np.asarray(part, np.float32) for name, part in (steps | moved).items()}


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
        "findings": [_finite(asdict(each)) for each in judged.findings],
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
        "traces": [
            {k: _number(v) if isinstance(v, float) else v for k, v in asdict(t).items()}
            for t in judged.traces
        ],
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


def _finite(record: dict[str, Any]) -> dict[str, Any]:
    """The record with rounded numbers, `None` for those that are not finite."""
    return {k: _number(v) if isinstance(v, float) else v for k, v in record.items()}


def _number(value: float) -> float | None:
    return round(float(value), 4) if math.isfinite(value) else None


def _listed(values: Values) -> list[float]:
    return [round(float(v), 3) for v in values]

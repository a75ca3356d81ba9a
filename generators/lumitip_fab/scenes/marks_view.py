"""The test with a multimeter of a part whose marked end is not known: where the probes touch."""

from collections.abc import Iterator

import numpy as np

from lumitip_fab.design import Packages
from lumitip_fab.design.packages import Marked
from lumitip_fab.scenes.drawing import Label, Points, Sheet, View, silhouette, view, visible_lines
from lumitip_fab.scenes.system import block

AZIMUTH_DEG, ELEVATION_DEG = -24.0, 34.0
SCALE = 13.0
PROBES = {"red": "#d11f2e", "black": "#1a1a1a"}
MARK = "#1f9d48"
_APART_MM = 32.0  # from part to part on the page
_PROBE_MM, _TIP_MM = 15.0, 4.0  # of a probe on the page: its length, its width at the far end
_MARK_SHARE = 0.18  # of a body's length, as it is drawn
_GAP_MM, _WORDS_MM, _MARGIN_MM = 10.0, 62.0, 4.0
_SHOWN = dict.fromkeys(("anode", "cathode"), "this way round the meter shows a voltage")
_SHOWN |= dict.fromkeys(("collector", "emitter"), "this way round light gives a voltage")


def marks_view(packages: Packages) -> str:
    """Each part to test, its marked end on the left, with the probes at its ends."""
    sheet = Sheet(_MARGIN_MM)
    eye = view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(SCALE)
    names = {"LED": packages.led_name, "photodetector": packages.photodetector_name}
    labels: list[Label] = []
    for row, (kind, part) in enumerate(packages.unmarked.items()):
        down = np.array([0.0, -row * _APART_MM])
        with sheet.group(kind):
            _draw(sheet, eye, part, down)
        labels += list(_labels(eye, f"{kind} {names[kind]}", part, down))
    low = sheet.leaders_beside(labels, _WORDS_MM, _GAP_MM)
    sheet.cover(float(sheet.low[0]), low)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def _draw(sheet: Sheet, eye: View, part: Marked, down: Points) -> None:
    """Body, mark and probes."""
    long, wide, high = part.body_mm
    body = block((-long / 2, long / 2), (-wide / 2, wide / 2), 0.0, 0.0, high)
    for at, colour in zip(_ends(eye, part, down), _probes(part), strict=True):
        out = np.sign(at[0] - down[0])
        far = at + _PROBE_MM * np.array([out * 0.8, 0.6])
        across = _TIP_MM / 2 * np.array([-0.6 * out, 0.8])
        sheet.area([np.array([at, far + across, far - across])], "body", PROBES[colour])
    sheet.area([ring + down for ring in silhouette(body, eye)], "body", "#f3f4f5")
    sheet.lines([line + down for line in visible_lines([body], eye)[0]], "line")
    inner = (_MARK_SHARE - 0.5) * long
    top = [(-long / 2, -wide / 2), (inner, -wide / 2), (inner, wide / 2), (-long / 2, wide / 2)]
    mark = np.array([(x, y, high) for x, y in top])
    sheet.area([eye.seen(mark)[:, :2] + down], "part", MARK)


def _ends(eye: View, part: Marked, down: Points) -> tuple[Points, Points]:
    """Where the probes touch on the page: the marked end, then the other."""
    long, _, high = part.body_mm
    ends = np.array([(-long / 2, 0.0, high / 2), (long / 2, 0.0, high / 2)])
    first, last = eye.seen(ends)[:, :2] + down
    return first, last


def _probes(part: Marked) -> tuple[str, str]:
    """Colours of the probes at the marked end and at the other, with which the meter shows
    something: red at an anode, or at a collector."""
    return ("red", "black") if part.marked in ("anode", "collector") else ("black", "red")


def _labels(eye: View, name: str, part: Marked, down: Points) -> Iterator[Label]:
    """The part by its name, and its ends with the probes."""
    long, _, high = part.body_mm
    top = eye.seen(np.array([[0.0, 0.0, high], [(_MARK_SHARE / 2 - 0.5) * long, 0.0, high]]))
    middle, mark = top[:, :2] + down
    marked, other = _probes(part)
    yield (name[0].upper() + name[1:], _SHOWN[part.marked]), middle
    yield ("Mark", f"the {part.marked}, as the design has it: {marked} probe"), mark
    yield ("Other end", f"{other} probe"), _ends(eye, part, down)[1]

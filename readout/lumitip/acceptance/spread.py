"""How single parts, boards and drifting gains change the values that fingers read of the gauge.

The effects of one part on several cells are correlated, so the fit needs their covariance.
"""

from dataclasses import replace

import numpy as np

from lumitip.acceptance.response import Response
from lumitip.grid import Floats
from lumitip.twin.built import Built
from lumitip.twin.optics import FULL, values_of_drive

LED = 0.1
"""Standard deviation of the light of an LED, as a share; this and those below as in
`parts/tolerances.toml`."""
PLACEMENT_MM = 0.05
"""That of a part beside its land, in x and in y."""
BOARD_MM = 0.125
"""That of a board beside its place: uniform within the play of the published backing's pins, and
accuracy of the print."""
DRIFT = 0.011
"""That of a cell's gain between the empty grasp and the gauge: half of that since a tare."""


def spread(response: Response, deviations: Floats, drive: Floats) -> Floats:
    """Change of the values by one standard deviation of each, shape `(n, placements * cells)`.

    Args:
        response: of the gauge.
        deviations: of the fingers, as `Response.values` takes them.
        drive: photocurrent of each cell in the empty grasp, shape `(cells,)`.
    """
    pair = response.built(deviations)
    before = _passed(response, pair, deviations)
    light = before.sum(axis=1)
    leds = _passed(response, replace(pair, led=pair.led * (1.0 + LED)), deviations) - before
    changes = [*leds.transpose(1, 0, 2)]
    each = np.eye(drive.size)
    for way_mm in PLACEMENT_MM * np.eye(2)[:, :, None]:
        for end in ("led_mm", "detector_mm"):
            moved = replace(pair, **{end: getattr(pair, end) + way_mm})
            change = _passed(response, moved, deviations) - before
            whole = change.sum(axis=1)
            single = change.transpose(1, 0, 2) if end == "led_mm" else whole * each[:, None]
            changes += [*single, whole * (BOARD_MM / PLACEMENT_MM)]
    gauge = np.arange(len(light)) > 0
    changes += [*(DRIFT * light * gauge[:, None] * each[:, None])]

    def values(passed: Floats) -> Floats:
        # The empty grasp shows the part, too.
        read = values_of_drive(drive * passed / light[0], response.model)
        return np.asarray(FULL * read[..., 1:, :] / np.maximum(read[..., :1, :], 1.0))

    rows = values(np.maximum(light + np.array(changes), 0.0)) - values(light)
    return np.asarray(rows.reshape(len(rows), -1))


def _passed(response: Response, pair: Built, deviations: Floats) -> Floats:
    """Light by LED and cell, in the empty grasp and behind each piece, shape `(1 + placements,
    cells, cells)`."""
    light = response.rays.of(pair)
    cell, led = response.rays.pairs
    pieces = response.pieces(deviations)
    passed = np.zeros((1 + len(pieces), pair.led.size, pair.detector.size))
    passed[:, led, cell] = [light.passed(piece) for piece in (None, *pieces)]
    return passed

"""The gauge card over the finger that its end with the edge hugs."""

from collections.abc import Mapping

import numpy as np

from lumitip_fab.design import GaugeCard, Outline, frames
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.drawing import Points, Sheet, view
from lumitip_fab.scenes.finger_views import paint

AZIMUTH_DEG, ELEVATION_DEG = 32.0, 38.0
SCALE = 1.3
RAISED_MM = 24.0  # of the card over its place
_LABEL_MM, _WORDS_MM = 8.0, 46.0


def gauge_view(card: GaugeCard, outline: Outline, printed: Mesh, layers: Mapping[str, Mesh]) -> str:
    """The card above the receiver, its end E down onto it.

    Args:
        card: for its places.
        outline: of the finger, along which the rails run.
        printed: the card in the frame of its bed.
        layers: interface, backing, film and so on in the sensor frame, from the back.
    """
    sheet, eye = Sheet(), view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(SCALE)
    paint(sheet, eye, {k: layers[k] for k in ("interface", "backing", "film") if k in layers})
    raised = frames.translation(0.0, 0.0, RAISED_MM) @ frames.gauge_bed_to_sensor(card)
    paint(sheet, eye, {"clamp": printed.moved(raised)})

    def page(x_mm: float, y_mm: float, z_mm: float) -> Points:
        return np.asarray(eye.seen(np.array([[x_mm, y_mm, z_mm + RAISED_MM]]))[0, :2])

    window, stop, low = card.window, card.stop, card.low_y_mm
    rail = outline.half_width_at(low) + card.rail_gap_mm + card.wall_mm / 2
    labels = [
        (("Stop", "against the tip"), page(stop.x_max_mm, stop.centre_mm[1], card.gap_mm)),
        (
            ("Edge", "of the blade, over the cells: end E"),
            page(window.centre_mm[0], window.y_min_mm + window.length_mm / 4, card.gap_mm),
        ),
        (("Rails", "beside the finger"), page(rail, low, -card.rail_mm / 2)),
    ]
    right = float(sheet.high[0]) + _LABEL_MM
    sheet.leaders(labels, right, "start")
    sheet.cover(right + _WORDS_MM, float(labels[0][1][1]))
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})

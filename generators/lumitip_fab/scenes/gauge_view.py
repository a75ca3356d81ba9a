"""The gauge card over the finger that its end with the edge hugs."""

import math
from collections.abc import Mapping

import numpy as np

from lumitip_fab.design import GaugeCard, Outline, frames
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.drawing import Points, Sheet, view
from lumitip_fab.scenes.finger_views import paint

AZIMUTH_DEG, ELEVATION_DEG = 32.0, 38.0
SCALE = 0.9
RAISED_MM = 24.0  # of the card over its place
_WORDS_MM, _WORDS = 68.0, 1.6


def gauge_view(card: GaugeCard, outline: Outline, printed: Mesh, layers: Mapping[str, Mesh]) -> str:
    """The card above the receiver, its end E down onto it.

    Args:
        card: for its places.
        outline: of the finger, along which the rails run.
        printed: the card in the frame of its bed.
        layers: interface, backing, film and so on in the sensor frame, from the back.
    """
    sheet, eye = Sheet(words_scale=_WORDS), view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(SCALE)
    paint(sheet, eye, {k: layers[k] for k in ("interface", "backing", "film") if k in layers})
    stop, low = card.stop, card.low_y_mm
    rail = outline.half_width_at(low) + card.rail_gap_mm + card.wall_mm / 2
    ways = [np.array([(x, low, 0.0), (x, low, RAISED_MM)]) for x in (-rail, rail)]
    sheet.lines([eye.seen(way)[:, :2] for way in ways], "axis")
    raised = frames.translation(0.0, 0.0, RAISED_MM) @ frames.gauge_bed_to_sensor(card)
    paint(sheet, eye, {"clamp": printed.moved(raised)})

    def page(x_mm: float, y_mm: float, z_mm: float) -> Points:
        return np.asarray(eye.seen(np.array([[x_mm, y_mm, z_mm + RAISED_MM]]))[0, :2])

    labels = [
        (("Stop", "against the tip"), page(stop.x_max_mm, stop.centre_mm[1], card.gap_mm)),
        (
            ("Edge", "of the blade, over the cells"),
            page(*_on_edge(card), card.gap_mm),
        ),
        (("Rails", "beside the finger"), page(rail, low, -card.rail_mm / 2)),
    ]
    sheet.leaders_beside(labels, _WORDS_MM)
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


def _on_edge(card: GaugeCard) -> tuple[float, float]:
    """A place of the edge, on the right of the window."""
    turn = math.radians(card.edge.angle_deg)
    x = (card.window.x_max_mm + card.window.centre_mm[0]) / 2
    return x, (card.edge.offset_mm + x * math.sin(turn)) / math.cos(turn)

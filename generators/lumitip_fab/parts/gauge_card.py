"""The gauge card, printed flat on the face of its blade, and `gauge.json`, which tells the robot
side where edge and strip are."""

import json
from dataclasses import asdict

import numpy as np
import shapely
from build123d import Face, Solid

from lumitip_fab.design import Box, Design, GaugeCard, Outline, Target
from lumitip_fab.design.frames import gauge_bed_to_sensor, gauge_ends
from lumitip_fab.parts import export
from lumitip_fab.parts.letters import PITCH, value_cutters
from lumitip_fab.parts.shapes import box_solid, one_solid, placed, polygon_face, prism
from lumitip_fab.parts.skin import offset_wire
from lumitip_fab.pipeline.artefact import Artefact

SCHEMA_VERSION = 1
_JOINT_MM = 0.5  # how far blade and strip reach into the frame
_FAR_MM = 400.0


def gauge_card_files(design: Design, card: GaugeCard) -> tuple[Artefact, ...]:
    """STEP in the sensor frame of a finger in end E, STL and 3MF on the bed, and `gauge.json`."""
    solid = gauge_card_solid(card, design.outline)
    files = export.part_files(f"gauge/{card.name}", solid, gauge_bed_to_sensor(card))
    return *files, Artefact("gauge.json", gauge_text(card, design.layout.design_hash).encode())


def gauge_text(card: GaugeCard, design_hash: str) -> str:
    """The text of `gauge.json`: lengths in mm, in the receiver's sensor frame."""
    record = {
        "schema_version": SCHEMA_VERSION,
        "design_hash": design_hash,
        "gap_mm": card.gap_mm,
        "placements": [asdict(placement) for placement in card.placements],
    }
    return json.dumps(record, indent=1) + "\n"


def gauge_card_solid(card: GaugeCard, outline: Outline) -> Solid:
    """The card in the sensor frame of the finger that its end E hugs.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    ends = gauge_ends(card)
    half = _end(card, outline)
    bed = np.asarray(np.linalg.inv(gauge_bed_to_sensor(card)))
    made, cutters = [], []
    for letter, target in (("E", card.edge), ("S", card.strip)):
        across = prism(polygon_face(_across(target, card.window)), target.low_mm, target.high_mm)
        made.append(placed(half + across, ends[target.kind]))
        cutters += [
            placed(c, ends[target.kind] @ np.linalg.inv(bed)) for c in _letter(card, letter)
        ]
    return one_solid((made[0] + made[1] - cutters).clean(), "gauge card", "the outline")


def _end(card: GaugeCard, outline: Outline) -> Solid:
    """Frame, rails and stop of one end, up to the middle of the card."""
    window, gap = card.window, card.gap_mm
    around = Face(offset_wire(outline, card.rail_gap_mm + card.wall_mm, 0.0))
    inside = Face(offset_wire(outline, card.rail_gap_mm, 0.0))
    reach = Box(-_FAR_MM, _FAR_MM, card.low_y_mm, card.middle_y_mm)
    beside = Box(-_FAR_MM, _FAR_MM, card.low_y_mm, card.rail_y_max_mm)
    stop = Box(card.stop.x_min_mm, card.stop.x_max_mm, card.stop.y_min_mm, card.middle_y_mm)
    frame = prism(around, 0.0, gap) & box_solid(reach, 0.0, gap)
    rails = prism(around, -card.rail_mm, 0.0) - prism(inside, -card.rail_mm, 0.0)
    rails = rails & box_solid(beside, -card.rail_mm, 0.0)
    whole = frame - box_solid(window, -1.0, gap + 1.0)
    return whole + rails + box_solid(stop, -card.rail_mm, 0.0)


def _across(target: Target, window: Box) -> list[tuple[float, float]]:
    """Corners of the blade or the strip, with its joints in the frame."""
    right = -_FAR_MM if target.kind == "edge" else -target.width_mm / 2
    left = target.width_mm / 2
    along = [(-_FAR_MM, right), (_FAR_MM, right), (_FAR_MM, left), (-_FAR_MM, left)]
    turn = np.radians(target.angle_deg)
    cosine, sine = np.cos(turn), np.sin(turn)
    beside = shapely.Polygon(
        [
            (a * cosine - (n + target.offset_mm) * sine, a * sine + (n + target.offset_mm) * cosine)
            for a, n in along
        ]
    )
    cut = beside & shapely.box(*window.grown(_JOINT_MM).bounds_mm)
    return [(float(x), float(y)) for x, y in shapely.get_coordinates(cut.exterior)[:-1]]


def _letter(card: GaugeCard, letter: str) -> list[Solid]:
    """Cutters of a letter in the frame's bar at the gripper end of end E, in the face that lies on
    the finger and is up on the bed; none where it would be too small."""
    if not card.letter_mm:
        return []
    high, middle = card.letter_mm, (card.low_y_mm + card.window.y_min_mm) / 2
    half = PITCH * high / 2
    box = Box(-half, half, middle - high / 2, middle + high / 2)
    return value_cutters(letter, box, card.gap_mm, card.letter_depth_mm)

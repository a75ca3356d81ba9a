"""Good fingers of the second optical model at each step of the acceptance protocol."""

from dataclasses import replace

import numpy as np

from accept_fingers import STEADY, path
from lumitip.acceptance.gauge import Gauge
from lumitip.acceptance.steps import Frames
from lumitip.frame import Values
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.twin.built import Piece
from second_light import Light
from second_specimen import Specimen, drawn_electronics
from second_tips import DEVIATIONS, Tips, drawn

_GAP_SD_MM = 0.1  # of fingers that are closed on the gauge
_DRIFT = 0.002  # of a cell's gain from step to step
_BLACK = 0.06
"""Albedo of the gauge's black plastic."""
_METAL, _SHEET_MM, _FAR_MM = 0.5, 0.4, 60.0
_EVERY = 3  # of the frames in which the sheet moves


def second_frames(layout: Layout, gauge: Gauge, seed: int) -> Frames:
    """The frames of a random pair of fingers.

    Args:
        layout: the cells.
        gauge: of the design.
        seed: of optics, electronics and noise.
    """
    chance = np.random.default_rng((9, seed))
    tips = drawn(chance)
    off = (tips.gap_mm - Tips().gap_mm) * _GAP_SD_MM / DEVIATIONS["gap_mm"]
    tips = replace(tips, gap_mm=gauge.gap_mm + off)
    heights = {of.piece.low_mm + of.piece.high_mm for of in gauge.placements}
    # Rays are kept with their places at the height of what they meet.
    lights = {
        height: Light.of(layout, replace(tips, specimen_height=height / 2.0 / gauge.gap_mm), seed)
        for height in heights
    }
    circuit = drawn_electronics(chance, len(layout), _DRIFT)
    any_light = next(iter(lights.values()))

    def read(light: Light, share: Floats, frames: int) -> Values:
        codes = circuit.codes(np.tile(share / light.full.max(), (frames, 1)), chance)
        values: Values = codes.astype(np.float32)
        return values

    sheet = Specimen("edge", _FAR_MM, 0.0, _SHEET_MM, 0.0, 0.0, _METAL)
    poses = path(layout, chance).poses[::_EVERY]
    edges = [replace(sheet, angle_deg=float(np.degrees(a)), offset_mm=float(o)) for a, o in poses]
    placed = []
    for of in gauge.placements:
        light = lights[of.piece.low_mm + of.piece.high_mm]
        placed.append(read(light, light.light(_specimen(of.piece)), STEADY))
    return Frames(
        read(any_light, any_light.full, STEADY),
        read(any_light, any_light.light(sheet), STEADY),
        np.concatenate([read(any_light, any_light.light(edge), 1) for edge in edges]),
        tuple(placed),
    )


def _specimen(piece: Piece) -> Specimen:
    """A piece of the gauge; a strip is a corner of two borders that lie opposite."""
    thick = piece.high_mm - piece.low_mm
    edge = Specimen("edge", piece.offset_mm, piece.angle_deg, thick, 0.0, 0.0, _BLACK)
    if piece.kind == "edge":
        return edge
    half = piece.width_mm / 2.0
    return replace(
        edge,
        kind="corner",
        offset_mm=piece.offset_mm + half,
        second_offset_mm=half - piece.offset_mm,
        second_angle_deg=piece.angle_deg + 180.0,
    )

"""Load on a finger, what its materials bear, and what that load does to it."""

import math
from dataclasses import dataclass

import numpy as np

from lumitip_fab.design.beam import Beam, Layer, Vectors
from lumitip_fab.design.torsion import SHEAR, torsion

PEAK = 1.5
"""Greatest shear in a rectangle over its mean."""


@dataclass(frozen=True)
class Strength:
    """The load case, limits, and figures of materials: assumed where the catalogue says so."""

    rated_force_n: float
    """At the tip of each finger, towards its back or sideways; for the light path both."""
    gripper_n: float
    """Greatest force of the gripper; 0 where it is not known."""
    safety: float
    """At least, of the printed layers and of the glue."""
    most_bend_mm: float
    """Deflection of the tip, at most."""
    offset_share: float
    """How far the path from LED to detector may leave the middle of an aperture, as a share of its
    half width, at most."""
    backing_mpa: float
    """Young's modulus of the backing's filament."""
    rigid_mpa: float
    """The same of the filament of an interface."""
    board_mpa: float
    """The same of the board's laminate."""
    board_strain: float
    """Most that the board's front may be strained, with the parts soldered on it."""
    glue: str
    """Title of the glue behind the board, or between plate and interface."""
    glue_mpa: float
    """Lap shear strength."""
    lap_mm: float
    """Overlap of the test that gave it: near its end a joint bears its peak within that length."""

    @property
    def closing_n(self) -> float:
        """Greatest force of the gripper; that of a finger, where the gripper's is not known."""
        return self.gripper_n or self.rated_force_n

    @property
    def rating(self) -> str:
        """The rated force in words, with what the gripper does to it."""
        rated = f"{self.rated_force_n:g} N at each tip, an estimate"
        if not self.gripper_n:
            return f"{rated}; the gripper's force is not known: limit it"
        if self.gripper_n > self.rated_force_n:
            return f"{rated}; the gripper closes with up to {self.gripper_n:g} N: limit it"
        return rated


@dataclass(frozen=True)
class Loads:
    """Figures of a finger under its rated force; lengths in mm."""

    layers_mpa: float
    """Greatest principal tension from layer to layer of printed parts, by bending and twist."""
    layers_h_mm: float
    """Where: over the mount plane."""
    safety: float
    """What the layers bear, over what they get; the least over all printed parts."""
    between_mpa: float
    """Greatest shear in printed parts, by the force and by twist: what layers bear between them
    that lie along the finger."""
    bare_n: float
    """Force at which the layers part without glue."""
    board_strain: float
    glue_mpa: float
    """Greatest shear in the glue."""
    bend_mm: float
    """Deflection of the tip towards its back."""
    side_mm: float
    """Deflection of the tip sideways."""
    lean_deg: float
    """Slope at the cell nearest to the tip."""
    aside_mm: float
    """How far from the middle a thing may be grasped: at the outermost cells."""
    twist_deg: float
    """Turn about the finger's axis at those cells, by the rated force on them."""
    offset_mm: float
    """Greatest distance of the path from LED to detector from the middle of an aperture."""


@dataclass(frozen=True, eq=False)
class Loaded:
    """A finger as a beam, with what its layers are."""

    beam: Beam
    stiff: Beam
    """The same without what is not stretched yet where the block meets the plate: for the bend."""
    printed: tuple[tuple[Layer, float], ...]
    """Printed layers, and their strength from layer to layer (MPa)."""
    board: Layer
    glued: Layer
    """The layer that the glue holds on the others."""
    glue_mm: Vectors
    """Width of the glue in each section, 0 where there is none."""


def loads(of: Loaded, strength: Strength, cells_mm: Vectors, depth_mm: float) -> Loads:
    """What the rated force does to a finger.

    Towards the back it acts in the middle of the tip, or as far aside as the outermost cells and as
    high as the highest: what lies farther out is not felt. There it bends less, and twists.

    Args:
        of: its layers.
        strength: load and materials.
        cells_mm: u of the cells, and their heights over the mount plane; shape `(n, 2)`.
        depth_mm: of the dies of LED and detector below the mask, the deeper one.
    """
    force, beam = strength.rated_force_n, of.beam
    aside, across = _turned(beam, cells_mm)
    parts = [
        (_tension_mpa(beam, layer, aside, across) * force, limit) for layer, limit in of.printed
    ]
    if not np.all(sum((layer.area_mm2 for layer, _ in of.printed), np.zeros(1))):
        parts = [(np.full_like(beam.h_mm, np.inf), limit) for _, limit in of.printed]
    worst, limit = max(parts, key=lambda part: float(part[0].max()) / part[1])
    bare = beam.alone(*(layer for layer, _ in of.printed))
    alone = _turned(bare, cells_mm)
    bare_n = min(
        limit / float(_tension_mpa(bare, layer, *alone).max()) for layer, limit in of.printed
    )
    strain = beam.tension_mpa(of.board) * force / of.board.modulus_mpa
    cells_h = cells_mm[:, 1]
    stiff = of.stiff.stiffness_nmm2
    back, lean = of.stiff.bent(stiff, np.append(cells_h, beam.tip_h_mm))
    side, _ = beam.bent(beam.side_stiffness_nmm2, np.append(cells_h, beam.tip_h_mm))
    turn = beam.summed(aside.twist, cells_h)
    # Fingers that bend and twist alike stay mirror images: a path crosses each mask off its middle
    # by lean and turn. Pulled sideways they move apart, and it crosses both masks half way.
    swung = beam.summed(across.twist * across.lever_mm, cells_h)
    offset = np.hypot(depth_mm * lean[:-1], depth_mm * turn + side[:-1] + swung) * force
    return Loads(
        layers_mpa=float(worst.max()),
        layers_h_mm=float(beam.h_mm[worst.argmax()]),
        safety=limit / max(float(worst.max()), 1e-9),
        between_mpa=force
        * max(_between_mpa(beam, layer, aside, across) for layer, _ in of.printed),
        bare_n=bare_n,
        board_strain=float(strain.max()),
        glue_mpa=_glue_mpa(of, strength),
        bend_mm=float(back[-1]) * force,
        side_mm=float(side[-1]) * force,
        lean_deg=math.degrees(float(lean[:-1].max()) * force),
        aside_mm=float(aside.lever_mm.max()),
        twist_deg=math.degrees(float(turn.max()) * force),
        offset_mm=float(offset.max()),
    )


@dataclass(frozen=True, eq=False)
class _Turned:
    """Twist by 1 N that acts beside the sections' middle."""

    arm_mm: Vectors
    """Distance of each section from the force that bends it."""
    lever_mm: Vectors
    twist: Vectors
    """Of a unit of length."""
    reach_mm: tuple[Vectors, ...]
    """For the shear strain in each layer of the beam."""


def _turned(beam: Beam, cells_mm: Vectors) -> tuple[_Turned, _Turned]:
    """Towards the back on the outermost cells, and sideways on the gripping face at the tip.
    Silicone passes the force to the plate up to the highest cells, where the plate is whole."""
    found, top = torsion(beam), float(cells_mm[:, 1].max())
    under = beam.h_mm <= top
    out = np.where(under, float(np.abs(cells_mm[:, 0]).max()), 0.0)
    across = np.where(under, np.abs(beam.middle_mm - beam.tip_w_mm), 0.0)
    arm, stiff = np.maximum(top - beam.h_mm, 0.0), found.stiffness_nmm2
    return (
        _Turned(arm, out, out / stiff, found.reach_mm),
        _Turned(beam.arm_mm, across, across / stiff, found.reach_mm),
    )


def _tension_mpa(beam: Beam, layer: Layer, aside: _Turned, across: _Turned) -> Vectors:
    """Greatest principal tension in a layer by 1 N: towards the back in the middle of the tip or on
    the outermost cells, or sideways. Where a section bends most and where it twists most is taken
    to be one place."""
    of = next(k for k, each in enumerate(beam.layers) if each is layer)
    shear = SHEAR * layer.modulus_mpa
    back, side = beam.tension_mpa(layer), beam.side_tension_mpa(layer)
    lower = back * aside.arm_mm / np.maximum(beam.arm_mm, 1e-9)
    twisted = (
        pulled / 2 + np.hypot(pulled / 2, shear * case.reach_mm[of] * case.twist)
        for pulled, case in ((lower, aside), (side, across))
    )
    return np.maximum(back, np.maximum(*twisted))


def _between_mpa(beam: Beam, layer: Layer, aside: _Turned, across: _Turned) -> float:
    """Greatest shear in a layer by 1 N: across a section, as of a rectangle, and by twist."""
    of = next(k for k, each in enumerate(beam.layers) if each is layer)
    there = (layer.area_mm2 > 0) & (beam.arm_mm > 0)
    if not there.any():
        return math.inf
    shear = SHEAR * layer.modulus_mpa
    twist = np.maximum(aside.reach_mm[of] * aside.twist, across.reach_mm[of] * across.twist)
    return float((PEAK / layer.area_mm2[there] + shear * twist[there]).max())


def lying_safety(found: Loads, layer_mpa: float, plane_mpa: float) -> float:
    """Safety of the printed layers if they lay along the finger: tension within them, shear between
    them.

    Args:
        found: what the rated force does.
        layer_mpa: strength between layers, in shear too.
        plane_mpa: strength within a layer.
    """
    return min(plane_mpa / max(found.layers_mpa, 1e-9), layer_mpa / max(found.between_mpa, 1e-9))


def _glue_mpa(of: Loaded, strength: Strength) -> float:
    """Greatest shear in the glue: along it, by how the force that it passes on changes; and at its
    ends, where that force passes within the length of a lap joint."""
    there = np.flatnonzero((of.glue_mm > 0) & (of.glued.area_mm2 > 0))
    if len(there) < 2:
        return math.inf
    held = of.beam.held_n(of.glued)[there] * strength.rated_force_n
    width, h = of.glue_mm[there], of.beam.h_mm[there]
    worst = float((np.abs(np.gradient(held, h)) / width).max())
    for force, wide, along in ((held, width, h - h[0]), (held[::-1], width[::-1], h[-1] - h[::-1])):
        lap = along <= strength.lap_mm
        area = float(np.trapezoid(wide[lap], along[lap]))
        worst = max(worst, float(force[lap][-1]) / max(area, 1e-9))
    return worst

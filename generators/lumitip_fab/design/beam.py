"""A finger as a cantilever beam: layers of materials in sections across it, as arrays.

In the mount frame: a section lies at a height h over the mount plane, as a standing part's printed
layers do, and has u to the right and w back from the gripping face. Bending by a force at the tip
follows Euler and Bernoulli: sections stay plane, layers that are glued to each other do not slip.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.design.mount import Mount
from lumitip_fab.design.shape import Box

Vectors = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Layer:
    """One material in each section; arrays of shape `(sections,)`, zero where there is none."""

    modulus_mpa: float
    area_mm2: Vectors
    first_mm3: Vectors
    """First moment about w = 0."""
    second_mm4: Vectors
    """Second moment about w = 0."""
    side_mm4: Vectors
    """Second moment about u = 0."""
    front_mm: Vectors
    """Least w."""
    back_mm: Vectors
    """Greatest w."""
    half_mm: Vectors
    """Greatest distance from u = 0."""
    glued: bool = True
    """Whether it does not slip on the others."""
    strips: "tuple[Layer, ...]" = ()
    """Its part within the width of the coupling's block, and that beside it."""

    @property
    def middle_mm(self) -> Vectors:
        """w of its centre; 0 where there is none."""
        there = self.area_mm2 > 0
        return np.divide(
            self.first_mm3, self.area_mm2, out=np.zeros_like(self.area_mm2), where=there
        )

    @property
    def own_mm4(self) -> Vectors:
        """Second moment about its own centre."""
        return self.second_mm4 - self.middle_mm * self.first_mm3


Block = tuple[Vectors, Vectors, Vectors, Vectors]
"""Inner and outer half width, front and back of a rectangle on both sides of u = 0, in each
section; where it is not, it has no height."""


def rectangles(
    modulus_mpa: float,
    core_mm: float,
    blocks: Sequence[Block],
    taken: Sequence[Block] = (),
    glued: bool = True,
) -> Layer:
    """A layer of rectangles.

    Args:
        modulus_mpa: of its material.
        core_mm: half width of the coupling's block.
        blocks: that do not overlap.
        taken: cut from these.
        glued: whether it does not slip.
    """
    sign = np.array([1.0] * len(blocks) + [-1.0] * len(taken))[:, None]
    inner, outer, front, back = (np.array(s) for s in zip(*blocks, *taken, strict=True))
    strips = (
        _summed(modulus_mpa, sign, (*sides, front, back), glued)
        for sides in (
            (np.minimum(inner, core_mm), np.minimum(outer, core_mm)),
            (np.maximum(inner, core_mm), np.maximum(outer, core_mm)),
        )
    )
    whole = _summed(modulus_mpa, sign, (inner, outer, front, back), glued)
    return replace(whole, strips=tuple(strips))


def _summed(modulus_mpa: float, sign: Vectors, sides: Block, glued: bool) -> Layer:
    """Rectangles on both sides of u = 0, each with its sign, as one layer without strips."""
    inner, outer, front, back = sides
    there = (back > front) & (outer > inner)
    wide = np.where(there, 2 * sign * (outer - inner), 0.0)
    cubed = np.where(there, 2 / 3 * sign * (outer**3 - inner**3), 0.0)
    kept = there & (sign > 0)
    front_mm = np.where(kept, front, np.inf).min(axis=0)
    back_mm = np.where(kept, back, -np.inf).max(axis=0)
    return Layer(
        modulus_mpa,
        (wide * (back - front)).sum(axis=0),
        (wide * (back**2 - front**2) / 2).sum(axis=0),
        (wide * (back**3 - front**3) / 3).sum(axis=0),
        (cubed * (back - front)).sum(axis=0),
        np.where(np.isfinite(front_mm), front_mm, 0.0),
        np.where(np.isfinite(back_mm), back_mm, 0.0),
        np.where(kept, outer, 0.0).max(axis=0),
        glued,
    )


def board_blocks(
    pocket: Box, board: Box, notch_y_mm: float, mount: Mount, pcb_mm: float, h_mm: Vectors
) -> tuple[Block, ...]:
    """A board in its pocket, whose front leans with the gripping face.

    Beside the wire notch nothing ties the plate to the coupling's block; beyond it the force
    spreads from the block's width at 45°.

    Args:
        pocket: its ends, for glue fills the gap there.
        board: its edge.
        notch_y_mm: end of the notch.
        mount: for block and lean.
        pcb_mm: its thickness.
        h_mm: heights of the sections.
    """
    tilt = math.radians(mount.tilt_deg)
    y, front = mount.origin_y_mm + h_mm / math.cos(tilt), -h_mm * math.tan(tilt)
    half = np.minimum(mount.block_width_mm / 2 + y - notch_y_mm, board.x_max_mm)
    there = (y > max(pocket.y_min_mm, notch_y_mm)) & (y < pocket.y_max_mm)
    back = np.where(there, front + pcb_mm / math.cos(tilt), front)
    return ((np.zeros_like(h_mm), half, front, back),)


def joined_mm(mount: Mount, notch_y_mm: float, h_mm: Vectors) -> Vectors:
    """Least w that stiffens each section: beyond the wire notch, stress spreads forward from the
    front of the coupling's block at 45°, and what lies before is not stretched yet.

    Args:
        mount: for block and lean.
        notch_y_mm: end of the notch.
        h_mm: heights of the sections.
    """
    beyond = mount.origin_y_mm + h_mm / math.cos(math.radians(mount.tilt_deg)) - notch_y_mm
    return np.where(beyond > 0.0, mount.block_front_w_mm - beyond, -np.inf)


def behind(low_mm: Vectors, blocks: Sequence[Block]) -> tuple[Block, ...]:
    """Rectangles without what lies before a w in each section."""
    return tuple(
        (inner, outer, np.maximum(front, low_mm), back) for inner, outer, front, back in blocks
    )


FLARE_SPREAD, RAMP_SPREAD = 0.27, 0.55
"""How fast stress spreads from the plate into the flare, and from there into the ramp that rises at
45°: what lies farther back bears nothing. By finite elements, see
`tests/checks/test_finger_fem.py`."""


def reached_mm(mount: Mount, plate_mm: float, h_mm: Vectors) -> Vectors:
    """Greatest w that bears load in each section.

    Args:
        mount: block, ramp and flare.
        plate_mm: from the rim plane to the back that the ramp stands on.
        h_mm: heights of the sections.
    """
    tilt, behind = math.tan(math.radians(mount.tilt_deg)), mount.block_back_w_mm + mount.land_mm
    end_h = (behind - plate_mm) / (1 - tilt) + mount.flare_mm
    start_h = (behind - plate_mm - mount.flare_depth_mm) / (1 - tilt)
    in_flare = plate_mm - h_mm * tilt + FLARE_SPREAD * np.maximum(end_h - h_mm, 0.0)
    start_w = min(behind - start_h, plate_mm - start_h * tilt + FLARE_SPREAD * (end_h - start_h))
    in_ramp = start_w + RAMP_SPREAD * (start_h - h_mm)
    return np.where(h_mm < start_h, in_ramp, in_flare)


@dataclass(frozen=True, eq=False)
class Beam:
    """Layers over heights h, and the tip that a force acts on."""

    h_mm: Vectors
    """Ascending."""
    tip_h_mm: float
    layers: tuple[Layer, ...]
    tip_w_mm: float = 0.0
    """w of the gripping face there."""

    def alone(self, *layers: Layer) -> "Beam":
        """Some layers without the others."""
        return replace(self, layers=layers)

    @property
    def arm_mm(self) -> Vectors:
        """Distance of each section from the tip."""
        return np.maximum(self.tip_h_mm - self.h_mm, 0.0)

    @property
    def middle_mm(self) -> Vectors:
        """w at which nothing is strained."""
        glued = [layer for layer in self.layers if layer.glued]
        stretch = sum((layer.modulus_mpa * layer.area_mm2 for layer in glued), np.zeros(1))
        first = sum((layer.modulus_mpa * layer.first_mm3 for layer in glued), np.zeros(1))
        return np.asarray(first / np.maximum(stretch, 1e-12))

    @property
    def stiffness_nmm2(self) -> Vectors:
        """Bending stiffness towards the back."""
        middle, total = self.middle_mm, np.zeros_like(self.h_mm)
        for layer in self.layers:
            away = (layer.middle_mm - middle) ** 2 * layer.area_mm2 if layer.glued else 0.0
            total = total + layer.modulus_mpa * (layer.own_mm4 + away)
        return np.maximum(total, 1e-9)

    @property
    def side_stiffness_nmm2(self) -> Vectors:
        """Bending stiffness sideways."""
        total = sum((layer.modulus_mpa * layer.side_mm4 for layer in self.layers), np.zeros(1))
        return np.asarray(np.maximum(total, 1e-9))

    def tension_mpa(self, layer: Layer) -> Vectors:
        """Tension at a layer's front by 1 N at the tip, towards the back."""
        there = layer.area_mm2 > 0
        reach = (self.middle_mm if layer.glued else layer.middle_mm) - layer.front_mm
        reach = np.maximum(reach, 0.0, out=np.zeros_like(reach), where=there)
        return np.asarray(layer.modulus_mpa * self.arm_mm / self.stiffness_nmm2 * reach)

    def side_tension_mpa(self, layer: Layer) -> Vectors:
        """Tension at a layer's side by 1 N at the tip, sideways."""
        return layer.modulus_mpa * self.arm_mm / self.side_stiffness_nmm2 * layer.half_mm

    def held_n(self, layer: Layer) -> Vectors:
        """Force along the finger that a layer holds by 1 N at the tip, towards the back."""
        pull = layer.modulus_mpa * layer.area_mm2 * np.abs(self.middle_mm - layer.middle_mm)
        return np.asarray(pull * self.arm_mm / self.stiffness_nmm2)

    def summed(self, per_mm: Vectors, at_h_mm: Vectors) -> Vectors:
        """Sum of a figure of a unit of length, from the mount plane to heights."""
        h = np.concatenate([[0.0], self.h_mm])
        each = np.concatenate([[per_mm[0]], per_mm])
        steps = (each[1:] + each[:-1]) / 2 * np.diff(h)
        return np.asarray(np.interp(at_h_mm, h, np.concatenate([[0.0], np.cumsum(steps)])))

    def bent(self, stiffness_nmm2: Vectors, at_h_mm: Vectors) -> tuple[Vectors, Vectors]:
        """Deflection (mm) and slope (radians) at heights by 1 N at the tip."""
        h = np.concatenate([[0.0], self.h_mm, [self.tip_h_mm]])
        curved = self.arm_mm / stiffness_nmm2
        curved = np.concatenate([[curved[0]], curved, [0.0]])
        step = np.diff(h)
        slope = np.concatenate([[0.0], np.cumsum((curved[1:] + curved[:-1]) / 2 * step)])
        moved = np.concatenate([[0.0], np.cumsum((slope[1:] + slope[:-1]) / 2 * step)])
        return np.interp(at_h_mm, h, moved), np.interp(at_h_mm, h, slope)

"""How a rigid backing is printed: standing, unless it is stronger lying and prints so without
support."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measurement, Subject
from lumitip_fab.checks.spans import longest_span_mm
from lumitip_fab.design import Design, Finger
from lumitip_fab.design.frames import backing_bed_to_sensor
from lumitip_fab.design.strength import Loads, lying_safety

WAYS = {"face up": np.eye(4), "face down": np.diag([1.0, -1.0, -1.0, 1.0])}
"""From the sensor frame to one that stands on the bed, but for its height."""


@dataclass(frozen=True)
class Lying:
    """A rigid backing that lies on the bed with its layers along the finger."""

    safety: float
    """What its layers bear over what they get."""
    spans_mm: dict[str, float]
    """Of each way to lie: a line laid over nothing, the longest one if the printer bridges it."""

    @property
    def span_mm(self) -> float:
        """Of the way that leaves less over nothing."""
        return min(self.spans_mm.values())


def lying(outputs: Path, design: Design, finger: Finger, found: Loads) -> Lying:
    """The written backing of a finger, turned onto its back and onto its front.

    Raises:
        OutputError: if its file is missing or holds no mesh.
    """
    mesh = solids.read_mesh(outputs / f"backing/{finger.name}_backing.stl")
    sensor = solids.moved(mesh, backing_bed_to_sensor(design.mount, design.stack))
    filament = design.slicing.backing
    safety = lying_safety(found, filament.layer_mpa, filament.plane_mpa)
    return Lying(safety, {way: _span_mm(sensor, turn, design) for way, turn in WAYS.items()})


def _span_mm(sensor: Any, turn: solids.Vectors, design: Design) -> float:
    turned = solids.moved(sensor, turn)
    turned.apply_translation((0.0, 0.0, -turned.bounds[0, 2]))
    printing = design.printing
    return longest_span_mm(turned, printing, enough_mm=printing.bridge_mm)[0]


def measure_orientation(
    outputs: Path, design: Design, finger: Finger, found: Loads
) -> Iterator[Measurement]:
    """Standing is right where lying is no stronger, or leaves more over nothing than the printer
    bridges. Of a compliant finger, whose plate lies in any case, nothing is measured."""
    if design.interfaces:
        return
    other, bridge_mm = lying(outputs, design, finger, found), design.printing.bridge_mm
    of = Subject("strength", f"backing/{finger.name}_backing.stl")
    note = "if it were printed lying; for information"
    yield of.figure("lying", other.safety, 0.0, np.inf, "times the load", note)
    least = bridge_mm if other.safety > found.safety else 0.0
    note = f"over nothing if it were printed lying, where it bears {other.safety:.1f} times the "
    note += f"load; standing {found.safety:.1f} times; {bridge_mm:g} mm need no support"
    yield of.figure("orientation", other.span_mm, least, np.inf, note=note)

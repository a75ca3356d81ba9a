"""`Artefact`: one file that a generator made, before it is written."""

from dataclasses import dataclass, field

import numpy as np

from lumitip_fab.frames import Matrix


@dataclass(frozen=True, eq=False)
class Artefact:
    """A file's place below the output folder, its bytes, and its frame."""

    path: str
    """Relative to the output folder, with forward slashes."""
    data: bytes
    to_sensor: Matrix = field(default_factory=lambda: np.eye(4))
    """From the file's own frame to its finger's sensor frame, or to `frame` (4x4, mm)."""
    frame: str = "sensor"
    """Name of the frame that `to_sensor` leads to: `"sensor"`, `"gripper"`, `"carrier"`,
    `"flange"`, `"tool"` (the robot's tool flange) or `""` for none."""

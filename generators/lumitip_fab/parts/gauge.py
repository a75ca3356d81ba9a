"""The gauge of a coupling: its foot alone, to hold against a gripper before fingers are printed."""

import numpy as np
from build123d import Solid

from lumitip_fab.design import Design
from lumitip_fab.design.frames import mount_to_sensor
from lumitip_fab.parts import coupling
from lumitip_fab.parts.shapes import one_solid, placed, polygon_face, prism

ABOVE_MM = 3.0  # of the counterbores above their seats, and of the block above its nose
_FAR_MM = 100.0


def gauge_solid(design: Design) -> Solid:
    """The gauge in the mount frame (mm), which is also its print bed.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    stack, mount = design.stack, design.mount
    block = coupling.coupling_solid(mount, stack, design.receiver.notch)
    block = block - coupling.coupling_holes(mount, stack)
    high = max(mount.land_mm, mount.nose.height_mm if mount.nose else 0.0) + ABOVE_MM
    square = [(-_FAR_MM, -_FAR_MM), (_FAR_MM, -_FAR_MM), (_FAR_MM, _FAR_MM), (-_FAR_MM, _FAR_MM)]
    to_mount = np.asarray(np.linalg.inv(mount_to_sensor(mount, stack)), np.float64)
    foot = placed(block, to_mount) & prism(polygon_face(square), 0.0, high)
    return one_solid(foot, f"{design.receiver.name} gauge")

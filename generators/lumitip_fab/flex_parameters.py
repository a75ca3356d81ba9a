"""What a parameter file says of a compliant finger."""

from pydantic import Field

from lumitip_fab.entry import Strict


class Flex(Strict):
    """A compliant finger; used where `backing.variant` is `flex`."""

    thread_hole_mm: float = Field(ge=1, le=5)
    """Diameter of the holes through which the board is tied to the plate (mm)."""
    interface_mm: float = Field(ge=5, le=100)
    """Length of the rigid interface along the finger, from the gripper end (mm)."""
    pad_mm: float = Field(ge=0.4, le=10)
    """Thickness of the interface's pad, which is glued to the plate (mm)."""
    standoff_mm: float = Field(ge=0, le=10)
    """How much farther the bolts are from the board than with a rigid finger (mm)."""
    groove_mm: float = Field(ge=0.8, le=5)
    """Width of the plate's groove for the interface's rim (mm)."""
    groove_depth_mm: float = Field(ge=0.3, le=5)
    """Depth of that groove (mm)."""
    glue_mm: float = Field(ge=0.05, le=0.5)
    """Gap between rim and groove, for glue (mm)."""
    lean_deg: float = Field(ge=0, le=5)
    """Added to the gripper's tilt, because the finger gives way when it grasps (degrees)."""

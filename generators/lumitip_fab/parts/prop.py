"""The prop under the gripper end of a mould."""

from build123d import Solid

from lumitip_fab.design import Design, Mould, Prop, Stack
from lumitip_fab.design.frames import prop_bed_to_sensor
from lumitip_fab.parts import export
from lumitip_fab.parts.shapes import box_solid, one_solid
from lumitip_fab.pipeline.artefact import Artefact


def prop_files(design: Design, prop: Prop) -> tuple[Artefact, ...]:
    """The prop: STEP in the sensor frame, STL and 3MF standing on its plate."""
    to_sensor = prop_bed_to_sensor(design.stack, design.mould, prop)
    solid = prop_solid(prop, design.stack, design.mould)
    return export.part_files(f"mould/{prop.name}", solid, to_sensor)


def prop_solid(prop: Prop, stack: Stack, mould: Mould) -> Solid:
    """The prop in the sensor frame of a finger in a mould that lies flat on it."""
    top = stack.silicone_z_mm + mould.floor_mm
    plate = box_solid(prop.plate, top, top + prop.height_mm)
    stop = box_solid(prop.stop, top - prop.stop_mm, top + prop.height_mm)
    return one_solid(plate + stop, "prop")

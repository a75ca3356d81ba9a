"""A board as a KiCad project: board file, footprints, schematic and rules."""

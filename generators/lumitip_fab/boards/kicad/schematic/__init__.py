"""Schematics of the boards, for KiCad 6 to 10."""

from lumitip_fab.boards.kicad.schematic.files import schematic_files

__all__ = ["schematic_files"]

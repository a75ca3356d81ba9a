"""The board as a KiCad project: `.kicad_pcb`, its footprint library and `.kicad_pro`."""

"""Files for the PCB manufacturer: Gerbers, bill of materials, positions, notes."""

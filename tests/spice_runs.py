"""Runs ngspice on a netlist."""

import re
import subprocess
from pathlib import Path

from programs import needs, program

needs_ngspice = needs("ngspice")


def simulated(netlist: str, folder: Path) -> dict[str, float]:
    """What ngspice prints of a netlist."""
    file = folder / "board.cir"
    file.write_text(netlist, encoding="utf-8")
    command = [program("ngspice"), "-b", str(file)]
    # Some versions end with 1 where a netlist plots nothing, though all went well.
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    found = re.findall(r"^(\w+) = (\S+)$", done.stdout, re.MULTILINE)
    assert found, done.stdout + done.stderr
    return {k: float(v) for k, v in found}

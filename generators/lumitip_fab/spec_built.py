"""Figures of a design that only its built files tell: what the fingers weigh."""

from pathlib import Path

from lumitip_fab import manifest
from lumitip_fab.checks.urdf_read import read_urdf
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError
from lumitip_fab.spec_outside import Row


def built_rows(out: Path, design: Design) -> tuple[Row, ...]:
    """Masses from the robot's model in an output folder.

    Raises:
        OutputError: if the folder was built from other values, or the model cannot be read.
    """
    if manifest.read(out).origin.parameters_hash != design.parameters_hash:
        raise OutputError(f"{out}: not built from these values: run lumitip-fab build first")
    links = read_urdf(out / "robot/lumitip.urdf").links
    weighed = [links[f"lumitip_{finger.name}"] for finger in design.fingers]
    densities = design.densities
    why = (
        f"volumes of the solids, with {densities.backing_g_ml:g} g/mL for the backing, "
        f"{densities.board_g_ml:g} for the board and its parts, {densities.silicone_g_ml:g} for "
        f"the silicone and {densities.film_g_ml:g} for the film; screws and wires are not in it"
    )
    rows = [
        Row(f"mass of the {finger.name} finger", "not stated", f"{link.mass_g:.1f} g", why)
        for finger, link in zip(design.fingers, weighed, strict=True)
    ]
    payload = sum(link.mass_g for link in weighed)
    return (*rows, Row("payload of both fingers", "not stated", f"{payload:.1f} g", why))

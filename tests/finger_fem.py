"""Finite elements of a finger: bricks that fill its written backing and the board in its pocket, or
the plate and the interface of a compliant one."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import skfem
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, sym_grad, trace

from lumitip_fab.checks.readers import solids
from lumitip_fab.design import Design, Finger
from lumitip_fab.design.frames import backing_bed_to_sensor, mount_to_sensor

POISSON = 0.35
SPREAD_MM = 2.0  # round the place of a force, as silicone spreads it
OFF_MM = 1e-3  # of a brick's middle from where faces of the mesh lie


@dataclass(frozen=True, eq=False)
class Bent:
    """Half of a finger, x >= 0, under the rated force on the line where the fingers touch first."""

    nodes_mm: Any
    """Shape `(3, n)`, in the sensor frame."""
    moved_mm: Any
    """Shape `(3, n)`."""
    tip_mm: float
    """Deflection of that line, or place, towards the back."""

    def front_strain(self, x_mm: float, y_mm: Any, front_z_mm: float, over_mm: float) -> Any:
        """Strain along the front at some y, over a length."""
        front = np.abs(self.nodes_mm[2] - front_z_mm) < OFF_MM
        x = self.nodes_mm[0, front]
        line = np.flatnonzero(front)[np.abs(x - x[np.abs(x - x_mm).argmin()]) < OFF_MM]
        line = line[np.argsort(self.nodes_mm[1, line])]
        along, moved = self.nodes_mm[1, line], self.moved_mm[1, line]
        ends = [np.interp(y_mm + side * over_mm / 2, along, moved) for side in (-1, 1)]
        return (ends[1] - ends[0]) / over_mm

    def turned(self, half_mm: float, y_mm: Any, low_z_mm: float) -> Any:
        """Turn about the finger's axis at some y, of what lies within a half width in front of a
        z."""
        x, y, z = self.nodes_mm
        found = []
        for level in y_mm:
            near = (z > low_z_mm) & (x > OFF_MM) & (x < half_mm)
            near &= np.abs(y - y[np.abs(y - level).argmin()]) < OFF_MM
            found.append(-(self.moved_mm[2, near] @ x[near]) / (x[near] @ x[near]))
        return np.array(found)

    def pulled(self, x_mm: float, low_y_mm: float, high_y_mm: float) -> float:
        """Greatest strain along the finger in each section, on average between two y."""
        x, y, z = self.nodes_mm
        near = np.abs(x - x[np.abs(x - x_mm).argmin()]) < OFF_MM
        near &= (y > low_y_mm) & (y < high_y_mm)
        levels = [np.flatnonzero(near & (np.abs(y - at) < OFF_MM)) for at in _apart(y[near])]
        worst = []
        for low, high in pairwise(levels):
            _, a, b = np.intersect1d(z[low].round(6), z[high].round(6), return_indices=True)
            moved = self.moved_mm[1, high[b]] - self.moved_mm[1, low[a]]
            worst.append(float((moved / (y[high[b]] - y[low[a]])).max()))
        return float(np.mean(worst))


def _apart(values: Any) -> Any:
    return np.unique(values.round(6))


def bent(
    outputs: Path,
    design: Design,
    finger: Finger,
    step_mm: tuple[float, ...],
    twisted_at_mm: tuple[float, float] | None = None,
) -> Bent:
    """Solve it, clamped in the mount plane.

    Args:
        outputs: the output folder.
        design: for frames, load and materials.
        finger: whose parts they are.
        step_mm: size of the bricks.
        twisted_at_mm: x and y of the force's place; half of it there, and half of it the other way
            on the other side, which twists the finger and does not bend it. None: the tip.
    """
    mesh, moduli = _bricks(outputs, design, finger, step_mm)
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex1()), intorder=2)
    constant = basis.with_element(skfem.ElementHex0())
    lam = constant.interpolate(moduli * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)))
    mu = constant.interpolate(moduli / (2 * (1 + POISSON)))
    stiffness = _elastic.assemble(basis, lam=lam, mu=mu)
    touch, rim = design.closing.contact_y_mm, design.stack.face_z_mm
    x, y, z = mesh.p
    block = (x < design.mount.block_width_mm / 2) & (z < design.stack.back_z_mm - OFF_MM)
    to_mount = np.linalg.inv(mount_to_sensor(design.mount, design.stack))
    height = to_mount[2, :3] @ mesh.p + to_mount[2, 3]
    base = np.flatnonzero(block & (height < step_mm[1] / 2))  # bricks follow the plane in steps
    line = np.flatnonzero((np.abs(y - touch) < OFF_MM) & (np.abs(z - rim) < OFF_MM))
    middle = [0]
    if twisted_at_mm is not None:
        away = np.hypot(x - twisted_at_mm[0], y - twisted_at_mm[1])
        line, middle = np.flatnonzero((away < SPREAD_MM) & (np.abs(z - rim) < OFF_MM)), [1, 2]
    of = basis.nodal_dofs
    plane = of[middle][:, np.flatnonzero(x < OFF_MM)]
    fixed = np.unique(np.concatenate([of[:, base].ravel(), plane.ravel()]))
    force = np.zeros(basis.N)
    force[of[2, line]] = -design.strength.rated_force_n / 2 / len(line)
    free = np.setdiff1d(np.arange(basis.N), fixed)
    solved = splu(
        stiffness[free][:, free].tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    ).solve(force[free])
    moved = np.zeros(basis.N)
    moved[free] = solved
    return Bent(mesh.p, moved[of], float(-moved[of[2, line]].mean()))


@skfem.BilinearForm
def _elastic(u: Any, v: Any, w: Any) -> Any:
    e, f = sym_grad(u), sym_grad(v)
    return w.lam * trace(e) * trace(f) + 2 * w.mu * ddot(e, f)


def _bricks(
    outputs: Path, design: Design, finger: Finger, step_mm: tuple[float, ...]
) -> tuple[Any, Any]:
    """Bricks whose middle lies in the finger, and their moduli.

    Along z whole bricks fill board and floor."""
    stack, touch = design.stack, design.closing.contact_y_mm
    backing = solids.read_mesh(outputs / f"backing/{finger.name}_backing.stl")
    parts = [solids.moved(backing, backing_bed_to_sensor(design.mount, stack))]
    for _ in design.interfaces:
        held = solids.read_mesh(outputs / f"interface/{finger.name}_interface.stl")
        parts.append(solids.moved(held, mount_to_sensor(design.mount, stack)))
    low, deep = np.min([part.bounds[0, 1:] for part in parts], axis=0)
    half = max(part.bounds[1, 0] for part in parts)
    planes = [stack.face_z_mm, *([stack.pocket_z_mm] if stack.sunk else []), stack.back_z_mm]
    through = [np.linspace(a, b, 1 + round((a - b) / step_mm[2])) for a, b in pairwise(planes)]
    below = stack.back_z_mm - deep + step_mm[2]
    axes = [
        np.arange(0.0, half + step_mm[0], step_mm[0]),
        touch - np.arange(0.0, touch - low + step_mm[1], step_mm[1])[::-1],
        np.unique(np.concatenate([*through, stack.back_z_mm - np.arange(0.0, below, step_mm[2])])),
    ]
    mesh = skfem.MeshHex.init_tensor(*axes)
    middle = mesh.p[:, mesh.t].mean(axis=1).T + OFF_MM
    within = [solids.inside(part, middle) for part in parts]
    soft, stiff = _rigid(design, middle) if stack.sunk else _compliant(design, middle)
    within[0] |= soft
    hard = stiff if stack.sunk else within[1]
    limit, kept = design.strength, np.flatnonzero(np.any([*within, stiff], axis=0))
    hard_mpa = limit.board_mpa if stack.sunk else limit.rigid_mpa
    moduli = np.where(hard, hard_mpa, limit.backing_mpa)[kept]
    return mesh.restrict(kept), moduli


def _rigid(design: Design, middle_mm: Any) -> tuple[Any, Any]:
    """Bricks of the glue in the slit at the board's end, and of the board."""
    stack, pocket = design.stack, design.board.pocket
    x, y, z = middle_mm.T
    across = (x < pocket.x_max_mm) & (z > stack.pocket_z_mm)
    slit = across & (y > pocket.y_max_mm) & (y < pocket.y_max_mm + design.board.roof_mm)
    return slit, across & (y > pocket.y_min_mm) & (y < pocket.y_max_mm)


def _compliant(design: Design, middle_mm: Any) -> tuple[Any, Any]:
    """Bricks of the glue round the interface's rim; none of the board, which slips on the plate."""
    (interface,), back = design.interfaces, design.stack.back_z_mm
    groove, (x, y, z) = interface.groove, middle_mm.T
    glue = (z > back) & (z < back + interface.groove_depth_mm)
    glue &= (x < groove.x_max_mm) & (y < groove.y_max_mm)
    inner = (x < groove.x_max_mm - interface.groove_mm) & (
        y < groove.y_max_mm - interface.groove_mm
    )
    return glue & ~inner, np.zeros(len(middle_mm), dtype=bool)

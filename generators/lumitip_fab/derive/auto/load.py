"""First values of what bears a finger's load: the load case, the ramp's flare, the floor."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from lumitip_fab.config.automatic import Value
from lumitip_fab.config.load import Input
from lumitip_fab.derive.auto.search import bounds
from lumitip_fab.derive.boards.boards import Plan
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import behind_mm, derive_stack, held_by, is_flex
from lumitip_fab.derive.finger.strength import LEAST_N, Body, borne_n
from lumitip_fab.derive.finger.tip import wedge
from lumitip_fab.derive.mount.fasteners import derive_fasteners
from lumitip_fab.derive.mount.rules import LEAST_FLARE_MM, deepest_flare_mm
from lumitip_fab.derive.once import derive_body, lay_out, optics_of
from lumitip_fab.errors import InputError

COMPLIANT_N, COMPLIANT_BEND = 5.0, 0.25
FLARE_ON_PAD_MM = 2.2
ENOUGH = 0.95  # of what the strongest finger bears: a floor that bears a little more is thick
DEPTH_STEP_MM, FINER_STEPS = 0.2, 4  # below a flare that holds, in whole millimetres
FLOOR_STEP_MM, MOST_FLOORS = 0.1, 12  # that are tried
FLAP_GAP_MM = 3.0  # flap to the flare, with the fillets beside it

Proposal = tuple[str, Value, str]


def load_case(config: Input) -> Iterator[Proposal]:
    """Most bending and glue by the kind of finger."""
    if is_flex(config.parameters):
        yield "finger.bend_fraction", COMPLIANT_BEND, "a compliant finger gives way"
        yield "backing.glue", "polyurethane", "holds on a plate that bends"
        yield "backing.flare_mm", FLARE_ON_PAD_MM, "on the pad of the interface"


def flare(config: Input) -> Iterator[Proposal]:
    """Length of the ramp's flare, to where the mask's flap at the tip may lie; its depth by the
    rated force, a thicker floor where no flare is enough, and where none is, the force that is
    borne."""
    p, faults = config.parameters, Diagnostics(config)
    try:
        derive_fasteners(config, faults)
        plan = lay_out(config, faults).plan
    except InputError:
        return
    body = _body(config, plan)
    if is_flex(p):
        borne = math.floor(10 * borne_n(config, body, optics_of(config))) / 10
        force = min(max(borne, bounds("finger.rated_force_n")[0]), COMPLIANT_N)
        yield "finger.rated_force_n", force, "a compliant finger gives way"
        return
    length = _length_mm(config, body)
    yield "backing.flare_mm", length, "as far as the back is free, up to the mask's flap at the tip"
    if "backing.flare_mm" not in config.automatic:
        length = p.backing.flare_mm
    tried = list(_until_borne(config, plan, length))
    most, wanted = max(each.borne_n for each in tried), p.finger.rated_force_n
    reason = f"bears finger.rated_force_n = {wanted:g} N"
    if most < wanted:
        wanted = max(math.floor(ENOUGH * most), LEAST_N)
        yield "finger.rated_force_n", wanted, f"flare and floor bear at most {most:.0f} N"
        reason = f"bears {wanted:g} N, nearly the most"
    best = next((each for each in tried if each.borne_n >= wanted), tried[-1])
    yield "backing.flare_depth_mm", best.depth_mm, reason
    if best.floor_mm > p.stack.floor_mm:
        yield "stack.floor_mm", best.floor_mm, f"the finger {reason}"


@dataclass(frozen=True)
class _Flared:
    """A floor and a flare that were tried, and the force that they bear."""

    floor_mm: float
    depth_mm: float
    borne_n: float


def _until_borne(config: Input, plan: Plan, length_mm: float) -> Iterator[_Flared]:
    """Floors and flares, thin and shallow first, up to the first that bears the rated force.

    A flare bears more the deeper it is, up to a depth from which on it spreads less of the load:
    whole millimetres are tried first, then steps below the first that holds.
    """
    p, optics = config.parameters, optics_of(config)
    floors, wanted = [p.stack.floor_mm], p.finger.rated_force_n
    if "stack.floor_mm" in config.automatic:
        floors += [round(floors[0] + FLOOR_STEP_MM * n, 2) for n in range(1, MOST_FLOORS)]
    for floor in floors:
        tried = config.with_values({"stack.floor_mm": floor})
        body = _body(tried, plan)

        def flared(depth_mm: float, tried: Input = tried, body: Body = body) -> _Flared:
            mount = replace(body.mount, flare_mm=length_mm, flare_depth_mm=depth_mm)
            borne = borne_n(tried, replace(body, mount=mount), optics)
            return _Flared(tried.parameters.stack.floor_mm, depth_mm, borne)

        for depth in _depths_mm(tried):
            found = flared(depth)
            if found.borne_n < wanted:
                yield found
                continue
            finer = (round(depth - DEPTH_STEP_MM * n, 2) for n in range(FINER_STEPS, 0, -1))
            least = p.backing.flare_depth_mm
            closer = (flared(d) for d in finer if d > least)
            yield next((f for f in closer if f.borne_n >= wanted), found)
            return


def _depths_mm(config: Input) -> list[float]:
    """Depths of flares, 1 mm apart."""
    p = config.parameters
    start = p.backing.flare_depth_mm
    if "backing.flare_depth_mm" not in config.automatic:
        return [start]
    deepest = deepest_flare_mm(held_by(config), behind_mm(p))
    deepest = min(deepest, bounds("backing.flare_depth_mm")[1])
    return [start + n for n in range(max(math.floor(deepest - start), 0) + 1)]


def _length_mm(config: Input, body: Body) -> float:
    """Of a flare from the ramp to the mask's flap, or to the wedge at the tip."""
    p = config.parameters
    flap = p.mask.flap_mm + p.mask.allowance_mm + FLAP_GAP_MM
    free = body.outline.tip_y_mm - max(flap, wedge(config)[0])
    free -= body.mount.ramp_end_y_mm(body.stack.back_z_mm, body.stack.rim_z_mm)
    _, most = bounds("backing.flare_mm")
    return min(max(math.floor(10 * free) / 10, LEAST_FLARE_MM), most)


def _body(config: Input, plan: Plan) -> Body:
    faults = Diagnostics(config)
    return derive_body(config, derive_stack(config, faults), plan, faults)[0]

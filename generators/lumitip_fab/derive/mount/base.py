"""Whether the gripper stands on the coupling that the flange is made for."""

from collections.abc import Iterator

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics


def fits_coupling(config: Input) -> bool:
    """Whether the bases of the gripper and of `flange.coupling` are the same."""
    return config.parts.coupling.gripper.base == config.parts.flange.coupling.base


def propose_flange(config: Input) -> Iterator[tuple[str, bool, str]]:
    """A flange where the gripper fits the coupling; none elsewhere."""
    yield "flange.enabled", fits_coupling(config), _reason(config)


def refuse_base(config: Input, faults: Diagnostics) -> None:
    """Refuse a flange under a gripper that does not stand on its coupling."""
    faults.unless(
        fits_coupling(config),
        "flange_without_base",
        reason=_reason(config),
        base=config.parts.flange.coupling.base,
    )


def refuse_module(config: Input, faults: Diagnostics) -> None:
    """Refuse a controller on the flange's board where no flange is made."""
    if config.parts.controller.board.module is None:
        return
    if fits_coupling(config):
        faults.add("module_without_flange")
    else:
        faults.add("module_without_base", reason=_reason(config))


def _reason(config: Input) -> str:
    """Bases of the gripper and of the coupling, in words."""
    p, parts = config.parameters, config.parts
    own, below = parts.coupling.gripper.base, parts.flange.coupling.base
    if own == below:
        return f"{p.coupling.gripper} stands on {p.flange.coupling!r}: both have base {below!r}"
    has = f"has base {own!r}" if own else "has no base in parts/grippers.toml"
    return f"{p.coupling.gripper} {has}; {p.flange.coupling!r} is for {below!r}"

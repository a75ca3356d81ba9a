"""The manual's choice of the gripper's cable: its maker's, or one from the flange's headers."""

from lumitip_fab.design import Design
from lumitip_fab.design.board_rules import rules_of
from lumitip_fab.design.cabling import INPUT_END, SLOT_A, SLOT_MM2
from lumitip_fab.design.gripper_cable import GripperCable
from lumitip_fab.design.gripper_cable import gripper_cable as cable_of
from lumitip_fab.text import listed, passage


def own_cable(design: Design) -> GripperCable:
    """What the flange's headers have for the gripper."""
    track_mm = rules_of(design, "flange").supply_track_mm
    (flange,) = design.flanges
    cables, supply_a = design.cabling.cables, design.mount.supply_a
    return cable_of(design.auxiliary_boards, cables, supply_a, track_mm, flange.contact_a)


def gripper_cable(design: Design) -> str:
    """The choice, where the board of a flange lies between the gripper's contacts and the
    robot's."""
    own, mount = own_cable(design), design.mount
    if own.by_maker:
        name = "draws_more" if own.fed_from else "nothing_offered"
        why = _text(name, mount=mount, most_a=own.most_a)
        return _text("makers_cable", why=why)
    drawn = ""
    if own.feeds:
        name = "drawn" if mount.supply_a else "not_known"
        drawn = _text(name, mount=mount, most_a=own.most_a)
    behind = _text("behind_fuse") * (not own.fed_from)
    return _text("gripper_cable", drawn=drawn, behind=behind)


def cable_from_headers(design: Design) -> str:
    """How a cable from the headers is made; empty where the gripper gets its maker's."""
    own = own_cable(design)
    if own.by_maker:
        return ""
    return _text("own_cable", supply=_supply(design, own))


def in_the_list(design: Design) -> str:
    """The cable that the list of parts has for the gripper."""
    own = own_cable(design)
    if own.by_maker:
        return _text("listed_makers")
    return _text("listed_free", fused=_text("listed_fuse") * own.feeds)


def _supply(design: Design, own: GripperCable) -> str:
    """The supply before the fuse, and how much its contacts carry; empty without it."""
    if not own.fed_from:
        return ""
    return _text(
        "from_robot",
        pads=listed([*own.fed_from]),
        volts=in_volts(raw_supply(design)),
        slot_mm2=SLOT_MM2,
        each_a=SLOT_A,
        all_a=own.most_a,
    )


def raw_supply(design: Design) -> str:
    """Net of the contacts' supply before the fuse, such as `"24V_IN"`."""
    return next(name for name in probed(design) if name.endswith(INPUT_END))


def in_volts(raw: str) -> str:
    """Voltage of the contacts' supply, such as `"24 V"`."""
    return raw.removesuffix(INPUT_END).replace("V", " V")


def probed(design: Design) -> list[str]:
    """Nets of the test points on the flange's board."""
    board = next(board for board in design.auxiliary_boards if board.name == "flange")
    return [part.value for part in board.components if part.kind == "test point"]


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)

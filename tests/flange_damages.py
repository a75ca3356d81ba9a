"""Ways to hurt the flange's printed parts, and the checks that each fails."""

from collections.abc import Callable

from manifold3d import Manifold

from damages import Body, box

Damage = Callable[[Body], Body]
SPIGOT, RECESS, FACE = 35.3, 35.7, 37.5
SEAT, FLOOR, SPLIT, TOP = -2.9, -1.1, 9.8, 14.3
PIN = (30.5, 0.0)


def rod(x: float, y: float, low: float, high: float, radius: float) -> Body:
    body = Manifold.cylinder(high - low, radius, circular_segments=128)
    return body.translate((x, y, low))


def tube(low: float, high: float, inner: float, outer: float) -> Body:
    return rod(0, 0, low, high, outer) - rod(0, 0, low - 1, high + 1, inner)


def collars(body: Body, height: float) -> Body:
    """Rings under the board round its screws."""
    for y in (-19.5, 19.5):
        body = body + (rod(16.24, y, FLOOR - 0.1, height, 2.4) - rod(16.24, y, FLOOR - 1, 1, 1.3))
    return body


def spigot_narrow(body: Body) -> Body:
    return body - tube(SEAT - 1, 0.0, SPIGOT - 0.04, SPIGOT + 1.0)


def spigot_short(body: Body) -> Body:
    return body - tube(SEAT - 1, SEAT + 0.2, SPIGOT - 0.4, SPIGOT + 1.0)


def bolt_askew(body: Body) -> Body:
    plugged = body + rod(-27, 16, SEAT, SPLIT, 2.7)
    return plugged - rod(-27, 15.7, SEAT - 1, SPLIT + 1, 2.65)


def bolt_hole_wide(body: Body) -> Body:
    return body - rod(-27, 16, SEAT - 1, SPLIT + 1, 2.8)


def hole_near_another(body: Body) -> Body:
    return body - rod(-21.8, 16, SEAT - 1, SPLIT + 1, 2.0)


def pin_hole_askew(body: Body) -> Body:
    plugged = body + rod(*PIN, SEAT, 5.6, 2.1)
    return plugged - rod(PIN[0] - 0.3, PIN[1], SEAT - 1, 5.6, 2.05)


def pin_hole_wide(body: Body) -> Body:
    return body - rod(*PIN, SEAT - 1, 5.6, 2.15)


def pin_hole_shallow(body: Body) -> Body:
    return body + rod(*PIN, 4.6, 5.8, 2.1)


def socket_narrow(body: Body) -> Body:
    return body + (rod(*PIN, 7.4, SPLIT, 2.2) - rod(*PIN, 7.4, SPLIT + 1, 2.0))


def socket_askew(body: Body) -> Body:
    ring = rod(*PIN, 7.4, SPLIT, 2.5)
    return (body + ring) - rod(PIN[0] + 0.3, PIN[1], 7.4, SPLIT + 1, 2.1)


def peg_thick(body: Body) -> Body:
    return body + rod(-PIN[0], 0, SPLIT - 1, SPLIT + 1.2, 2.65)


def peg_askew(body: Body) -> Body:
    low = body - rod(-PIN[0], 0, SPLIT, SPLIT + 3, 3.0)
    return low + rod(-PIN[0] + 0.08, 0, SPLIT - 1, SPLIT + 1.2, 2.5)


def peg_missing(body: Body) -> Body:
    return body - rod(-PIN[0], 0, SPLIT, SPLIT + 3, 3.0)


def peg_high(body: Body) -> Body:
    return body + rod(-PIN[0], 0, SPLIT - 1, SPLIT + 1.9, 2.5)


def low_wall(body: Body) -> Body:
    peg = rod(-PIN[0], 0, SPLIT - 1, SPLIT + 3, 2.6)
    return body - (rod(0, 0, SPLIT - 0.25, SPLIT + 0.5, 40) - peg)


def pocket_narrow(body: Body) -> Body:
    return body + box((20.7, -15.0, FLOOR), (21.0, 15.0, 0.4))


def pocket_wide(body: Body) -> Body:
    return body - box((20.0, -10.0, FLOOR), (21.0, 10.0, SPLIT + 1))


def floor_high(body: Body) -> Body:
    return collars(body, FLOOR + 0.15)


def floor_higher(body: Body) -> Body:
    return collars(body, FLOOR + 0.55)


def relief_filled(body: Body) -> Body:
    return body + box((-6.0, 17.0, -2.5), (0.0, 22.0, FLOOR))


def relief_deep(body: Body) -> Body:
    return body - box((-6.0, 17.5, -2.3), (9.0, 23.5, FLOOR))


def window_blocked(body: Body) -> Body:
    return body + box((6.0, -3.5, SEAT), (8.0, 3.5, FLOOR))


def window_narrow(body: Body) -> Body:
    return body + box((5.0, 2.65, SEAT), (20.0, 3.5, FLOOR))


def way_out_blocked(body: Body) -> Body:
    return body + box((-5.0, 31.5, 0.0), (-2.0, 34.5, 4.0))


def shroud_obstructed(body: Body) -> Body:
    """A block beside the contacts of a header, where its shroud is."""
    return body + box((11.2, 27.5, 0.0), (14.2, 30.5, 4.0))


def screw_askew(body: Body) -> Body:
    plugged = body + rod(16.24, 19.5, SEAT + 0.95, FLOOR - 0.02, 1.5)
    return plugged - rod(16.54, 19.5, SEAT + 0.5, FLOOR + 1, 1.2)


def screw_hole_wide(body: Body) -> Body:
    return body - rod(16.24, 19.5, SEAT - 1, FLOOR + 1, 1.3)


def countersink_missing(body: Body) -> Body:
    return body + (
        rod(16.24, 19.5, SEAT + 0.02, SEAT + 0.85, 2.2) - rod(16.24, 19.5, SEAT - 1, 0, 1.15)
    )


def bolt_hole_bellied(body: Body) -> Body:
    """A belly inside a bolt's hole, where its head's ring presses."""
    for low, narrow, wide in ((1.0, 2.55, 3.75), (3.99, 3.75, 2.55)):
        body = body - Manifold.cylinder(3.0, narrow, wide, 128).translate((-27, 16, low))
    return body


def sawn(body: Body) -> Body:
    """A saw's cut round the board that leaves one side."""
    return body - box((-40.0, -40.0, 0.05), (24.0, 40.0, 0.45))


def wall_thin(body: Body) -> Body:
    """A slot that leaves 0.6 mm of the outside."""
    return body - box((-36.9, -4.0, 4.0), (-35.0, 4.0, SPLIT + 3))


def foot_missing(body: Body) -> Body:
    return body - tube(SEAT - 1, SEAT + 0.33, 19.7, 50.0)


def loose_piece(body: Body) -> Body:
    return body + box((10.0, 8.0, 3.0), (12.0, 10.0, 5.0))


def recess_narrow(body: Body) -> Body:
    return body + tube(SPLIT + 1.0, TOP, RECESS - 0.15, RECESS + 0.5)


def recess_shallow(body: Body) -> Body:
    return body + tube(SPLIT, SPLIT + 1.8, 34.5, RECESS + 0.5) + tube(SPLIT, SPLIT + 1.8, 5.0, 20.0)


def face_narrow(body: Body) -> Body:
    return body - tube(SPLIT - 1, TOP + 1, FACE - 0.1, FACE + 2)


def lid_high(body: Body) -> Body:
    return body + tube(TOP - 1, TOP + 0.2, RECESS, FACE)


def lid_bolt_askew(body: Body) -> Body:
    plugged = body + rod(27, 16, SPLIT, SPLIT + 1.6, 2.7)
    return plugged - rod(26.6, 16, SPLIT - 1, TOP, 2.65)


def lid_sags(body: Body) -> Body:
    """A nub under the lid that stands into the pocket, over a header."""
    return body + box((0.0, 18.0, SPLIT - 1.0), (2.0, 20.0, SPLIT + 0.5))


LOWERS: dict[Damage, set[str]] = {
    spigot_narrow: {"spigot", "min_wall"},
    spigot_short: {"seat", "overhang", "span"},
    bolt_askew: {"bolts", "bolt_clearance"},
    bolt_hole_wide: {"bolt_width"},
    hole_near_another: {"hole_wall", "min_wall"},
    pin_hole_askew: {"pin"},
    pin_hole_wide: {"pin_width"},
    pin_hole_shallow: {"pin_depth"},
    socket_narrow: {"socket_width"},
    socket_askew: {"socket"},
    peg_thick: {"peg_play"},
    peg_askew: {"peg"},
    peg_missing: {"peg", "peg_play", "peg_height"},
    peg_high: {"peg_height"},
    low_wall: {"added_height", "headroom"},
    pocket_narrow: {"board_gap"},
    pocket_wide: {"board_play"},
    floor_high: {"board_seat"},
    floor_higher: {"board_seat", "contact_press", "headroom", "interference"},
    relief_filled: {"tails"},
    relief_deep: {"tail_floor", "min_wall"},
    window_blocked: {"window", "window_gap", "interference"},
    window_narrow: {"window_gap"},
    way_out_blocked: {"cables"},
    shroud_obstructed: {"cables", "interference"},
    screw_askew: {"screws", "screw_clearance"},
    screw_hole_wide: {"screw_width"},
    countersink_missing: {"screw_heads", "head_clearance"},
    bolt_hole_bellied: {"bolt_bearing"},
    sawn: {"layers", "bolt_bearing", "overhang", "span", "min_wall"},
    wall_thin: {"min_wall", "hole_wall"},
    foot_missing: {
        "span",
        "bed_contact",
        "overhang",
        "seat",
        "screw_heads",
        "head_clearance",
        "min_wall",
    },
    loose_piece: {"bodies"},
}
UPPERS: dict[Damage, set[str]] = {
    recess_narrow: {"recess"},
    recess_shallow: {"recess_depth"},
    face_narrow: {"face"},
    lid_high: {"added_height", "recess_depth"},
    lid_bolt_askew: {"bolts", "bolt_clearance"},
    lid_sags: {"added_height", "interference"},
}

"""Small boards of plain parts, to route and to damage, and placed boards of presets."""

from pathlib import Path

from lumitip_fab.boards.model import Net, NetClass, PlacedComponent, Placement
from lumitip_fab.boards.placement import place
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Box, Footprint, Pad, Point, Side

CLASSES = (NetClass("signal", 0.2, 0.2, 0.6, 0.3), NetClass("supply", 0.5, 0.2, 0.6, 0.3))


BODY = Box(-1, 1, -0.5, 0.5)


def _footprint(*pads: Pad) -> Footprint:
    return Footprint("plain", pads, BODY, 1.0)


CHIP = _footprint(Pad("1", -0.8, 0, 0.8, 0.9), Pad("2", 0.8, 0, 0.8, 0.9))
PIN = _footprint(Pad("1", 0, 0, 1.6, 1.6, True, drill_mm=1.0))
FINE = _footprint(*(Pad(str(i), 0.65 * i, 0, 0.3, 1.4) for i in range(4)))


def part(
    ref: str,
    footprint: Footprint,
    at: Point,
    nets: dict[str, str],
    angle_deg: float = 0,
    side: Side = "front",
) -> PlacedComponent:
    """A part in its place."""
    kind = "wires" if footprint is PIN else "resistor"
    place = *at, angle_deg, side
    joined = tuple(nets.items())
    yard = BODY.grown(0.1)
    return PlacedComponent(ref, "", "", kind, footprint, *place, joined, courtyard=yard)


def board(
    *parts: PlacedComponent,
    supply: tuple[str, ...] = ("GND",),
    width_mm: float = 20,
    keep_outs: tuple[Box, ...] = (),
) -> Placement:
    """A board of 10 mm by the width with a hole in its middle."""
    nets = sorted({net for p in parts for _, net in p.nets})
    return Placement(
        name="receiver",
        title="small",
        revision="A",
        date="",
        design_hash="",
        outline=Box(-width_mm / 2, width_mm / 2, -5, 5),
        corner_mm=0.5,
        holes=((0.0, 0.0),),
        hole_mm=2.0,
        keep_outs=keep_outs,
        edge_clearance_mm=0.3,
        hole_clearance_mm=0.3,
        components=parts,
        nets=tuple(Net(n, "supply" if n in supply else "signal") for n in nets),
        classes=CLASSES,
        ground="GND",
        silk=(),
        texts=(),
    )


def crossing() -> Placement:
    """Two nets that cross, a bus of fine leads round the hole, supply and ground, both sides."""
    return board(
        part("R1", CHIP, (-6, 3.03), {"1": "A", "2": "GND"}),
        part("R2", CHIP, (6.017, 3), {"1": "B", "2": "3V3"}, 90),
        part("R3", CHIP, (-6, -3), {"1": "B", "2": "GND"}),
        part("R4", CHIP, (6, -3.04), {"1": "A", "2": "3V3"}, 90, "back"),
        part("U1", FINE, (-3.01, 0), {"0": "S0", "1": "S1", "2": "3V3", "3": "GND"}, 90),
        part("U2", FINE, (3, -1), {"0": "S0", "1": "S1", "2": "3V3", "3": "GND"}, 90),
        part("J1", PIN, (-8.8, 0), {"1": "GND"}),
        part("J2", PIN, (8.8, 0), {"1": "3V3"}),
        supply=("GND", "3V3"),
    )


def narrows(nets: str = "ABCDE") -> Placement:
    """Nets past the hole, where beside it each side has room for one track a layer."""
    rows = {n: y for n, y in zip("ABCDE", (4.0, 2.0, 0.0, -2.0, -4.0), strict=True) if n in nets}
    left = [part(f"R{n}", CHIP, (-2.6, y), {"2": n}) for n, y in rows.items()]
    right = [part(f"Q{n}", CHIP, (2.6, y), {"1": n}) for n, y in rows.items()]
    wall = [
        part(f"W{i}", PIN, (0, y), {"1": f"W{i}"}) for i, y in enumerate((-4.1, -2.7, 2.7, 4.1))
    ]
    return board(*left, *right, *wall, width_mm=9)


def preset(design_dir: Path, name: str, finger: str) -> Placement:
    """A placed board of a preset."""
    design = derive(load(design_dir / "presets" / f"{name}.toml"))
    which = next(f for f in design.fingers if f.name == finger)
    return place(design, which)

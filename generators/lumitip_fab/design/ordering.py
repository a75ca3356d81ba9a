"""PCB fabs, parts to buy, and prices."""

from dataclasses import dataclass

from lumitip_fab.design.shape import Box, Point

Pairs = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Fab:
    """A PCB fab."""

    name: str
    layers: Pairs
    """End of the file name of each layer: `(("front copper", ".GTL"), …)`."""
    bom: Pairs
    """Heading and field of each column of the bill of materials."""
    positions: Pairs
    """Heading and field of each column of the placement list."""
    sides: tuple[str, str]
    """Its names of front and back."""
    back_from_behind: bool
    """Whether angles of parts on the back count counter-clockwise as seen from there; else as
    in KiCad."""
    rotations: tuple[tuple[str, float], ...]
    """Offset of the angle (degrees) of footprints, by the beginning of their name."""
    rotations_assumed: tuple[str, ...]
    """Beginnings whose offset is assumed."""
    part_rotations: tuple[tuple[str, float], ...]
    """Offset of the angle (degrees) of single parts, by their order number."""
    anode_first: tuple[str, ...]
    """Order numbers of LEDs whose pad 1, the marked one, is the anode: houses count an LED's angle
    from the cathode."""
    remark: str
    """Remark on ordering there; may be empty."""
    least_mm: Point | None = None
    """Smallest board that it assembles; none of one that takes every board."""


@dataclass(frozen=True)
class Bought:
    """Something that is bought, and a line of the bill."""

    group: str
    """Such as `"fasteners"`."""
    item: str
    manufacturer: str
    part: str
    """Order number."""
    where: str
    """Its use."""
    quantity: float
    each: float | None
    """Price of a unit; none where it is not known."""
    unit: str = "piece"
    pack: str = ""
    """Name of the pack that it comes in; empty where it is bought singly."""

    @property
    def price(self) -> float | None:
        """Price of the whole quantity."""
        return None if self.each is None else round(self.quantity * self.each, 2)


@dataclass(frozen=True)
class Pack:
    """What one buys of something that is sold in packs."""

    name: str
    title: str
    manufacturer: str
    """Empty where any will do."""
    product: str
    pack: str
    """Such as `"roll of 33 m x 12 mm"`."""
    holds: float
    unit: str
    """Of `holds`: `"g"`, `"m"`, `"mL"`, `"piece"` or `"sheet"`."""
    price: float | None
    """Price of a pack; none where it is not known."""
    confidence: str
    """Confidence in product and size of the pack."""
    colours: tuple[str, ...] = ()
    """Colours of a set of wires, by the codes of IEC 60757."""

    @property
    def each(self) -> float | None:
        """Price of a unit; none where it is not known."""
        return None if self.price is None else self.price / self.holds


@dataclass(frozen=True)
class PartPrice:
    """Price of a part that is soldered to a board."""

    part: str
    """Order number; for resistors, `{code}` stands for the value."""
    each: float

    def of(self, part: str) -> bool:
        """Whether it is the price of this part."""
        start, code, end = self.part.partition("{code}")
        return part.startswith(start) and part.endswith(end) if code else part == self.part


@dataclass(frozen=True)
class Purchase:
    """Everything that the bill of materials needs beyond the built files."""

    currency: str
    dated: str
    """Year and month of the prices."""
    source: str
    confidence: str
    pieces: tuple[Bought, ...]
    parts: tuple[PartPrice, ...]
    board_each: float
    """A bare board, whatever its size."""
    board_per_cm2: float
    placing_each: float
    """Placing and soldering a part on a board."""
    silicone: str
    """Name of the silicone's pack."""
    film: str
    """Name of the film's pack."""
    packs: tuple[Pack, ...]
    """Every pack that may be needed."""

    def part_each(self, part: str) -> float | None:
        """Price of a part by its order number; none if it is not known."""
        return next((price.each for price in self.parts if price.of(part)), None)

    def pack(self, name: str) -> Pack | None:
        """A pack by its name; none where none is known."""
        return next((pack for pack in self.packs if pack.name == name), None)

    def unit_price(self, name: str) -> float | None:
        """Price of a unit out of a pack; none where it is not known."""
        pack = self.pack(name)
        return pack.each if pack else None

    def bare_board_each(self, box: Box) -> float:
        """Price of a bare board of this size, to the cent."""
        cm2 = box.width_mm * box.length_mm / 100
        return round(self.board_each + cm2 * self.board_per_cm2, 2)

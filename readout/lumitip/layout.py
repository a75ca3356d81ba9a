"""`Layout`: positions, wiring and optics of the cells; the contents of `layout.json`.

It is all that the robot side needs of a design. `lumitip-fab` writes it.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumitip.errors import LayoutError
from lumitip.grid import Floats, Integers

SCHEMA_VERSION = 1
_DECIMALS = 6  # of a mm: below any tolerance, above rounding errors


@dataclass(frozen=True)
class Cell:
    """One cell; see `Layout` for units and frames."""

    index: int
    x_mm: float
    y_mm: float
    column: int
    row: int
    mux: int
    channel: int
    adc_pin: str


@dataclass(frozen=True)
class Optics:
    """The optical path between an LED and its photodetector."""

    hole_mm: float
    """Mask aperture: across flats of a hexagon, diameter of a circle (mm); the mean of all cells,
    see `Layout.hole_share`."""
    hole_shape: str
    """`"hexagon"` (flats face the tip) or `"circle"`."""
    emitter_depth_mm: float
    """Depth of the LED die below the inner face of the film (mm)."""
    detector_depth_mm: float
    """Depth of the photodetector die below the inner face of the film (mm)."""
    emitter_exponent: float
    """Exponent m of the LED's radiant intensity, cos(angle) ** m."""
    detector_exponent: float
    """Exponent n of the photodetector's sensitivity, cos(angle) ** n."""
    silicone_index: float
    """Refractive index of the silicone."""
    film_mm: float
    """Thickness of the mask film (mm)."""
    pull_up_ohm: float
    """Pull-up resistor of each analog line (ohm)."""
    supply_v: float
    """Supply of the detectors and reference of the ADC (V)."""


@dataclass(frozen=True, eq=False)
class Layout:
    """Cells of a fingertip in frame order, in the receiver's sensor frame.

    Sensor frame (mm): looking at the gripping face with the tip up, x to the right from the mean
    of the cell centres, y towards the tip from the centre line of the columns, z out of the face
    from the outer face of the film. Layouts with the same `design_hash` are equal. Arrays are
    read-only.
    """

    x_mm: Floats
    """Cell centres, shape `(cells,)` (mm)."""
    y_mm: Floats
    """Cell centres, shape `(cells,)` (mm)."""
    column: Integers
    """Column of each cell, 0 leftmost, shape `(cells,)`."""
    row: Integers
    """Row of each cell, 0 nearest the tip, shape `(cells,)`."""
    neighbours: Integers
    """Pairs of neighbouring cells, shape `(pairs, 2)`, smaller index first."""
    mux: Integers
    """Multiplexer of each detector, 0 is U1, shape `(cells,)`."""
    channel: Integers
    """Input of that multiplexer, shape `(cells,)`."""
    adc_pin: NDArray[np.str_]
    """Controller pin that reads that multiplexer, shape `(cells,)`."""
    pitch_mm: float
    """Distance between neighbouring cells (mm)."""
    optics: Optics
    schema_version: int = SCHEMA_VERSION
    hole_share: Floats = field(default_factory=lambda: np.ones(0))
    """Aperture of each cell relative to `optics.hole_mm`, shape `(cells,)`; 1 by default."""

    def __post_init__(self) -> None:
        if not np.size(self.hole_share):
            object.__setattr__(self, "hole_share", np.ones(len(self)))
        for name in (*_ARRAYS, "hole_share"):
            array = np.array(getattr(self, name))
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self.__post_init__()  # a copy or a pickled array can be written to

    def __len__(self) -> int:
        return int(self.x_mm.size)

    @property
    def hole_mm(self) -> Floats:
        """Aperture of each cell in both masks, shape `(cells,)` (mm)."""
        return np.asarray(self.hole_share * self.optics.hole_mm)

    def __repr__(self) -> str:
        of = f"{len(self)} cells, pitch {self.pitch_mm:g} mm, design {self.design_hash[:16]}"
        return f"<Layout of {of}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Layout) and self.design_hash == other.design_hash

    def __hash__(self) -> int:
        return hash(self.design_hash)

    @property
    def cells(self) -> tuple[Cell, ...]:
        """The cells as records, in frame order."""
        columns = [getattr(self, name).tolist() for name in _PER_CELL]
        return tuple(Cell(i, *values) for i, values in enumerate(zip(*columns, strict=True)))

    @property
    def design_hash(self) -> str:
        """SHA-256 (hex) of cells, wiring and frame order only."""
        record = {name: _plain(getattr(self, name)) for name in _PER_CELL}
        text = json.dumps(record, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()

    def to_json(self) -> str:
        """The text of `layout.json`: equal layouts give equal bytes."""
        record = {name: _plain(getattr(self, name)) for name in _ARRAYS}
        record |= {
            "schema_version": self.schema_version,
            "design_hash": self.design_hash,
            "pitch_mm": round(self.pitch_mm, _DECIMALS),
            "optics": {
                k: v if isinstance(v, str) else _plain(float(v))
                for k, v in asdict(self.optics).items()
            },
        }
        if (self.hole_share != 1.0).any():
            record["hole_mm"] = _plain(self.hole_mm)
        lines = (
            f"{json.dumps(k)}: {json.dumps(v, sort_keys=True)}" for k, v in sorted(record.items())
        )
        return "{\n " + ",\n ".join(lines) + "\n}\n"

    @classmethod
    def load(cls, path: str | Path) -> "Layout":
        """Read a `layout.json`.

        Raises:
            LayoutError: if it is not a layout of this version.
        """
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, ValueError, TypeError) as error:
            raise LayoutError(f"{path!s:.200}: cannot be read as a layout: {error}") from error
        return cls.from_json(text, source=str(path))

    @classmethod
    def from_json(cls, text: str, source: str = "layout") -> "Layout":
        """Read the text of a `layout.json`, ignoring unknown keys.

        Args:
            text: the JSON text.
            source: its file name, for messages.

        Raises:
            LayoutError: if it is not a layout of this version.
        """
        try:
            record = json.loads(text)
        except (ValueError, TypeError, RecursionError) as error:
            raise LayoutError(f"{source} is not JSON: {error}") from error
        try:
            return _read(record)
        except LayoutError as error:
            raise LayoutError(f"{source}: {error}") from error


_PER_CELL = tuple(f.name for f in fields(Cell))[1:]
_ARRAYS = ("x_mm", "y_mm", "column", "row", "neighbours", "mux", "channel", "adc_pin")
_INTEGERS = ("column", "row", "mux", "channel")


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        # Adding 0.0 turns -0.0 into 0.0, which would change the text and the hash.
        return (np.round(value, _DECIMALS) + 0.0 if value.dtype.kind == "f" else value).tolist()
    return round(value, _DECIMALS) if isinstance(value, float) else value


def _read(record: Any) -> Layout:
    if not isinstance(record, Mapping):
        raise LayoutError(f"the file is a {type(record).__name__}; a JSON object is needed")
    version = record.get("schema_version")
    if version != SCHEMA_VERSION or isinstance(version, bool):
        raise LayoutError(
            f"schema_version is {version!r}; this lumitip reads {SCHEMA_VERSION}. Install the "
            "lumitip that wrote the file, or build the design again"
        )
    x_mm = _numbers(record, "x_mm")
    cells = x_mm.size
    arrays: dict[str, Any] = {"x_mm": x_mm, "y_mm": _numbers(record, "y_mm", cells)}
    arrays |= {name: _whole(record, name, (cells,)) for name in _INTEGERS}
    arrays["neighbours"] = _whole(record, "neighbours", (None, 2), below=cells)
    pairs = arrays["neighbours"].tolist()
    if any(a >= b for a, b in pairs) or len({(a, b) for a, b in pairs}) != len(pairs):
        raise LayoutError("neighbours: each pair must occur once, with the smaller index first")
    pins = record.get("adc_pin")
    if not isinstance(pins, list) or len(pins) != cells or not all(type(p) is str for p in pins):
        raise LayoutError(f"adc_pin: a list of {cells} pin names is needed")
    optics = _optics(record)
    layout = Layout(
        **arrays,
        adc_pin=np.array(pins),
        pitch_mm=_number(record, "pitch_mm"),
        optics=optics,
        hole_share=_hole_share(record, optics, cells),
    )
    if layout.design_hash != record.get("design_hash"):
        raise LayoutError(
            f"design_hash is {str(record.get('design_hash'))[:16]!r}; the cells and wiring have "
            f"{layout.design_hash[:16]!r}. The file was changed by hand: build the design again"
        )
    return layout


def _number(record: Mapping[str, Any], name: str, within: str = "") -> float:
    value: Any = record.get(name)
    if type(value) not in (int, float) or not 0 <= value < 1e12:
        raise LayoutError(f"{within}{name} is {value!r:.80}; a number from 0 to 1e12 is needed")
    return float(value)


def _numbers(record: Mapping[str, Any], name: str, count: int | None = None) -> Floats:
    values = record.get(name)
    needed = "numbers" if count is None else f"{count} numbers"
    if (
        not isinstance(values, list)
        or not values
        or (count is not None and len(values) != count)
        or not all(type(v) in (int, float) and abs(v) < 1e6 for v in values)
    ):
        raise LayoutError(f"{name}: a list of {needed} below 1e6 is needed")
    return np.array(values, dtype=np.float64)


def _whole(
    record: Mapping[str, Any], name: str, shape: tuple[int | None, ...], below: int = 2**31
) -> Integers:
    values = record.get(name)
    rows = values if isinstance(values, list) else []
    flat = [v for row in rows for v in (row if isinstance(row, list) else [row])]
    fits = (
        isinstance(values, list)
        and (shape[0] is None or len(rows) == shape[0])
        and all(type(v) is int and 0 <= v < below for v in flat)
        and all(
            isinstance(r, list) and len(r) == 2 if len(shape) == 2 else type(r) is int for r in rows
        )
    )
    if not fits:
        what = "pairs of cell indices" if len(shape) == 2 else f"{shape[0]} whole numbers"
        raise LayoutError(f"{name}: a list of {what} from 0 to {below - 1} is needed")
    return np.array(values, dtype=np.int64).reshape([-1 if n is None else n for n in shape])


def _hole_share(record: Mapping[str, Any], optics: Optics, cells: int) -> Floats:
    if "hole_mm" not in record:
        return np.ones(cells)
    sizes = _numbers(record, "hole_mm", cells)
    if sizes.min() <= 0.0 or optics.hole_mm <= 0.0:
        raise LayoutError("hole_mm: sizes above 0 are needed, in optics too")
    return np.asarray(sizes / optics.hole_mm)


def _optics(record: Mapping[str, Any]) -> Optics:
    optics = record.get("optics")
    if not isinstance(optics, Mapping):
        raise LayoutError("optics: an object is needed")
    if optics.get("hole_shape") not in ("hexagon", "circle"):
        raise LayoutError(
            f"optics.hole_shape is {optics.get('hole_shape')!r:.80}; "
            'allowed are "hexagon" and "circle"'
        )
    read = {f.name: _number(optics, f.name, "optics.") for f in fields(Optics) if f.type is float}
    return Optics(hole_shape=str(optics["hole_shape"]), **read)

"""The catalogue and the presets as plain tables, read without the code that derives designs."""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

DESIGN = Path(__file__).parents[2] / "design"
BASE, DEFAULT = "published", "fingertip"
Table = dict[str, Any]


@cache
def entries(kind: str) -> Table:
    """The entries of `design/parts/<kind>.toml` by name."""
    return tomllib.loads((DESIGN / "parts" / f"{kind}.toml").read_text(encoding="utf-8"))


def preset_file(name: str) -> str:
    """The file of a preset in the folder of designs; the default's is beside the others."""
    return f"{name}.toml" if name == DEFAULT else f"presets/{name}.toml"


@cache
def preset(name: str) -> Table:
    """A preset with all that it extends, its fields by name: `{"grid.pitch_mm": 6.0, …}`."""
    table = tomllib.loads((DESIGN / preset_file(name)).read_text(encoding="utf-8"))
    base = table.pop("extends", None)
    values = dict(preset(Path(base).stem)) if base else {}
    for key, value in table.items():
        if isinstance(value, dict):
            values |= {f"{key}.{field}": v for field, v in value.items()}
        else:
            values[key] = value
    return values


def presets() -> list[str]:
    """Names of all presets, sorted."""
    return sorted(file.stem for file in (DESIGN / "presets").glob("*.toml"))


def over_pads_mm(part: Table) -> tuple[float, float]:
    """Length and width of a chip with its pads."""
    along = max(part["pad_pitch_mm"] + part["pad_mm"][0], part["body_mm"][0])
    return along, max(part["pad_mm"][1], part["body_mm"][1])


def bends(filament: str) -> bool:
    """Whether parts of a filament give way."""
    return bool(entries("filaments")[filament].get("rigid_parts"))


def bypasses() -> list[str]:
    """Capacitors that every multiplexer takes beside its supply."""
    asked = [mux["bypass_nf"] for mux in entries("multiplexers").values()]
    least, most = max(low for low, _ in asked), min(high for _, high in asked)
    return [
        name
        for name, part in entries("capacitors").items()
        if least <= part["capacitance_nf"] * part.get("left", 1) and part["capacitance_nf"] <= most
    ]

"""Protection of wires and pins: figures of its parts."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Protection:
    """Parts between the wires that leave the controller's board and its pins."""

    board: str
    """Auxiliary board that has them."""
    diode: str
    """In the catalogue."""
    breakdown_v: float
    """Greatest breakdown voltage of the diode."""
    dynamic_ohm: float
    diode_pf: float
    """Greatest capacitance of the diode."""
    series_ohm: float
    resistor_tolerance: float
    capacitor_pf: float
    """Capacitor at an analog pin; 0 without one."""
    pin_pf: float
    """Capacitance of an analog input with the wire to it."""
    lines: tuple[str, ...]
    """Signals with a resistor before their pin, which is on a net of its own."""
    clamped: tuple[str, ...]
    """Nets with a diode at each of their wires."""
    discharge_kv: float
    """Contact discharge by IEC 61000-4-2."""
    nh_per_mm: float
    """Inductance of the way over a diode, by its distance from the wire's pad."""
    reach_mm: float
    """From a wire's pad to its diode, at most."""
    pin_mm: float
    """From resistor and capacitor to the pin, at most."""
    hbm_v: float | None
    """Discharge of the human-body model that a pin bears; none where it is not known."""
    most_pin_a: float | None
    """Largest pulse into a pin; none where it is not known."""
    pin_a: float
    """Pulse into a pin, an upper bound."""

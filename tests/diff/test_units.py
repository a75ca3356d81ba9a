"""Units of parameters and of figures of the catalogue that differ."""

from types import SimpleNamespace

import pytest

from lumitip_fab.diff.values import parameter_differences

UNITS = {
    "parts.printers.fdm 0.4.speed_mm_s": "mm/s",
    "parts.printers.fdm 0.4.max_flow_mm3_s": "mm³/s",
    "parts.current_sources.LT3092.thermal_k_per_w": "K/W",
    "parts.current_sources.LT3092.line_per_v": "1/V",
    "parts.silicones.soft.coverage_cm2_ml": "cm²/mL",
    "parts.filaments.pla.density_g_ml": "g/mL",
    "parts.filaments.pla.soften_c": "°C",
    "emitter.current_ma": "mA",
    "stack.silicone_mm": "mm",
    "coupling.gripper": "",
}


@pytest.mark.parametrize("name", UNITS)
def test_the_longest_end_of_a_name_is_its_unit(name: str) -> None:
    folders = [SimpleNamespace(parameters={name: value}, parts={}) for value in (1.0, 2.0)]
    (entry,) = parameter_differences(*folders)  # type: ignore[arg-type]
    assert entry == {"name": name, "unit": UNITS[name], "a": 1.0, "b": 2.0}

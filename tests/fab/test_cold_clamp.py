"""The TVS diode at the input, whose breakdown voltage is lower when it is cold."""

import dataclasses

import pytest

from lumitip_fab.config.load import Input
from lumitip_fab.derive import derive
from lumitip_fab.docs.spec import outside
from lumitip_fab.errors import InputError

TVS = "SMBJ24A"


def with_breakdown(config: Input, least_v: float) -> Input:
    """A file whose TVS diode breaks down from another voltage on, at 25 °C."""
    diodes = dict(config.catalogue.tvs_diodes)
    most_v = diodes[TVS].breakdown_v[1]
    diodes[TVS] = diodes[TVS].model_copy(update={"breakdown_v": (least_v, most_v)})
    catalogue = config.catalogue.model_copy(update={"tvs_diodes": diodes})
    return dataclasses.replace(config, catalogue=catalogue)


def test_a_diode_that_conducts_when_it_is_cold_is_refused(inputs: dict[str, Input]) -> None:
    config = inputs["published"]
    at_0_c = r"breakdown voltage from 25\.06 V on at 0 °C; the supply is 24 V, at most 25\.2 V"
    with pytest.raises(InputError, match=at_0_c):
        derive(with_breakdown(config, 25.7))  # above 25.2 V at 25 °C
    (plug_in,) = derive(with_breakdown(config, 25.9)).electrical.plug_ins
    assert plug_in.conducts_v == pytest.approx(0.975 * 25.9)


def test_a_breakout_has_no_diode_that_conducts_when_it_is_cold(inputs: dict[str, Input]) -> None:
    config = inputs["franka_hand"]
    assert derive(config).entered
    assert not derive(with_breakdown(config, 25.7)).entered


def test_the_spec_says_from_where_on_it_conducts(inputs: dict[str, Input]) -> None:
    rows = {row.quantity: row for row in outside(derive(inputs["published"]))}
    row = rows["TVS diode of the flange may conduct"]
    assert row.computed == "from 26.0 V on at 0 °C"
    assert "8 % over 24 V: keep the supply within +5 %" in row.reason


def test_the_spec_rounds_that_voltage_down(inputs: dict[str, Input]) -> None:
    made = derive(with_breakdown(inputs["published"], 26.65))  # 25.98 V at 0 °C
    (row,) = (row for row in outside(made) if row.quantity.startswith("TVS diode"))
    assert row.computed == "from 25.9 V on at 0 °C"


def test_an_esd_diode_that_conducts_when_it_is_cold_is_refused(inputs: dict[str, Input]) -> None:
    config = inputs["dense"]
    diodes = dict(config.catalogue.esd_diodes)
    name = next(iter(diodes))
    change = {"standoff_v": 3.4, "breakdown_v": (3.5, diodes[name].breakdown_v[1])}
    diodes[name] = diodes[name].model_copy(update=change)
    catalogue = config.catalogue.model_copy(update={"esd_diodes": diodes})
    named = r"breakdown voltage from 3\.413 V on at 0 °C; signals .* have 3\.3 V, at most 3\.465 V"
    with pytest.raises(InputError, match=named):
        derive(dataclasses.replace(config, catalogue=catalogue))

"""The table of figures states the bits that the firmware sends, not those of the ADC."""

import re
from pathlib import Path

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.docs.spec import rows
from lumitip_fab.paths import firmware_sources


def test_the_resolution_is_that_of_the_packets(design_dir: Path) -> None:
    design = derive(load(design_dir / "fingertip.toml"))
    (settings,) = (
        f.read_text(encoding="utf-8") for f in firmware_sources() if f.name == "settings.h"
    )
    bits = re.search(r"^#define LUMITIP_BITS (\d+)$", settings, re.MULTILINE)
    assert bits
    (resolution,) = (row for row in rows(design) if row.quantity == "resolution")
    assert resolution.computed == resolution.published == f"{bits[1]} bits"
    assert f"all {design.controller.adc_bits} of the ADC" in resolution.reason

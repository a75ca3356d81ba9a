"""The test with a multimeter of parts whose marked terminal is not known."""

from lumitip_fab.design import Led, Packages, Photodetector
from lumitip_fab.text import as_written

_PROBE_V = 0.15  # less than at the working current: a diode test drives about 1 mA


def polarity_test(packages: Packages) -> str:
    """A section of the manual; empty where the polarity of both kinds of part is known."""
    tests = [
        test
        for part, test in (
            (packages.led, _led(packages.led, packages.led_name)),
            (
                packages.photodetector,
                _detector(packages.photodetector, packages.photodetector_name),
            ),
        )
        if not part.mark_is_known
    ]
    if not tests:
        return ""
    return f"""### Before you order: which end is marked?

A board with the wrong polarity does not work. Test one part of each kind with a multimeter. It
takes two minutes.

{"".join(tests)}If a mark is as the design takes it, write `marked_confidence = "measured"` into the
part's entry in `parts/`. If it is not, correct `marked` there as well. Build again: boards and
notes follow, and the file `STOP_READ_FIRST.txt` is no longer in the zips.

### Order

"""


def _led(led: Led, name: str) -> str:
    probed_v = led.forward_voltage_v - _PROBE_V
    return f"""**LED {as_written(name)}.** Select the diode test. Touch one end with each probe,
then exchange the probes. One way round the meter shows about {probed_v:.1f} V, the other way
nothing. When it shows the voltage, the red probe is at the anode and the black one at the cathode.
The design takes the marked end for the **{led.marked}** ({led.mark_confidence}).

"""


def _detector(detector: Photodetector, name: str) -> str:
    return f"""**Photodetector {as_written(name)}.** Select resistance, a range of 200 kΩ or more.
Hold the part into sunlight or the light of a halogen lamp: a white LED gives no infrared light. One
way round the resistance is some kΩ in the light and rises when you shade the part. Then the
positive probe is at the collector; on most meters it is the red one. The design takes the marked
end for the **{detector.marked}** ({detector.mark_confidence}).

"""

"""How the noise of calibrated values depends on the light."""

from lumitip.grid import Floats
from lumitip.twin.optics import Model
from lumitip.twin.twin import Twin


def dimness(twin: Twin) -> Floats:
    """How much larger the noise of calibrated values is than with the default gain of `Model`,
    shape `(cells,)`: dim cells are multiplied by more in the calibration."""
    usual = Twin(twin.layout, twin.model.changed(gain=Model.gain))
    return usual.empty / twin.empty

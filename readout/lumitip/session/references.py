"""`References`: the calibration in use, measured and saved."""

import logging

import numpy as np

from lumitip import arguments
from lumitip.calibration import Calibration, Kind, checked_kind, named
from lumitip.errors import CalibrationError
from lumitip.frame import complement
from lumitip.links.base import Calibrated
from lumitip.session.hub import Hub

_log = logging.getLogger(__name__)
_FRAME_S = 10.0  # longest wait for a frame
_SHADED = 0.9  # of what the lighter cells keep since the last tare
_LIGHTER = 0.8  # quantile of those: warm LEDs dim all cells alike, an object does not shade most


class References:
    """The calibration of the frames of a hub.

    Args:
        hub: connected.
        calibrated: begin with the saved calibration, or with that of the recording.

    Raises:
        CalibrationError: if the saved calibration cannot be read.
    """

    def __init__(self, hub: Hub, calibrated: bool) -> None:
        self._hub = hub
        self._calibration = Calibration(hub.link.device_id, hub.link.layout.design_hash)
        if calibrated:
            self.calibration = self._saved()

    @property
    def calibration(self) -> Calibration:
        """The calibration in use; a new one applies to the next frames.

        Raises:
            CalibrationError: on setting one with a cell that is not lighter with an empty grasp
                than in the dark, or, a `CalibrationMismatch`, of another device or design.
        """
        return self._calibration

    @calibration.setter
    def calibration(self, calibration: Calibration) -> None:
        arguments.instance(calibration, Calibration, "calibration", CalibrationError)
        layout = self._hub.link.layout
        calibration.check(self._hub.link.device_id, layout.design_hash, len(layout))
        correction = calibration.correction()  # may refuse it, and the one in use stays
        self._calibration = calibration
        self._hub.intake.correction = correction

    def measure(self, kind: Kind, num_samples: int, keep: bool) -> Calibration:
        """See `Fingertip.tare`."""
        kind, number = checked_kind(kind), arguments.count(num_samples, "num_samples")
        if keep:
            self._needs_device()
        queue = self._hub.queue(number)
        try:
            frames = [self._hub.next(queue, _FRAME_S) for _ in range(number)]
        finally:
            self._hub.remove(queue)
        light = np.stack([complement(f.raw, f.bits) for f in frames])
        calibration = self._calibration.measured(kind, light)
        if kind == "empty" and (doubt := _doubt(self._calibration, calibration)):
            _log.warning("%s: %s", self._hub.link.device_id, doubt)
        if keep:
            calibration.save()
        self.calibration = calibration
        return calibration

    def forget(self) -> None:
        """See `Fingertip.forget`."""
        self._needs_device()
        self._calibration.forget()

    def _needs_device(self) -> None:
        if isinstance(self._hub.link, Calibrated):
            raise CalibrationError(
                f"this is a recording of {self._hub.link.device_id}; calibrations are saved only "
                "for devices. Open the device"
            )

    def _saved(self) -> Calibration:
        link = self._hub.link
        if isinstance(link, Calibrated):
            return link.calibration or self._calibration
        return Calibration.kept(link.device_id, link.layout.design_hash, len(link.layout))


def _doubt(before: Calibration, now: Calibration) -> str:
    """A sentence if some cells lost more light since the last tare than the others: a thin thing,
    or one that lets light through, may be in the grasp. Empty if none did."""
    if before.empty is None or now.empty is None:
        return ""
    dark = now.dark if now.dark is not None else 0.0
    kept = np.asarray((now.empty - dark) / (before.empty - dark))
    kept /= np.quantile(kept, _LIGHTER)
    shaded = np.flatnonzero(kept < _SHADED)
    if not shaded.size:
        return ""
    most = 100.0 * (1.0 - float(kept.min()))
    return (
        f"{named(shaded, kept.size)}: up to {most:.0f} % darker than at the last tare, beside "
        "the others. Is something between the fingers? Take it out and tare again. If nothing is, "
        "a part has aged or is dirty: `lumitip doctor` tests each cell"
    )

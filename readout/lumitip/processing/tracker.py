"""`Tracker`: contacts of one fingertip over time, without flicker between shapes."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from lumitip import arguments
from lumitip.errors import ArgumentError
from lumitip.layout import Layout
from lumitip.processing.batch import usable_cells
from lumitip.processing.contact import Contact
from lumitip.processing.processor import COVERED_BELOW, MIN_CONTRAST, Processor


class Tracker:
    """Adds hysteresis to `Processor`: one tracker follows one fingertip, from one thread.

    A contact begins at `min_contrast` and ends below `release_contrast`, without delay. Its shape
    changes after `hold` frames in a row with another shape; until then the shape before is
    reported, as long as its fit applies to the frame.
    """

    def __init__(
        self,
        layout: Layout,
        min_contrast: float = MIN_CONTRAST,
        release_contrast: float = 0.75 * MIN_CONTRAST,
        hold: int = 3,
        covered_below: float = COVERED_BELOW,
    ) -> None:
        """Prepare for the grid of a layout.

        Args:
            layout: cells and neighbours.
            min_contrast: contrast at which a contact begins (counts of 255).
            release_contrast: contrast below which it ends, not above `min_contrast`.
            hold: frames in a row before the shape changes, at least 1.
            covered_below: as for `Processor`.

        Raises:
            LayoutError: if `layout` is no layout.
            ArgumentError: if another parameter is out of its range.
        """
        release_contrast = arguments.number(release_contrast, "release_contrast", 0.0)
        self._min_contrast = arguments.number(min_contrast, "min_contrast", 0.0)
        self._processor = Processor(layout, release_contrast, covered_below)
        self._hold = arguments.count(hold, "hold")
        if release_contrast > self._min_contrast:
            raise ArgumentError(
                f"release_contrast is {release_contrast}; it must not be above min_contrast, "
                f"which is {min_contrast}"
            )
        self.reset()

    def __repr__(self) -> str:
        return f"<Tracker, hold {self._hold}, {self._processor!r}>"

    def reset(self) -> None:
        """Forget the frames so far."""
        self._last: Contact | None = None
        self._other = ""
        self._times = 0

    def __call__(self, values: ArrayLike) -> Contact:
        """Process the next frame; see `Processor`."""
        contact = self._processor(values)
        before = self._last
        touched = before is not None and before.contrast is not None
        if contact.contrast is not None and contact.contrast < self._min_contrast and not touched:
            frame = np.asarray(values, dtype=np.float64)
            contact = self._processor.without_contrast(frame[usable_cells(frame)])
        if before is not None and touched and contact.contrast is not None:
            contact = self._held(contact, before.shape)
        else:
            self._times = 0
        self._last = contact
        return contact

    def _held(self, contact: Contact, shape: str) -> Contact:
        if contact.shape == shape or not _applies(shape, contact):
            self._times = 0
            return contact
        self._times = self._times + 1 if contact.shape == self._other else 1
        self._other = contact.shape
        if self._times >= self._hold:
            self._times = 0
            return contact
        return replace(contact, shape=shape)


def _applies(shape: str, contact: Contact) -> bool:
    fit = {"edge": contact.line, "corner": contact.corner, "cable": contact.cable}[shape]
    return fit is not None

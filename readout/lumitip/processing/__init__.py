"""From the values of a frame to the object between the fingers. Needs numpy alone.

contact = Processor(layout)(frame.values)
contact.shape, contact.centre_mm, contact.line, contact.corner, contact.cable
"""

from lumitip.processing.batch import Batch
from lumitip.processing.contact import SHAPES, Cable, Contact, Corner, Line
from lumitip.processing.processor import Processor, ValuesError
from lumitip.processing.tracker import Tracker

__all__ = [
    "SHAPES",
    "Batch",
    "Cable",
    "Contact",
    "Corner",
    "Line",
    "Processor",
    "Tracker",
    "ValuesError",
]

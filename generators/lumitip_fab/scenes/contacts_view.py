"""The coupling's contacts as the gripper's side sees them: number, signal and place of each."""

import math
from collections.abc import Iterator

import numpy as np

from lumitip_fab.design import Flange, Point, ToolContact
from lumitip_fab.scenes.drawing import Points, Sheet

SCALE = 1.0
"""True size: a print of the page is laid on the coupling."""
_CONTACT_MM = 1.7
_FIRST_MM = 8.0
"""From the contacts to the nearest label."""
_LINE_MM = 6.5
"""From label to label: all of them beside the face."""
_LABEL_MM, _WORDS_MM = 6.0, 34.0
_METAL, _PIN = "#d9dde2", "#8b95a1"


def contacts_view(flange: Flange) -> str:
    """The face of the coupling with recess, bolts, contacts and the hole for the locating pin, seen
    from the gripper; x towards the pin."""
    sheet = Sheet()
    sheet.area([_circle((0.0, 0.0), flange.face_mm)], "body", _METAL)
    sheet.lines([_circle((0.0, 0.0), flange.centring_mm)], "line")
    for at in flange.bolts:
        sheet.area([_circle(at, flange.bolt_hole_mm)], "part", "#fff")
    sheet.area([_circle(flange.pin_at, flange.pin_mm)], "part", _PIN)
    right = float(sheet.high[0]) + _LABEL_MM
    for contact, label_y in _labelled(flange.contacts):
        x, y = SCALE * contact.at[0], SCALE * contact.at[1]
        sheet.area([_circle(contact.at, _CONTACT_MM)], "part", "#fff")
        sheet.lines([np.array([(x, y), (x, label_y), (right, label_y)])], "leader")
        sheet.dot(x, y)
        sheet.words(right + 1.5, label_y - 1.2, contact.number, "name", "start")
        sheet.words(right + 9.0, label_y - 1.2, contact.carries, "number", "start")
    pin_x, pin_y = (SCALE * place for place in flange.pin_at)
    sheet.lines([np.array([(pin_x, pin_y), (right, pin_y)])], "leader")
    sheet.dot(pin_x, pin_y)
    sheet.words(right + 1.5, pin_y - 1.2, "hole for the locating pin", "detail", "start")
    sheet.cover(right + _WORDS_MM, pin_y)
    return sheet.svg({"data-scale": SCALE})


def _labelled(contacts: tuple[ToolContact, ...]) -> Iterator[tuple[ToolContact, float]]:
    """Each contact with the height of its label, so that no leader crosses another: those above
    the middle go up, the farthest from the labels the highest; those below go down."""
    for way in (1, -1):
        side = [c for c in contacts if (1 if c.at[1] >= 0 else -1) == way]
        for place, contact in enumerate(sorted(side, key=lambda c: (-c.at[0], way * c.at[1]))):
            yield contact, way * (SCALE * abs(contact.at[1]) + _FIRST_MM + _LINE_MM * place)


def _circle(at: Point, diameter_mm: float) -> Points:
    turn = np.linspace(0.0, math.tau, 73)
    ring = np.stack([np.cos(turn), np.sin(turn)], axis=1) * diameter_mm / 2
    return np.asarray(SCALE * (ring + np.array(at)))

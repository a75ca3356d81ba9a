"""Names of a design and its device: text of any script."""

import unicodedata
from typing import Annotated

from pydantic import AfterValidator, Field

from lumitip_fab.text import LONGEST, board_name

DEVICE_BYTES = 29
"""Of a Bluetooth name: what one scan response carries."""
_JOINERS = "\u200c\u200d"
"""Invisible, but part of how some scripts and emoji are written."""


def _writable(text: str) -> str:
    """The text itself, if all of it can be seen and none turns the direction of writing."""
    for character in text:
        category = unicodedata.category(character)
        if category[0] == "C" or category in ("Zl", "Zp"):
            if character in _JOINERS:
                continue
            called = unicodedata.name(character, "a control character")
            raise ValueError(
                f"is {text!r:.80}, which contains U+{ord(character):04X} ({called}); letters, "
                "digits, punctuation and spaces of any script are allowed"
            )
    if not board_name(text).strip():
        raise ValueError(f"is {text!r:.80}, which has no visible character")
    return text


def _short_enough(text: str) -> str:
    size = len(text.encode())
    if size > DEVICE_BYTES:
        raise ValueError(
            f"is {text!r:.80}, {size} bytes of UTF-8; a Bluetooth name has at most {DEVICE_BYTES}"
        )
    return text


Text = Annotated[str, Field(min_length=1, max_length=LONGEST), AfterValidator(_writable)]
DeviceName = Annotated[
    str,
    Field(min_length=1, max_length=DEVICE_BYTES),
    AfterValidator(_writable),
    AfterValidator(_short_enough),
]

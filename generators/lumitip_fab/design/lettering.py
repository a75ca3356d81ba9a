"""A user's text in the letters that a medium has."""

import unicodedata

from anyascii import anyascii

LONGEST = 32
"""Most characters of a name, and of what it becomes."""
PAGE_LETTERS = (
    (0x20, 0x7E), (0xA1, 0xAC), (0xAE, 0x24F), (0x384, 0x3FF), (0x400, 0x525),
    (0x1E00, 0x1EFB), (0x1F00, 0x1FFF), (0x2010, 0x2027), (0x2030, 0x205E), (0x20A0, 0x20B5),
)  # fmt: skip
"""Latin, Greek, Cyrillic and punctuation, all of them in the typeface of the PDFs, which sets
letters from left to right and joins none."""


def page_text(text: str) -> str:
    """The text with each character that the PDFs' typeface lacks transliterated."""
    whole = unicodedata.normalize("NFC", text)
    return _shortened("".join(c if _on_pages(c) else anyascii(c) for c in whole))


def board_text(text: str) -> str:
    """The text in ASCII, the only letters of a silkscreen."""
    return _shortened(anyascii(unicodedata.normalize("NFC", text)))


def _on_pages(character: str) -> bool:
    return any(first <= ord(character) <= last for first, last in PAGE_LETTERS)


def _shortened(text: str) -> str:
    return text if len(text) <= LONGEST else text[:LONGEST].rstrip()

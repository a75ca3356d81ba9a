"""Addresses of links: `scheme://target?option=value`."""

import math
import os
import unicodedata
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qsl, unquote

from lumitip.errors import UrlError

_LONGEST = 4096  # of a path on Linux; no name or port is as long


@dataclass(frozen=True)
class Url:
    """An address, taken apart."""

    text: str
    """As it was given."""
    scheme: str
    target: str
    """What stands between `://` and the question mark, with `%20` and its like replaced."""
    options: dict[str, str]

    @classmethod
    def parse(cls, text: str) -> "Url":
        """Take an address apart.

        Raises:
            UrlError: if it has no scheme, options that are none, or characters that no name,
                port or file has.
        """
        if not isinstance(text, str):
            raise UrlError(f"{text!r:.40} given, an address like ble://Lumitip is needed")
        if len(text) > _LONGEST:
            raise UrlError(
                f"{text[:40]!r}… of {len(text)} characters given, at most {_LONGEST} are allowed"
            )
        scheme, found, rest = text.partition("://")
        if not found:
            raise UrlError(
                f"{text!r} given, an address like ble://Lumitip or twin://demo is needed"
            )
        target, _, query = rest.partition("?")
        try:
            pairs = parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query))
        except ValueError as error:
            raise UrlError(f"{text!r}: options like ?name=value&other=value are needed") from error
        if len(dict(pairs)) != len(pairs):
            raise UrlError(f"{text!r}: an option is given twice")
        for part in (unquote(target), *(word for pair in pairs for word in pair)):
            if odd := next(filter(_unusable, part), None):
                raise UrlError(f"{text!r}: {odd!r} in it, which no name, port or file has")
        return cls(text, scheme.lower(), unquote(target), dict(pairs))

    @property
    def path(self) -> Path:
        """The target as a file; `~` is the user's home folder."""
        try:
            return Path(self.target).expanduser()
        except RuntimeError:  # there is none: whoever reads says that there is no such file
            return Path(self.target)

    def allow(self, *names: str) -> None:
        """Refuse options of other names.

        Raises:
            UrlError: naming the first of them.
        """
        for name in self.options:
            if name not in names:
                allowed = ", ".join(names) or "none"
                raise UrlError(f"{self.text!r}: option {name!r} given, allowed are {allowed}")

    def number(self, name: str, default: float, least: float, most: float) -> float:
        """An option that is a number.

        Raises:
            UrlError: if it is none, or outside the limits.
        """
        text = self.options.get(name)
        if text is None:
            return default
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            raise UrlError(
                f"{self.text!r}: {name}={text} given, a number from {least:g} to {most:g} is needed"
            )
        return value

    def choice(self, name: str, *allowed: str) -> str:
        """An option that is one of several words, the first if it is not given.

        Raises:
            UrlError: if it is another.
        """
        value = self.options.get(name, allowed[0])
        if value not in allowed:
            raise UrlError(f"{self.text!r}: {name}={value} given, allowed are {', '.join(allowed)}")
        return value


def _unusable(character: str) -> bool:
    """Whether it is a control character, or none that the system takes in a name."""
    try:
        os.fsencode(character)
    except UnicodeEncodeError:
        return True
    return unicodedata.category(character) == "Cc"

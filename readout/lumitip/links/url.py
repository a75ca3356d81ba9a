"""Addresses of links: `scheme://target?option=value`."""

import math
import os
import re
import unicodedata
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import parse_qsl, unquote, unquote_plus

from lumitip.errors import UrlError

_LONGEST = 4096  # of a path on Linux; no name or port is as long
_OPTION = re.compile(r"(?:^|[?;])([^=?;]*)=")


@dataclass(frozen=True)
class Url:
    """The parts of an address."""

    text: str
    """The whole address for messages, `redacted`."""
    scheme: str
    target: str
    """The part between `://` and the question mark, percent-decoded."""
    options: dict[str, str] = field(repr=False)

    @classmethod
    def parse(cls, text: str) -> "Url":
        """Parse an address.

        Raises:
            UrlError: if scheme, options or characters are wrong.
        """
        if not isinstance(text, str):
            raise UrlError(f"the address is {text!r:.40}; one like ble://Lumitip is needed")
        public = redacted(text)
        if len(text) > _LONGEST:
            raise UrlError(
                f"the address {public[:40]!r}… has {len(text)} characters; the limit is {_LONGEST}"
            )
        scheme, found, rest = text.partition("://")
        if not found:
            raise UrlError(
                f"the address is {public!r}; one like ble://Lumitip or twin://demo is needed"
            )
        target, _, query = rest.partition("?")
        try:
            pairs = parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query))
        except ValueError as error:
            raise UrlError(
                f"{public!r}: options like ?name=value&other=value are needed"
            ) from error
        if len(dict(pairs)) != len(pairs):
            raise UrlError(f"{public!r}: an option occurs twice")
        for part in (unquote(target), *(word for pair in pairs for word in pair)):
            if bad := next(filter(_unusable, part), None):
                raise UrlError(f"{public!r}: the character {bad!r} is not allowed")
        return cls(public, scheme.lower(), unquote(target), dict(pairs))

    @property
    def path(self) -> Path:
        """The target as a file; `~` is the user's home folder.

        Raises:
            UrlError: if there is none.
        """
        if not self.target:
            raise UrlError(
                f"the address {self.text!r} has no file; one like {self.scheme}://run.mcap is "
                "needed"
            )
        try:
            return Path(self.target).expanduser()
        except RuntimeError:  # no home folder: opening the file will fail
            return Path(self.target)

    def allow(self, *names: str) -> None:
        """Reject options of other names.

        Raises:
            UrlError: for the first such option.
        """
        for name in self.options:
            if name not in names:
                allowed = ", ".join(names) or "none"
                raise UrlError(f"{self.text!r}: there is no option {name!r}; allowed are {allowed}")

    def number(self, name: str, default: float, least: float, most: float) -> float:
        """An option that is a number.

        Raises:
            UrlError: if it is not a number within the limits.
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
                f"{self.text!r}: {name} is {text}; a number from {least:g} to {most:g} is needed"
            )
        return value

    def choice(self, name: str, *allowed: str) -> str:
        """An option that is one of several words; the first is the default.

        Raises:
            UrlError: if it is another word.
        """
        value = self.options.get(name, allowed[0])
        if value not in allowed:
            raise UrlError(f"{self.text!r}: {name} is {value}; allowed are {', '.join(allowed)}")
        return value


def redacted(address: str) -> str:
    """An address, or a text that holds one, with `***` for its token: for messages, logs, pages."""
    return "&".join(map(_without_token, address.split("&")))


def _without_token(part: str) -> str:
    for option in _OPTION.finditer(part):
        if unquote_plus(option[1]).strip().lower() == "token":
            return f"{part[: option.end()]}***"
    return part


def _unusable(character: str) -> bool:
    """Whether it is a control character, or not encodable in a file name."""
    try:
        os.fsencode(character)
    except UnicodeEncodeError:
        return True
    return unicodedata.category(character) == "Cc"

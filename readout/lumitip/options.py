"""Options of `Fingertip.open`, for all functions that pass them on."""

from collections.abc import Callable, Mapping
from typing import TypedDict

from lumitip.errors import UnknownOption
from lumitip.links.base import LinkEvent


class OpenOptions(TypedDict, total=False):
    """Options of `Fingertip.open`, which describes them."""

    timeout: float | None
    buffer: int
    any_design: bool
    calibrated: bool
    on_event: Callable[[LinkEvent], None] | None


def check_options(options: Mapping[str, object]) -> None:
    """Reject options of other names.

    Raises:
        UnknownOption: for the first such option.
    """
    for name in options:
        if name not in OpenOptions.__annotations__:
            raise UnknownOption(name, tuple(OpenOptions.__annotations__))

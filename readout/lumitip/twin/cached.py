"""`Cached`: a function that keeps its last results, and can be pickled, without them."""

from collections.abc import Callable
from functools import lru_cache
from typing import Any, Generic, ParamSpec, TypeVar

_P = ParamSpec("_P")
_R = TypeVar("_R")
_MOST = 8  # results that are kept


class Cached(Generic[_P, _R]):
    """A function of hashable arguments, with its last results. Thread-safe."""

    def __init__(self, function: Callable[_P, _R]) -> None:
        self._function = function
        self._kept: Callable[..., _R] = lru_cache(_MOST)(function)

    def __call__(self, *args: _P.args, **kwargs: _P.kwargs) -> _R:
        return self._kept(*args, **kwargs)

    def __reduce__(self) -> tuple[Any, ...]:
        return Cached, (self._function,)

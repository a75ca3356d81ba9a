"""ROS 2 messages in Python without ROS: fields and types of ROS's own definitions, as rosbags has
them, with the checks that ROS's generated classes make when a field is set."""

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.base import Nodetype

OWN = Path(__file__).parents[1] / "readout" / "ros2" / "lumitip_msgs" / "msg"
_RANGES = {
    f"{sign}int{bits}": (-(2 ** (bits - 1)) if not sign else 0, 2 ** (bits - (not sign)) - 1)
    for sign in ("", "u")
    for bits in (8, 16, 32, 64)
}


def typestore() -> Any:
    """The definitions of ROS 2 Jazzy, and Lumitip's own."""
    store = get_typestore(Stores.ROS2_JAZZY)
    for path in sorted(OWN.glob("*.msg")):
        store.register(get_types_from_msg(path.read_text("utf-8"), f"lumitip_msgs/msg/{path.stem}"))
    return store


class Message:
    """A message; fields without a value have ROS's defaults."""

    _kind: str
    _fields: list[tuple[str, Any]]
    _classes: dict[str, type["Message"]]

    def __init__(self, **values: Any) -> None:
        unknown = set(values) - {name for name, _ in self._fields}
        assert not unknown, f"{self._kind} has no {unknown}"
        for name, type_ in self._fields:
            setattr(self, name, values.get(name, _default(type_, self._classes)))

    def __setattr__(self, name: str, value: Any) -> None:
        type_ = dict(self._fields).get(name)
        assert type_, f"{self._kind} has no {name}"
        _check(type_, value, self._classes, f"{self._kind}.{name}")
        object.__setattr__(self, name, value)


def message_modules(store: Any) -> dict[str, ModuleType]:
    """Modules such as `std_msgs.msg`, by name, with every message of the store."""
    classes: dict[str, type[Message]] = {}
    modules: dict[str, ModuleType] = {}
    for kind, (constants, fields) in store.fielddefs.items():
        package, _, name = kind.split("/")
        values = {n: bytes([v]) if type_ == "byte" else v for n, type_, v in constants}
        namespace = {"_kind": kind, "_fields": fields, "_classes": classes, **values}
        classes[kind] = type(name, (Message,), namespace)
        for module in (package, f"{package}.msg"):
            modules.setdefault(module, ModuleType(module))
        setattr(modules[f"{package}.msg"], name, classes[kind])
    return modules


def _default(type_: Any, classes: dict[str, type[Message]]) -> Any:
    kind, of = type_
    if kind == Nodetype.NAME:
        return classes[of]()
    if kind == Nodetype.SEQUENCE:
        return []
    if kind == Nodetype.ARRAY:
        return [_default(of[0], classes) for _ in range(of[1])]
    name = of[0]
    plain = {"string": "", "bool": False, "byte": b"\0", "float32": 0.0, "float64": 0.0}
    return plain.get(name, 0)


def _check(type_: Any, value: Any, classes: dict[str, type[Message]], where: str) -> None:
    kind, of = type_
    if kind == Nodetype.NAME:
        assert type(value) is classes[of], (where, value)
        return
    if kind in (Nodetype.SEQUENCE, Nodetype.ARRAY):
        assert isinstance(value, list), (where, value)
        for each in value:
            _check(of[0], each, classes, where)
        return
    name = of[0]
    if name in _RANGES:
        low, high = _RANGES[name]
        assert type(value) is int and low <= value <= high, (where, value)
    elif name in ("float32", "float64"):
        assert type(value) is float, (where, value)
    elif name == "byte":
        assert type(value) is bytes and len(value) == 1, (where, value)
    else:
        assert type(value) is {"string": str, "bool": bool}[name], (where, value)


def encoded(store: Any, message: Message) -> bytes:
    """A message as CDR, by rosbags."""
    return bytes(store.serialize_cdr(_plain(store, message), message._kind))


def _plain(store: Any, message: Message) -> Any:
    values = {}
    for name, type_ in message._fields:
        values[name] = _converted(store, type_, getattr(message, name))
    return store.types[message._kind](**values)


def _converted(store: Any, type_: Any, value: Any) -> Any:
    kind, of = type_
    if kind == Nodetype.NAME:
        return _plain(store, value)
    if kind in (Nodetype.SEQUENCE, Nodetype.ARRAY):
        inner, name = of[0][0], of[0][1][0] if of[0][0] == Nodetype.BASE else ""
        if inner == Nodetype.BASE and name != "string":
            return np.array(value, {"byte": "uint8"}.get(name, name))
        return [_converted(store, of[0], each) for each in value]
    return value[0] if of[0] == "byte" else value

"""The messages' bytes by a second implementation, Cyclone DDS, also through DDS on loopback; and
the hashes of their types."""

import uuid
from dataclasses import dataclass
from typing import Any

import pytest
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import float32, float64, int32, sequence, uint8, uint16, uint32, uint64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from ros_definitions import encoded, message_modules

LOOPBACK = (
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='lo' multicast='false'/>"
    "</Interfaces></General><Discovery><ParticipantIndex>auto</ParticipantIndex><Peers>"
    "<Peer address='127.0.0.1'/></Peers></Discovery></Domain></CycloneDDS>"
)


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time
    frame_id: str


@dataclass
class Point(IdlStruct, typename="geometry_msgs::msg::dds_::Point_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Values(IdlStruct, typename="lumitip_msgs::msg::dds_::Values_"):
    header: Header
    values: sequence[float32]
    dropped_before: int32


@dataclass
class Contact(IdlStruct, typename="lumitip_msgs::msg::dds_::Contact_"):
    header: Header
    shape: str
    threshold: float64
    contrast: float64
    centre: Point
    angle: float64
    width: float64
    vertex: Point
    opening: float64


@dataclass
class Estimate(IdlStruct, typename="lumitip_msgs::msg::dds_::Estimate_"):
    header: Header
    kind: str
    flags: sequence[str]
    offset: float64
    angle: float64
    dark_side: str
    width: float64
    curvature: float64
    vertex: Point
    direction: float64
    opening: float64
    parameters: sequence[str]
    covariance: sequence[float64]
    transmittance: float64
    gain: float64
    rms_counts: float64
    left_out: sequence[uint32]


@dataclass
class Frame(IdlStruct, typename="lumitip_msgs::msg::dds_::Frame_"):
    header: Header
    sequence: uint64
    device_time: float64
    host_time: float64
    dropped_before: int32
    bits: uint8
    values: sequence[uint16]


HEAD = Header(Time(1_790_000_000, 999_999_999), "lumitip_receiver")
MESSAGES = [
    Values(HEAD, [255.0, 0.5, 17.25], -1),
    Contact(HEAD, "edge", 120.5, 80.25, Point(0.001, -0.002, 0.0), 0.5, 1.0, Point(0, 0, 0), 2.0),
    Estimate(
        HEAD,
        "cable",
        ["misfit", "weak"],
        0.0015,
        -0.75,
        "left",
        0.003,
        2.5,
        Point(0.0, 0.0, 0.0),
        0.0,
        0.0,
        ["offset", "angle"],
        [1e-9, 2e-9, 2e-9, 4e-6],
        0.25,
        0.98,
        3.5,
        [0, 31],
    ),
    Frame(HEAD, 1 << 40, 1.5, 100.25, 0, 12, [0, 4095, 7]),
]
HASHES = {
    "std_msgs/msg/Header": "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
    "lumitip_msgs/msg/Contact": "c3d498eb895f17b009885f80066086b728e2bb5302999acd62ef0bf7f8283204",
    "lumitip_msgs/msg/Estimate": "08c8d56cda237b08a4874c25a491706d07c84d62565ac970f4670ea3dd898dd1",
    "lumitip_msgs/msg/Frame": "2224319304850dfcabdd113704cad27853f2b6f6c375c1af4924183fea0f1138",
    "lumitip_msgs/msg/Values": "024d0aabc769817ab14bc9bb7f47bf44d527b268a11950ecf3518f00eb93c6f1",
}
"""Version 1 of ROS 2's hashes. That of `Header` is the one of ROS 2 itself; the others change with
a definition, and a changed one no longer matches recordings and nodes of before."""


def ours(store: Any, message: IdlStruct) -> Any:
    """The same message as the node makes it."""
    modules = message_modules(store)

    def made(value: Any) -> Any:
        if not isinstance(value, IdlStruct):
            return value
        package, _, _, name = (
            type(value).__idl_typename__.replace("::", " ").replace(".", " ").split()
        )
        kind = getattr(modules[f"{package}.msg"], name.removesuffix("_"))
        fields = {k: made(v) for k, v in vars(value).items()}
        types = dict(kind._fields)
        return kind(**{k: _typed(types[k], v) for k, v in fields.items()})

    return made(message)


def _typed(type_: Any, value: Any) -> Any:
    _, of = type_
    return float(value) if of[0] == "float64" else value


@pytest.mark.parametrize("message", MESSAGES, ids=lambda m: type(m).__name__)
def test_bytes_are_those_of_a_second_implementation(store: Any, message: IdlStruct) -> None:
    mine = encoded(store, ours(store, message))
    theirs = message.serialize(use_version_2=False)
    assert mine[:4] == b"\0\1\0\0", "little-endian CDR"
    assert mine[4:] == theirs[4:][: len(mine) - 4]
    assert not any(theirs[len(mine) :]), "padding alone"


@pytest.mark.parametrize("message", MESSAGES, ids=lambda m: type(m).__name__)
def test_a_message_goes_through_dds(store: Any, message: IdlStruct) -> None:
    """From bytes by the definitions of `lumitip_msgs`, by Cyclone DDS, to another participant."""
    sent = type(message).deserialize(encoded(store, ours(store, message)))
    number = 77
    topic_name = f"rt/fingertip/{type(message).__name__.lower()}_{uuid.uuid4().hex[:8]}"
    qos = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.Durability.TransientLocal)
    with _Domain(number):
        sender, receiver = DomainParticipant(number), DomainParticipant(number)
        writer = DataWriter(sender, Topic(sender, topic_name, type(message), qos=qos), qos=qos)
        reader = DataReader(receiver, Topic(receiver, topic_name, type(message), qos=qos), qos=qos)
        writer.write(sent)
        taken = next(reader.take_iter(timeout=duration(seconds=10)))
        assert taken == message


class _Domain:
    """A domain on loopback."""

    def __init__(self, number: int) -> None:
        self._number = number

    def __enter__(self) -> None:
        self._kept = Domain(self._number, LOOPBACK)

    def __exit__(self, *_: object) -> None:
        del self._kept


@pytest.mark.parametrize("kind", HASHES)
def test_the_hash_of_a_type_stays(store: Any, kind: str) -> None:
    assert store.hash_rihs01(kind) == f"RIHS01_{HASHES[kind]}"

"""Status and the legacy frame."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumitip.protocol.bluetooth import STATUS_BYTES, Fault, Status, decode_legacy, legacy_mtu
from lumitip.protocol.packet import PacketError

KNOWN = Status((1, 2, 3), "0123456789abcdef", 32, 23, 51, Fault.MTU_TOO_SMALL | Fault.WATCHDOG)


def test_bytes_of_a_status_worked_out_by_hand() -> None:
    wanted = "02 010203 0123456789abcdef 2000 1700 3300 1100"
    assert KNOWN.encode() == bytes.fromhex(wanted)
    assert Status.decode(KNOWN.encode()) == KNOWN
    assert Status.decode(KNOWN.encode() + b"of a later version") == KNOWN


def test_a_status_fits_the_smallest_notification() -> None:
    assert STATUS_BYTES == 23 - 3


def test_unknown_faults_are_kept() -> None:
    assert Status.decode(replace(KNOWN, faults=Fault(0x8001)).encode()).faults == 0x8001


@pytest.mark.parametrize(
    "wrong",
    [{"mtu": 65536}, {"firmware": (1, 2)}, {"design_hash": "xyz"}, {"design_hash": "1" * 17}],
    ids=str,
)
def test_what_no_status_can_carry_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(PacketError):
        replace(KNOWN, **wrong).encode()


@given(st.binary(max_size=40))
def test_any_bytes_give_a_status_or_the_typed_error(data: bytes) -> None:
    try:
        status = Status.decode(data)
    except PacketError as error:
        assert error.reason == ("length" if len(data) < STATUS_BYTES else "version")
    else:
        assert status.encode() == data[:STATUS_BYTES]


def test_legacy_frame() -> None:
    frame = decode_legacy(bytearray(range(32)), 32)
    assert frame.dtype == np.uint8
    assert frame.tolist() == list(range(32))
    assert not frame.flags.writeable


@pytest.mark.parametrize("length", [0, 20, 31, 33])
def test_a_legacy_frame_cut_off_is_refused(length: int) -> None:
    with pytest.raises(PacketError, match=f"{length} bytes;.*{legacy_mtu(32)}") as caught:
        decode_legacy(bytes(length), 32)
    assert caught.value.reason == "length"

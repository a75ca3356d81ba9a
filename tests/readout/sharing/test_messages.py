"""Messages between server and client: whole, in pieces, and damaged."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumitip.errors import LumitipError
from lumitip.protocol.messages import (
    Kind,
    MessageDecoder,
    MessageError,
    decode_json,
    decode_request,
    encode,
    encode_json,
    encode_request,
)

MESSAGES = st.lists(st.tuples(st.sampled_from(Kind), st.binary(max_size=40)), max_size=8)


@given(MESSAGES, st.integers(1, 20))
def test_messages_survive_any_pieces(messages: list[tuple[Kind, bytes]], size: int) -> None:
    stream = b"".join(encode(*message) for message in messages)
    decoder, found = MessageDecoder(), []
    for at in range(0, len(stream), size):
        found += decoder.feed(stream[at : at + size])
    assert found == messages


@given(st.binary(max_size=200))
def test_other_bytes_raise_one_error(data: bytes) -> None:
    for read in (MessageDecoder().feed, decode_json, decode_request):
        try:
            read(data)
        except MessageError as error:
            assert isinstance(error, LumitipError)


def test_a_request_has_version_and_token() -> None:
    assert decode_request(encode_request("secret")) == "secret"
    assert decode_request(encode_request(None)) == ""
    with pytest.raises(MessageError, match="version of the protocol is 7; 1 is needed"):
        decode_request(b'{"lumitip": 7}')


def test_a_length_beyond_the_limit_is_an_error_at_once() -> None:
    with pytest.raises(MessageError, match="not the stream"):
        MessageDecoder().feed(b"\x03\xff\xff\xff\x7f")


def test_json_is_an_object() -> None:
    (message,) = MessageDecoder().feed(encode_json(Kind.EVENT, {"kind": "lost"}))
    assert decode_json(message[1]) == {"kind": "lost"}
    with pytest.raises(MessageError, match="a JSON object is needed"):
        decode_json(b"[1]")

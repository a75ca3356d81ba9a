"""Addresses in messages, logs and pages: without the token of a shared fingertip."""

import logging

import pytest

from lumitip import Fingertip, FingertipGroup
from lumitip.cli import main
from lumitip.errors import ArgumentError, LumitipError
from lumitip.links.tcp import Address
from lumitip.links.url import Url, redacted
from lumitip.sharing import FingertipServer


@pytest.mark.parametrize(
    ("address", "public"),
    [
        ("tcp://127.0.0.1:8998?token=s3cret", "tcp://127.0.0.1:8998?token=***"),
        ("tcp://a?token=s3cret&x=1", "tcp://a?token=***&x=1"),
        ("tcp://a?x=1&Token=s3cret", "tcp://a?x=1&Token=***"),
        ("tcp://a?%74oken=s3cret", "tcp://a?%74oken=***"),
        ("tcp://a?x=1?token=s3;cret?", "tcp://a?x=1?token=***"),
        ("TCP://a&token=s3cret", "TCP://a&token=***"),
        ("twin://disc?rate=50&seed=1", "twin://disc?rate=50&seed=1"),
        ("replay://token=1.mcap", "replay://token=1.mcap"),
        ("serial:///dev/ttyACM0", "serial:///dev/ttyACM0"),
    ],
)
def test_the_token_and_nothing_else_is_hidden(address: str, public: str) -> None:
    assert redacted(address) == public == redacted(public)


def test_parts_of_an_address_print_no_token() -> None:
    url = Url.parse("tcp://a?token=s3cret")
    assert url.options == {"token": "s3cret"} and url.text == "tcp://a?token=***"
    assert "s3cret" not in f"{url!r} {url}"
    assert "s3cret" not in f"{(one := Address('a', 1, 's3cret'))!r} {one}"


@pytest.mark.parametrize(
    "address",
    [
        "tcp://127.0.0.1:9?token=s3cret",
        "tcp://a:b?token=s3cret",
        "tcp://a?token=s3cret&tokn=1",
        "tcp://a?token=s3cret&token=s3cret",
        "tcp://a?token=s3cret&x",
        "tcp://a\n?token=s3cret",
        "a?token=s3cret",
        "tcp:a?token=s3cret",
        "http://a?token=s3cret",
        "twin://disc?token=s3cret",
        "t://?token=s3cret" + 5000 * "a",
    ],
)
def test_no_error_has_the_token(address: str) -> None:
    with pytest.raises(LumitipError) as caught:
        Fingertip.open(address)
    assert "s3cret" not in repr(caught.value)


def test_no_error_of_other_uses_has_the_token(capsys: pytest.CaptureFixture[str]) -> None:
    for fingers in ("tcp://a?token=s3cret", ["tcp://a?token=s3cret"]):
        with pytest.raises(ArgumentError, match="token=") as caught:
            FingertipGroup.open(fingers)  # type: ignore[arg-type]
        assert "s3cret" not in str(caught.value)
    with pytest.raises(LumitipError, match="is a file") as refused:
        FingertipServer("replay://a?token=s3cret")
    assert "s3cret" not in str(refused.value)
    assert main(["twin", "--serve-serial", "tcp://a?token=s3cret"]) == 2
    assert "s3cret" not in capsys.readouterr().err


def test_an_open_fingertip_prints_and_logs_no_token(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG)
    with (
        FingertipServer("twin://disc?rate=50", port=0, token="s3cret") as server,
        Fingertip.open(server.address) as tip,
    ):
        tip.read(60.0)
        printed = f"{tip!r} {server!r} {tip.device_id}"
    assert "s3cret" not in printed + caplog.text

"""`gauge.json`: read as written, refused with every fault at once."""

import json
from pathlib import Path

import pytest

from acceptance_frames import record
from lumitip.acceptance.gauge import Gauge, GaugeError, in_gap


def test_a_file_is_read_as_it_is_written(tmp_path: Path) -> None:
    file = tmp_path / "gauge.json"
    file.write_text(json.dumps(record()), encoding="utf-8")
    gauge = Gauge.load(file)
    assert (gauge.gap_mm, len(gauge.placements)) == (3.0, 4)
    strip = gauge.placements[3]
    assert (strip.name, strip.on) == ("strip on the emitter", "emitter")
    piece = strip.piece
    assert (piece.kind, piece.angle_deg, piece.width_mm) == ("strip", 78.0, 3.0)
    assert (piece.low_mm, piece.high_mm) == (0.0, 0.8)


def test_where_the_fingers_do_not_close_it_lies_on_the_finger_that_it_hugs(gauge: Gauge) -> None:
    on_receiver, on_emitter = gauge.placements[:2]
    assert in_gap(on_receiver, gauge, 3.7) == on_receiver.piece
    moved = in_gap(on_emitter, gauge, 3.7)
    assert (moved.low_mm, moved.high_mm) == pytest.approx((0.7, 1.5))


def test_every_fault_is_named_at_once() -> None:
    wrong = record()
    wrong["gap_mm"] = True
    wrong["placements"][0] |= {"kind": "disc", "offset_mm": "0"}
    wrong["placements"][1] |= {"on": None, "low_mm": 0.9}
    wrong["placements"][2] |= {"width_mm": 0.0, "name": ""}
    wrong["placements"][3] = 7
    with pytest.raises(GaugeError) as caught:
        Gauge.from_json(json.dumps(wrong), "own.json")
    text = str(caught.value)
    for part in (
        "own.json: gap_mm is True; a number from 0.1 to 20 is needed",
        'placements[0]: kind is \'disc\'; "edge" or "strip" is needed',
        "placements[0]: offset_mm is '0'; a number",
        'placements[1]: on is None; "receiver" or "emitter" is needed',
        "placements[1]: low_mm is 0.9, high_mm 0.8; high_mm must be the larger",
        "placements[2]: name is ''",
        "placements[2]: width_mm is 0; a strip needs a width above 0",
        "placements[3]: is 7; an object is needed",
    ):
        assert part in text


def test_both_ends_on_both_fingers_within_the_gap_are_needed() -> None:
    wrong = record()
    wrong["gap_mm"] = 2.9
    wrong["placements"] = wrong["placements"][:1]
    with pytest.raises(GaugeError) as caught:
        Gauge.from_json(json.dumps(wrong))
    text = str(caught.value)
    assert 'no placement has kind "strip"; each kind is needed' in text
    assert 'no placement has on "emitter"; each on is needed' in text
    assert "a placement's high_mm is above gap_mm" in text


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no JSON"),
        ("[]", "an object is needed"),
        ("[" * 100_000, "no JSON"),
        ('{"schema_version": true}', "schema_version is True; this version reads 1"),
        ('{"schema_version": 2}', "schema_version is 2; this version reads 1"),
        (json.dumps(record() | {"placements": []}), "a list of one or more is needed"),
        (json.dumps(record() | {"gap_mm": float("nan")}), "gap_mm is nan"),
        (json.dumps(record() | {"design_hash": 3}), "design_hash is 3; a text is needed"),
    ],
)
def test_other_files_are_refused(text: str, message: str) -> None:
    with pytest.raises(GaugeError, match=message):
        Gauge.from_json(text)


def test_a_missing_file_says_who_writes_it(tmp_path: Path) -> None:
    with pytest.raises(GaugeError, match=r"`lumitip-fab build` writes it beside layout\.json, if"):
        Gauge.load(tmp_path / "gauge.json")

"""The benchmark of mutations fails on each goal that is missed, and prints a score by artefact."""

import pytest

from bench_mutations import judged, print_score
from mutations.trial import Trial

CAUGHT = Trial("mask/a.pdf", "move", 1, "moved", ("mask.position",))
MISSED = Trial("mask/a.svg", "move", 1, "moved", ())
CRASHED = Trial("bom.csv", "remove", 1, "gone", ("bom.rows",), "KeyError: 'a'")


@pytest.mark.parametrize(
    ("trials", "code"),
    [
        ([CAUGHT] * 97 + [MISSED] * 3, 0),
        ([CAUGHT] * 96 + [MISSED] * 4, 1),
        ([CAUGHT] * 99 + [CRASHED], 1),
    ],
)
def test_each_goal_is_held(trials: list[Trial], code: int) -> None:
    assert judged(trials) == code


def test_the_score_has_the_worst_artefact_first(capsys: pytest.CaptureFixture[str]) -> None:
    print_score([CAUGHT, CAUGHT, MISSED, CRASHED])
    lines = [line.split() for line in capsys.readouterr().out.strip().splitlines()]
    assert [line[:3] for line in lines[1:]] == [
        ["bom.csv", "0", "1"],
        ["mask/svg", "0", "1"],
        ["mask/pdf", "2", "2"],
        ["all", "2", "4"],
    ]

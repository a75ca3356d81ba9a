"""The process that estimates poses for the live view: `python -m lumitip.view.pose_process`.

A process of its own, because a fit computes for milliseconds and its tables for seconds: within the
process that reads, frames would wait for it. Lines of JSON on its input and output, from and to
`lumitip.view.estimating` alone:

    in    {"layout": …, "gap_mm": 3.0, "diameter_mm": 3.0}     first, and when that changes
    out   {"ready": true}                                      once the tables are computed
    in    [255.0, 17.5, …]                                     values of a frame
    out   {"kind": "edge", …}                                  see `lumitip.view.pose.described`

A failure is `{"failed": "…"}`, the last line. The process ends when its input does.
"""

import json
import os
import sys
from collections.abc import Iterable, Iterator
from typing import Any

from lumitip.errors import LumitipError
from lumitip.estimation import PoseEstimator
from lumitip.layout import Layout
from lumitip.view.pose import described, reach_of

_NICER = 10  # readers go first on a busy computer


def answers(lines: Iterable[str]) -> Iterator[dict[str, Any]]:
    """The answers to lines of input."""
    angle_deg = None
    for line in lines:
        question = json.loads(line)
        if isinstance(question, dict):
            layout = Layout.from_json(json.dumps(question.pop("layout")))
            estimator = PoseEstimator(layout, tracking=True, **question).prepare()
            reach_mm = reach_of(layout)
            yield {"ready": True}
            continue
        shown = described(estimator(question), reach_mm, angle_deg)
        angle_deg = shown["angle_deg"]
        yield shown


def main() -> None:
    """Answer until the input ends."""
    if hasattr(os, "nice"):
        os.nice(_NICER)
    try:
        for answer in answers(sys.stdin):
            print(json.dumps(answer), flush=True)
    except LumitipError as error:
        print(json.dumps({"failed": str(error)}), flush=True)
    except BrokenPipeError:  # the live view was killed
        os._exit(0)


if __name__ == "__main__":
    main()

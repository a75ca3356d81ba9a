"""Simulated tasks in closed loop: follow the edge of a cloth, follow a cable.

task = Task(layout, Settings("cable"))
values = task.reset(seed=1)
values, ended = task.step(Command(forward_mm_s=80.0))
"""

from lumitip.tasks.curve import Curve
from lumitip.tasks.task import Metrics, Settings, Task, TaskError
from lumitip.tasks.trial import CONTROLLERS, Bench, Summary, Tuned, Tuning, search, summary

__all__ = [
    "CONTROLLERS",
    "Bench",
    "Curve",
    "Metrics",
    "Settings",
    "Summary",
    "Task",
    "TaskError",
    "Tuned",
    "Tuning",
    "search",
    "summary",
]

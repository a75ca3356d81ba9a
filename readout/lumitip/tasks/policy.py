"""`Policy`: a learned controller, a small network from frames to velocities. Needs numpy alone.

policy = Policy.shipped("cloth")
follow = Follower(policy, speed_mm_s=200.0)
command = follow(frame.values)              # at every frame, at the rate of the training
"""

import io
import json
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumitip import arguments
from lumitip.control import Command, Limits
from lumitip.grid import Floats, Integers
from lumitip.layout import Layout
from lumitip.processing.processor import MIN_CONTRAST, frame_values
from lumitip.tasks.task import KINDS, TaskError
from lumitip.values import shown

Inputs = NDArray[np.float32]
HISTORY = 4
"""Frames that the network sees, the newest first."""
COMMANDS = 2
"""Commands that it sees, the newest first: the actuator follows them late."""
SCALE = np.array([400.0, 400.0, 8.0])
"""Velocities (mm/s, mm/s, rad/s) of an output of 1."""
FASTEST_MM_S = 700.0
"""Highest speed of the training."""
LIMITS = Limits(800.0, 800.0, 8.0)
"""Those of the training."""
UNSEEN_S = 0.15
"""Time without contrast until a `Follower` stops."""
_NOTHING = 0.5  # the input of a cell that reads nothing, whose mark is 1
_FOLDER = Path(__file__).parent / "policies"
_SCHEMA = 1


@dataclass(frozen=True, eq=False)
class Policy:
    """The weights of a network for one layout and one kind of object."""

    kind: str
    """`"cloth"` or `"cable"`."""
    design_hash: str
    """Of the layout."""
    rate_hz: float
    """Frames and commands in a second."""
    seed: int
    """Of the training."""
    weights: Sequence[Inputs]
    """Of each layer, shape `(inputs, outputs)`; hidden ones end in tanh."""
    biases: Sequence[Inputs]
    """Of each layer, shape `(outputs,)`."""

    def __repr__(self) -> str:
        sizes = [len(w) for w in self.weights] + [len(self.biases[-1])]
        return (
            f"<Policy for a {self.kind}, design {self.design_hash[:16]}, "
            f"{' to '.join(map(str, sizes))}>"
        )

    @classmethod
    def shipped(cls, kind: str) -> "Policy":
        """The policy of the published sensor that comes with the package.

        Raises:
            TaskError: if there is none of this kind.
        """
        if not isinstance(kind, str) or kind not in KINDS:
            raise TaskError(f"kind is {shown(kind)}; allowed are {', '.join(KINDS)}")
        return cls.load(_FOLDER / f"{kind}.npz")

    @classmethod
    def load(cls, path: str | Path) -> "Policy":
        """Read the file of a policy.

        Raises:
            TaskError: if it is not such a file.
        """
        try:
            with Path(path).open("rb") as stream, np.load(stream, allow_pickle=False) as file:
                record = json.loads(str(file["record"]))
                if record["schema_version"] != _SCHEMA:
                    raise ValueError(f"schema_version is {record['schema_version']!r}")
                count = int(record["layers"])
                parts = [
                    [np.asarray(file[f"{name}{n}"], np.float32) for n in range(count)]
                    for name in ("weight", "bias")
                ]
            policy = cls(
                record["kind"],
                record["design_hash"],
                float(record["rate_hz"]),
                int(record["seed"]),
                *parts,
            )
            _check(policy)
        except (OSError, EOFError, ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
            raise TaskError(
                f"{path}: cannot be read as a policy ({error}). `lumitip train` writes one"
            ) from error
        return policy

    def save(self, path: str | Path) -> None:
        """Write the file of the policy; weights are rounded to 16 bits.

        Raises:
            OSError: if it cannot be written.
        """
        record = {
            "schema_version": _SCHEMA,
            "kind": self.kind,
            "design_hash": self.design_hash,
            "rate_hz": self.rate_hz,
            "seed": self.seed,
            "layers": len(self.weights),
        }
        arrays: dict[str, NDArray[np.generic]] = {"record": np.array(json.dumps(record))}
        for name, parts in (("weight", self.weights), ("bias", self.biases)):
            arrays |= {f"{name}{n}": part.astype(np.float16) for n, part in enumerate(parts)}
        packed = io.BytesIO()
        np.savez(packed, **arrays)  # type: ignore[arg-type]
        Path(path).write_bytes(packed.getvalue())

    def __call__(self, inputs: Inputs) -> Floats:
        """Commands: forward (mm/s), lateral (mm/s) and turning (rad/s), shape `(n, 3)`.

        Args:
            inputs: as `Memory` makes them, shape `(n, inputs)`.
        """
        return within(SCALE * layers(inputs, self.weights, self.biases)[-1])


def layers(inputs: Inputs, weights: Sequence[Inputs], biases: Sequence[Inputs]) -> list[Inputs]:
    """Inputs, what each hidden layer makes of them, and the outputs."""
    found = [inputs]
    for number, (weight, bias) in enumerate(zip(weights, biases, strict=True), 1):
        found.append(found[-1] @ weight + bias)
        if number < len(weights):
            np.tanh(found[-1], out=found[-1])
    return found


def within(commands: Floats, limits: Limits = LIMITS) -> Floats:
    """Commands within limits, shape `(n, 3)`."""
    most = np.array([limits.forward_mm_s, limits.lateral_mm_s, limits.rotation_rad_s])
    return np.clip(commands, -most, most)


class Memory:
    """The last frames and commands of some fingers, as a network sees them."""

    def __init__(self, number: int, cells: int) -> None:
        self._frames = np.zeros((number, HISTORY, cells), np.float32)
        self._commands = np.zeros((number, COMMANDS, 3), np.float32)
        self._fresh = np.ones(number, bool)

    @staticmethod
    def size(cells: int) -> int:
        """Number of inputs."""
        return (HISTORY + 1) * cells + 3 * COMMANDS + 1

    def see(self, values: Floats, speed_mm_s: Floats) -> Inputs:
        """The inputs after a frame of each finger, shape `(number, inputs)`.

        Args:
            values: calibrated; NaN for cells to leave out, shape `(number, cells)`.
            speed_mm_s: along the line, shape `(number,)`.
        """
        dead = ~np.isfinite(values)
        shade = np.where(dead, _NOTHING, 1.0 - values / 255.0)
        self._frames[:, 1:] = self._frames[:, :-1]
        self._frames[:, 0] = shade
        self._frames[self._fresh] = shade[self._fresh, None]
        self._fresh[:] = False
        count = len(values)
        parts = (
            self._frames.reshape(count, -1),
            dead,
            (speed_mm_s / SCALE[0])[:, None],
            self._commands.reshape(count, -1),
        )
        return np.concatenate(parts, axis=1, dtype=np.float32)

    def act(self, commands: Floats) -> None:
        """Remember the commands of all fingers, shape `(number, 3)`."""
        self._commands[:, 1:] = self._commands[:, :-1]
        self._commands[:, 0] = commands / SCALE

    def forget(self, fingers: Integers) -> None:
        """Forget all of some fingers, by their numbers."""
        self._commands[fingers] = 0.0
        self._fresh[fingers] = True


class Follower:
    """Follows a line with a policy: `command = follow(values)`, for every frame.

    Args:
        policy: of this layout and kind of object.
        layout: the cells.
        speed_mm_s: along the line.
        limits: largest velocities.

    Raises:
        LayoutError: if `layout` is no layout.
        TaskError: if the policy is of another layout, or the speed beyond that of the training.
    """

    def __init__(
        self, policy: Policy, layout: Layout, speed_mm_s: float = 80.0, limits: Limits = LIMITS
    ) -> None:
        self.policy = arguments.instance(policy, Policy, "policy", TaskError)
        self._layout = arguments.layout(layout)
        if policy.design_hash != layout.design_hash:
            raise TaskError(
                f"the policy is of design {policy.design_hash[:16]}, the layout of "
                f"{layout.design_hash[:16]}. Train one: `lumitip train {policy.kind} --layout …`"
            )
        self.speed_mm_s = arguments.number(
            speed_mm_s, "speed_mm_s", 0.0, FASTEST_MM_S, error=TaskError
        )
        self.limits = arguments.instance(limits, Limits, "limits", TaskError)
        self.reset()

    def reset(self) -> None:
        """Forget the history."""
        self._memory = Memory(1, len(self._layout))
        self._unseen = 0

    def __call__(self, values: ArrayLike) -> Command:
        """The command for the next frame; a stop with the reason `"lost"` after `UNSEEN_S` without
        contrast.

        Args:
            values: calibrated, 255 is full light, shape `(cells,)`; NaN for cells to leave out.

        Raises:
            ValuesError: if there is another number of values, or they are no numbers.
        """
        read = frame_values(values, self._layout)
        seen = read[np.isfinite(read)]
        contrast = float(np.ptp(seen)) if seen.size else 0.0
        self._unseen = 0 if contrast >= MIN_CONTRAST else self._unseen + 1
        if self._unseen > UNSEEN_S * self.policy.rate_hz:
            return Command(state="stop", reason="lost")
        inputs = self._memory.see(read[None], np.array([self.speed_mm_s]))
        asked = within(self.policy(inputs), self.limits)
        self._memory.act(asked)
        return Command(*asked[0].tolist())


def _check(policy: Policy) -> None:
    if policy.kind not in KINDS or not isinstance(policy.design_hash, str):
        raise ValueError(f"kind {policy.kind!r}, design {policy.design_hash!r}")
    if not policy.weights or not policy.rate_hz > 0.0:
        raise ValueError("no layers, or no rate")
    for weight, bias in zip(policy.weights, policy.biases, strict=True):
        if weight.ndim != 2 or bias.shape != weight.shape[1:]:
            raise ValueError(f"layers of shapes {weight.shape} and {bias.shape}")
        if not (np.isfinite(weight).all() and np.isfinite(bias).all()):
            raise ValueError("a weight that is not finite")
    for one, other in zip(policy.biases, policy.weights[1:], strict=False):
        if len(one) != len(other):
            raise ValueError("layers that do not fit together")
    if len(policy.biases[-1]) != len(SCALE):
        raise ValueError(f"{len(policy.biases[-1])} outputs")

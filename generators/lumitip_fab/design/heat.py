"""Every step of making a sensor that heats something, and how much each heated part bears."""

from dataclasses import dataclass


@dataclass(frozen=True)
class HeatedPart:
    """A part that a step heats."""

    name: str
    """`"backing"`, `"board"`, `"film"`, `"interface"`, `"mould"` or `"silicone"`."""
    material: str
    limit_c: float
    """Highest temperature that its material bears in this step (°C)."""


@dataclass(frozen=True)
class HeatStep:
    """A step that heats parts, all of them to one temperature."""

    name: str
    """`"solder"`, `"cure"` or `"crease"`."""
    place: str
    """What is heated, in words for the person who does it."""
    temperature_c: float
    """Highest temperature that a part reaches (°C)."""
    parts: tuple[HeatedPart, ...]

    @property
    def limit_c(self) -> float:
        """The lowest limit of its parts (°C)."""
        return min(part.limit_c for part in self.parts)

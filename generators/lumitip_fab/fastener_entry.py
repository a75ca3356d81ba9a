"""Screws and nuts in the catalogue, by their thread: what goes through a printed hole."""

from typing import Self

from pydantic import model_validator

from lumitip_fab.entry import Entry, Length


class Fastener(Entry):
    """A metric thread with the heads and the nut that go with it."""

    thread_mm: Length
    """Outer diameter of the thread."""
    hole_mm: tuple[Length, Length]
    """Clearance holes by ISO 273: fine and coarse."""
    cap_head_mm: Length
    """Diameter of the head of a socket head cap screw, ISO 4762."""
    countersunk_mm: Length
    """Diameter of the head of a countersunk screw, ISO 7046."""
    nut_mm: Length
    """Width of a nut across flats, ISO 4032."""
    nut_height_mm: Length
    """Height of a nut, ISO 4032."""

    @model_validator(mode="after")
    def _goes_through(self) -> Self:
        fine, coarse = self.hole_mm
        if not self.thread_mm < fine <= coarse:
            raise ValueError(
                f"hole_mm = [{fine:g}, {coarse:g}] given, more than thread_mm = "
                f"{self.thread_mm:g} is needed, the finer first"
            )
        if min(self.cap_head_mm, self.countersunk_mm, self.nut_mm) <= coarse:
            raise ValueError(
                f"cap_head_mm = {self.cap_head_mm:g}, countersunk_mm = {self.countersunk_mm:g} and "
                f"nut_mm = {self.nut_mm:g} given, more than the coarse hole's {coarse:g} is needed"
            )
        return self

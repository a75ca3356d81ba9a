"""`WorkStep`: a step of the work, as the notes and the manual have it."""

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class WorkStep:
    """Its heading, and what to do."""

    title: str
    text: str
    """In Markdown."""
    drawings: tuple[tuple[str, str], ...] = ()
    """Path of each below the output folder, and its caption."""

    def note(self) -> str:
        """For a note, which has no drawings."""
        return f"## {self.title}\n\n{self.text}"

    def section(self) -> str:
        """For the manual, which keeps a step on one page where it fits."""
        shown = "\n".join(f"![{caption}]({path})" for path, caption in self.drawings)
        return "\n\n".join(filter(None, [f"## #. {self.title}", shown, self.text]))


def numbered(work: Iterable[str]) -> str:
    """A numbered list in Markdown."""
    return "\n".join(f"{n}. {text}" for n, text in enumerate(work, 1))

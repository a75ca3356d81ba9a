"""`WorkStep`: a step of the work, as the notes and the manual have it."""

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

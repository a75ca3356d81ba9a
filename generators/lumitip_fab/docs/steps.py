"""`WorkStep`: a step of the work, as the notes and the manual have it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class WorkStep:
    """Its heading, and what to do."""

    title: str
    text: str
    """In Markdown."""
    picture: str = ""
    """Path of a drawing below the output folder; empty without one."""
    caption: str = ""
    """Of the drawing."""

    def note(self) -> str:
        """For a note, which has no pictures."""
        return f"## {self.title}\n\n{self.text}"

    def page(self) -> str:
        """For the manual, where each step begins a page."""
        shown = f"![{self.caption}]({self.picture})\n\n" if self.picture else ""
        return f"## #. {self.title}\n\n{shown}{self.text}"

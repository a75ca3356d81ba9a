"""Entries of a PDF that act or carry files: JavaScript, actions, attachments, forms, notes."""

from collections.abc import Iterator

import pikepdf

_DOCUMENT = frozenset(("/Type", "/Pages", "/PageMode", "/PageLayout", "/Lang", "/Metadata"))
_PAGE = frozenset(("/Type", "/Parent", "/Contents", "/Resources", "/MediaBox", "/Rotate", "/Trans"))
"""Entries that a document and a page may have; all else is reached from others, or scales and trims
the page."""


def require_plain(pdf: pikepdf.Pdf) -> None:
    """Accept a PDF that has pages to print and nothing else.

    Raises:
        ValueError: if there is more.
    """
    if more := sorted(_more(pdf)):
        raise ValueError(f"has {', '.join(more)} beside plain pages")


def _more(pdf: pikepdf.Pdf) -> Iterator[str]:
    yield from {str(key) for key in pdf.Root.keys()} - _DOCUMENT  # noqa: SIM118
    for page in pdf.pages:
        yield from {str(key) for key in page.keys()} - _PAGE  # noqa: SIM118

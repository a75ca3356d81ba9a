"""A page as a printer puts it on paper: drawn by pdfium, in grey."""

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pikepdf
import pypdfium2
from numpy.typing import NDArray

from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.mask_page import MM, PageError, Points

Grey = NDArray[np.uint8]

DPI = 600
LARGEST_MM = 500.0
"""Longest side of a page that is drawn: a damaged one may need all memory."""


@dataclass(frozen=True)
class Word:
    """A text of a page with the middle of its box (mm)."""

    text: str
    middle_mm: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Picture:
    """A page, or a part of it, in pixels."""

    grey: Grey
    """Rows from the top; 0 is black and 255 the bare paper."""
    pixel_mm: Points
    """Width and height of a pixel, shape `(2,)`."""
    corner_mm: Points
    """Lower left corner on the page (y up), shape `(2,)`."""
    words: tuple[Word, ...] = ()

    @property
    def size_mm(self) -> Points:
        """Width and height, shape `(2,)`."""
        return self.pixel_mm * self.grey.shape[::-1]

    @cached_property
    def ink(self) -> Points:
        """Share of each pixel that is black."""
        return np.float32(1) - self.grey / np.float32(255)

    @property
    def ink_middle_mm(self) -> Points:
        """Its centroid on the page, shape `(2,)`.

        Raises:
            ZeroDivisionError: if there is none.
        """
        row, column = (
            np.average(np.arange(n) + 0.5, weights=self.ink.sum(axis=1 - axis))
            for axis, n in enumerate(self.grey.shape)
        )
        middle: Points = self.points(np.array([[column, row]]))[0]
        return middle

    def pixels(self, points: Points) -> Points:
        """Column and row of points on the page (mm), shape `(n, 2)`; whole numbers are corners of
        pixels."""
        across, up = ((points - self.corner_mm) / self.pixel_mm).T
        return np.stack([across, len(self.grey) - up], axis=1)

    def points(self, pixels: Points) -> Points:
        """Points on the page (mm) of columns and rows, shape `(n, 2)`."""
        column, row = np.asarray(pixels, dtype=np.float64).T
        return np.stack([column, len(self.grey) - row], axis=1) * self.pixel_mm + self.corner_mm

    def part(self, low: Points, high: Points) -> "Picture":
        """The pixels between two corners of a box on the page (mm), or what there is of them."""
        (left, below), (right, above) = self.pixels(np.array([low, high]))
        height, width = self.grey.shape
        first, last = max(int(left), 0), min(int(right) + 1, width)
        top, bottom = max(int(above), 0), min(int(below) + 1, height)
        corner = self.points(np.array([[first, bottom]]))[0]
        return Picture(self.grey[top:bottom, first:last], self.pixel_mm, corner)


def page_pictures(path: Path) -> tuple[Picture, Picture]:
    """The only page of a PDF as it is printed and as a screen shows it, with all that a reader
    applies: page boxes, rotation, user unit, layers, transparency and annotations.

    Raises:
        PageError: if the file is missing or damaged, or has not one page of a usual size.
    """
    try:
        with pikepdf.open(path) as pdf:
            unit_mm = MM * float(pdf.pages[0].obj.get("/UserUnit", 1))
        printed, shown = pictures_of(path.read_bytes(), unit_mm, "print", None)
    except FileNotFoundError as error:
        raise PageError("no such file") from error
    except (OSError, pikepdf.PdfError, *MALFORMED) as error:
        raise PageError(f"cannot be drawn: {error!r:.200}") from error
    return printed, shown


def pictures_of(pdf: bytes, unit_mm: float, *modes: str | None) -> Iterator[Picture]:
    """Draw the only page of a PDF, for each of pdfium's modes.

    Raises:
        PageError: if it has not one page, or one that is too large.
        RuntimeError: if it is damaged.
    """
    with closing(pypdfium2.PdfDocument(pdf)) as document:
        if len(document) != 1:
            raise PageError(f"{len(document)} pages, one is needed")
        page = document[0]
        size_mm = np.array(page.get_size()) * unit_mm
        if not 0 < size_mm.min() <= size_mm.max() <= LARGEST_MM:
            raise PageError(f"its page is {size_mm[0]:.4g} x {size_mm[1]:.4g} mm")
        words = tuple(_words(page, unit_mm))
        for mode in modes:
            grey = _drawn(page, unit_mm, mode)
            yield Picture(grey, size_mm / grey.shape[::-1], np.zeros(2), words)


def _drawn(page: pypdfium2.PdfPage, unit_mm: float, mode: str | None) -> Grey:
    bitmap = page.render(scale=unit_mm / 25.4 * DPI, grayscale=True, optimize_mode=mode)
    return np.array(bitmap.to_numpy())


def _words(page: pypdfium2.PdfPage, unit_mm: float) -> Iterator[Word]:
    text = page.get_textpage()
    for index in range(text.count_rects()):
        left, low, right, high = text.get_rect(index)
        word = text.get_text_bounded(left, low, right, high)
        middle = (left + right) / 2 * unit_mm, (low + high) / 2 * unit_mm
        yield Word(word.strip(), middle)

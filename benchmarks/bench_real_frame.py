"""The three published frames by both methods: a cloth edge, the corner of a cloth, a cable of 3 mm.

Known of the objects are 90° of the corner and 3 mm of the cable; the estimator expects both, as
priors, so the table of the cable has other expected diameters too.

Edge and cable: whether both methods agree. The publication states no error of its method. It is
computed with the twin: simulated objects for which the method draws a line in the same place have a
known true pose, and their mean and deviation are bias and uncertainty of the method. The
fingertips differ from the expected one as in the other benchmarks, with a gap from 2 to 5 mm, since
that of these grasps is not published. Both methods agree if they are apart by two combined standard
deviations at most (95 %), in offset and in angle. For the edge this is a goal, whatever gap the
estimator assumes. Its fits of corner and cable may miss the truth, but not without a flag.

Run by `make bench`; exits 1 if a goal is missed.
"""

import sys
from dataclasses import dataclass

import numpy as np

from common import Goals, on_one_core
from lumitip.estimation import Estimate, PoseEstimator
from lumitip.grid import Floats
from lumitip.layout import Layout
from lumitip.links.twin import published_layout
from lumitip.processing import Processor
from lumitip.twin import Cable, HalfPlane, Scene
from poses import Line, Method, published, read, wrong_twin
from real_frames import KINDS, Tried, by_diameter, by_gap, deviation, real_frame

ANY_GAP_MM = (2.0, 5.0)
AROUND_MM, AROUND_DEG = 1.5, 10.0  # range of the simulated objects around the drawn line
ALIKE_MM, ALIKE_DEG = 0.3, 1.0  # largest difference of two lines in the same place
FINGERS, OBJECTS = 40, 8000
AGREE = 2.0  # combined standard deviations, beyond which 5 % lie
DIAMETER_MM = 3.0  # of the cable
OPENING_DEG, WIDTH_MM = 10.0, 0.3  # errors of corner and cable beyond which an estimate is wrong


@dataclass(frozen=True)
class Stated:
    """A line and its standard deviations: offset (mm), angle (degrees)."""

    line: Floats
    deviation: Floats

    def __str__(self) -> str:
        (offset, angle), (offset_sd, angle_sd) = self.line, self.deviation
        return f"{offset:+.2f} ± {offset_sd:.2f} mm, {angle:.1f} ± {angle_sd:.1f}°"

    def apart(self, other: "Stated") -> float:
        """Distance in combined standard deviations: the larger of offset and angle."""
        away = np.abs(self.line - other.line) / np.hypot(self.deviation, other.deviation)
        return float(away.max())


def stated_by(method: Method, layout: Layout, kind: str, drawn: Line) -> tuple[Stated, int]:
    """True place of the objects for which a method draws a line, and their number."""
    chance, found = np.random.default_rng(5), []
    for seed in range(FINGERS):
        twin = wrong_twin(layout, seed, ANY_GAP_MM)
        for _ in range(OBJECTS // FINGERS):
            true = np.array(drawn) + (AROUND_MM, AROUND_DEG) * chance.uniform(-1.0, 1.0, 2)
            again = method(read(twin, placed(kind, true), chance), kind)
            if again and np.all(np.abs(np.subtract(again, drawn)) < (ALIKE_MM, ALIKE_DEG)):
                found.append(true)
    return Stated(np.mean(found, axis=0), np.std(found, axis=0)), len(found)


def placed(kind: str, true: Floats) -> Scene:
    """A cable along a line, or a sheet to the left of it."""
    if kind == "cable":
        return Cable(offset_mm=true[0], angle_deg=true[1])
    return HalfPlane(offset_mm=-true[0], angle_deg=true[1] + 180.0)


def without_single_cells_deg(layout: Layout, gap_mm: float, values: Floats) -> float:
    """Deviation of the angle by the jackknife: each cell left out in turn."""
    estimator, cells = PoseEstimator(layout, gap_mm=gap_mm), range(len(values))
    estimates = [
        estimator(np.where(np.arange(len(values)) == c, np.nan, values), "edge") for c in cells
    ]
    return float(np.sqrt((len(values) - 1.0) * np.var([t.angle_deg for t in estimates])))


def line_of(estimate: Estimate) -> Stated:
    """The line of an estimate with its stated errors."""
    return Stated(
        np.array([estimate.offset_mm, estimate.angle_deg]),
        np.array([estimate.offset_sd_mm, estimate.angle_sd_deg]),
    )


def yardstick(layout: Layout, name: str) -> Stated:
    """Print the line that the published method draws in a frame; where the truth is then."""
    method, kind = published(layout), KINDS[name]
    drawn = method(real_frame(name), kind)
    assert drawn is not None
    stated, many = stated_by(method, layout, kind, drawn)
    print(f"  published method draws {drawn[0]:+.2f} mm, {drawn[1]:.1f}°")
    print(f"  {many} simulated objects that it draws there lie at {stated}")
    return stated


def edge(layout: Layout, goals: Goals) -> None:
    """The cloth edge."""
    print("cloth edge")
    stated = yardstick(layout, "cloth_edge")
    for tried in by_gap(layout, "cloth_edge"):
        gap_mm = float(tried.assumed.split()[1])
        alone_deg = without_single_cells_deg(layout, gap_mm, real_frame("cloth_edge"))
        line = line_of(tried.estimate)
        apart = line.apart(stated)
        print(
            f"  {tried.assumed}: {line} (± {alone_deg:.1f}° by jackknife), {fit(tried)}; "
            f"{apart:.1f} combined deviations from the published method"
        )
        name = f"edge by both methods, {tried.assumed}"
        goals.at_most(name, apart, AGREE, "combined deviations apart")


def corner(layout: Layout, goals: Goals) -> None:
    """The corner of a cloth, which has 90°."""
    print("cloth corner: 90°, expected ± 12° by the estimator")
    drawn = Processor(layout)(real_frame("cloth_corner")).corner
    assert drawn is not None
    wrong = 0
    print(f"  published method: vertex {place(drawn.vertex_mm)}, opening {drawn.opening_deg:.1f}°")
    for tried in by_gap(layout, "cloth_corner"):
        found = tried.estimate
        assert found.vertex_mm is not None
        print(
            f"  {tried.assumed}: vertex {place(found.vertex_mm)}, opening "
            f"{found.opening_deg:.1f}°, border {line_of(found)}, {fit(tried)}"
        )
        wrong += found.trusted and abs(found.opening_deg - 90.0) > OPENING_DEG
    goals.at_most("corners with a wrong opening and without a flag", wrong, 0)


def cable(layout: Layout, goals: Goals) -> None:
    """The cable of 3 mm."""
    print("cable: 3 mm, expected ± 10 % by the estimator")
    drawn = Processor(layout)(real_frame("cable")).cable
    assert drawn is not None
    stated = yardstick(layout, "cable")
    print(f"  published method: {drawn.width_mm:.1f} mm between the borders that it draws")
    wrong = 0
    for tried in (*by_gap(layout, "cable"), *by_diameter(layout)):
        found = tried.estimate
        print(f"  {of_cable(tried, stated)}")
        wrong += found.trusted and abs(found.width_mm - DIAMETER_MM) > WIDTH_MM
    goals.at_most("cables with a wrong width and without a flag", wrong, 0)


def of_cable(tried: Tried, stated: Stated) -> str:
    """Line and width of an estimate of the cable."""
    found, line = tried.estimate, line_of(tried.estimate)
    return (
        f"{tried.assumed}: {line}, width {found.width_mm:.1f} ± {deviation(found, 'width_mm'):.1f} "
        f"mm, {fit(tried)}; {line.apart(stated):.1f} combined deviations from the published method"
    )


def fit(tried: Tried) -> str:
    """Misfit of an estimate, and its flags."""
    return " ".join([f"misfit {tried.estimate.rms_counts:.1f} counts", *tried.estimate.flags])


def place(point_mm: tuple[float, float]) -> str:
    """A point, for a line of the report."""
    return f"{point_mm[0]:+.1f}, {point_mm[1]:+.1f} mm"


def main() -> int:
    """Both methods on the three frames; the exit code."""
    layout, goals = published_layout(), Goals()
    print("the published frames (measured on hardware), gaps not published")
    edge(layout, goals)
    corner(layout, goals)
    cable(layout, goals)
    return goals.exit_code()


if __name__ == "__main__":
    on_one_core()
    sys.exit(main())

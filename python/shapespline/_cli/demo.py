# SPDX-License-Identifier: MIT OR Apache-2.0

"""The demo: real data, what the C² cubic spline does to their shape, and what mends it."""

from __future__ import annotations

import time
from dataclasses import dataclass
from importlib import resources
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from shapespline import FairSpline, NuSpline, Tangents, fit, plot
from shapespline._cli.progress import progress
from shapespline._methods import METHODS
from shapespline.plot._style import STYLE

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from shapespline import ShapeReport, SpaceCurve

    Floats = NDArray[np.float64]

CUBIC = "#c8442f"


@dataclass(frozen=True)
class DataSet:
    """Points with their parameters and ends."""

    name: str
    file: str
    source: str
    points: Floats
    parameters: str | Floats = "chordal"
    boundary: str | Tangents = "zero-curvature"
    view: tuple[float, float] = (25.0, -60.0)


def _columns(name: str) -> dict[str, Floats]:
    """Return the columns of a data file of this package."""
    text = (resources.files("shapespline") / "data" / f"{name}.csv").read_text(encoding="utf-8")
    header, *rows = [line for line in text.splitlines() if not line.startswith("#")]
    table = np.array([[float(cell) for cell in row.split(",")] for row in rows])
    return dict(zip(header.split(","), table.T, strict=True))


def _points(columns: dict[str, Floats]) -> Floats:
    return np.column_stack([columns[axis] for axis in "xyz"])


def _helix() -> DataSet:
    theta = np.arange(25) * (np.pi / 3)
    points = np.column_stack([np.cos(theta), np.sin(theta), theta])
    # Along the circles through the first and the last three points, 6 long.
    circular = NuSpline(points, boundary="circular").tangents
    start, end = 6 * circular[[0, -1]] / np.linalg.norm(circular[[0, -1]], axis=1)[:, None]
    return DataSet(
        "Helix",
        "helix",
        "25 points, 6 a turn; Karavelas & Kaklis 2000, Example 1",
        points,
        boundary=Tangents(start, end),
        view=(18, -60),
    )


def data_sets() -> list[DataSet]:
    """Return what the demo fits."""
    feature = _columns("gm_feature_line")
    ends = Tangents((-11.038033, 801.759583, -57.116488), (-758.641754, 249.218852, -132.963858))
    return [
        DataSet(
            "GM feature line",
            "feature_line",
            "20 points of a car body; Karavelas & Kaklis 2000, Example 2",
            _points(feature),
            feature["u"],
            ends,
            view=(28, -130),
        ),
        _helix(),
        DataSet(
            "Hiking track",
            "hiking_track",
            "184 GPS points on Mojstrovka with elevation; gpxpy, Apache-2.0",
            _points(_columns("gps_mojstrovka")),
            view=(40, -65),
        ),
        DataSet(
            "Protein backbone",
            "protein_backbone",
            "70 Cα atoms of the HIV capsid's C-terminal domain; wwPDB 1A8O, CC0",
            _points(_columns("protein_1a8o_ca")),
            view=(20, 40),
        ),
    ]


def _table(cubic: ShapeReport, kept: ShapeReport) -> Iterator[str]:
    yield f"  {'violations':<16}{'C² cubic':>10}{'shape-preserving':>18}{'segments asked':>16}"
    after = kept.counts()
    for criterion, (violated, asked) in cubic.counts().items():
        if asked:
            yield f"  {criterion:<16}{violated:>10}{after[criterion][0]:>18}{asked:>16}"


def _measures(curve: SpaceCurve) -> tuple[float, float]:
    """Return ∫κ² ds and the largest curvature."""
    found = curve.fairness()
    return found.bending / found.length, found.max_curvature


def _fit(data: DataSet) -> tuple[NuSpline, FairSpline]:
    """Fit a set both ways and print what a reader wants to compare."""
    print(f"\n{data.name}: {data.source}")
    # The type is wider than the names it can hold: these come from the table above.
    ends = {"boundary": data.boundary}
    cubic = NuSpline(data.points, data.parameters, **ends)  # type: ignore[arg-type]
    with progress("searching for the fairest curve"):
        start = time.perf_counter()
        kept = fit(data.points, data.parameters, **ends)  # type: ignore[call-overload]
        seconds = time.perf_counter() - start
    for line in _table(cubic.check(), kept.check()):
        print(line)
    search = kept.diagnostics
    (energy, largest), (of_cubic, largest_of_cubic) = _measures(kept), _measures(cubic)
    print(
        f"  energy {energy / of_cubic:.3g} × that of the cubic, largest curvature {largest:.3g} "
        f"(the cubic's: {largest_of_cubic:.3g});\n  {search.extra_knots} extra knots, "
        f"{search.iterations} Newton steps, {1e3 * seconds:.1f} ms"
    )
    return cubic, kept


def _window(report: ShapeReport, segments: int, length: int = 20) -> tuple[int, int]:
    """Return the stretch of segments, not longer than can be seen, with the most violations."""
    if segments <= 1.5 * length:
        return 0, segments
    violated = np.bincount([v.segment for v in report.violations], minlength=segments)
    inside = np.convolve(violated, np.ones(length), "valid")
    # In the middle of equals, so that what is wrong is not at the rim.
    best = np.flatnonzero(inside == inside.max())
    first = int(best[len(best) // 2])
    return first, first + length


def _along(c: SpaceCurve, first: float, last: float) -> Floats:
    """Return points along a stretch of the curve."""
    return c(np.linspace(first, last, 2000))


def _bare(ax: Axes, title: str, aspect: float = 1.0) -> None:
    """Show shapes only: one scale, no axes."""
    ax.set_title(title)
    ax.set_aspect(aspect, adjustable="datalim")
    ax.margins(0.06)
    ax.set_axis_off()


def _whole(ax: Axes, data: DataSet, kept: SpaceCurve, shown: tuple[float, float]) -> None:
    """Draw the curve in parallel projection, from the elevation and azimuth of its view."""
    elevation, azimuth = np.radians(data.view)
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    away = np.cos(elevation) * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    away[2] = np.sin(elevation)
    plane = np.column_stack([right, np.cross(away, right)])
    width, height = np.ptp(kept.points @ plane, axis=0)
    if height > 1.5 * width:  # lay it down: the panel is wide
        plane = plane[:, ::-1]
    u = kept.parameters
    title = "The whole curve"
    ax.plot(*(kept.points @ plane).T, linestyle="", marker="o", markersize=2, color=plot.DATA)
    ax.plot(*(_along(kept, u[0], u[-1]) @ plane).T, color=plot.CURVE, linewidth=1)
    if shown != (u[0], u[-1]):
        ax.plot(*(_along(kept, *shown) @ plane).T, color=plot.CURVE, linewidth=2.8)
        title += " (bold: what the right shows)"
    _bare(ax, title)


def _close_up(ax: Axes, cubic: SpaceCurve, kept: SpaceCurve, shown: tuple[float, float]) -> None:
    """Draw the place where the two curves differ most, in the plane where it is seen best."""
    u = kept.parameters
    t = np.linspace(*shown, 4000)
    apart = cubic(t) - kept(t)
    distance = np.linalg.norm(apart, axis=1)
    worst = int(distance.argmax())
    middle = int(np.clip(np.searchsorted(u, t[worst]) - 1, 0, len(u) - 2))
    first, last = max(middle - 1, 0), min(middle + 2, len(u) - 1)

    near = kept.points[first : last + 1]
    along = near[-1] - near[0]
    along /= np.linalg.norm(along)
    across = apart[worst] - (apart[worst] @ along) * along
    across /= np.linalg.norm(across) or 1.0
    plane = np.column_stack([along, across])
    # A difference that the eye would miss is stretched, by a number that the title tells.
    wanted = 0.25 * np.ptp(near @ along) / distance[worst]
    stretch = max((k for k in (1, 2, 5, 10, 20, 50, 100) if k <= wanted), default=1)
    ax.plot(*(near @ plane).T, color=plot.DATA, linewidth=0.8, marker="o", markersize=4)
    ax.plot(*(_along(kept, u[first], u[last]) @ plane).T, color=plot.CURVE, linewidth=1.8)
    bad = _along(cubic, u[first], u[last]) @ plane
    ax.plot(*bad.T, color=CUBIC, linewidth=1.4, linestyle="--")
    title = "Close-up: where the two differ most"
    _bare(ax, title + (f" (height ×{stretch})" if stretch > 1 else ""), stretch)


def _draw(data: DataSet, cubic: SpaceCurve, kept: SpaceCurve) -> Figure:
    figure = Figure(figsize=(11, 6), layout="constrained")
    figure.suptitle(f"{data.name}: {data.source}", x=0.008, ha="left", fontsize=12)
    areas = figure.add_gridspec(2, 2, width_ratios=[1, 1.5])
    report = cubic.check()
    u = kept.parameters
    first, last = _window(report, len(u) - 1)
    shown = (float(u[first]), float(u[last]))

    _whole(figure.add_subplot(areas[0, 0]), data, kept, shown)
    _close_up(figure.add_subplot(areas[1, 0]), cubic, kept, shown)

    over = figure.add_subplot(areas[0, 1])
    plot.torsion(cubic, ax=over, color=CUBIC, linestyle="--", data=False, label="C² cubic spline")
    plot.torsion(kept, ax=over, label="FairSpline, which keeps the shape")
    below = figure.add_subplot(areas[1, 1], sharex=over)
    plot.curvature(cubic, ax=below, color=CUBIC, linestyle="--", data=False)
    plot.curvature(kept, ax=below)
    wrong = sorted({v.segment for v in report.violations if first <= v.segment < last})
    for ax in (over, below):
        for k, segment in enumerate(wrong):
            label = "the C² cubic violates a criterion" if k == 0 else None
            ax.axvspan(*u[segment : segment + 2], color=CUBIC, alpha=0.1, lw=0, label=label)

    # What decides is the sign of torsion: spikes may leave the picture.
    inside = np.linspace(*shown, 4000)
    data_torsion = np.abs(kept._discrete_torsion()[first:last])
    top = 2.2 * float(np.nanmax(data_torsion))
    over.set(title="Torsion must have the sign of the data's", xlabel="", ylim=(-top, top))
    kappa = kept.curvature(inside)
    below.set(title="Curvature", xlim=shown, ylim=(0, 1.4 * float(np.nanquantile(kappa, 0.97))))
    handles, labels = over.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower right", ncols=4)
    return figure


def _families() -> tuple[list[str], bool]:
    """Fit every set with every family; return a table, and whether all shapes are kept."""
    families = [method.family.__name__ for method in METHODS.values()]
    lines = [" " * 18 + "".join(f"{name:>22}" for name in ("C² cubic", *families))]
    everything_kept = True
    for data in data_sets():
        options: dict[str, Any] = {"parameters": data.parameters, "boundary": data.boundary}
        cubic = NuSpline(data.points, **options)
        cell = f"{len(cubic.check().violations)}, κ {_measures(cubic)[1]:.2g}"
        line = f"  {data.name:<16}{cell:>22}"
        for method in METHODS:
            start = time.perf_counter()
            kept = fit(data.points, method=method, **options)  # type: ignore[call-overload]
            seconds = time.perf_counter() - start
            left = len(kept.check().violations)
            everything_kept &= left == 0
            cell = f"{left}, κ {_measures(kept)[1]:.2g}, {1e3 * seconds:.1f} ms"
            line += f"{cell:>22}"
        lines.append(line)
    return lines, everything_kept


def run(out: Path) -> int:
    """Fit and draw every set; return the exit status."""
    print("What interpolation does to the shape of data: violated criteria, segment by segment.")
    everything_kept = True
    with mpl.rc_context(STYLE):
        for data in data_sets():
            cubic, kept = _fit(data)
            everything_kept &= kept.check().ok
            path = out / f"{data.file}.png"
            with progress("drawing"):
                _draw(data, cubic, kept).savefig(path, dpi=150)
            print(f"  drawn to {path}")
    print("\nThe same with every family: violations left, largest curvature κ, and the time taken.")
    lines, all_kept = _families()
    print("\n".join(lines))
    return 0 if everything_kept and all_kept else 1

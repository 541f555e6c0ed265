"""The demo: real data, what the C² cubic spline does to their shape, and what mends it."""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import resources
from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from shapespline import NuSpline, Tangents, plot

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from shapespline import ShapeReport, SpaceCurve

    Floats = NDArray[np.float64]

CUBIC = "#c8442f"
STYLE = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#606770",
    "axes.labelcolor": "#404650",
    "xtick.color": "#606770",
    "ytick.color": "#606770",
    "legend.frameon": False,
}


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


@contextmanager
def _progress(text: str) -> Iterator[None]:
    """Say what is going on, where somebody is looking; the line goes when it is done."""
    shown = sys.stderr.isatty()
    if shown:
        print(f"  {text} …", end="", file=sys.stderr, flush=True)
    try:
        yield
    finally:
        if shown:
            print(f"\r{' ' * (len(text) + 4)}\r", end="", file=sys.stderr, flush=True)


def _table(cubic: ShapeReport, kept: ShapeReport) -> Iterator[str]:
    yield f"  {'violations':<16}{'C² cubic':>10}{'shape-preserving':>18}{'segments asked':>16}"
    after = kept.counts()
    for criterion, (violated, asked) in cubic.counts().items():
        if asked:
            yield f"  {criterion:<16}{violated:>10}{after[criterion][0]:>18}{asked:>16}"


def _fit(data: DataSet) -> tuple[NuSpline, NuSpline]:
    """Fit a set both ways and print what a reader wants to compare."""
    print(f"\n{data.name}: {data.source}")
    # The type is wider than the names it can hold: these come from the table above.
    ends = {"boundary": data.boundary}
    cubic = NuSpline(data.points, data.parameters, **ends)  # type: ignore[arg-type]
    with _progress("searching for tension"):
        start = time.perf_counter()
        kept = NuSpline.shape_preserving(data.points, data.parameters, **ends)  # type: ignore[arg-type]
        seconds = time.perf_counter() - start
    for line in _table(cubic.check(), kept.check()):
        print(line)
    search = kept.diagnostics
    assert search is not None
    print(
        f"  tension up to {kept.tension.max():.3g} at {search.nodes_changed} of "
        f"{len(kept.tension)} points; {search.iterations} iterations, {search.solves} solves, "
        f"{1e3 * seconds:.1f} ms"
    )
    return cubic, kept


def _equal_scales(ax: Axes, points: Floats) -> None:
    """Give the three axes one scale, and leave the box without ticks that nobody reads."""
    low, high = points.min(axis=0), points.max(axis=0)
    middle, size = (low + high) / 2, np.maximum(high - low, 0.25 * (high - low).max())
    limits = zip("xyz", middle - 0.52 * size, middle + 0.52 * size, strict=True)
    ax.set(**{f"{axis}lim": (a, b) for axis, a, b in limits})
    ax.set_box_aspect(size, zoom=1.25)  # type: ignore[call-arg, arg-type]
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):  # type: ignore[attr-defined]
        axis.set_ticklabels([])
        axis.set_tick_params(length=0)
        axis.set_pane_color("#f6f7f9")
        axis._axinfo["grid"].update(color="#e3e6ea", linewidth=0.6)


def _draw(data: DataSet, cubic: SpaceCurve, kept: SpaceCurve) -> Figure:
    figure = Figure(figsize=(11, 5.6), layout="constrained")
    figure.suptitle(
        f"{data.name} — {data.source}", x=0.01, ha="left", fontsize=11, fontweight="bold"
    )
    areas = figure.add_gridspec(2, 2, width_ratios=[1, 1.25])
    space = figure.add_subplot(areas[:, 0], projection="3d")
    plot.curve(kept, ax=space, label="shape-preserving ν-spline")
    plot.curve(cubic, ax=space, points=False, color=CUBIC, linestyle="--", label="C² cubic spline")
    space.view_init(*data.view)
    _equal_scales(space, data.points)
    space.legend(loc="lower left", bbox_to_anchor=(0.0, -0.02))

    over = figure.add_subplot(areas[0, 1])
    plot.torsion(cubic, ax=over, color=CUBIC, linestyle="--", data=False)
    plot.torsion(kept, ax=over)
    over.set(title="Torsion: must have the sign of the data's", xlabel="")
    over.legend(loc="best")
    below = figure.add_subplot(areas[1, 1], sharex=over)
    plot.curvature(cubic, ax=below, color=CUBIC, linestyle="--")
    plot.curvature(kept, ax=below)
    below.set(title="Curvature")
    return figure


def run(out: Path) -> int:
    """Fit and draw every set; return the exit status."""
    print("What interpolation does to the shape of data: violated criteria, segment by segment.")
    everything_kept = True
    with mpl.rc_context(STYLE):
        for data in data_sets():
            cubic, kept = _fit(data)
            everything_kept &= kept.check().ok
            path = out / f"{data.file}.png"
            with _progress("drawing"):
                _draw(data, cubic, kept).savefig(path, dpi=150)
            print(f"  drawn to {path}")
    return 0 if everything_kept else 1

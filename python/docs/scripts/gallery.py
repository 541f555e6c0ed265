# SPDX-License-Identifier: MIT OR Apache-2.0

"""Draw the figures of the papers again: python python/docs/scripts/gallery.py [DIR].

The page python/docs/gallery.md describes each figure, so that it can be held beside the original.
Dashed is the classical spline, solid the shape-preserving one, as in the papers.
"""

import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.interpolate import BPoly

import shapespline as ss
from shapespline.plot._style import STYLE

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests"))
import cases
import polygons

Array = np.ndarray

OUT = ROOT / "python" / "docs" / "images" / "gallery"
CUBIC, KEPT, DATA = ss.plot.WRONG, ss.plot.CURVE, ss.plot.DATA
DASHED = {"color": CUBIC, "linestyle": "--", "linewidth": 1.2, "label": "C² cubic"}
SOLID = {"color": KEPT, "linewidth": 1.5}

FIGURES: dict[str, Callable[[], Figure]] = {}


def figure(name: str) -> Callable[[Callable[[], Figure]], Callable[[], Figure]]:
    """Register a function that draws a figure, under the name of its file."""

    def register(draw: Callable[[], Figure]) -> Callable[[], Figure]:
        FIGURES[name] = draw
        return draw

    return register


def new(width: float = 6.4, height: float = 3.8) -> Figure:
    """Return an empty figure."""
    return Figure(figsize=(width, height), layout="constrained")


def along(c: ss.SpaceCurve, first: float, last: float, count: int = 1200) -> Array:
    """Return parameters inside an interval."""
    return np.linspace(first, last, count + 2)[1:-1]


def pair(case: cases.Case) -> tuple[ss.SpaceCurve, ss.SpaceCurve]:
    """Return the C² cubic and NUSSP's ν-spline, as published."""
    return case.fit(), case.preserve(strategy="nussp", step=0.5)


def looking(elevation: float, azimuth: float) -> Array:
    """Return the matrix that projects space onto the plane seen from a direction, in degrees.

    Matplotlib's own Axes in space leave most of the figure empty around a long and narrow curve.
    """
    e, a = np.radians([elevation, azimuth])
    across = [-np.sin(a), np.cos(a), 0]
    up = [-np.sin(e) * np.cos(a), -np.sin(e) * np.sin(a), np.cos(e)]
    return np.array([across, up]).T


def projected(ax: Axes, c: ss.SpaceCurve, view: Array, **style: object) -> None:
    """Draw a curve in space as it is seen, with its points."""
    u = np.linspace(*c.parameters[[0, -1]], 60 * len(c.points))
    ax.plot(*(c.points @ view).T, color=DATA, linewidth=0.6, marker="o", markersize=3, zorder=1)
    ax.plot(*(c(u) @ view).T, **style)
    ax.set_aspect("equal")
    ax.set_axis_off()


def both_in_space(case: cases.Case, view: Array, size: tuple[float, float]) -> Figure:
    """Draw points, C² cubic and ν-spline in space."""
    drawing = new(*size)
    ax = drawing.add_subplot()
    cubic, kept = pair(case)
    projected(ax, cubic, view, **DASHED)
    projected(ax, kept, view, **SOLID, label="ν-spline")
    drawing.legend(loc="outside lower center", ncols=2)
    return drawing


def both_over_u(case: cases.Case, draw: Callable[..., Axes], top: float) -> Figure:
    """Draw torsion or curvature of both curves over the parameter."""
    drawing = new(8)
    ax = drawing.add_subplot()
    cubic, kept = pair(case)
    draw(cubic, ax=ax, color=CUBIC, linestyle="--", label="C² cubic", data=False, samples=200)
    draw(kept, ax=ax, label="ν-spline", samples=200)
    ax.set_ylim(-top if draw is ss.plot.torsion else 0, top)
    wrong = [v for v in cubic.check().violations if draw is ss.plot.torsion]
    for v in wrong:
        if v.criterion == "torsion":
            ax.axvspan(*cubic.parameters[v.segment : v.segment + 2], color=CUBIC, alpha=0.1, lw=0)
    ax.legend(loc="upper center", ncols=3)
    return drawing


def direction(c: ss.SpaceCurve, u: Array) -> Array:
    """Return the unit vectors along w = Q' × Q''."""
    w = np.cross(c(u, 1), c(u, 2))
    return w / np.linalg.norm(w, axis=1)[:, None]


def unit(vector: Array) -> Array:
    """Return the vector over its length."""
    return vector / np.linalg.norm(vector)


# Karavelas & Kaklis 2000


@figure("001-1")
def helix() -> Figure:
    """Figure 1: the helix."""
    return both_in_space(cases.helix(), looking(20, -70)[:, ::-1], (9, 2.6))


@figure("001-2")
def helix_torsion() -> Figure:
    """Figure 2: torsion of the helix."""
    return both_over_u(cases.helix(), ss.plot.torsion, 2.0)


@figure("001-3")
def helix_curvature() -> Figure:
    """Figure 3: curvature of the helix."""
    return both_over_u(cases.helix(), ss.plot.curvature, 2.5)


@figure("001-4")
def helix_coplanarity() -> Figure:
    """Figure 4: the coplanarity ratio on the first segment."""
    case, drawing = cases.helix(), new()
    ax = drawing.add_subplot()
    # On the first segment the polygon's plane is that of the end tangent and the chord.
    normal = unit(ss.polygon_shape(case.points, boundary=case.boundary).binormals[1])
    for c, style in zip(pair(case), (DASHED, SOLID | {"label": "ν-spline"}), strict=True):
        u = along(c, *c.parameters[:2])
        sine = np.linalg.norm(np.cross(direction(c, u), normal), axis=1)
        ax.plot(u, sine, **style)
    ax.axhline(0.2, color="black", linewidth=0.8)
    ax.text(0.02, 0.205, "ε₁ = 0.2", va="bottom")
    ax.set(xlabel="parameter u in [u₁, u₂]", ylabel="‖w × P‖ / (‖w‖ ‖P‖)", ylim=(0, None))
    ax.margins(x=0)
    ax.legend(loc="upper center")
    return drawing


@figure("001-5")
def feature_line() -> Figure:
    """Figure 5: the industrial line; the two curves can hardly be told apart."""
    return both_in_space(cases.gm_line(), looking(40, -30), (6.4, 4.6))


@figure("001-6")
def feature_torsion() -> Figure:
    """Figure 6: torsion of the industrial line."""
    return both_over_u(cases.gm_line(), ss.plot.torsion, 0.03)


@figure("001-7")
def feature_curvature() -> Figure:
    """Figure 7: curvature of the industrial line."""
    return both_over_u(cases.gm_line(), ss.plot.curvature, 0.006)


@figure("001-8")
def feature_convexity() -> Figure:
    """Figure 8: the convexity ratio on the first segment."""
    case, drawing = cases.gm_line(), new()
    cubic, kept = pair(case)
    convexity_ratio(drawing.add_subplot(), case, [(cubic, DASHED), (kept, SOLID)])
    drawing.axes[0].set_xlabel("parameter u in [u₁, u₂]")
    return drawing


def convexity_ratio(
    ax: Axes, case: cases.Case, curves: list[tuple[ss.SpaceCurve, dict[str, object]]]
) -> None:
    """Draw the cosine of the angle between w and the first binormal vector on the first segment."""
    normal = unit(np.cross(case.boundary.start, case.points[1] - case.points[0]))
    for c, style in curves:
        u = along(c, *c.parameters[:2])
        ax.plot(u, direction(c, u) @ normal, **style)
    ax.axhline(0, color="black", linewidth=0.8)
    ax.set(ylabel="w · P₁ / (‖w‖ ‖P₁‖)", ylim=(-1.05, 1.05))
    ax.margins(x=0)


# Manni 2001


def manni() -> tuple[cases.Case, ss.SpaceCurve, ss.TensionSpline]:
    """Return the data, the C² cubic, and Q: its algorithm with λ halved where a check fails."""
    case = cases.gm_line()
    kept = ss.TensionSpline.shape_preserving(
        case.points, case.parameters, boundary=case.boundary, strategy="reduction", step=0.5
    )
    return case, case.fit(), kept


@figure("000-1")
def manni_curves() -> Figure:
    """Figure 1: the C² cubic on the left, Q on the right."""
    drawing = new(9, 3.4)
    _, cubic, kept = manni()
    shown = [(cubic, DASHED, "C² cubic spline"), (kept, SOLID, "Q, C² tension cubic")]
    for ax, (c, style, title) in zip(drawing.subplots(1, 2), shown, strict=True):
        projected(ax, c, looking(40, -30), **{**style, "linestyle": "-"})
        ax.set_title(title)
    return drawing


@figure("000-2")
def manni_curvature() -> Figure:
    """Figure 2: curvature, and the convexity ratio on the first segment."""
    drawing = new(9, 3.6)
    case, cubic, kept = manni()
    left, right = drawing.subplots(1, 2)
    dotted = DASHED | {"linestyle": ":"}
    ss.plot.curvature(cubic, ax=left, color=CUBIC, linestyle=":", data=False, samples=200)
    ss.plot.curvature(kept, ax=left, data=False, samples=200)
    left.set(title="‖K(s)‖", xlabel="s", ylim=(0, 0.009))
    convexity_ratio(right, case, [(cubic, dotted), (kept, SOLID | {"label": "Q"})])
    right.set(title="Convexity ratio in [σ₀, σ₁]", xlabel="s", ylabel="K · N₀ / ‖K‖")
    right.legend(loc="lower left")
    return drawing


@figure("000-3")
def manni_torsion() -> Figure:
    """Figure 3: torsion with the signs of the data, and what makes Q twice differentiable."""
    drawing = new(9, 3.6)
    _, cubic, kept = manni()
    left, right = drawing.subplots(1, 2)
    ss.plot.torsion(cubic, ax=left, color=CUBIC, linestyle=":", data=False, samples=200)
    ss.plot.torsion(kept, ax=left, data=False, samples=200)
    signs = np.sign(ss.polygon_shape(kept.points, boundary=kept.boundary).torsion)
    ends = kept.parameters
    left.hlines(0.028 * signs, ends[:-1], ends[1:], color="black", linewidth=1)
    left.set(title="Torsion; lines: the sign of the discrete torsion", ylim=(-0.03, 0.03))
    left.set_xlabel("s")
    image = kept.to_ppoly()
    for i, (a, b) in enumerate(zip(image.x, image.x[1:], strict=False)):
        t = np.linspace(a, b, 60)
        t[-1] = np.nextafter(b, a)
        label = "C″(t)" if i == 0 else None
        right.plot(t, image(t, 2)[:, 0], color=CUBIC, linestyle=":", linewidth=1.4, label=label)
    s = np.linspace(*ends[[0, -1]], 2000)
    right.plot(s, kept(s, 2)[:, 0], **SOLID, label="Q″(s)")
    right.set(title="First component of the second derivative", xlabel="t, s")
    right.margins(x=0)
    right.legend(loc="lower left")
    return drawing


# Ng, Kong & Ong


@figure("003-1-6")
def bezier_like() -> Figure:
    """Figures 1 to 6: families of quartics and quintics, one shape parameter growing."""
    drawing = new(9.5, 6)
    axes = drawing.subplots(2, 3, sharex=True)
    t = np.linspace(0, 1, 400)
    # End slopes 3 and 4 as in the paper; a = b = 3 makes them three times the control legs.
    control = [0.0, 1.0, 1.0 - 4 / 3, 1.0]
    shades = mpl.colormaps["viridis"](np.linspace(0, 0.85, 5))
    varied = {
        "α": lambda v: (v, 1.0),
        "β": lambda v: (1.0, v),
        "μ = α = β": lambda v: (v, v),
    }
    for row, degree in zip(axes, (4, 5), strict=True):
        for ax, (name, shape) in zip(row, varied.items(), strict=True):
            ax.plot([0, 1], [0, 1], color=DATA, linestyle="--", marker="o", markersize=4)
            for value, color, mark in zip(
                (0, 1, 3, 8, 20), shades, ("i", "ii", "iii", "iv", "v"), strict=True
            ):
                alpha, beta = map(float, shape(value))
                y = ss.bezier_like(degree, control, t, alpha=alpha, beta=beta)
                ax.plot(t, y, color=color, linewidth=1.3, label=f"({mark}) {value}")
            number = 3 * (degree - 4) + list(varied).index(name) + 1
            ax.set_title(f"{number}: {'quartic' if degree == 4 else 'quintic'}, {name}")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="outside lower center", ncols=5)
    return drawing


#: name → x, y: data with the features that the paper describes of its own.
MONOTONE: dict[str, tuple[Array, Array]] = {
    "rpn14": tuple(polygons.load("rpn14").values()),
    "late jump": (np.array([0.0, 1, 3, 5, 6, 7]), np.array([0, 0.2, 0.4, 0.6, 0.8, 5.8])),
    "steps": (
        np.array([0.0, 1, 2, 3, 5, 7, 8, 9]),
        np.array([0, 0.5, 0.7, 3.7, 4.2, 4.4, 9.4, 9.6]),
    ),
    "stairs": (np.array([0.0, 2, 4, 5, 6, 7, 8]), np.array([0, 0.5, 0.7, 2.7, 2.9, 7.9, 8.1])),
}


def plain_quartic(x: Array, y: Array) -> Callable[[Array], Array]:
    """Return the C¹ quartic with α = β = 3 everywhere, which nothing keeps monotone."""
    slopes = ss.MonotoneQuartic(x, y).slopes
    h = np.diff(x)
    m0, m1 = h * slopes[:-1], h * slopes[1:]
    middle = (y[:-1] + y[1:]) / 2 + 3 * (m0 - m1) / 6
    control = np.stack([y[:-1], y[:-1] + m0 / 4, middle, y[1:] - m1 / 4, y[1:]])
    return BPoly(control, x)


def plain_quintic(x: Array, y: Array) -> Callable[[Array], Array]:
    """Return the C² quintic with the same slopes and least (20), not asked to be monotone.

    The energy of a segment is in spec: (h²/35)[… + h s₀(−30Δ+22d₀+8d₁) + h s₁(30Δ−8d₀−22d₁) +
    h²(3s₀²+s₀s₁+3s₁²)]; its gradient in the second derivatives s is a tridiagonal system.
    """
    d, h = ss.MonotoneQuintic(x, y, slopes="fritsch-butland").slopes, np.diff(x)
    secant = np.diff(y) / h
    diagonal = np.r_[6 * h**4, 0] + np.r_[0, 6 * h**4]
    matrix = np.diag(diagonal) + np.diag(h**4, 1) + np.diag(h**4, -1)
    right = np.r_[h**3 * (30 * secant - 22 * d[:-1] - 8 * d[1:]), 0]
    right -= np.r_[0, h**3 * (30 * secant - 8 * d[:-1] - 22 * d[1:])]
    s = np.linalg.solve(matrix, right)
    return BPoly.from_derivatives(x, np.column_stack([y, d, s]))


def before_and_after(
    name: str, plain: Callable[..., Callable[[Array], Array]], kept: Callable[..., object]
) -> Figure:
    """Draw an interpolant without and with the conditions of monotonicity, falling parts marked."""
    drawing = new(9, 3.4)
    left, right = drawing.subplots(1, 2, sharey=True)
    x, y = MONOTONE[name]
    before = plain(x, y)
    t = np.linspace(x[0], x[-1], 4001)
    for ax, f, style, title in (
        (left, before, {"color": CUBIC}, "(a) without the conditions"),
        (right, kept(x, y), {"color": KEPT}, "(b) monotone"),
    ):
        values = f(t)
        falling = np.r_[np.diff(values) < -1e-9 * np.ptp(y), False]
        ax.fill_between(
            t, 0, 1, where=falling, transform=ax.get_xaxis_transform(), color=CUBIC, alpha=0.15,
            linewidth=0,
        )  # fmt: skip
        ax.plot(t, values, linewidth=1.5, **style)
        ax.plot(x, y, linestyle="", marker="o", color="black", markersize=4)
        ax.set(title=title, xlabel="x")
    return drawing


def quartic(x: Array, y: Array) -> ss.MonotoneQuartic:
    """Return the paper's C¹ monotone quartic."""
    return ss.MonotoneQuartic(x, y, shape=3.0)


def quintic(x: Array, y: Array) -> ss.MonotoneQuintic:
    """Return the paper's C² monotone quintic."""
    return ss.MonotoneQuintic(x, y, slopes="fritsch-butland", energy="parametric")


@figure("003-7")
def quartic_wiggles() -> Figure:
    """Figure 7: a quartic that is not monotone, and one that is."""
    return before_and_after("rpn14", plain_quartic, quartic)


@figure("003-8")
def quartic_dip() -> Figure:
    """Figure 8: a dip in the last segment."""
    return before_and_after("late jump", plain_quartic, quartic)


@figure("003-9")
def quintic_wiggles() -> Figure:
    """Figure 9: a smooth quintic with wiggles."""
    return before_and_after("steps", plain_quintic, quintic)


@figure("003-10")
def quintic_dip() -> Figure:
    """Figure 10: a dip in the last segment, and a fourth one that is not monotone."""
    return before_and_after("stairs", plain_quintic, quintic)


def draw_all(out: Path) -> list[Path]:
    """Draw every figure; return the files."""
    out.mkdir(parents=True, exist_ok=True)
    files = []
    with mpl.rc_context(STYLE):
        for name, draw in FIGURES.items():
            path = out / f"{name}.png"
            draw().savefig(path, dpi=130)
            files.append(path)
    return files


if __name__ == "__main__":
    for file in draw_all(Path(sys.argv[1]) if len(sys.argv) > 1 else OUT):
        print(file)

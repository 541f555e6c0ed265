# SPDX-License-Identifier: MIT OR Apache-2.0

"""From Bézier pieces to a B-spline with no more knots than the smoothness needs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from shapespline._core import FairSpline, PiecewiseBezier

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

#: How far the B-spline may be from a piece, over the size of its control points: some hundred ulp.
ACCURACY = 256 * np.finfo(float).eps
#: Rounds in which breaks give up one derivative each; then they give up all.
ROUNDS = 8


def _sizes(control: Floats) -> Floats:
    """Return how large the coordinates of each piece are: what their rounding is relative to."""
    sizes: Floats = np.abs(control).max(axis=(1, 2))
    return sizes


def _smoothness(control: Floats, widths: Floats) -> NDArray[np.int64]:
    """Return how many derivatives seem to agree at each inner break, at most degree − 1."""
    sizes = _sizes(control)
    size = np.maximum(sizes[:-1], sizes[1:])[:, None]
    # In units of the shorter piece, so that no power of a width overflows.
    shorter = np.minimum(widths[:-1], widths[1:])
    before, after = (shorter / widths[:-1])[:, None], (shorter / widths[1:])[:, None]
    agree = np.ones(len(control) - 1, dtype=bool)
    smooth = np.zeros(len(control) - 1, dtype=np.int64)
    differences = control
    for order in range(control.shape[1] - 1):
        left, right = differences[:-1, -1] * before**order, differences[1:, 0] * after**order
        apart = np.abs(right - left)
        agree &= np.all(apart <= 2**order * ACCURACY * size, axis=1)
        smooth[agree] = order
        differences = np.diff(differences, axis=1)
    return smooth


def _blossoms(control: Floats, breaks: Floats, smooth: NDArray[np.int64]) -> tuple[Floats, Floats]:
    """Return the knots and the control points: the polar forms of pieces at runs of knots."""
    pieces, degree = len(control), control.shape[1] - 1
    times = np.r_[degree + 1, degree - smooth, degree + 1]
    index = np.repeat(np.arange(pieces + 1), times)
    windows = np.lib.stride_tricks.sliding_window_view(index[1:-1], degree)
    first, last = windows[:, 0], windows[:, -1]
    # Of the pieces that a window spans the longest: others would be prolonged further.
    widths = np.diff(breaks)
    piece = np.minimum(first, pieces - 1)
    for step in range(1, degree):
        other = np.minimum(first + step, pieces - 1)
        longer = (first + step < last) & (widths[other] > widths[piece])
        piece = np.where(longer, other, piece)
    points = control[piece]
    for k in range(degree):
        s = ((breaks[windows[:, k]] - breaks[piece]) / widths[piece])[:, None, None]
        # Exact at both ends, where the control point is one of the piece.
        points = (1 - s) * points[:, :-1] + s * points[:, 1:]
    return breaks[index], points[:, 0]


def fewest_knots(control: Floats, breaks: Floats) -> tuple[Floats, Floats]:
    """Return the knots and the control points of polynomial Bézier pieces that meet.

    Where derivatives agree to rounding, and the B-spline proves to be the curve to rounding, an
    inner knot is (degree − derivatives)-fold.
    """
    degree = control.shape[1] - 1
    smooth = _smoothness(control, np.diff(breaks))
    sizes = _sizes(control)
    # What a neighbour's rounding puts into a piece is none of its fault.
    sizes = np.maximum(sizes, np.maximum(np.r_[0, sizes[:-1]], np.r_[sizes[1:], 0]))
    for attempt in range(ROUNDS + 1):
        knots, points = _blossoms(control, breaks, smooth)
        back = PiecewiseBezier.from_bspline(knots, points, degree).control
        wrong = np.abs(back - control).max(axis=(1, 2)) > ACCURACY * sizes
        at = wrong[:-1] | wrong[1:]
        if not np.any(at & (smooth > 0)):
            break
        smooth = np.where(at, np.maximum(smooth - 1, 0) if attempt < ROUNDS else 0, smooth)
    return knots, points


def _fair_smoothness(curve: FairSpline) -> NDArray[np.int64]:
    """Return how many derivatives of a fair curve agree at each knot, the two ends included."""
    return np.where(np.isin(curve.knots, curve.parameters[list(curve.corners)]), 0, 2)


def fair_knots(curve: FairSpline) -> tuple[Floats, Floats]:
    """Return the knots and the control points of a fair curve, whose ends are fourfold.

    It is C² but for its corners by its making, so that nothing has to be compared.
    """
    return _blossoms(curve.bezier, curve.knots, _fair_smoothness(curve)[1:-1])


def of_fair_spline(curve: FairSpline) -> tuple[Floats, Floats]:
    """Return the same, but where a closed curve has no corner at its seam with knots that go on.

    Three knots more on both sides then repeat the others, and the last three control points the
    first.
    """
    smooth = _fair_smoothness(curve)
    if curve.boundary != "periodic" or smooth[0] == 0 or smooth[-1] == 0:
        return fair_knots(curve)
    # Three pieces before and behind, and more turns where one has fewer.
    pieces, knots = len(curve.knots) - 1, curve.knots
    index = np.arange(-3, pieces + 3)
    turns = np.arange(-3, pieces + 4) // pieces
    breaks = knots[np.arange(-3, pieces + 4) % pieces] + turns * (knots[-1] - knots[0])
    breaks[3 : pieces + 4] = knots
    around = smooth[:-1][index[1:] % pieces]
    t, c = _blossoms(curve.bezier[index % pieces], breaks, around)
    first, last = np.searchsorted(t, knots[[0, -1]])
    shape = (last - first + 3, c.shape[1])
    return t[first - 3 : last + 4], np.resize(c[first - 3 : last - 3], shape)

# SPDX-License-Identifier: MIT OR Apache-2.0

"""What fair curves cost, beside the plain cubic and within the times that are promised."""

from collections.abc import Iterator

import numpy as np
from measuring import Line, at_most, best, within

import polygons
import shapespline as ss


def clusters_of(points: np.ndarray) -> int:
    """Return in how many windows the plain cubic fails."""
    segments = np.unique([v.segment for v in ss.NuSpline(points).check().violations])
    return 1 + int((np.diff(segments) > 16).sum())


def fair(count: int) -> Iterator[Line]:
    """Measure curves without violation, a cluster of violated segments, and a hard track."""
    smooth = polygons.helix(count)
    # Its natural ends keep the shape; circular ones would not.
    ours, plain = best(lambda: ss.FairSpline(smooth), lambda: ss.NuSpline(smooth).check())
    what = f"FairSpline where nothing is violated, N = {len(smooth):g}, beside ν and its check"
    yield at_most(what, ours, plain, 2.0)

    # Too short for several threads: one core.
    points = polygons.gentle_track(8000, kinks=0.003)
    clusters = clusters_of(points)
    (mended,) = best(lambda: ss.FairSpline(points), budget=1.0)
    what = f"FairSpline, N = {len(points):g}, a cluster of {clusters} violated ones"
    yield within(what, mended / clusters, 5e-3)
    points = polygons.gentle_track(count, kinks=50 / count)
    (mended,) = best(lambda: ss.FairSpline(points), budget=1.0)
    what = f"FairSpline, N = {len(points):g}, {clusters_of(points)} clusters, all threads"
    yield within(what, mended, 0.2)

    track = polygons.load_points("gps_mojstrovka")
    for energy, limit in (("parametric", 0.3), ("bending", 0.6)):
        (taken,) = best(lambda e=energy: ss.FairSpline(track, energy=e), budget=1.0)
        yield within(f"FairSpline, hiking track, {energy}", taken, limit)
    for family in (ss.NuSpline, ss.TensionSpline):
        fairest, growth = best(
            lambda f=family: f.shape_preserving(track),
            lambda f=family: f.shape_preserving(track, strategy="growth"),
        )
        what = f"{family.__name__}, hiking track, each tension lowered, beside growth alone"
        yield at_most(what, fairest, growth, 5.0)

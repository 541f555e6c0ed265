# SPDX-License-Identifier: MIT OR Apache-2.0

"""What a fit calls preserved stays preserved in every form that it can be exported in.

On chords over six decades: the legs of short segments between far points lose digits when they are
written as control points, and what hangs on those digits has to be undecided, not preserved.
"""

from itertools import chain

import numpy as np
import pytest
from scipy.interpolate import BPoly

import cases
import shapespline as ss
from scale import scaled
from shapespline._cli import files

#: Row C8 of the faults: called preserved once, and violated as a file.
FOUND = np.array(
    [[-149.4151, -136.1778, 251.5883], [-149.4203, -136.1959, 251.5792],
     [-149.4195, -136.1959, 251.5792], [482.9655, -373.2714, 733.8720]]
)  # fmt: skip


def rounded(values, digits=15):
    """Return values as they come back from text of so many digits."""
    return np.array([float(f"{x:.{digits}g}") for x in np.ravel(values)]).reshape(values.shape)


def exports(curve, path):
    """Return the curve in every form it can leave in; all run through the points at its knots."""
    u = curve.knots
    files.write_curve(path, curve)
    ppoly, bspline = curve.to_ppoly(), curve.to_bspline()
    yield "json", files.read_curve(path).curve
    yield "bezier", ss.PiecewiseBezier(curve.bezier, u)
    yield "bpoly", BPoly(curve.bezier.swapaxes(0, 1), u)
    yield "15 digits", ss.PiecewiseBezier(rounded(curve.bezier), u)
    if isinstance(curve, ss.TensionSpline):
        # SciPy's forms are run through in the curve's own parameter; these are their images.
        ppoly, bspline = (ss.PiecewiseBezier(curve.bezier, u),) * 2
    yield "ppoly", ppoly
    yield "bspline", bspline


def uneven(rng, count, dim, decades=6.0):
    """Return a walk whose chords have lengths over some decades."""
    chords = rng.normal(size=(count - 1, dim))
    chords /= np.linalg.norm(chords, axis=1)[:, None]
    chords *= 10 ** rng.uniform(-decades / 2, decades / 2, (count - 1, 1))
    return np.vstack([np.zeros(dim), chords.cumsum(axis=0)]) + rng.normal(size=dim)


def how_many(family):
    # Nearly every segment of a fair curve is searched for here.
    return scaled(150, 25) if family is ss.FairSpline else scaled(3000)


def fits(family, dim, rng):
    """Return shape-preserving curves on uneven chords, with several kinds of ends and options."""
    count = how_many(family)
    ends = ["natural", "circular", "periodic"]
    for k in range(count):
        points = uneven(rng, int(rng.integers(4, 30)), dim)
        end = ends[k % 3]
        parameters = ["chordal", "centripetal", 0.3][k // 3 % 3]
        options = {"closed": True} if end == "periodic" else {"boundary": end}
        try:
            yield cases.preserving(family)(points, parameters, **options)
        except ss.ConvergenceError:
            continue


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("family", cases.FAMILIES)
def test_what_is_preserved_stays_preserved(family, dim, rng, tmp_path):
    found = [cases.preserving(family)(FOUND[:, :dim], p) for p in ("chordal", "uniform")]
    judged = 0
    for curve in chain(found, fits(family, dim, rng)):
        own = curve.check()
        if not own.ok:
            continue
        for name, form in exports(curve, tmp_path / "curve.json"):
            options = curve._fit_options()
            given = {"parameters": curve.parameters, "boundary": curve.boundary, **options}
            report = ss.check_shape(curve.points, form, **given)
            assert report.ok, (name, curve.points.tolist(), report.violations)
        judged += 1
    assert judged > how_many(family) / 2

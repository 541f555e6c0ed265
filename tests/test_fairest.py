# SPDX-License-Identifier: MIT OR Apache-2.0

"""The default strategy returns the fairest curve: no more tension than growth, none to spare."""

from dataclasses import replace

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss
from scale import scaled as how_many

#: those of the families that search
SEARCHED = [
    case
    for case in cases.of_every_family([*cases.shared(), *cases.small()])
    if case.family is not ss.CatmullRom
]


def bending(curve):
    """Return the integral of the squared curvature."""
    measures = ss.fairness(curve)
    return measures.bending / measures.length


@pytest.mark.parametrize("case", [*cases.shared(), *cases.small()], ids=str)
def test_never_more_tension_than_growth(case):
    growth, fairest = case.preserve(strategy="growth"), case.preserve(strategy="fairest")
    assert fairest.tension.sum() <= growth.tension.sum()
    # Lowered one by one: nowhere more, not only in total.
    assert np.all(fairest.tension <= growth.tension * (1 + 1e-12))


@pytest.mark.parametrize("case", SEARCHED, ids=str)
def test_never_bends_more_than_growth(case):
    growth, fairest = case.preserve(strategy="growth"), case.preserve(strategy="fairest")
    assert bending(fairest) <= bending(growth) * (1 + 1e-3)


@pytest.mark.parametrize("case", [*cases.shared(), *cases.small()], ids=str)
def test_no_tension_can_be_lowered_any_more(case):
    """Some per cent less break a criterion; or as little as will do makes the curve bend more."""
    curve = case.preserve()
    tension = curve.tension

    def scaled(node, factor):
        lower = tension.copy()
        lower[node] *= factor
        if case.boundary == "periodic":
            lower[-1] = lower[0]
        return case.fit(tension=lower)

    def keeps(curve):
        # A fit does not accept what rounding hides.
        report = curve.check()
        return report.ok and not report.undecided

    spare = []
    for node in np.flatnonzero(tension > 0):
        if not keeps(scaled(node, 0.96)):
            continue
        breaks, factor = 0.0, 0.96
        if keeps(scaled(node, 0.0)):
            factor = 0.0
        while factor - breaks > 0.01 * factor:
            middle = (breaks + factor) / 2
            if keeps(scaled(node, middle)):
                factor = middle
            else:
                breaks = middle
        if bending(scaled(node, factor)) < bending(curve):
            spare.append((node, factor))
    assert spare == []


def planar(e):
    """Return planar points with a nearly straight triple."""
    points = np.array([(0, 1), (1, 0), (2, 0), (3, e), (4, 3 * e), (5, 1)])
    return cases.Case(f"planar {e}", points)


#: largest curvature and bending, in mean chords, that prototypes of this search reached
REACHED = [
    (ss.TensionSpline, cases.space_set("gps_mojstrovka", "zero-curvature"), 127, 847),
    (ss.TensionSpline, cases.space_set("gps_mojstrovka", "circular"), 127, 847),
    (ss.TensionSpline, cases.space_set("coil_m16n08_first", "periodic"), 0.083, 0.340),
    (ss.TensionSpline, cases.gm_line(), 0.43, 0.124),
    (ss.TensionSpline, planar(1e-2), 1.8, 2.50),
    (ss.TensionSpline, planar(1e-6), 1.9, 2.96),
    (ss.NuSpline, cases.space_set("coil_m16n08_first", "periodic"), 0.11, 0.340),
]


@pytest.mark.parametrize(
    ("family", "case", "curvature", "energy"), REACHED, ids=lambda x: getattr(x, "__name__", str(x))
)
def test_numbers_of_the_prototypes_are_reached(family, case, curvature, energy):
    curve = replace(case, family=family).preserve()
    chord = np.linalg.norm(np.diff(curve.points, axis=0), axis=1).mean()
    assert curve.check().ok
    assert ss.fairness(curve).max_curvature * chord <= 1.1 * curvature
    assert bending(curve) * chord <= 1.1 * energy


def test_default_is_fairest():
    case = cases.gm_line()
    np.testing.assert_array_equal(
        case.preserve().tension, case.preserve(strategy="fairest").tension
    )


def bends(curve):
    fairness = curve.fairness()
    return fairness.bending / fairness.length


SUBSETS = [("convexity", "inflection"), ("torsion",), ("turning", "coplanarity"), ("convexity",)]


@pytest.mark.parametrize("family", [ss.NuSpline, ss.TensionSpline])
@pytest.mark.parametrize("criteria", SUBSETS, ids=str)
def test_fewer_criteria_never_bend_more(family, criteria, rng):
    """Where any tension is needed at all: else the curve is the plain spline."""
    walks = [np.array([[4, 3, 3], [2, 4, -3], [4, -2, -4], [4, 0, -4], [-4, -3, 0.0]])]
    walks += [polygons.random_walk(rng, 12, 2 + k % 2) for k in range(how_many(200))]
    searched = 0
    for points in walks:
        fewer = family.shape_preserving(points, criteria=criteria)
        assert fewer.check().ok
        assert set(fewer._fit_options()["criteria"]) == set(criteria)
        if not fewer.tension.any():
            continue
        searched += 1
        every = family.shape_preserving(points)
        assert bends(fewer) <= bends(every) * (1 + 1e-6)
    assert searched > 3

# SPDX-License-Identifier: MIT OR Apache-2.0

"""The published results of Karavelas & Kaklis 2000, to the last digit they print."""

import numpy as np
import pytest

import cases
import shapespline as ss

# The paper counts nodes and segments from 1.


def from_one(violations) -> set[tuple[str, int]]:
    return {(v.criterion, v.segment + 1) for v in violations}


def test_gm_feature_line_tension():
    curve = cases.gm_line().preserve(strategy="nussp", step=0.5)
    expected = np.zeros(20)
    expected[0:7] = 0.5
    expected[14:18] = 2.0
    np.testing.assert_array_equal(curve.tension, expected)
    assert curve.diagnostics.iterations == 5
    assert curve.check().ok


def test_gm_feature_line_violations_of_the_c2_cubic():
    report = cases.gm_line().fit().check(cases.PAPERS)
    assert not report.ok
    assert from_one(report.violations) == {
        ("torsion", 2),
        ("torsion", 5),
        ("torsion", 16),
        ("convexity", 1),
    }
    assert report.counts()["torsion"] == (3, 19)
    assert report.counts()["convexity"] == (1, 19)


# Nodes counted from each end; the paper does not print the tangents' length, see the spec.
@pytest.mark.parametrize("length", [5.7, 6.0, 6.4])
def test_helix_tension(length):
    curve = cases.helix(length).preserve(strategy="nussp", step=0.5, coplanarity=0.2)
    expected = np.zeros(25)
    expected[:4] = [3.5, 2.0, 3.5, 2.0]
    expected[-4:] = expected[3::-1]
    np.testing.assert_array_equal(curve.tension, expected)
    assert curve.diagnostics.iterations == 8


def test_helix_tension_with_unit_tangents():
    curve = cases.helix(1.0).preserve(strategy="nussp", step=0.5, coplanarity=0.2)
    expected = np.zeros(25)
    expected[[0, 2, 22, 24]] = 0.5
    np.testing.assert_array_equal(curve.tension, expected)


def test_helix_violations_of_the_c2_cubic():
    """The paper names the wrong torsion, the nodes 2 and 24 with a wrong binormal, and the ends."""
    found = from_one(cases.helix().fit().check().violations)
    assert {i for name, i in found if name == "torsion"} == {2, 23}
    assert {i for name, i in found if name == "convexity"} == {1, 2, 23, 24}
    assert {i for name, i in found if name == "coplanarity"} == {1, 24}


def test_history_counts_the_violations_of_every_check():
    curve = cases.gm_line().preserve(strategy="nussp")
    assert len(curve.history) == curve.diagnostics.iterations
    violations = [entry.violations for entry in curve.history]
    assert violations[0] == 4
    assert all(count > 0 for count in violations[:-1])
    assert violations[-1] == 0


def test_an_iteration_less_does_not_converge():
    """NUSSP needs five checks on the GM line: with four it says so, and hands over what it has."""
    case = cases.gm_line()
    assert case.preserve(strategy="nussp", max_iterations=5).check().ok
    with pytest.raises(ss.ConvergenceError, match="4") as caught:
        case.preserve(strategy="nussp", max_iterations=4)
    curve, report = caught.value.curve, caught.value.report
    assert isinstance(curve, ss.NuSpline)
    # Every check but the last raised ν by 0.5 somewhere; nodes 15–18 were raised each time.
    assert curve.tension[15] == 1.5
    assert not report.ok
    assert from_one(report.violations) == from_one(curve.check().violations)

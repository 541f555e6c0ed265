# SPDX-License-Identifier: MIT OR Apache-2.0

"""fit_many: every curve as its class alone makes it, and every fault where it belongs."""

import os
import pickle

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss
import threads
from scale import scaled

CLASSES = {method: family for family, method in cases.METHODS.items()}
every_method = pytest.mark.parametrize("method", CLASSES)


def collection(count=40, seed=5, dim=3):
    """Return the points of all curves and where each begins."""
    rng = np.random.default_rng(seed)
    lengths = rng.integers(2, 60, size=count)
    walks = [polygons.random_walk(rng, n, dim) for n in lengths]
    return np.vstack(walks), np.r_[0, np.cumsum(lengths)]


def count_of(method):
    """Return of how many curves: fair ones take some hundred times as long."""
    return scaled(40, 8) if method == "fair" else 40


def assert_same(a, b):
    assert type(a) is type(b)
    np.testing.assert_array_equal(a.bezier, b.bezier)
    np.testing.assert_array_equal(a.parameters, b.parameters)
    np.testing.assert_array_equal(cases.tension_of(a), cases.tension_of(b))
    assert a.diagnostics == b.diagnostics


@pytest.mark.parametrize("threads", [None, 1, 3])
@pytest.mark.parametrize("dim", [2, 3])
@every_method
def test_each_curve_is_that_of_its_class(method, dim, threads):
    points, offsets = collection(count_of(method), dim=dim)
    fits = ss.fit_many(points, offsets, method=method, threads=threads)
    assert fits.ok
    assert dict(fits.errors) == {}
    assert len(fits) == len(offsets) - 1
    for k, curve in enumerate(fits):
        assert_same(curve, cases.preserving(CLASSES[method])(points[offsets[k] : offsets[k + 1]]))
        assert curve.check().ok


@pytest.mark.parametrize(
    ("method", "options"),
    [
        ("nu", {"strategy": "nussp", "step": 1.0, "boundary": "circular", "coplanarity": 0.1}),
        ("tension", {"strategy": "reduction", "step": 0.7, "criteria": ["torsion", "convexity"]}),
        ("catmull-rom", {"safety": 0.5, "continuity": "G1", "collinearity": 0.1}),
        ("fair", {"energy": "bending", "boundary": "circular", "collinearity": 0.1}),
        ("nu", {"boundary": ss.Tangents([1.0, 0, 0], [0, 1.0, 0]), "parameters": "uniform"}),
    ],
)
def test_options_reach_every_curve(method, options):
    points, offsets = collection(min(12, count_of(method)), seed=9)
    keep = np.diff(offsets) >= 3
    rows = [points[a:b] for a, b in zip(offsets[:-1][keep], offsets[1:][keep], strict=True)]
    points, offsets = np.vstack(rows), np.r_[0, np.cumsum([len(row) for row in rows])]
    fits = ss.fit_many(points, offsets, method=method, **options)
    assert fits.ok, fits.errors
    for row, curve in zip(rows, fits, strict=True):
        assert_same(curve, cases.preserving(CLASSES[method])(row, **options))


@pytest.mark.parametrize(
    ("method", "options"),
    [
        ("nu", {"tension": 2.0}),
        ("nu", {}),
        ("tension", {"tangent_scale": 0.3}),
        ("catmull-rom", {"tension": 0.3, "continuity": "G1"}),
    ],
)
def test_given_tension(method, options):
    points, offsets = collection(8)
    fits = ss.fit_many(
        points, offsets, method=method, parameters="chordal", shape_preserving=False, **options
    )
    for k, curve in enumerate(fits):
        row = points[offsets[k] : offsets[k + 1]]
        assert_same(curve, CLASSES[method](row, "chordal", **options))
        assert curve.diagnostics is None


def test_given_parameters_are_those_of_all_points(rng):
    points, offsets = collection(5)
    u = np.cumsum(rng.uniform(0.1, 2.0, len(points)))
    for k, curve in enumerate(ss.fit_many(points, offsets, parameters=u)):
        np.testing.assert_array_equal(curve.parameters, u[offsets[k] : offsets[k + 1]])


def faulty():
    """Return a collection in which curves 1, 3 and 5 cannot be fitted."""
    points, offsets = collection(8, seed=2)
    points[offsets[1] + 1] = points[offsets[1]]
    points[offsets[3] + 1, 2] = np.nan
    offsets = np.r_[offsets[:6], offsets[5], offsets[6:]]  # a curve without points
    return points, offsets


@every_method
def test_faults_are_those_of_their_curves_alone(method):
    points, offsets = faulty()
    fits = ss.fit_many(points, offsets, method=method)
    assert sorted(fits.errors) == [1, 3, 5]
    assert [k for k, curve in enumerate(fits) if curve is None] == [1, 3, 5]
    assert not fits.ok
    pieces = {1: ["curve 1", "points[1]", "points[0]"], 3: ["curve 3", "points[1", "nan"],
              5: ["curve 5", "points", "0"]}  # fmt: skip
    for k, error in fits.errors.items():
        assert type(error) is ss.InputError
        # A whole curve, or the second point of one.
        assert (error.argument, error.index) == ("points", 5 if k == 5 else (k, 1))
        text = str(error).lower()
        assert [piece for piece in pieces[k] if piece not in text] == [], text
    for k in (0, 2, 4, 6):
        row = points[offsets[k] : offsets[k + 1]]
        assert_same(fits[k], cases.preserving(CLASSES[method])(row))
    with pytest.raises(ValueError, match="curve 1"):
        ss.fit_many(points, offsets, method=method, errors="raise")
    with pytest.raises(TypeError):
        fits.errors[0] = None


@pytest.mark.parametrize("method", ["nu", "tension"])
def test_curves_that_do_not_converge_are_told_with_what_they_have(method):
    points, offsets = collection(10)
    fits = ss.fit_many(points, offsets, method=method, max_iterations=1)
    assert 0 < len(fits.errors) < len(fits)
    for k, curve in enumerate(fits):
        if curve is not None:
            assert curve.check().ok
            continue
        error = fits.errors[k]
        assert isinstance(error, ss.ConvergenceError)
        assert str(error).startswith(f"curve {k}: ")
        assert isinstance(error.curve, CLASSES[method])
        np.testing.assert_array_equal(error.curve.points, points[offsets[k] : offsets[k + 1]])
        assert not error.report.ok
    with pytest.raises(ss.ConvergenceError):
        ss.fit_many(points, offsets, method=method, max_iterations=1, errors="raise")


def test_the_result_is_a_sequence_that_pickles():
    points, offsets = faulty()
    fits = ss.fit_many(points, offsets)
    assert fits[-1] is fits[len(fits) - 1]
    assert fits[2:4] == (fits[2], fits[3])
    with pytest.raises(IndexError):
        fits[99]
    with pytest.raises(AttributeError):
        fits.ok = True
    again = pickle.loads(pickle.dumps(fits))
    assert repr(again) == repr(fits) == "<Fits: 9 curves, 3 of them failed>"
    assert {k: str(e) for k, e in again.errors.items()} == {
        k: str(e) for k, e in fits.errors.items()
    }
    assert_same(again[0], fits[0])


def test_no_curves():
    fits = ss.fit_many(np.empty((0, 3)), [0])
    assert (len(fits), fits.ok) == (0, True)


def long_collection():
    points = np.random.default_rng(0).normal(size=(400_000, 3)).cumsum(axis=0)
    return points, np.arange(0, 400_001, 100)


def test_other_threads_run_meanwhile():
    points, offsets = long_collection()
    # The curves themselves are made under the lock, after all have been fitted.
    threads.assert_others_run(lambda: ss.fit_many(points, offsets, method="catmull-rom"), 0.6)


@pytest.mark.skipif(os.name != "posix", reason="signals to the own process")
@pytest.mark.parametrize("order", ["many", "long first", "long last"])
def test_ctrl_c_ends_it(order):
    """Within a second, whichever thread has a search that takes long."""
    points, offsets = long_collection()
    if order == "many":
        points, offsets = np.tile(points, (5, 1)), np.arange(0, 2_000_001, 100)
    else:
        # One curve has much to search for, two points have nothing.
        points = points[:3002]
        offsets = [0, 3000, 3002] if order == "long first" else [0, 2, 3002]
    options = {"strategy": "nussp", "step": 1e-6, "max_iterations": 10**9}
    threads.assert_ctrl_c_ends(lambda: ss.fit_many(points, offsets, method="nu", **options))

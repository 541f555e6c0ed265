# SPDX-License-Identifier: MIT OR Apache-2.0

"""Curves as Python objects: immutable, picklable, copyable, hashable, shared between threads."""

import copy
import importlib
import pickle
import sys
import weakref
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd
import pytest

import cases
import polygons
import shapespline as ss
import things
import threads


def same(a, b):
    """Compare everything that makes a curve."""
    np.testing.assert_array_equal(a.points, b.points)
    np.testing.assert_array_equal(a.parameters, b.parameters)
    np.testing.assert_array_equal(a.tangents, b.tangents)
    np.testing.assert_array_equal(cases.tension_of(a), cases.tension_of(b))
    np.testing.assert_array_equal(a.knots, b.knots)
    u = np.linspace(a.parameters[0] - 1, a.parameters[-1] + 1, 50)
    for order in range(4):
        np.testing.assert_array_equal(a(u, order), b(u, order))
    if isinstance(a.boundary, ss.Tangents):
        np.testing.assert_array_equal(a.boundary.start, b.boundary.start)
        np.testing.assert_array_equal(a.boundary.end, b.boundary.end)
    else:
        assert a.boundary == b.boundary


@pytest.mark.parametrize("case", cases.of_every_family(cases.small()), ids=str)
def test_pickling(case):
    tense, preserving = case.tense(0.5), case.preserve()
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        for curve in (tense, preserving):
            again = pickle.loads(pickle.dumps(curve, protocol))
            assert type(again) is case.family
            same(curve, again)
            assert again.check().to_dict() == curve.check().to_dict()
        # What the search did is part of what it returned.
        assert again.diagnostics.iterations == curve.diagnostics.iterations
        assert [h.violations for h in again.history] == [h.violations for h in curve.history]


@pytest.mark.parametrize("case", cases.of_every_family(cases.small()), ids=str)
def test_copying(case):
    curve = case.preserve()
    for copied in (copy.copy, copy.deepcopy):
        same(curve, copied(curve))


def test_pickling_the_small_objects():
    tangents = ss.Tangents([1, 2, 3], [4, 5, 6])
    again = pickle.loads(pickle.dumps(tangents))
    np.testing.assert_array_equal(again.start, tangents.start)
    np.testing.assert_array_equal(again.end, tangents.end)
    for one in (ss.Tangents([1, 2]), ss.Tangents(end=[1, 2, 3])):
        again = pickle.loads(pickle.dumps(one))
        assert again == one
        assert hash(again) == hash(one)
        assert (again.start is None, again.end is None) == (one.start is None, one.end is None)
        assert eval(repr(one), {"Tangents": ss.Tangents}) == one
    assert ss.Tangents([1, 2]) != ss.Tangents(end=[1, 2])
    report = cases.gm_line().fit().check()
    again = pickle.loads(pickle.dumps(report))
    assert again.to_dict() == report.to_dict()
    assert str(again) == str(report)


def test_a_failure_can_cross_a_process_boundary():
    with pytest.raises(ss.ConvergenceError) as caught:
        cases.gm_line().preserve(strategy="nussp", max_iterations=2)
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value)
    same(again.curve, caught.value.curve)
    assert again.report.to_dict() == caught.value.report.to_dict()


def test_hash_and_equality_are_identity():
    a, b = cases.gm_line().fit(), cases.gm_line().fit()
    assert a == a
    assert a != b
    assert len({a, b, a}) == 2
    assert {a: 1}[a] == 1


@pytest.mark.parametrize(
    "name", ["points", "parameters", "tangents", "tension", "boundary", "bezier", "anything_else"]
)
def test_attributes_cannot_be_set(name):
    curve = cases.gm_line().fit()
    with pytest.raises(AttributeError):
        setattr(curve, name, 1)


@pytest.mark.parametrize("name", ["points", "parameters", "tangents", "tension", "bezier"])
def test_what_an_attribute_returns_cannot_change_the_curve(name):
    curve = cases.gm_line().preserve()
    before, value = curve(0.3), getattr(curve, name).copy()
    returned = getattr(curve, name)
    if returned.flags.writeable:
        returned[...] = -1.0
    else:
        with pytest.raises(ValueError, match="read-only"):
            returned[...] = -1.0
    np.testing.assert_array_equal(getattr(curve, name), value)
    np.testing.assert_array_equal(curve(0.3), before)


def test_the_curve_does_not_follow_its_input():
    points, u = polygons.helix(), np.arange(25.0)
    tension = np.ones(25)
    curve = ss.NuSpline(points, u, tension=tension)
    before = curve(3.3)
    points += 1.0
    u *= 2.0
    tension *= 3.0
    np.testing.assert_array_equal(curve(3.3), before)
    np.testing.assert_array_equal(curve.points, polygons.helix())


WHOLE = np.array([[0, 0, 1], [3, 1, 0], [4, 4, 2], [8, 3, 3], [9, 0, 1]])


def strided(values):
    wide = np.zeros((2 * len(values), values.shape[1] + 2))
    wide[::2, 1:-1] = values
    return wide[::2, 1:-1]


def read_only(values):
    values = values.astype(float)
    values.flags.writeable = False
    return values


@pytest.mark.parametrize(
    "convert",
    [
        lambda p: p.tolist(),
        lambda p: [tuple(row) for row in p],
        lambda p: p.astype(np.int16),
        lambda p: p.astype(np.uint8),
        lambda p: p.astype(np.float32),
        lambda p: p.astype(np.float16),
        lambda p: p.astype(np.longdouble),
        lambda p: np.asfortranarray(p.astype(float)),
        lambda p: p.astype(float)[::-1][::-1],
        lambda p: p.astype(">f8"),
        strided,
        read_only,
        lambda p: pd.DataFrame(p, columns=list("xyz")),
        lambda p: pd.DataFrame(p.astype(float)),
    ],
    ids=[
        "list", "tuples", "int16", "uint8", "float32", "float16", "longdouble", "fortran",
        "reversed", "big endian", "strided", "read-only", "frame of integers", "frame",
    ],
)  # fmt: skip
def test_every_kind_of_input_gives_the_same_curve(convert):
    expected = ss.NuSpline.shape_preserving(WHOLE.astype(float))
    same(ss.NuSpline.shape_preserving(convert(WHOLE)), expected)
    u = expected.parameters
    frame = pd.DataFrame({"u": u})
    same(ss.NuSpline(WHOLE, frame["u"]), ss.NuSpline(WHOLE, u))
    same(ss.NuSpline(WHOLE, list(u)), ss.NuSpline(WHOLE, u))
    np.testing.assert_array_equal(expected(frame["u"]), expected(u))
    same(ss.NuSpline(WHOLE, tension=frame["u"]), ss.NuSpline(WHOLE, tension=u))
    same(ss.NuSpline(WHOLE, tension=1), ss.NuSpline(WHOLE, tension=np.ones(5, dtype=np.int8)))


def test_threads_share_a_curve_and_fit_their_own():
    case = cases.space_set("gps_mojstrovka", "zero-curvature")
    curve = case.preserve()
    u = np.linspace(*curve.parameters[[0, -1]], 20_000)
    expected = curve(u, 1)

    def work(number):
        np.testing.assert_array_equal(curve(u, 1), expected)
        np.testing.assert_array_equal(case.preserve().tension, curve.tension)
        return number

    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(work, range(32))) == list(range(32))


@pytest.mark.parametrize("work", ["fit", "evaluate"])
def test_long_work_lets_other_threads_run(work):
    points = polygons.gentle_track(600_000)
    curve = ss.NuSpline(points)
    u = np.random.default_rng(1).uniform(*curve.parameters[[0, -1]], 6_000_000)
    task = {
        "fit": lambda: ss.NuSpline.shape_preserving(points),
        "evaluate": lambda: curve(u),
    }[work]
    threads.assert_others_run(task)


# A tuple or an int of Python itself, which knows no weak references, is what they are.
PLAIN = (tuple, int)


@pytest.mark.parametrize(
    "thing",
    [thing for thing in things.everything() if not isinstance(thing, PLAIN)],
    ids=lambda thing: type(thing).__name__,
)
def test_objects_can_be_weakly_referenced(thing):
    assert weakref.ref(thing)() is thing


def attributes():
    """Yield every object with the name of each of its public attributes."""
    for thing in things.everything():
        for name in dir(type(thing)):
            member = getattr(type(thing), name)
            if not name.startswith("_") and not callable(member) and hasattr(thing, name):
                yield pytest.param(thing, name, id=f"{type(thing).__name__}.{name}")
        yield pytest.param(thing, "anything", id=f"{type(thing).__name__}.anything")


@pytest.mark.parametrize(("thing", "name"), list(attributes()))
def test_no_attribute_of_any_object_can_be_set_or_deleted(thing, name):
    with pytest.raises(AttributeError):
        setattr(thing, name, 1)
    with pytest.raises(AttributeError):
        delattr(thing, name)


def test_the_module_can_be_loaded_again():
    again = importlib.reload(ss._core)
    assert again.NuSpline is ss.NuSpline
    np.testing.assert_array_equal(again.NuSpline([[0, 0], [3, 4]])(2.5), [1.5, 2.0])
    del sys.modules["shapespline._core"]
    try:
        fresh = importlib.import_module("shapespline._core")
        np.testing.assert_array_equal(fresh.NuSpline([[0, 0], [3, 4]])(2.5), [1.5, 2.0])
        assert "Evaluate the curve" in fresh.NuSpline.__call__.__doc__
    finally:
        sys.modules["shapespline._core"] = again

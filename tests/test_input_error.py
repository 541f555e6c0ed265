# SPDX-License-Identifier: MIT OR Apache-2.0

"""`InputError` says in attributes what is refused: curves, functions, collections, other curves."""

import pickle

import numpy as np
import pytest

import shapespline as ss

NAN = float("nan")
LINE = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]
RISING = [0.0, 1.0, 2.0]


def own(points=LINE):
    return ss.NuSpline(points)


ERRORS = {
    # what is wrong: (call, argument, index, value)
    "a point": (lambda: own([[0, 0], [1, NAN]]), "points", 1, NAN),
    "a repeated point": (lambda: own([[0, 0], [1, 1], [1, 1]]), "points", 2, (1, 1)),
    "too few points": (lambda: own([[0, 0]]), "points", None, 1),
    "shape of points": (lambda: own(np.eye(4)), "points", None, (4, 4)),
    "a parameter": (lambda: ss.NuSpline(LINE, [0, 2, 1]), "parameters", 2, 1.0),
    "a name": (lambda: ss.NuSpline(LINE, "chord"), "parameters", None, "chord"),
    "an option": (
        lambda: ss.NuSpline.shape_preserving(LINE, coplanarity=2.0),
        "coplanarity",
        None,
        2.0,
    ),
    "a side of λ": (
        lambda: ss.TensionSpline(LINE, tangent_scale=([1, 1], [1, 2])),
        "tangent_scale",
        (1, 1),
        2.0,
    ),
    "a tangent": (lambda: ss.Tangents([0, NAN], [1, 0]), "start", 1, NAN),
    "an order": (lambda: own()(0.5, -1), "nu", None, -1),
    "an entry of an array": (
        lambda: ss.PiecewiseBezier([[[0, 0], [1, NAN]]], [0, 1]),
        "control",
        (0, 1, 1),
        NAN,
    ),
    "a curve of many": (
        lambda: ss.fit_many(LINE + [LINE[2]] * 2, [0, 3, 5], errors="raise"),
        "points",
        (1, 1),
        (2, 0),
    ),
    "an offset": (lambda: ss.fit_many(LINE, [0, 4]), "offsets", 1, 4),
    "a point off the curve": (
        lambda: ss.check_shape([[0, 0], [1, 2], [2, 0]], own(), parameters=own().parameters),
        "points",
        1,
        1.0,
    ),
    "a parameter off the curve": (
        lambda: ss.check_shape(LINE, own(), parameters=[0, 1, 9]),
        "parameters",
        2,
        9.0,
    ),
    "columns of a curve": (lambda: ss.check_shape(np.eye(3), own()), "curve", None, 2),
    "no curve at all": (
        lambda: ss.check_shape(LINE, [[1.0]], parameters=RISING),
        "curve",
        None,
        (1, 1),
    ),
    "an x": (lambda: ss.MonotoneQuintic([0, 1, 1], RISING), "x", 2, 1.0),
    "a y": (lambda: ss.MonotoneQuartic(RISING, [0, 1, NAN]), "y", 2, NAN),
    "a y of a column": (
        lambda: ss.MonotoneQuintic(RISING, [[[0, 0]], [[0, NAN]], [[0, 0]]]),
        "y",
        (1, 0, 1),
        NAN,
    ),
    "a y along another axis": (
        lambda: ss.MonotoneQuintic(RISING, [[0, 0, 0], [1, 2, NAN]], axis=1),
        "y",
        (1, 2),
        NAN,
    ),
    "lengths": (lambda: ss.MonotoneQuintic(RISING, [0, 1]), "y", None, (2,)),
    "slopes": (lambda: ss.MonotoneQuintic(RISING, RISING, slopes=[1, NAN, 1]), "slopes", 1, NAN),
    "an axis": (lambda: ss.MonotoneQuintic(RISING, RISING, axis=3), "axis", None, 3),
    "a row": (
        lambda: ss.fit_many_monotone([RISING, [0, 2, 1]], [RISING, RISING]),
        "x",
        (1, 2),
        1.0,
    ),
    "an extrapolation": (
        lambda: ss.MonotoneQuintic(RISING, RISING)(9, extrapolate="wild"),
        "extrapolate",
        None,
        "wild",
    ),
    "not invertible": (lambda: ss.MonotoneQuintic(RISING, [0, 1, 0]).inverse(0.5), "y", 2, 0.0),
    "a level": (lambda: ss.MonotoneQuintic(RISING, RISING).solve(np.inf), "y", None, np.inf),
    "a huge count": (lambda: own().sample(10**30), "n", None, str(10**30)),
    "a count that Python cannot write": (
        lambda: own().sample(10**5000),
        "n",
        None,
        "a longer one",
    ),
}


@pytest.mark.parametrize("name", ERRORS)
def test_an_error_says_what_is_refused(name):
    call, argument, index, value = ERRORS[name]
    with pytest.raises(ss.InputError) as caught:
        call()
    error = caught.value
    assert isinstance(error, ValueError)
    assert (error.argument, error.index) == (argument, index), str(error)
    np.testing.assert_equal(error.value, value)
    assert len(str(error)) < 300
    assert "\n" not in str(error)
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.argument, again.index) == (str(error), argument, index)
    np.testing.assert_equal(again.value, value)

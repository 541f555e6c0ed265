# SPDX-License-Identifier: MIT OR Apache-2.0

"""SciPy's own tests of PCHIP and Akima, as properties of all families.

`TestPCHIP`, `TestAkima1DInterpolator` and `test_shapes` in scipy/interpolate/tests: axes of size
zero, casts, end slopes (gh-3453), two points (gh-6222), axes; roots (gh-6357) are in
test_monotone_roots.py, extrapolation in test_monotone_extrapolation.py.
"""

import itertools

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

import shapespline as ss
from scale import scaled

FAMILIES = [
    (ss.MonotoneCubic, {}),
    (ss.MonotoneCubic, {"ends": "natural", "layer": 0.0}),
    (ss.MonotoneQuartic, {}),
    (ss.MonotoneQuintic, {}),
    (ss.MonotoneQuintic, {"slopes": "fritsch-butland"}),
]
#: Families whose slopes are Fritsch and Butland's.
SLOPES = [
    (ss.MonotoneQuartic, {}),
    (ss.MonotoneQuartic, {"shape": 3.0}),
    (ss.MonotoneQuintic, {"slopes": "fritsch-butland"}),
]
SHAPES = [(), (0,), (1,), (6, 2, 5), (2, 0, 3)]


@pytest.mark.parametrize(("family", "options"), FAMILIES)
@pytest.mark.parametrize("places", SHAPES)
def test_shapes(rng, family, options, places):
    """Any shape of places and of y, zero sizes included, in values and all of the calculus."""
    x = np.arange(5.0)
    for rest in SHAPES:
        for axis in range(-len(rest) - 1, len(rest) + 1):
            at = axis % (len(rest) + 1)
            y = rng.random((*rest[:at], 5, *rest[at:]))
            f = family(x, y, axis, **options)
            q = rng.uniform(-1, 5, places)
            expected = rest[:at] + places + rest[at:]
            for values in (f(q), f(q, 2), f.derivative()(q), f.antiderivative()(q)):
                assert np.shape(values) == expected
            assert f.y.shape == f.slopes.shape == f.second_derivatives.shape == y.shape
            assert np.shape(f.integrate(0, 3)) == np.shape(f.bending_energy) == rest
            if family is ss.MonotoneCubic:
                assert f.interval_gaps.shape == (*rest[:at], 4, *rest[at:])
            else:
                assert f.alpha.shape == f.beta.shape == (*rest[:at], 4, *rest[at:])
            assert f.to_bpoly()(np.ones(places)).shape == expected
            many = f.diagnostics
            assert len(many) == np.prod(rest, dtype=int) if rest else many.converged
            if rest:
                assert f.roots().shape == f.solve(0.5).shape == rest
            assert repr(f)


@pytest.mark.parametrize(("family", "options"), FAMILIES)
def test_no_columns_but_bad_arguments(family, options):
    empty = np.empty((3, 0))
    with pytest.raises(ss.InputError, match=r"x\[2\] = 1"):
        family([0, 1, 1], empty, **options)
    with pytest.raises(ss.InputError, match="y has 3"):
        family([0, 1], empty, **options)
    f = family([0, 1, 2], empty, **options)
    assert f([0.5, 1.5]).shape == (2, 0)
    assert f.diagnostics == []
    given = family([0, 1, 2], empty, slopes=empty)
    assert given.slopes.shape == (3, 0)


@pytest.mark.parametrize(("family", "options"), FAMILIES)
@pytest.mark.parametrize("dtype", [np.int64, np.int8, np.uint16, np.float32, np.longdouble, object])
def test_casts(family, options, dtype):
    """SciPy's test_cast (gh-3453): integers are data as any."""
    data = np.array(
        [[0, 4, 12, 27, 47, 60, 79, 87, 99, 100], [3, 3, 9, 22, 42, 56, 68, 75, 83, 85]]
    )
    q = np.arange(100)
    if dtype is object:
        x, y = data.tolist()
    else:
        x, y = data.astype(dtype)
    expected = family(*(data * 1.0), **options)(q * 1.0)
    np.testing.assert_array_equal(family(x, y, **options)(q), expected)


@pytest.mark.parametrize(("family", "options"), [(ss.MonotoneCubic, {}), *SLOPES])
def test_end_slopes(family, options):
    """SciPy's test_endslopes (gh-3453), where the slope at 0 was 0 for PCHIP's 33,756."""
    x = [0.0, 0.1, 0.25, 0.35]
    for y in ([279.35, 0.5e3, 1.0e3, 2.5e3], [279.35, 2.5e3, 1.50e3, 1.0e3]):
        f = family(x, y, **options)
        for end in (0, -1):
            assert f(x[end], 1) != 0
    if family is not ss.MonotoneCubic:
        assert f.slopes[0] == pytest.approx(33756, rel=1e-5)


@pytest.mark.parametrize(("family", "options"), SLOPES)
def test_end_slopes_beside_turns_and_flats_are_pchip_s(rng, family, options):
    for _ in range(scaled(1000)):
        n = rng.integers(3, 8)
        x = np.cumsum(10.0 ** rng.uniform(-2, 2, n)) * 10.0 ** rng.uniform(-9, 9)
        y = rng.choice([-3, -1, 0, 0.5, 2], n) * 10.0 ** rng.uniform(-9, 9)
        secants = np.diff(y) / np.diff(x)
        d = family(x, y, **options).slopes
        peer = PchipInterpolator(x, y)
        for end, near, next_ in ((0, 0, 1), (-1, -1, -2)):
            s, t = secants[near], secants[next_]
            assert d[end] * s >= 0
            assert abs(d[end]) <= 2 * abs(s) * (1 + 1e-15)
            if s * t <= 0:
                limited = np.sign(s) * min(abs(peer(x[end], 1)), 2 * abs(s))
                assert d[end] == pytest.approx(limited, rel=1e-12)


@pytest.mark.parametrize(("family", "options"), FAMILIES)
def test_all_zeros_and_two_points(family, options):
    """SciPy's test_all_zeros and test_two_points (gh-6222)."""
    x, q = np.arange(10.0), np.linspace(-1, 10, 101)
    np.testing.assert_array_equal(family(x, 0 * x, **options)(q), 0)
    np.testing.assert_allclose(family([0, 1], [0, 2], **options)(q), 2 * q, rtol=1e-15)


@pytest.mark.parametrize(("family", "options"), FAMILIES)
def test_one_slope_vector_for_all_columns(rng, family, options):
    clip = {"clip": True} if family is ss.MonotoneQuintic else {}
    del options
    x = np.arange(4.0)
    for shape, axis in (((4, 3), 0), ((3, 4), 1), ((2, 4, 5), 1), ((4,), 0), ((4, 4), 0)):
        y = np.sort(rng.random(shape), axis)
        d = rng.uniform(0, 0.1, 4)
        whole = np.moveaxis(np.broadcast_to(d, (*np.moveaxis(y, axis, -1).shape[:-1], 4)), -1, axis)
        one, each = (family(x, y, axis, slopes=s, **clip) for s in (d, whole))
        np.testing.assert_array_equal(one.slopes, each.slopes)
        np.testing.assert_array_equal(one([0.5, 2.2]), each([0.5, 2.2]))
    kind = family.__name__.removeprefix("Monotone").lower()
    y = np.sort(rng.random((3, 4)), 1)
    rows = ss.fit_many_monotone([x] * 3, y, kind=kind, slopes=d, **clip)
    np.testing.assert_array_equal(rows(0.7), family(x, y, 1, slopes=d, **clip)(0.7))
    wrong = r"slopes must have the shape of y, \(3, 2\), or \(3,\), got shape \(2,\)"
    with pytest.raises(ss.InputError, match=wrong):
        family([0, 1, 2], [[0, 1], [1, 2], [2, 3]], slopes=[1, 2])
    with pytest.raises(ss.InputError, match=r"shape of y, \(3, 4\), or \(4,\), got shape \(4, 3\)"):
        ss.fit_many_monotone([x] * 3, y, kind=kind, slopes=y.T)


def test_options_of_the_other_kind_are_refused():
    x = [[0, 1, 2]]
    for kind, option, value in (
        ("quintic", "shape", 1.0),
        ("quintic", "shape", 3.0),
        ("quintic", "shape", ([1, 1], [1, 1])),
        ("quartic", "energy", "bending"),
        ("quartic", "energy", "parametric"),
        ("quartic", "slopes", "optimal"),
        ("cubic", "slopes", "optimal"),
        ("cubic", "slopes", "fritsch-butland"),
        ("cubic", "clip", True),
        ("quintic", "ends", "natural"),
        ("quartic", "layer", 0.0),
        ("quintic", "min_slope", 0.5),
    ):
        with pytest.raises(ss.InputError, match=f"{option}.* is for kind") as error:
            ss.fit_many_monotone(x, x, kind=kind, **{option: value})
        assert error.value.argument == option
    for kind, options in itertools.product(
        ("cubic", "quartic", "quintic"), ({}, {"shape": None, "energy": None, "slopes": None})
    ):
        np.testing.assert_array_equal(ss.fit_many_monotone(x, x, kind=kind, **options)(1.5), [1.5])


@pytest.mark.parametrize("name", ["shape", "slopes", "x", "y"])
def test_shapes_in_messages_are_tuples(name):
    """And no bracket of another language."""
    x, y = np.arange(3.0), np.zeros((3, 2))
    calls = {
        "shape": lambda f: f(x, y, 5),
        "slopes": lambda f: f(x, y, slopes=np.ones((2, 3))),
        "x": lambda f: f(np.ones((3, 1)), y),
        "y": lambda f: f(x, np.ones((4, 2))),
    }
    for family in (ss.MonotoneQuartic, ss.MonotoneQuintic):
        with pytest.raises(ss.InputError) as error:
            calls[name](family)
        if name != "y":
            assert "(" in str(error.value)
        assert "[2, 3]" not in str(error.value)

# SPDX-License-Identifier: MIT OR Apache-2.0

"""Roots, solutions and inverses of functions: none is wrong, none is missing, in every family."""

import numpy as np
import pytest
from scipy.interpolate import PPoly

import shapespline as ss
from scale import scaled

FAMILIES = [
    (ss.MonotoneCubic, {}),
    (ss.MonotoneCubic, {"ends": "natural", "layer": 0.0}),
    (ss.MonotoneQuartic, {}),
    (ss.MonotoneQuartic, {"shape": 3.0}),
    (ss.MonotoneQuintic, {}),
    (ss.MonotoneQuintic, {"slopes": "fritsch-butland"}),
]
MODES = [True, False, "linear", "clip", "periodic", ("linear", True), (False, "clip")]


def verify(f, level, found, mode):
    """Check that f is the level at every solution, to some ulp or between neighbouring floats."""
    found = found[~np.isnan(found)]
    assert (np.diff(found) > 0).all()
    out = np.maximum(f.x[0] - found, found - f.x[-1]).clip(0)
    far = (1 + out / np.diff(f.x)[[0, -1]].min()) ** f.degree
    size = max(abs(f(np.linspace(f.x[0], f.x[-1], 101))).max(), abs(level))
    around = np.array([f(np.nextafter(found, s), extrapolate=mode) for s in (-np.inf, np.inf)])
    with np.errstate(invalid="ignore"):
        passes = (np.nanmin(around, 0) <= level) & (level <= np.nanmax(around, 0))
    near = abs(f(found, extrapolate=mode) - level) <= 16 * np.spacing(size * far)
    assert (near | passes).all(), (level, mode, found)


@pytest.mark.parametrize(("family", "options"), FAMILIES)
@pytest.mark.parametrize("mode", MODES)
def test_a_line_has_one_root(family, options, mode):
    """SciPy's test_roots (gh-6357), where MonotoneQuintic found -7401.8 and 7402.8 as well."""
    f = family([0, 1], [-1, 1], extrapolate=mode, **options)
    for roots in (f.roots(), f.roots(mode), f.derivative().antiderivative().solve(1.0)):
        np.testing.assert_array_equal(roots, [0.5])
    many = ss.fit_many_monotone(
        [[0, 1]] * 3, [[-1, 1]] * 3, kind={3: "cubic", 4: "quartic", 5: "quintic"}[f.degree]
    )
    for roots in many.roots(mode):
        np.testing.assert_array_equal(roots, [0.5])
    columns = family([0, 1], [[-1, 1], [1, -3]], extrapolate=mode, **options).roots()
    np.testing.assert_array_equal(columns[0], [0.5])
    np.testing.assert_array_equal(columns[1], [0.25])


@pytest.mark.parametrize(("family", "options"), FAMILIES)
def test_lines_anywhere_have_one_root(rng, family, options):
    for _ in range(scaled(2000)):
        n = rng.integers(2, 8)
        x = np.cumsum(rng.uniform(0.1, 2, n)) * 10.0 ** rng.uniform(-30, 30)
        root = x[0] + (x[-1] - x[0]) * rng.uniform(-3, 4)
        y = 10.0 ** rng.uniform(-30, 30) * rng.choice([-1, 1]) * (x - root)
        f = family(x, y, **options)
        for mode in (True, "linear"):
            (found,) = f.roots(mode)
            # What rounding of y does to the end polynomial.
            out = max(x[0] - root, root - x[-1], 0) / np.diff(x)[[0, -1]].min()
            room = (
                np.spacing(abs(y).max())
                / abs(y[1] - y[0])
                * (1 + out) ** (4 if mode is True else 1)
            )
            assert abs(found - root) <= 32 * room * x[-1]
        assert len(f.roots(False)) == (x[0] <= root <= x[-1])


@pytest.mark.parametrize(("family", "options"), FAMILIES)
def test_solutions_are_right_and_as_many_as_scipy_finds(rng, family, options):
    for _ in range(scaled(400)):
        n = rng.integers(2, 10)
        x = np.cumsum(rng.uniform(0.1, 2, n))
        y = rng.normal(size=n).cumsum() if rng.random() < 0.5 else np.cumsum(rng.random(n))
        f = family(x, y, **options)
        for g in (f, f.derivative(), f.derivative(2), f.antiderivative()):
            inside = g(rng.uniform(x[0], x[-1], 3))
            for level in (0.0, g(x[-1]), *inside, *(3 * inside)):
                for mode in MODES:
                    verify(g, level, g.solve(level, mode), mode)
            peer = PPoly.from_bernstein_basis(g.to_bpoly())
            for level in inside:
                ours, theirs = g.solve(level, False), peer.solve(level, False, extrapolate=False)
                # SciPy misses some at knots, counts some twice, and finds rounding on level pieces.
                theirs = theirs[np.diff(theirs, prepend=-np.inf) > 1e-7]
                steep = abs(g(theirs, 1)) * (x[-1] - x[0]) > 1e-9 * abs(g(f.x)).max()
                theirs = theirs[steep]
                missing = [s for s in theirs if abs(ours - s).min(initial=np.inf) > 1e-5]
                assert not missing, (level, ours, theirs)


@pytest.mark.parametrize(("family", "options"), FAMILIES)
def test_flats(family, options):
    f = family([0, 1, 2, 3], [0, 1, 1, 2], extrapolate=False, **options)
    np.testing.assert_array_equal(f.solve(1.0), [1, np.nan])
    np.testing.assert_array_equal(f.derivative().roots(), [1, np.nan])
    level = family([0, 1, 2], [3, 3, 3], **options)
    np.testing.assert_array_equal(level.solve(3.0), [0, np.nan, 1, np.nan])
    assert level.solve(4.0).size == 0


@pytest.mark.parametrize(("family", "options"), FAMILIES)
def test_inverse_outside_follows_the_extrapolation(rng, family, options):
    x, y = np.cumsum(rng.uniform(0.5, 2, 9)), np.cumsum(rng.uniform(0.5, 2, 9))
    out = np.array([y[0] - 5, y[0], y[-1], y[-1] + 5, np.nan, -np.inf, np.inf])
    ends = [x[0], x[-1]]
    for sign in (1, -1):
        for mode in MODES:
            f = family(x, sign * y, extrapolate=mode, **options)
            below, above = mode if isinstance(mode, tuple) else (mode, mode)
            found = f.inverse(sign * out)
            np.testing.assert_array_equal(found[1:3], ends)
            assert np.isnan(found[4])
            for side, near, far in ((below, 0, 5), (above, 3, 6)):
                if side == "linear":
                    assert f(found[near]) == pytest.approx(sign * out[near], rel=1e-13)
                    assert f.solve(sign * out[near])[-1 if near else 0] == pytest.approx(
                        found[near], rel=1e-13
                    )
                    assert found[far] == (np.inf if near else -np.inf)
                elif side == "clip":
                    np.testing.assert_array_equal(found[[near, far]], ends[near > 0])
                else:
                    assert np.isnan(found[[near, far]]).all()
            assert [f.inverse(v) for v in sign * out[:4]] == pytest.approx(
                found[:4], rel=1e-12, nan_ok=True
            )


def test_rows_have_solve_and_roots(rng):
    x = np.cumsum(rng.uniform(0.5, 2, (50, 7)), 1)
    y = rng.normal(size=(50, 7))
    for kind in ("quartic", "quintic"):
        f = ss.fit_many_monotone(x, y, kind=kind)
        levels = rng.normal(size=50)
        for mode in (None, *MODES):
            for k, (some, roots) in enumerate(
                zip(f.solve(levels, mode), f.roots(extrapolate=mode), strict=True)
            ):
                np.testing.assert_array_equal(some, f[k].solve(levels[k], mode))
                np.testing.assert_array_equal(roots, f[k].roots(mode))
        slope = f.derivative()
        np.testing.assert_array_equal(slope.solve(0.1)[3], slope[3].solve(0.1))
        with pytest.raises(ss.InputError, match=r"y\[2\] must be finite"):
            f.solve(np.r_[0, 0, np.nan, np.zeros(47)])
        with pytest.raises(ss.InputError, match="y must be a number or one for each of 50 rows"):
            f.solve([1, 2])

# SPDX-License-Identifier: MIT OR Apache-2.0

"""The lines about monotone interpolation, beside SciPy's PCHIP."""

from collections.abc import Iterator
from itertools import product

import numpy as np
from measuring import Line, at_most, best, faster, within
from scipy.interpolate import PchipInterpolator

import shapespline as ss


def rising(rng: np.random.Generator, *shape: int) -> np.ndarray:
    """Return increasing numbers along the first axis, their steps uniform."""
    return np.cumsum(rng.random(shape), axis=0)


def monotone_building(count: int) -> Iterator[Line]:
    """Compare building monotone interpolants to SciPy's PCHIP, which is C¹ only."""
    rng = np.random.default_rng(1)
    x, y = rising(rng, count) + 0.1 * np.arange(count), rising(rng, count)
    cubic, quartic, paper, best_one, pchip = best(
        lambda: ss.MonotoneCubic(x, y),
        lambda: ss.MonotoneQuartic(x, y),
        lambda: ss.MonotoneQuintic(x, y, slopes="fritsch-butland"),
        lambda: ss.MonotoneQuintic(x, y),
        lambda: PchipInterpolator(x, y),
    )
    yield at_most(f"MonotoneCubic build, N = {count:g}", cubic, pchip, 6.0, "PCHIP")
    yield faster(f"MonotoneQuartic build, N = {count:g}", quartic, pchip, 3.0)
    what = "MonotoneQuintic build"
    yield faster(f"{what}, Fritsch–Butland slopes, N = {count:g}", paper, pchip, 1.0)
    yield at_most(f"{what}, optimal slopes, N = {count:g}", best_one, pchip, 25.0, "PCHIP")


def monotone_evaluating(sizes: list[int], queries: int) -> Iterator[Line]:
    """Compare values to PCHIP's, and inverses to values."""
    rng = np.random.default_rng(1)
    for count in sizes:
        x, y = rising(rng, count) + 0.1 * np.arange(count), rising(rng, count)
        pchip = PchipInterpolator(x, y)
        functions = {
            "cubic": ss.MonotoneCubic(x, y),
            "quintic": ss.MonotoneQuintic(x, y, slopes="fritsch-butland"),
        }
        u = rng.uniform(x[0], x[-1], queries)
        for (kind, f), (order, query) in product(
            functions.items(), (("sorted", np.sort(u)), ("unsorted", u))
        ):
            levels = f(query)
            ours, theirs, inverse = best(
                lambda f=f, q=query: f(q),
                lambda f=pchip, q=query: f(q),
                lambda f=f, v=levels: f.inverse(v),
            )
            what = f"at {queries:g} {order}, N = {count:g}"
            yield faster(f"evaluate {kind} {what}", ours, theirs, 3.0)
            yield at_most(f"inverse of {kind} {what}", inverse, ours, 5.0, "values")


def monotone_small() -> Iterator[Line]:
    """Measure small monotone fits, one scalar call, and many columns in one call."""
    rng = np.random.default_rng(1)
    for count in (4, 20):
        x, y = np.arange(float(count)), np.cumsum(rng.exponential(size=count))
        quintic = ss.MonotoneQuintic(x, y)
        cubic, paper, optimal, call = best(
            lambda x=x, y=y: ss.MonotoneCubic(x, y),
            lambda x=x, y=y: ss.MonotoneQuintic(x, y, slopes="fritsch-butland"),
            lambda x=x, y=y: ss.MonotoneQuintic(x, y),
            lambda f=quintic: f(1.5),
            budget=0.5,
        )
        yield within(f"one cubic, N = {count}", cubic, 15e-6)
        yield within(f"one quintic, Fritsch–Butland slopes, N = {count}", paper, 15e-6)
        yield within(f"one quintic, optimal slopes, N = {count}", optimal, 40e-6)
    yield within("one scalar call of a quintic", call, 2e-6)
    x, columns = np.arange(20.0), rising(rng, 20, 10_000)
    rows = np.ascontiguousarray(columns.T)

    def loop():
        for row in rows:
            PchipInterpolator(x, row)

    cubic, paper, optimal, pchip = best(
        lambda: ss.MonotoneCubic(x, columns),
        lambda: ss.MonotoneQuintic(x, columns, slopes="fritsch-butland"),
        lambda: ss.MonotoneQuintic(x, columns),
        loop,
    )
    what = "10,000 columns of 20 points"
    yield faster(f"{what}, cubic", cubic, pchip, 30.0)
    yield faster(f"{what}, Fritsch–Butland slopes", paper, pchip, 50.0)
    yield faster(f"{what}, optimal slopes", optimal, pchip, 15.0)


def monotone_convex_and_smooth(count: int) -> Iterator[Line]:
    """Measure convex fits, and smoothing with its constraint active, idle, and convex as well."""
    rng = np.random.default_rng(1)
    x, y = rising(rng, 1000), rising(rng, 1000)
    (convex,) = best(lambda: ss.MonotoneCubic(x, y, convex="data"))
    yield within('one cubic, convex="data", N = 1000', convex, 20e-3)
    x = np.sort(rng.uniform(0, 10, count))
    y = 1 / (1 + np.exp(-2 * (x - 5))) + 0.1 * rng.normal(size=count)
    line, signs = x + 0.01 * rng.normal(size=count), np.where(x[1:] < 5, 1, -1)
    active, idle, shaped = best(
        lambda: ss.smooth_monotone(x, y, penalty=0.1),
        lambda: ss.smooth_monotone(x, line, penalty=10.0),
        lambda: ss.smooth_monotone(x, y, penalty=0.1, convex=signs),
    )
    share = count / 100_000
    yield within(f"smoothing, N = {count:g}", active, 1.0 * share)
    yield within(f"smoothing, N = {count:g}, constraint idle", idle, 1.0 * share)
    yield within(f"smoothing, N = {count:g}, convex and concave", shaped, 5.0 * share)
    few = slice(None, None, count // 10_000)
    (chosen,) = best(lambda: ss.smooth_monotone(x[few], y[few]))
    yield within("smoothing, N = 10,000, penalty by cross-validation", chosen, 2.0)

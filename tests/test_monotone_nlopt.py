# SPDX-License-Identifier: MIT OR Apache-2.0

"""A second opinion: both programs of the quintic through NLopt's SLSQP, built here anew."""

from pathlib import Path

import nlopt
import numpy as np
import pytest

import shapespline as ss

DATA = Path(__file__).parent / "data"


def published(name):
    return np.loadtxt(DATA / name, delimiter=",", comments="#", skiprows=2, unpack=True)


def random_data(rng, n):
    """Increasing data with steps over two decades."""
    x = np.cumsum(10.0 ** rng.uniform(-1, 1, n))
    return x, np.cumsum(10.0 ** rng.uniform(-1, 1, n))


def energy_matrix(h):
    """Return M with ∫ y''² dx = v·M·v on a segment, v = (Δ, d₀, s₀, d₁, s₁), by quadrature."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    matrix = np.zeros((5, 5))
    for t, weight in zip((nodes + 1) / 2, weights / 2, strict=True):
        u = 1 - t
        basis = [u**3, 3 * u * u * t, 3 * u * t * t, t**3]
        # Bernstein coefficients of y itself, by the Hermite data, as rows over v.
        y = h * np.array([
            [0, 0, 0, 0, 0],
            [0, 1 / 5, 0, 0, 0],
            [0, 2 / 5, h / 20, 0, 0],
            [1, 0, 0, -2 / 5, h / 20],
            [1, 0, 0, -1 / 5, 0],
            [1, 0, 0, 0, 0],
        ])  # fmt: skip
        second = 20 / h**2 * np.diff(y, 2, axis=0)
        row = np.asarray(basis) @ second
        matrix += weight * h * np.outer(row, row)
    return matrix


def quadratic(x, y):
    """Return (H, g, c) with energy ½v·H·v + g·v + c in v = (d₀, s₀, d₁, s₁, …)."""
    h, n = np.diff(x), len(x)
    H, g, c = np.zeros((2 * n, 2 * n)), np.zeros(2 * n), 0.0
    for i, secant in enumerate(np.diff(y) / h):
        M = energy_matrix(h[i])
        at = slice(2 * i, 2 * i + 4)
        H[at, at] += 2 * M[1:, 1:]
        g[at] += 2 * secant * M[1:, 0]
        c += M[0, 0] * secant**2
    return H, g, c


def minimise(H, g, start, unit, lower=None, upper=None, rows=None, least=None):
    """Minimise ½v·H·v + g·v with bounds and rows·v ≥ least; v in units of about its own size."""
    H, g = H * np.outer(unit, unit), g * unit
    scale = abs(np.diag(H)).max()
    solver = nlopt.opt(nlopt.LD_SLSQP, len(g))

    def objective(v, gradient):
        slope = H @ v + g
        if gradient.size:
            gradient[:] = slope / scale
        return float(v @ (slope + g)) / (2 * scale)

    def excess(result, v, gradient):
        if gradient.size:
            gradient[:] = -rows * unit
        result[:] = least - (rows * unit) @ v

    solver.set_min_objective(objective)
    if lower is not None:
        solver.set_lower_bounds(lower / unit)
        solver.set_upper_bounds(upper / unit)
    if rows is not None:
        solver.add_inequality_mconstraint(excess, np.full(len(rows), 1e-12))
    solver.set_xtol_rel(1e-13)
    solver.set_ftol_rel(1e-15)
    solver.set_maxeval(3000)
    try:
        return solver.optimize(start / unit) * unit
    except nlopt.RoundoffLimited:
        # No better step is left in double precision: the last one is as good.
        return solver.last_optimize_result() * unit


def paper_energy(x, y, d):
    """Return the least energy of the paper's program for slopes d: (22), (23), α, β ≥ 0."""
    h, n = np.diff(x), len(x)
    secant = np.diff(y) / h
    lower, upper = np.full(n, -np.inf), np.full(n, np.inf)
    lower[:-1] = -4 * d[:-1] / h
    upper[:-1] = 6 * (secant - d[:-1]) / h
    lower[1:] = np.maximum(lower[1:], -6 * (secant - d[1:]) / h)
    upper[1:] = np.minimum(upper[1:], 4 * d[1:] / h)
    upper = np.maximum(lower, upper)
    H, g, c = quadratic(x, y)
    v = np.zeros(2 * n)
    v[::2] = d
    ours, slopes = H[1::2, 1::2], (H @ v + g)[1::2]
    constant = v @ (H @ v) / 2 + g @ v + c
    unit = np.maximum((upper - lower) / 2, 1e-3 * abs(d).max() / h.max())
    s = minimise(ours, slopes, (lower + upper) / 2, unit, lower, upper)
    return s @ ours @ s / 2 + slopes @ s + constant


def optimal_energy(x, y, parts):
    """Return the least energy over slopes and second derivatives, monotone on equal parts."""
    h, n = np.diff(x), len(x)
    secant = np.diff(y) / h
    H, g, c = quadratic(x, y)
    rows, least = [], []
    whole = np.array([
        [1, 0, 0, 0, 0], [1, 1, 0, 0, 0], [-2, -1, -2, 1, 5], [0, 0, 1, -1, 0], [0, 0, 1, 0, 0]
    ])  # fmt: skip
    for i in range(n - 1):
        scale = np.array([1, h[i] / 4, 1, h[i] / 4]) / secant[i]
        for part in range(parts):
            ends = part / parts, (part + 1) / parts
            for k in range(5):
                b = whole.astype(float)
                for t in [ends[1]] * k + [ends[0]] * (4 - k):
                    b = (1 - t) * b[:-1] + t * b[1:]
                row = np.zeros(2 * n)
                row[2 * i : 2 * i + 4] = b[0, :4] * scale
                rows.append(row)
                least.append(-b[0, 4])
    start = np.ravel(
        np.column_stack(
            [(f := ss.MonotoneQuintic(x, y, slopes="fritsch-butland")).slopes, f.second_derivatives]
        )
    )
    size = np.maximum(np.r_[secant, secant[-1]], np.r_[secant[0], secant])
    unit = np.ravel(np.column_stack([size, 4 * size / np.r_[h, h[-1]]]))
    v = minimise(H, g, start, unit, rows=np.array(rows), least=np.array(least))
    return v @ H @ v / 2 + g @ v + c


@pytest.mark.parametrize("name", ["rpn14.csv", "akima.csv"])
def test_the_paper_s_program_on_published_data(name):
    x, y = published(name)
    f = ss.MonotoneQuintic(x, y, slopes="fritsch-butland")
    flat = np.diff(y) == 0
    if flat.any():
        # The family cannot move second derivatives beside flats: only what lies behind is compared.
        start = np.flatnonzero(flat)[-1] + 1
        x, y = x[start:], y[start:]
        f = ss.MonotoneQuintic(x, y, slopes="fritsch-butland")
    assert f.bending_energy == pytest.approx(paper_energy(x, y, f.slopes), rel=1e-8)


@pytest.mark.parametrize("n", [3, 5, 9, 14])
def test_the_paper_s_program_on_random_data(rng, n):
    for _ in range(5):
        x, y = random_data(rng, n)
        f = ss.MonotoneQuintic(x, y, slopes="fritsch-butland")
        assert f.bending_energy == pytest.approx(paper_energy(x, y, f.slopes), rel=1e-8)


@pytest.mark.parametrize(("parts", "expected"), [(1, 10.214), (8, 9.830)])
def test_the_optimal_program_on_published_data(parts, expected):
    x, y = published("rpn14.csv")
    theirs = optimal_energy(x, y, parts)
    assert theirs == pytest.approx(expected, rel=1e-4)
    assert ss.MonotoneQuintic(x, y).bending_energy <= 1.005 * theirs


def test_the_optimal_program_on_random_data(rng):
    for n in (4, 6, 9):
        x, y = random_data(rng, n)
        theirs, ours = optimal_energy(x, y, 6), ss.MonotoneQuintic(x, y).bending_energy
        # Theirs has finitely many conditions as well: it need not be below ours.
        assert 0.97 * theirs <= ours <= 1.005 * theirs

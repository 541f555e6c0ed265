# SPDX-License-Identifier: MIT OR Apache-2.0

"""What python/docs/least-energy.md says of `MonotoneCubic`, by means that share nothing with it."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import nnls

import polygons
import shapespline as ss
from scale import scaled

#: Linear pieces of the slope per interval, and the weight of the rises in the program.
PIECES, WEIGHT = 60, 1e4


def least_energy_of_linear_slopes(x, y):
    """Return the least ∫ s'² of non-negative slopes s that are linear between many knots."""
    t = np.unique(np.concatenate([np.linspace(a, b, PIECES + 1) for a, b in pairwise(x)]))
    h = np.diff(t)
    n = len(t)
    bending = np.zeros((n - 1, n))
    bending[range(n - 1), range(n - 1)] = -1 / np.sqrt(h)
    bending[range(n - 1), range(1, n)] = 1 / np.sqrt(h)
    rises = np.zeros((len(x) - 1, n))
    for k in range(n - 1):
        i = np.searchsorted(x, t[k], side="right") - 1
        rises[i, k : k + 2] += h[k] / 2
    # Equality by weight, in units of the slopes: what is left of it is of the order 1/WEIGHT².
    scale = WEIGHT * np.linalg.norm(bending, axis=1).max()
    rows = np.vstack([bending, scale * rises])
    right = np.concatenate([np.zeros(n - 1), scale * np.diff(y)])
    found, _ = nnls(rows, right, maxiter=100 * n)
    return float(np.sum((bending @ found) ** 2))


def rough(rng):
    return np.cumsum(rng.uniform(0.3, 1, 7)), np.cumsum(rng.lognormal(0, 1.5, 7))


def test_a_program_with_many_knots_comes_down_to_the_least_energy(rng):
    """Its functions are monotone, so they have no less; their energy is off by the square of h."""
    for x, y in [polygons.load("rpn14").values(), *(rough(rng) for _ in range(4))]:
        least = ss.minimal_bending(x, y)
        found = least_energy_of_linear_slopes(np.asarray(x), np.asarray(y))
        assert least * (1 - 1e-5) <= found <= least * 1.003


def test_intervals_have_at_most_three_pieces(rng):
    for case in range(scaled(500)):
        x = np.cumsum(rng.uniform(0.1, 1, 12))
        y = [rng.normal(size=12), rng.integers(0, 3, 12), np.cumsum(rng.lognormal(0, 2, 12))]
        f = ss.MonotoneCubic(
            x, y[case % 3], ends="natural", layer=[0, 1 / 16, 1 / 4][case // 3 % 3]
        )
        inside = np.setdiff1d(f.knots, x)
        assert np.bincount(np.searchsorted(x, inside), minlength=1).max() <= 2


@pytest.mark.parametrize("layer", [1 / 64, 1 / 16, 1 / 4])
def test_layers_cost_no_more_than_their_bound(layer, rng):
    for _ in range(scaled(500)):
        x, y = np.cumsum(rng.uniform(0.1, 1, 12)), rng.normal(size=12)
        f = ss.MonotoneCubic(x, y, ends="natural", layer=layer)
        more = f.bending_energy / ss.minimal_bending(x, y)
        assert 1 - 1e-12 <= more <= (1 - layer) ** -2 * (1 + 1e-12)

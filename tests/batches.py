# SPDX-License-Identifier: MIT OR Apache-2.0

"""One value however it is asked for: alone, sorted, backwards, strided, in bulk."""

import numpy as np

#: batches around the sizes at which evaluation goes another way
BATCHES = sorted({m + d for m in (8, 16, 32, 64, 96, 128, 257) for d in (-1, 0, 1)} | {1, 2, 1000})


def assert_same_batches(function, domain, rng):
    """Evaluate one by one, sorted, backwards, strided, in two dimensions and among others."""
    outside = 0.1 * (domain[1] - domain[0])
    u = rng.uniform(domain[0] - outside, domain[1] + outside, max(BATCHES))
    u[::7] = rng.choice(domain, len(u[::7]))
    alone = np.array([function(x) for x in u.tolist()])
    for m in BATCHES:
        some, expected = u[:m], alone[:m]
        order = np.argsort(some)
        np.testing.assert_array_equal(function(some), expected)
        np.testing.assert_array_equal(function(some[order]), expected[order])
        np.testing.assert_array_equal(function(some[order[::-1]]), expected[order[::-1]])
        np.testing.assert_array_equal(function(np.repeat(some, 3)[::3]), expected)
        np.testing.assert_array_equal(function(some[::-1]), expected[::-1])
        if m % 2 == 0:
            square = function(some.reshape(2, -1))
            np.testing.assert_array_equal(square.reshape(expected.shape), expected)


#: sizes beyond every block into which long batches and long data are cut
BLOCKS = [m + d for m in (2048, 4096, 8192, 16_384, 32_768, 65_536) for d in (-1, 0, 1)]


def assert_long_batches_agree(function, domain, rng):
    """Compare batches beyond every block with short ones, sorted and backwards."""
    u = rng.uniform(*domain, max(BLOCKS))
    for m in BLOCKS:
        values, ascending = function(u[:m]), function(np.sort(u[:m]))
        np.testing.assert_array_equal(function(u[:m][::-1])[::-1], values)
        np.testing.assert_array_equal(values[np.argsort(u[:m])], ascending)
        few = np.r_[0, rng.integers(m, size=20), m - 1]
        np.testing.assert_array_equal(values[few], function(u[few]))

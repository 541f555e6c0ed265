# SPDX-License-Identifier: MIT OR Apache-2.0

"""The limits of Karavelas & Kaklis 2000, Theorems 4.7 to 4.13, as all ν grow together.

Each quantity approaches its limit like 1/ν: from one ν to the next, a hundred times larger, the
distance must fall by nearly a hundred. So a wrong factor, or a limit that is only nearly right,
cannot pass.
"""

from dataclasses import dataclass

import numpy as np
import pytest

import polygons
import shapespline as ss

M = 4  #: the segment [u_M, u_{M+1}] that is looked at, and its first node
T = np.linspace(0.15, 0.85, 8)[:, None]  #: local parameters inside the segment


@dataclass(frozen=True)
class Limit:
    """A ν-spline with large tension, and the quantities that the theorems name."""

    curve: ss.NuSpline
    u: np.ndarray
    h: np.ndarray  #: h_{m-1}, h_m, h_{m+1}
    A: np.ndarray  #: A_m, A_{m+1} of (3.5)
    B: np.ndarray  #: right-hand side B_m of (3.7)
    L: np.ndarray  #: L_{m-1}, L_m, L_{m+1}
    c: float  #: ν_m / ν_{m+1}

    @property
    def P(self):
        """Binormal vectors at both ends of the segment."""
        return np.cross(self.L[:-1], self.L[1:])

    @property
    def Gamma(self):
        return self.P[0] @ self.L[2]

    @property
    def inside(self):
        return self.u[M] + self.h[1] * T[:, 0]

    def binormal(self, t=T):
        """Return the vector that (4.29), (4.35) and (4.36) are made of."""
        before, after = self.h[0] ** -1.5, self.h[2] ** -1.5
        return before * self.P[0] * (1 - t) ** 2 + self.c * after * self.P[1] * t**2

    def d(self, n, i):
        """Return lim A_n / A_i, with n and i counted from m, by (4.30)."""
        ratio = self.c * np.sqrt(self.h[0] / self.h[2])
        return 1.0 if n == i else ratio if n == 0 else 1 / ratio


def large(tension: float) -> Limit:
    """Return the curve through a fixed walk with ν in fixed, uneven proportions."""
    rng = np.random.default_rng(41)
    points = polygons.random_walk(rng, 10)
    weights = rng.uniform(0.5, 2.0, 10)
    curve = ss.NuSpline(points, tension=tension * weights)
    u = curve.parameters
    spacing, chords = np.diff(u), np.diff(points, axis=0)
    A = [
        2 * spacing[i - 1]
        + 2 * spacing[i]
        + 0.5 * np.sqrt(spacing[i - 1] * spacing[i]) * curve.tension[i]
        for i in (M, M + 1)
    ]
    h, L = spacing[M - 1 : M + 2], chords[M - 1 : M + 2]
    B = 3 * (h[1] / h[0] * L[0] + h[0] / h[1] * L[1])
    return Limit(curve, u, h, np.array(A), B, L, weights[M] / weights[M + 1])


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def position(x):
    """(4.19)"""
    a, b = x.curve.points[[M, M + 1]]
    return x.curve(x.inside), a * (1 - T) ** 2 * (1 + 2 * T) + b * T**2 * (3 - 2 * T)


def velocity(x):
    """(4.20)"""
    return x.curve(x.inside, 1), 6 / x.h[1] * x.L[1] * T * (1 - T)


def omega(x, u, **side):
    return np.cross(x.curve(u, 1, **side), x.curve(u, 2, **side))


def binormal_vector(x):
    """(4.22), for n = m and n = m+1"""
    found, limits = [], []
    for n in (0, 1):
        found.append(x.A[n] * omega(x, x.inside))
        start = x.d(n, 0) / x.h[0] * x.P[0] * (1 - T) ** 2
        limits.append(18 / x.h[1] * (start + x.d(n, 1) / x.h[2] * x.P[1] * T**2))
    return np.array(found), np.array(limits)


def nodal_binormal_vector(x):
    """(4.24), from both sides of the node"""
    found = [x.A[0] * omega(x, x.u[M], side=side) for side in ("left", "right")]
    return np.array(found), np.array([18 / (x.h[0] * x.h[1]) * x.P[0]] * 2)


def curvature(x):
    """(4.26), for n = m and n = m+1"""
    found, limits, t = [], [], T
    for n in (0, 1):
        found.append(x.curve.curvature(x.inside) * x.A[n])
        start = x.d(n, 0) / x.h[0] * x.P[0] / ((1 - t) * t**3)
        end = x.d(n, 1) / x.h[2] * x.P[1] / ((1 - t) ** 3 * t)
        factor = x.h[1] ** 2 / (12 * np.linalg.norm(x.L[1]) ** 3)
        limits.append(factor * np.linalg.norm(start + end, axis=-1))
    return np.array(found), np.array(limits)


def nodal_curvature(x):
    """(4.28)"""
    found = x.curve.curvature(x.u[M]) * x.A[0] ** -2.0
    size = np.linalg.norm(x.P[0]) / np.linalg.norm(x.B) ** 3
    return np.array(found), np.array(18 * size / (x.h[0] * x.h[1]))


def torsion(x):
    """(4.29), at the segment's ends too"""
    t = np.vstack([[0.0], T, [1.0]])
    found = np.concatenate(
        [
            [x.curve.torsion(x.u[M], side="right")],
            x.curve.torsion(x.inside),
            [x.curve.torsion(x.u[M + 1], side="left")],
        ]
    )
    factor = x.c * x.Gamma / (3 * (x.h[0] * x.h[2]) ** 1.5)
    return found, factor / np.linalg.norm(x.binormal(t), axis=-1) ** 2


def frame(x):
    """(4.33), (4.35), (4.36)"""
    tangent = np.broadcast_to(unit(x.L[1]), (len(T), 3))
    normal = unit(np.cross(x.binormal(), x.L[1]))
    return np.array(x.curve.frame(x.inside)), np.array([tangent, normal, unit(x.binormal())])


def nodal_frame(x):
    """(4.34), (4.35), (4.37)"""
    normal = unit(np.cross(x.P[0], x.B))
    return np.array(x.curve.frame(x.u[M])), np.array([unit(x.B), normal, unit(x.P[0])])


@pytest.mark.parametrize(
    "quantity",
    [
        position,
        velocity,
        binormal_vector,
        nodal_binormal_vector,
        curvature,
        nodal_curvature,
        torsion,
        frame,
        nodal_frame,
    ],
    ids=lambda q: f"{q.__name__} {q.__doc__.split()[0]}",
)
def test_limit(quantity):
    distances = []
    for tension in (1e3, 1e5, 1e7):
        found, limit = quantity(large(tension))
        assert found.shape == limit.shape
        distances.append(np.abs(found - limit).max() / np.abs(limit).max())
    assert distances[0] > 0
    assert distances[1] < distances[0] / 50
    # The last step may already meet rounding.
    assert distances[2] < max(distances[1] / 50, 1e-8)
    assert distances[2] < 1e-5


def test_tangents_vanish():
    """Lemma 4.2, and A_m q_m → B_m (Corollary 4.3)."""
    x = large(1e7)
    q = x.curve.tangents[M]
    assert np.linalg.norm(q) < 1e-5
    np.testing.assert_allclose(x.A[0] * q, x.B, rtol=1e-5)

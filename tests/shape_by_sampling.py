# SPDX-License-Identifier: MIT OR Apache-2.0

"""Decide by dense sampling whether a curve keeps the shape of its data.

The library decides its shape criteria exactly, from the coefficients of each segment. The tests
must not trust that, so this file knows nothing of splines: it takes the points, the parameters,
the boundary and a function that gives derivatives, and looks at many values of that function. It
follows Karavelas & Kaklis 2000, section 2 (convexity, torsion, coplanarity, collinearity), and
adds inflection (P·P' < 0: one change of sign, in the direction the polygon turns).

Sampling can only find violations, never prove their absence, and a sampled value has rounding
errors of its own. So a value counts as a violation only when it lies on the wrong side by more
than an estimate of these errors.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
#: ``derivative(u, order, side)`` for an array of parameters: values of shape ``u.shape + (dim,)``.
Derivative = Callable[[Array, int, str], Array]
#: ``None`` (zero curvature), ``"periodic"``, or the two end tangents.
Boundary = str | tuple[npt.ArrayLike | None, npt.ArrayLike | None] | None

CRITERIA = ("convexity", "inflection", "turning", "torsion", "coplanarity", "collinearity")
# Derivatives of a cubic lose a few dozen units in the last place before they arrive here.
ROUNDING = 256 * np.finfo(float).eps


@dataclass(frozen=True)
class Polygon:
    """The data polygon with unit chords; arrays run over nodes or segments as named."""

    chords: Array  #: unit chords l, with one stand-in at each end: (segments + 2, 3)
    lengths: Array  #: lengths of the same chords
    spacing: Array  #: parameter spacing h with one stand-in at each end
    binormals: Array  #: P̂ = l × l at the nodes, zero where the chords are parallel: (nodes, 3)
    torsion: Array  #: Γ̂ = det[l, l, l] on the segments, zero where coplanar
    turning: Array  #: P̂·P̂' on the segments, zero where perpendicular to tolerance
    straight: npt.NDArray[np.bool_]  #: nodes where the collinearity criterion applies
    closed: bool  #: whether the last node is the first


@dataclass(frozen=True)
class Sampled:
    """What was found: for every criterion, one flag a segment."""

    applicable: dict[str, npt.NDArray[np.bool_]]
    violated: dict[str, npt.NDArray[np.bool_]]

    @property
    def violations(self) -> list[tuple[str, int]]:
        """Criterion and segment of every violation."""
        return [(name, int(i)) for name, bad in self.violated.items() for i in np.flatnonzero(bad)]


def in_space(vectors: npt.ArrayLike) -> Array:
    """Return the vectors with a third component: planar data lie in the plane z = 0."""
    vectors = np.asarray(vectors, dtype=float)
    flat = vectors.shape[-1] == 2
    return np.concatenate([vectors, np.zeros((*vectors.shape[:-1], 1))], -1) if flat else vectors


def dot(a: Array, b: Array) -> Array:
    """Return the inner products along the last axis."""
    return np.sum(a * b, axis=-1)


def norm(a: Array) -> Array:
    """Return the lengths along the last axis."""
    return np.sqrt(dot(a, a))


def data_polygon(
    points: npt.ArrayLike, parameters: npt.ArrayLike, boundary: Boundary, tolerance: float = 1e-9
) -> Polygon:
    """Return chords, binormals and discrete torsion, with the stand-ins that the ends require."""
    points = in_space(points)
    spacing = np.diff(np.asarray(parameters, dtype=float))
    chords = np.diff(points, axis=0)
    closed = isinstance(boundary, str) and boundary == "periodic"
    ends = (None, None) if boundary is None or closed else boundary
    given = np.array([end is not None for end in ends])
    if closed:
        first, last = chords[-1], chords[0]
        spacing = np.r_[spacing[-1], spacing, spacing[0]]
    else:
        # With zero curvature an end has no binormal: its chord follows itself.
        stand_ins = zip(ends, chords[[0, -1]], strict=True)
        first, last = (own if end is None else in_space(end) for end, own in stand_ins)
        spacing = np.r_[spacing[0], spacing, spacing[-1]]
    chords = np.vstack([first, chords, last])
    # Components near 1e±100 must not overflow or vanish when squared.
    magnitude = np.abs(chords).max(axis=1, keepdims=True)
    lengths = magnitude[:, 0] * norm(chords / magnitude)
    chords = chords / magnitude
    chords /= norm(chords)[:, None]
    # A tangent is no chord. The chord that gives (5.9) the limit of (1 + ν) q = D is hD/6.
    lengths[[0, -1]] *= np.where(given, spacing[[0, -1]] / 6, 1.0)
    binormals = np.cross(chords[:-1], chords[1:])
    binormals[norm(binormals) <= tolerance] = 0.0
    torsion = dot(np.cross(chords[:-2], chords[1:-1]), chords[2:])
    torsion[np.abs(torsion) <= tolerance] = 0.0
    before, after = binormals[:-1], binormals[1:]
    turning = dot(before, after)
    turning[np.abs(turning) <= tolerance * norm(before) * norm(after)] = 0.0
    straight = (norm(binormals) == 0.0) & (dot(chords[:-1], chords[1:]) > 0.0)
    if not closed:
        straight[[0, -1]] &= given
    return Polygon(chords, lengths, spacing, binormals, torsion, turning, straight, closed)


def applicable(
    polygon: Polygon, coplanarity: float, tolerance: float
) -> dict[str, npt.NDArray[np.bool_]]:
    """Return which criterion each segment requires.

    Coplanarity is asked only of data that are not planar as a whole (5.34)–(5.37), and only where
    a plane is known: both turns must exceed the square root of the tolerance (next to a straight
    node any Γ̂ is small), and the segment's own two binormals must leave room for it: when they
    differ by more than ε₁/2, no curve that follows both can satisfy it. Torsion, too, is asked only
    where both turns exceed the square root of the tolerance.
    """
    sizes = norm(polygon.binormals)
    known = np.sqrt(tolerance)
    bent = (sizes[:-1] > known) & (sizes[1:] > known)
    sine = norm(np.cross(polygon.binormals[:-1], polygon.binormals[1:]))
    agree = sine <= coplanarity / 2 * sizes[:-1] * sizes[1:]
    solid = bool(np.any(polygon.torsion != 0))
    return {
        "convexity": polygon.turning > 0,
        "inflection": polygon.turning < 0,
        "turning": (sizes[:-1] > 0) | (sizes[1:] > 0),
        "torsion": (polygon.torsion != 0) & bent,
        "coplanarity": solid & (polygon.torsion == 0) & bent & agree & (polygon.turning != 0),
        "collinearity": polygon.straight[:-1] | polygon.straight[1:],
    }


def separating_point(polygon: Polygon) -> Array:
    """Return the local parameter of the point (5.9) where the limit curve changes its turn."""
    length, h = polygon.lengths, polygon.spacing
    # Only ratios matter, so lengths are taken relative to the largest.
    length = length / length.max()
    size = norm(polygon.binormals) * length[:-1] * length[1:]
    left = h[2:] ** 0.75 * np.sqrt(size[:-1])
    right = h[:-2] ** 0.75 * np.sqrt(size[1:])
    return left / np.where(left + right > 0, left + right, 1.0)


@dataclass(frozen=True)
class Samples:
    """Values on every segment in its local parameter, scaled by chord length and spacing."""

    t: Array  #: local parameters in [0, 1]: (samples,)
    first: Array  #: h γ' / ‖L‖: (segments, samples, 3)
    omega: Array  #: γ' × γ'' in the same units
    triple: Array  #: det[γ', γ'', γ''']
    first_error: Array  #: rounding estimates of the three, (segments, 1)
    omega_error: Array
    triple_error: Array


def sample(polygon: Polygon, parameters: Array, derivative: Derivative, count: int) -> Samples:
    """Evaluate three derivatives on every closed segment, one-sided at its ends."""
    u = np.asarray(parameters, dtype=float)
    h = np.diff(u)
    # Denser towards the ends, where a violated end condition shows first.
    t = (1 - np.cos(np.linspace(0, np.pi, count))) / 2
    inside = u[:-1, None] + h[:, None] * t[1:-1]
    values = []
    for order in (1, 2, 3):
        parts = [
            derivative(u[:-1], order, "right")[:, None],
            derivative(inside, order, "right"),
            derivative(u[1:], order, "left")[:, None],
        ]
        value = in_space(np.concatenate(parts, axis=1))
        # One factor h at a time: h³ alone may overflow where h³γ''' does not.
        for _ in range(order):
            value = value * h[:, None, None]
        values.append(value / polygon.lengths[1:-1, None, None])
    first, second, third = values
    omega = np.cross(first, second)
    triple = dot(omega, third)
    # A derivative of order k of the cubic with chord 1 and end tangents m, m' is a sum of terms
    # up to 12·max(1, |m|, |m'|): cancellation leaves errors of that size, whatever the sum is.
    size = np.maximum(1.0, norm(first).max(axis=1, keepdims=True))
    error = 12 * ROUNDING * size
    d1, d2, d3 = (norm(v).max(axis=1, keepdims=True) for v in values)
    omega_error = error * (d1 + d2)
    triple_error = omega_error * d3 + error * norm(omega).max(axis=1, keepdims=True)
    return Samples(t, first, omega, triple, error, omega_error, triple_error)


def sign_against(s: Samples, normals: Array) -> tuple[Array, Array]:
    """Return ω·n with its rounding estimate; ``normals`` holds one vector a segment.

    A binormal is a cross product of unit chords, so it carries an absolute error of some ulps.
    """
    value = dot(s.omega, normals[:, None])
    noise = s.omega_error * norm(normals)[:, None] + ROUNDING * norm(s.omega)
    return value, noise


def convexity(polygon: Polygon, s: Samples) -> npt.NDArray[np.bool_]:
    """Find where ω·n > 0 fails for one of the two binormals of the segment (2.3)."""
    bad = np.zeros(len(s.first), dtype=bool)
    for normals in (polygon.binormals[:-1], polygon.binormals[1:]):
        value, noise = sign_against(s, normals)
        bad |= np.any(value < -noise, axis=1)
    return bad


def inflection(polygon: Polygon, s: Samples) -> npt.NDArray[np.bool_]:
    """Find where ω does not follow P at the start and P' at the end, with one change between."""
    bad = np.zeros(len(s.first), dtype=bool)
    for normals, start in ((polygon.binormals[:-1], 1.0), (polygon.binormals[1:], -1.0)):
        value, noise = sign_against(s, normals)
        value = start * value
        bad |= (value[:, 0] < -noise[:, 0]) | (value[:, -1] > noise[:, -1])
        # Once clearly negative, it must not become clearly positive again.
        turned = np.logical_or.accumulate(value < -noise, axis=1)
        bad |= np.any(turned & (value > noise), axis=1)
    return bad


def turning(polygon: Polygon, s: Samples, tolerance: float) -> npt.NDArray[np.bool_]:
    """Find where a segment bends the wrong way at one of its nodes, or its tangent is not between.

    Manni 2001, (i.3): (ω·P_j)(P_i·P_j) > 0 at node i for j = i−1, i, i+1 where P_i·P_j ≠ 0; and
    Gautam, (12.1): seen along P_i the tangent lies between the chords. All on this segment's side
    of the node; the chord beside is left to the segment there where that has the same tangent.
    """
    nodes = polygon.binormals
    beside = (nodes[-2], nodes[1]) if polygon.closed else (np.zeros(3), np.zeros(3))
    nodes = np.vstack([beside[0], nodes, beside[1]])
    count = len(polygon.torsion)
    bad = np.zeros(count, dtype=bool)
    for node, sample in ((0, 0), (1, -1)):
        at = slice(node, node + count)
        own = nodes[1:-1][at]
        omega, first = s.omega[:, sample], s.first[:, sample]
        for other in (nodes[:-2][at], own, nodes[2:][at]):
            cosine = dot(own, other)
            asked = np.abs(cosine) > tolerance * norm(own) * norm(other)
            noise = s.omega_error[:, 0] * norm(other) + ROUNDING * norm(omega)
            bad |= asked & (np.sign(cosine) * dot(omega, other) < -noise)
        before, after = polygon.chords[:-1][at], polygon.chords[1:][at]
        turns = [np.cross(before, first), np.cross(first, after)]
        noise = s.first_error[:, 0] * norm(own) + ROUNDING * norm(first)
        outside = [(norm(own) > 0) & (dot(turn, own) < -noise) for turn in turns]
        bad |= outside[1 - node]
        if count > 1:
            other = np.roll(s.first[:, -1 - sample], -1 if node else 1, axis=0)
            # Curves of other libraries are sampled a hair beside the point on its left.
            parts = norm(np.cross(first, other)) > 1e-6 * norm(first) * norm(other)
            corner = parts | (dot(first, other) <= 0)
            if not polygon.closed:
                corner[-1 if node else 0] = False
            bad |= corner & outside[node]
    return bad


def torsion(polygon: Polygon, s: Samples) -> npt.NDArray[np.bool_]:
    """Find where the torsion's sign is not that of the discrete torsion (2.4)."""
    sign = np.sign(polygon.torsion)[:, None]
    return np.any(sign * s.triple < -s.triple_error, axis=1)


def coplanarity(polygon: Polygon, s: Samples, sine: float) -> npt.NDArray[np.bool_]:
    """Find where ω leaves the binormal's line by more than asin ε₁, or vanishes (2.5), (2.6).

    In the inflection case the middle of the segment is left out, as in section 5: the parts are
    [u_m, (u_m + u*)/2] and [(u* + u_{m+1})/2, u_{m+1}].
    """
    middle = separating_point(polygon)[:, None]
    convex = (polygon.turning > 0)[:, None]
    parts = (convex | (s.t <= middle / 2), ~convex & (s.t >= (1 + middle) / 2))
    bad = np.zeros(len(s.first), dtype=bool)
    for normals in (polygon.binormals[:-1], polygon.binormals[1:]):
        size = norm(normals)[:, None]
        normals = normals / np.where(size > 0, size, 1.0)
        lean = norm(np.cross(s.omega, normals[:, None])) - sine * norm(s.omega)
        along, noise = sign_against(s, normals)
        # The binormal's own direction is uncertain by its rounding over its size.
        noise = noise + ROUNDING * norm(s.omega) / np.where(size > 0, size, 1.0)
        for part in parts:
            bad |= np.any(part & (lean > noise), axis=1)
            # Within the cone around a line, ω can only change sides through zero.
            bad |= np.any(part & (along > noise), axis=1) & np.any(part & (along < -noise), axis=1)
    return bad


def collinearity(polygon: Polygon, s: Samples, sine: float) -> npt.NDArray[np.bool_]:
    """Find where γ' leaves the chord's line by more than asin ε₀ near a straight node (2.7)."""
    chord = polygon.chords[1:-1, None]
    lean = norm(np.cross(s.first, chord)) - sine * norm(s.first)
    wrong = lean > s.first_error
    near_start = polygon.straight[:-1, None] & (s.t <= 0.5)
    near_end = polygon.straight[1:, None] & (s.t >= 0.5)
    return np.any(wrong & (near_start | near_end), axis=1)


def shape_by_sampling(
    points: npt.ArrayLike,
    parameters: npt.ArrayLike,
    boundary: Boundary,
    derivative: Derivative,
    *,
    coplanarity_sine: float = 0.2,
    collinearity_sine: float = 0.2,
    tolerance: float = 1e-9,
    count: int = 41,
) -> Sampled:
    """Sample every segment ``count`` times and return what each criterion says.

    Parameters
    ----------
    points, parameters
        The data, (n, 2) or (n, 3), and one increasing parameter a point.
    boundary
        ``None`` for zero curvature, ``"periodic"``, or the pair of end tangents.
    derivative
        ``derivative(u, order, side)``, orders 1 to 3, sides ``"left"`` and ``"right"``.
    coplanarity_sine, collinearity_sine, tolerance
        ε₁, ε₀ and the relative zero test of binormals and discrete torsion.
    count
        Samples a segment, both ends included.
    """
    polygon = data_polygon(points, parameters, boundary, tolerance)
    asked = applicable(polygon, coplanarity_sine, tolerance)
    s = sample(polygon, np.asarray(parameters, dtype=float), derivative, count)
    found = {
        "convexity": convexity(polygon, s),
        "inflection": inflection(polygon, s),
        "turning": turning(polygon, s, tolerance),
        "torsion": torsion(polygon, s),
        "coplanarity": coplanarity(polygon, s, coplanarity_sine),
        "collinearity": collinearity(polygon, s, collinearity_sine),
    }
    return Sampled(asked, {name: asked[name] & found[name] for name in CRITERIA})


def image_derivative(curve: object) -> Derivative:
    """Return the derivatives of a tension cubic's image, run through linearly on each segment.

    Its end legs are h λ⁰ T/3 and h λ¹ T'/3 (Manni 2001, (3.2)); one segment a row of u.
    """
    u0, h = curve.parameters[:-1, None], np.diff(curve.parameters)[:, None]
    start, end = (h * scale[:, None] / 3 for scale in curve.tangent_scale)
    a, c = start * curve.tangents[:-1], end * curve.tangents[1:]
    b = np.diff(curve.points, axis=0) - a - c
    ab, bc = b - a, c - b

    def derivative(u: Array, order: int, side: str) -> Array:
        t = ((u.reshape(len(h), -1) - u0) / h)[..., None]
        A, B, C, AB, BC = (v[:, None] for v in (a, b, c, ab, bc))
        if order == 1:
            value = 3 * (A * (1 - t) ** 2 + 2 * B * t * (1 - t) + C * t**2)
        elif order == 2:
            value = 6 * (AB * (1 - t) + BC * t)
        else:
            value = 6 * (BC - AB) + 0 * t
        for _ in range(order):
            value = value / h[:, None]
        return value.reshape(*u.shape, -1)

    return derivative


def of_curve(curve: object, **options: float) -> Sampled:
    """Sample a shapespline curve against its own data, through its public interface only.

    What is sampled is the image run through linearly on each segment: shape does not depend on the
    parameter, but the halves of a segment near a straight node do.
    """
    boundary = curve.boundary
    if isinstance(boundary, str):
        if boundary == "circular":
            # Karavelas & Kaklis, Example 1: the ends' tangents are those of the circles, before
            # tension has shortened them.
            full = np.ones(len(curve.points))
            if type(curve).__name__ == "NuSpline":
                full = 1 + curve.tension
            elif type(curve).__name__ == "CatmullRom":
                full = 1 / (1 - curve.tension)
            boundary = (curve.tangents[0] * full[0], curve.tangents[-1] * full[-1])
        elif boundary != "periodic":
            boundary = None
    else:
        boundary = (boundary.start, boundary.end)
    derivative = lambda u, order, side: curve(u, order, side=side)  # noqa: E731
    if hasattr(curve, "image_parameter"):
        derivative = image_derivative(curve)
    return shape_by_sampling(
        curve.points,
        curve.parameters,
        boundary,
        derivative,
        **options,
    )

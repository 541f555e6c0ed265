# SPDX-License-Identifier: MIT OR Apache-2.0

"""Data polygons to interpolate: the shared data sets, and families made to be difficult.

Every generator is seeded, so a failure names a polygon that everybody can make again.
"""

from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

DATA = Path(__file__).parent / "data"
#: Karavelas & Kaklis 2000, Table 6.2.
GM_TANGENTS = ((-11.038033, 801.759583, -57.116488), (-758.641754, 249.218852, -132.963858))
#: file and boundary of the space curves in tests/data
SPACE_SETS = (
    ("gm_feature_line", "tangents"),
    ("gm_feature_line", "zero-curvature"),
    ("gps_mojstrovka", "zero-curvature"),
    ("gps_mojstrovka", "circular"),
    ("protein_1a8o_ca", "zero-curvature"),
    ("protein_1a8o_ca", "circular"),
    ("coil_m16n08_first", "periodic"),
)


def load(name: str) -> dict[str, Array]:
    """Return the columns of a file in tests/data by name; lines starting with # are comments."""
    with (DATA / f"{name}.csv").open(encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    table = np.loadtxt(lines[1:], delimiter=",", ndmin=2)
    return dict(zip(lines[0].strip().split(","), table.T, strict=True))


def load_points(name: str) -> Array:
    """Return the points of a file in tests/data, one a row."""
    columns = load(name)
    return np.column_stack([columns[axis] for axis in "xyz" if axis in columns])


def helix(count: int = 25) -> Array:
    """Return (cos θ, sin θ, θ) with θ in steps of π/3: Karavelas & Kaklis 2000, Example 1."""
    theta = np.arange(count) * (np.pi / 3)
    return np.column_stack([np.cos(theta), np.sin(theta), theta])


def circle_tangent(a: Array, b: Array, c: Array) -> Array:
    """Return the unit tangent, at ``a``, of the circle through three points.

    Seen from ``a`` under inversion, the circle is a straight line parallel to that tangent.
    """
    first, second = b - a, c - a
    tangent = first / (first @ first) - second / (second @ second)
    return tangent / np.linalg.norm(tangent)


def helix_tangents(length: float) -> tuple[Array, Array]:
    """Return the end tangents along the circles through the first and the last three points."""
    points = helix()
    start = circle_tangent(points[0], points[1], points[2])
    end = -circle_tangent(points[-1], points[-2], points[-3])
    return length * start, length * end


def rotation(rng: np.random.Generator, dim: int = 3) -> Array:
    """Return a random proper rotation matrix."""
    q, r = np.linalg.qr(rng.normal(size=(dim, dim)))
    q = q * np.sign(np.diag(r))
    q[:, 0] *= np.sign(np.linalg.det(q))
    return q


def random_walk(rng: np.random.Generator, count: int, dim: int = 3) -> Array:
    """Return independent normal steps: every turn and torsion occurs."""
    return np.cumsum(rng.normal(size=(count, dim)), axis=0)


def near_collinear(rng: np.random.Generator, count: int, dim: int = 3) -> Array:
    """Return a line in a random direction with a ripple between 1e-12 and 1e-2 of its length."""
    ripple = 10.0 ** rng.uniform(-12, -2)
    points = ripple * rng.normal(size=(count, dim))
    points[:, 0] += np.cumsum(rng.uniform(0.2, 2.0, count))
    return points @ rotation(rng, dim)


def near_coplanar(rng: np.random.Generator, count: int) -> Array:
    """Return a planar walk lifted out of its plane by between 1e-13 and 1e-3."""
    points = random_walk(rng, count)
    points[:, 2] = 10.0 ** rng.uniform(-13, -3) * rng.normal(size=count)
    return points @ rotation(rng)


def doubling_back(rng: np.random.Generator, count: int, dim: int = 3) -> Array:
    """Return a walk that turns round by 180° at some nodes, exactly or to within 1e-14 … 1e-4."""
    step = rng.integers(-4, 5, size=dim).astype(float)
    step[0] += 5.0
    steps = [step]
    for _ in range(count - 2):
        kind = rng.integers(4)
        if kind == 0:
            step = -step  # exactly: the coordinates are small integers, so sums are exact
        elif kind == 1:
            nearly = 10.0 ** rng.uniform(-14, -4) * rng.normal(size=dim)
            step = -step * rng.uniform(0.3, 3.0) + nearly
        else:
            step = rng.integers(-4, 5, size=dim).astype(float)
            step[1] += 5.0
        steps.append(step)
    return np.vstack([np.zeros(dim), np.cumsum(steps, axis=0)])


def uneven_chords(rng: np.random.Generator, count: int, dim: int = 3) -> Array:
    """Return a walk whose chord lengths differ by up to 1e6."""
    steps = rng.normal(size=(count, dim))
    steps /= np.linalg.norm(steps, axis=1, keepdims=True)
    return np.cumsum(steps * 10.0 ** rng.uniform(-3, 3, size=(count, 1)), axis=0)


def lattice_walk(rng: np.random.Generator, count: int, dim: int = 3) -> Array:
    """Return steps to lattice neighbours: exactly straight, coplanar and reversed pieces abound."""
    steps = np.zeros((count, dim))
    steps[np.arange(count), rng.integers(dim, size=count)] = rng.choice([-1.0, 1.0], count)
    return np.cumsum(steps, axis=0)


def regular(rng: np.random.Generator, count: int, dim: int = 3) -> Array:
    """Return a few lattice steps over and over: what fails somewhere fails at every repeat."""
    steps = rng.integers(-2, 3, size=(rng.integers(1, 6), dim)).astype(float)
    steps[~steps.any(axis=1), 0] = 1.0
    return np.cumsum(np.resize(steps, (2 * count, dim)), axis=0)


def planar_in_space(rng: np.random.Generator, count: int) -> Array:
    """Return a walk in the plane z = 0 given with three coordinates."""
    points = random_walk(rng, count)
    points[:, 2] = 0.0
    return points


def two_or_three(rng: np.random.Generator, count: int, dim: int = 3) -> Array:
    """Return the smallest data: two points, or three."""
    return rng.normal(size=(2 + count % 2, dim))


def close(points: Array) -> Array:
    """Return the polygon closed by its first point, which is repeated as the last."""
    return np.vstack([points, points[:1]])


#: name → generator of (rng, count): what the zero-violations test runs through
FAMILIES = {
    "random walk": random_walk,
    "planar walk": lambda rng, count: random_walk(rng, count, 2),
    "near collinear": near_collinear,
    "planar near collinear": lambda rng, count: near_collinear(rng, count, 2),
    "near coplanar": near_coplanar,
    "doubling back": doubling_back,
    "planar doubling back": lambda rng, count: doubling_back(rng, count, 2),
    "uneven chords": uneven_chords,
    "planar uneven chords": lambda rng, count: uneven_chords(rng, count, 2),
    "lattice walk": lattice_walk,
    "planar lattice walk": lambda rng, count: lattice_walk(rng, count, 2),
    "regular": regular,
    "planar regular": lambda rng, count: regular(rng, count, 2),
    "planar in space": planar_in_space,
    "two or three points": two_or_three,
}


def gentle_track(count: int, kinks: float = 0.003, seed: int = 7) -> Array:
    """Return a long helix-like track that keeps its shape except at a few sharp corners.

    Curvature and torsion vary slowly and keep their signs, so a C² cubic keeps the shape almost
    everywhere; a fraction ``kinks`` of the nodes is pushed sideways by a third of a chord.
    """
    rng = np.random.default_rng(seed)
    s = np.arange(count) * 0.15
    phase = s + 0.3 * np.sin(s / 40)
    points = np.column_stack([np.cos(phase), np.sin(phase), 0.35 * s + 0.5 * np.sin(s / 60)])
    corners = rng.choice(np.arange(5, max(6, count - 5)), size=int(kinks * count), replace=False)
    points[corners] += 0.05 * rng.normal(size=(len(corners), 3))
    return points

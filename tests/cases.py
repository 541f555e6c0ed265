# SPDX-License-Identifier: MIT OR Apache-2.0

"""What to fit: data sets with their ends, ready to be passed to a curve's constructor."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

import polygons
import shapespline as ss

STRATEGIES = ("nussp", "growth", "fairest")
#: the families of curves that must pass the same checks
FAMILIES = (ss.FairSpline, ss.NuSpline, ss.TensionSpline, ss.CatmullRom)
#: those of them that can be given tension
TENSE = (ss.NuSpline, ss.TensionSpline, ss.CatmullRom)
#: the names that fits know the families by
METHODS = {
    ss.FairSpline: "fair",
    ss.NuSpline: "nu",
    ss.TensionSpline: "tension",
    ss.CatmullRom: "catmull-rom",
}
#: what Karavelas & Kaklis and Gautam ask of a segment: they leave out Manni's (i.3) at the nodes
PAPERS = ("convexity", "inflection", "torsion", "coplanarity", "collinearity")


def preserving(family: type[ss.SpaceCurve]) -> Callable[..., ss.SpaceCurve]:
    """Return what makes the shape-preserving curve of a family."""
    return family if family is ss.FairSpline else family.shape_preserving


def tension_of(curve: ss.SpaceCurve) -> npt.NDArray[np.float64]:
    """Return the tension of a curve, none of a fair one."""
    return np.zeros(len(curve.points)) if isinstance(curve, ss.FairSpline) else curve.tension


@dataclass(frozen=True)
class Case:
    """Arguments of a fit, and the changes of coordinates that it must be indifferent to."""

    name: str
    points: npt.NDArray[np.float64]
    parameters: object = "chordal"
    boundary: object = "zero-curvature"
    family: type[ss.SpaceCurve] = ss.NuSpline

    def __str__(self) -> str:
        name = self.family.__name__
        return self.name if self.family is ss.NuSpline else f"{name}: {self.name}"

    def fit(self, **options: object) -> ss.SpaceCurve:
        """Return the curve with given tension, which a fair one does not have."""
        return self.family(self.points, self.parameters, boundary=self.boundary, **options)

    def tense(self, tension: npt.ArrayLike) -> ss.SpaceCurve:
        """Return the curve with tension, in the units of ν or 1/λ − 1, whatever the family."""
        if self.family is ss.FairSpline:
            return self.fit()
        tension = np.asarray(tension, dtype=float)
        if self.family is ss.TensionSpline:
            return self.fit(tangent_scale=1 / (1 + tension))
        if self.family is ss.CatmullRom:
            return self.fit(tension=tension / (1 + tension))
        return self.fit(tension=tension)

    def preserve(self, **options: object) -> ss.SpaceCurve:
        """Return the shape-preserving curve; only ν and tension splines know strategies."""
        if self.family in (ss.FairSpline, ss.CatmullRom):
            options.pop("strategy", None)
        make = preserving(self.family)
        return make(self.points, self.parameters, boundary=self.boundary, **options)

    def explicit(self) -> "Case":
        """Return the same case with its parameters as an array."""
        return replace(self, parameters=self.fit().parameters)

    def moved(self, points: npt.NDArray[np.float64], vectors=lambda v: v) -> "Case":
        """Return the case with other points, and its end tangents passed through ``vectors``."""
        boundary = self.boundary
        if isinstance(boundary, ss.Tangents):
            ends = (boundary.start, boundary.end)
            boundary = ss.Tangents(*(None if v is None else vectors(v) for v in ends))
        return replace(self, points=points, boundary=boundary)

    def reversed(self) -> "Case":
        """Return the case traversed backwards, with explicit parameters."""
        u = self.fit().parameters
        boundary = self.boundary
        if isinstance(boundary, ss.Tangents):
            ends = (boundary.end, boundary.start)
            boundary = ss.Tangents(*(None if v is None else -v for v in ends))
        return replace(
            self,
            points=self.points[::-1],
            parameters=(u[-1] + u[0]) - u[::-1],
            boundary=boundary,
        )


def space_set(name: str, end: str) -> Case:
    """Return one of ``polygons.SPACE_SETS``; the GM line comes with its parameters."""
    columns = polygons.load(name)
    parameters = columns.get("u", "chordal")
    boundary = ss.Tangents(*polygons.GM_TANGENTS) if end == "tangents" else end
    return Case(f"{name}, {end}", polygons.load_points(name), parameters, boundary)


def gm_line() -> Case:
    """Return Karavelas & Kaklis 2000, Example 2."""
    return space_set("gm_feature_line", "tangents")


def helix(length: float = 6.0) -> Case:
    """Return Karavelas & Kaklis 2000, Example 1, with end tangents of the given length."""
    return Case("helix", polygons.helix(), "chordal", ss.Tangents(*polygons.helix_tangents(length)))


def shared() -> list[Case]:
    """Return every space curve of tests/data with its ends, and the helix."""
    return [*(space_set(*pair) for pair in polygons.SPACE_SETS), helix()]


def small() -> list[Case]:
    """Return one case for each kind of end and both dimensions, small enough for every strategy."""
    rng = np.random.default_rng(3)
    walk = polygons.random_walk(rng, 14)
    plane = polygons.random_walk(rng, 14, 2)
    start = 1.3 * (walk[1] - walk[0]) - 0.4 * (walk[2] - walk[1])
    return [
        gm_line(),
        helix(),
        space_set("protein_1a8o_ca", "zero-curvature"),
        Case("coil", polygons.load_points("coil_m16n08_first"), "chordal", "periodic"),
        Case("walk, zero curvature", walk),
        Case("walk, circular, centripetal", walk, "centripetal", "circular"),
        Case("walk, closed", polygons.close(walk), "chordal", "periodic"),
        Case("plane, zero curvature", plane),
        Case("plane, closed", polygons.close(plane), "uniform", "periodic"),
        Case("plane, tangents", plane, "chordal", ss.Tangents([1.0, 0.5], [-0.2, 2.0])),
        Case("walk, start tangent", walk, "chordal", ss.Tangents(start)),
        Case("plane, end tangent", plane, "chordal", ss.Tangents(end=[-0.2, 2.0])),
    ]


def of_every_family(cases: list[Case]) -> list[Case]:
    """Return each case once for each family of curves."""
    return [replace(case, family=family) for family in FAMILIES for case in cases]

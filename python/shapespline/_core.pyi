from collections.abc import Iterable, Sequence
from typing import Any, Literal, NoReturn, TypedDict, final, overload

import numpy as np
import pandas as pd  # type: ignore[import-untyped, unused-ignore]
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import (  # type: ignore[import-untyped, unused-ignore]
    BSpline,
    PPoly,
)
from typing_extensions import Self, disjoint_base

from shapespline._records import NodeRecord, OscillationRecord, UndecidedRecord

__version__: str

__all__ = [
    "CatmullRom",
    "Diagnostics",
    "NuSpline",
    "PiecewiseBezier",
    "SearchStep",
    "ShapeRecord",
    "ShapeReport",
    "SpaceCurve",
    "Tangents",
    "TensionSpline",
    "__version__",
    "_check_shape",
    "_curve_from_bytes",
    "_curve_inflections",
    "_fit_many",
    "_piecewise_from_bytes",
    "_polygon_inflections",
    "_polygon_shape",
    "_report_from_bytes",
]

_Floats = NDArray[np.float64]
_Side = Literal["left", "right"]
_Criterion = Literal[
    "convexity", "inflection", "torsion", "coplanarity", "collinearity", "global-convexity"
]
_Boundary = Literal["zero-curvature", "natural", "periodic", "circular"]
_Strategy = Literal["nussp", "growth", "fairest", "reduction"]
_Continuity = Literal["C1", "G1"]
_Parametrization = Literal["uniform", "chordal", "centripetal"]
# An array or nested lists: what gives an array back where one number gives a number.
_Many = NDArray[np.generic] | Sequence[float] | Sequence[Sequence[float]]

class _Count(TypedDict):
    violated: int
    applicable: int

class _Record(TypedDict):
    segment: int
    criterion: _Criterion
    applicable: bool
    satisfied: bool
    margin: float | None
    location: float | None

class _Undecided(TypedDict):
    segment: int
    criterion: _Criterion
    interval: list[float]

class _Report(TypedDict):
    ok: bool
    margin: float | None
    counts: dict[_Criterion, _Count]
    coplanarity: float
    collinearity: float
    tolerance: float
    segments: list[_Record]
    violations: list[_Record]
    undecided: list[_Undecided]

@disjoint_base
class SpaceCurve:
    def __new__(cls) -> Self: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def parameters(self) -> _Floats: ...
    @property
    def tangents(self) -> _Floats: ...
    @property
    def tension(self) -> _Floats: ...
    @property
    def boundary(self) -> Literal["zero-curvature", "periodic", "circular"] | Tangents: ...
    @property
    def bezier(self) -> _Floats: ...
    @property
    def diagnostics(self) -> Diagnostics | None: ...
    @property
    def history(self) -> list[SearchStep] | None: ...
    def __call__(self, u: ArrayLike, nu: int = 0, *, side: _Side = "right") -> _Floats: ...
    @overload
    def curvature(self, u: float, *, side: _Side = "right") -> float: ...
    @overload
    def curvature(self, u: _Many, *, side: _Side = "right") -> _Floats: ...
    @overload
    def curvature(self, u: ArrayLike, *, side: _Side = "right") -> float | _Floats: ...
    def curvature_vector(self, u: ArrayLike, *, side: _Side = "right") -> _Floats: ...
    @overload
    def torsion(self, u: float, *, side: _Side = "right") -> float: ...
    @overload
    def torsion(self, u: _Many, *, side: _Side = "right") -> _Floats: ...
    @overload
    def torsion(self, u: ArrayLike, *, side: _Side = "right") -> float | _Floats: ...
    def frame(self, u: ArrayLike, side: _Side = "right") -> tuple[_Floats, _Floats, _Floats]: ...
    def arc_length(self, a: float | None = None, b: float | None = None) -> float: ...
    def sample(self, n: int, by: Literal["parameter", "arc-length"] = "parameter") -> _Floats: ...
    def to_bspline(self) -> BSpline: ...
    def to_ppoly(self) -> PPoly: ...
    def check(
        self,
        criteria: _Criterion | Iterable[_Criterion] | None = None,
        *,
        coplanarity: float = 0.2,
        collinearity: float = 0.2,
        tolerance: float = 1e-9,
    ) -> ShapeReport: ...
    def _discrete_torsion(self) -> _Floats: ...
    def __copy__(self) -> SpaceCurve: ...
    def __deepcopy__(self, _memo: object) -> SpaceCurve: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class NuSpline(SpaceCurve):
    def __new__(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "chordal",
        *,
        boundary: _Boundary | Tangents = "zero-curvature",
        tension: float | ArrayLike = 0.0,
    ) -> NuSpline: ...
    @classmethod
    def shape_preserving(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "chordal",
        *,
        boundary: _Boundary | Tangents = "zero-curvature",
        criteria: _Criterion | Iterable[_Criterion] | None = None,
        strategy: _Strategy = "fairest",
        step: float = 0.5,
        coplanarity: float = 0.2,
        collinearity: float = 0.2,
        tolerance: float = 1e-9,
        max_iterations: int | None = None,
    ) -> NuSpline: ...
    def __copy__(self) -> NuSpline: ...
    def __deepcopy__(self, _memo: object) -> NuSpline: ...

@final
class TensionSpline(SpaceCurve):
    def __new__(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "chordal",
        *,
        boundary: _Boundary | Tangents = "natural",
        tangent_scale: float | ArrayLike | tuple[ArrayLike, ArrayLike] = 1.0,
    ) -> TensionSpline: ...
    @classmethod
    def shape_preserving(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "chordal",
        *,
        boundary: _Boundary | Tangents = "natural",
        criteria: _Criterion | Iterable[_Criterion] | None = None,
        strategy: _Strategy = "fairest",
        step: float | None = None,
        coplanarity: float = 0.2,
        collinearity: float = 0.2,
        tolerance: float = 1e-9,
        max_iterations: int | None = None,
    ) -> TensionSpline: ...
    @property
    def tangent_scale(self) -> tuple[_Floats, _Floats]: ...
    @overload
    def image_parameter(self, u: float) -> float: ...
    @overload
    def image_parameter(self, u: _Many) -> _Floats: ...
    @overload
    def image_parameter(self, u: ArrayLike) -> float | _Floats: ...
    def __copy__(self) -> TensionSpline: ...
    def __deepcopy__(self, _memo: object) -> TensionSpline: ...

@final
class CatmullRom(SpaceCurve):
    def __new__(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "centripetal",
        *,
        boundary: _Boundary | Tangents = "natural",
        tension: float | ArrayLike = 0.0,
        continuity: _Continuity = "C1",
    ) -> CatmullRom: ...
    @classmethod
    def shape_preserving(
        cls,
        points: ArrayLike,
        parameters: _Parametrization | float | ArrayLike = "centripetal",
        *,
        boundary: _Boundary | Tangents = "natural",
        criteria: _Criterion | Iterable[_Criterion] | None = None,
        safety: float = 0.9,
        continuity: _Continuity = "C1",
        coplanarity: float = 0.2,
        collinearity: float = 0.2,
        tolerance: float = 1e-9,
    ) -> CatmullRom: ...
    @property
    def continuity(self) -> _Continuity: ...
    def __copy__(self) -> CatmullRom: ...
    def __deepcopy__(self, _memo: object) -> CatmullRom: ...

@final
class Tangents:
    def __new__(cls, start: ArrayLike, end: ArrayLike) -> Tangents: ...
    @property
    def start(self) -> _Floats: ...
    @property
    def end(self) -> _Floats: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __copy__(self) -> Tangents: ...
    def __deepcopy__(self, _memo: object) -> Tangents: ...
    def __reduce__(self) -> tuple[type[Tangents], tuple[_Floats, _Floats]]: ...

@final
class PiecewiseBezier:
    def __new__(
        cls, control: ArrayLike, breaks: ArrayLike, *, weights: ArrayLike | None = None
    ) -> PiecewiseBezier: ...
    @classmethod
    def from_bspline(
        cls,
        knots: ArrayLike,
        control: ArrayLike,
        degree: int,
        *,
        weights: ArrayLike | None = None,
    ) -> PiecewiseBezier: ...
    @classmethod
    def from_power(cls, coefficients: ArrayLike, breaks: ArrayLike) -> PiecewiseBezier: ...
    @property
    def control(self) -> _Floats: ...
    @property
    def weights(self) -> _Floats | None: ...
    @property
    def breaks(self) -> _Floats: ...
    @property
    def degree(self) -> int: ...
    def __call__(self, u: ArrayLike) -> _Floats: ...
    def __copy__(self) -> PiecewiseBezier: ...
    def __deepcopy__(self, _memo: object) -> PiecewiseBezier: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class ShapeRecord:
    def __new__(
        cls,
        segment: int,
        criterion: str,
        applicable: bool,
        satisfied: bool,
        margin: float,
        location: float,
    ) -> ShapeRecord: ...
    @property
    def segment(self) -> int: ...
    @property
    def criterion(self) -> _Criterion: ...
    @property
    def applicable(self) -> bool: ...
    @property
    def satisfied(self) -> bool: ...
    @property
    def margin(self) -> float: ...
    @property
    def location(self) -> float: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[type[ShapeRecord], tuple[object, ...]]: ...

@final
class ShapeReport:
    def __new__(cls) -> NoReturn: ...
    @property
    def ok(self) -> bool: ...
    @property
    def margin(self) -> float: ...
    @property
    def violations(self) -> list[ShapeRecord]: ...
    @property
    def segments(self) -> list[ShapeRecord]: ...
    @property
    def undecided(self) -> list[UndecidedRecord]: ...
    @property
    def nodes(self) -> list[NodeRecord]: ...
    @property
    def oscillations(self) -> list[OscillationRecord]: ...
    @property
    def boundary(self) -> Literal["zero-curvature", "periodic", "circular"] | Tangents: ...
    def counts(self) -> dict[_Criterion, tuple[int, int]]: ...
    def to_dict(self) -> _Report: ...
    def to_dataframe(self) -> pd.DataFrame: ...
    def plot(self, ax: Axes | None = None) -> Axes: ...
    def _repr_html_(self) -> str: ...
    def __copy__(self) -> ShapeReport: ...
    def __deepcopy__(self, _memo: object) -> ShapeReport: ...
    def __reduce__(self) -> tuple[object, tuple[bytes]]: ...

@final
class Diagnostics:
    def __new__(
        cls, status: str, iterations: int, solves: int, relaxations: int, nodes_changed: int
    ) -> Diagnostics: ...
    @property
    def status(self) -> Literal["solved", "iteration-limit"]: ...
    @property
    def iterations(self) -> int: ...
    @property
    def solves(self) -> int: ...
    @property
    def relaxations(self) -> int: ...
    @property
    def nodes_changed(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[type[Diagnostics], tuple[object, ...]]: ...

@final
class SearchStep:
    def __new__(cls, phase: str, violations: int, changed: int) -> SearchStep: ...
    @property
    def phase(self) -> Literal["raise", "relax", "verify"]: ...
    @property
    def violations(self) -> int: ...
    @property
    def changed(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[type[SearchStep], tuple[object, ...]]: ...

def _curve_from_bytes(data: bytes) -> SpaceCurve: ...
def _report_from_bytes(data: bytes) -> ShapeReport: ...
def _fit_many(
    points: ArrayLike,
    offsets: ArrayLike,
    method: str,
    parameters: _Parametrization | float | ArrayLike,
    boundary: _Boundary | Tangents,
    shape_preserving: bool,
    threads: int | None,
    criteria: _Criterion | Iterable[_Criterion] | None,
    coplanarity: float,
    collinearity: float,
    tolerance: float,
    strategy: _Strategy,
    step: float | None,
    max_iterations: int | None,
    safety: float,
    continuity: _Continuity,
    tension: float,
    tangent_scale: float,
) -> tuple[list[SpaceCurve | None], dict[int, Exception]]: ...
def _piecewise_from_bytes(data: bytes) -> PiecewiseBezier: ...
def _check_shape(
    points: ArrayLike,
    curve: PiecewiseBezier,
    parameters: _Parametrization | float | ArrayLike | None,
    boundary: _Boundary | Tangents | None,
    criteria: _Criterion | Iterable[_Criterion] | None,
    coplanarity: float,
    collinearity: float,
    tolerance: float,
) -> ShapeReport: ...
def _curve_inflections(
    curve: PiecewiseBezier, direction: ArrayLike | None
) -> tuple[int, _Floats, bool]: ...
def _polygon_inflections(
    points: ArrayLike, direction: ArrayLike | None
) -> tuple[int, _Floats, bool]: ...
def _polygon_shape(
    points: ArrayLike,
    parameters: _Parametrization | float | ArrayLike,
    boundary: _Boundary | Tangents,
    tolerance: float,
) -> dict[str, Any]: ...

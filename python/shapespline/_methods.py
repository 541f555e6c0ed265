# SPDX-License-Identifier: MIT OR Apache-2.0

"""The methods that fit curves: their classes, their options, and the default of each."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from shapespline._core import CatmullRom, FairSpline, InputError, NuSpline, TensionSpline

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from shapespline._core import SpaceCurve

__all__ = ["METHODS", "Method", "given_options", "method_of"]


@dataclass(frozen=True)
class Method:
    """A method by what it makes and takes."""

    family: type[SpaceCurve]
    #: Options of a fit that keeps the shape, with their defaults.
    options: Mapping[str, Any]
    #: The same of given tension; empty where there is none.
    given: Mapping[str, Any]
    parameters: str = "chordal"
    #: Options of the fit of one curve, which speak of its points, with their defaults.
    alone: Mapping[str, Any] = field(default_factory=dict)

    @property
    def all_options(self) -> dict[str, Any]:
        """The options of all kinds of fit, with their defaults."""
        return {**self.options, **self.given, **self.alone}

    def fit(self, *arguments: Any, **options: Any) -> SpaceCurve:
        """Return the curve that keeps the shape."""
        make: Any = getattr(self.family, "shape_preserving", self.family)
        curve: SpaceCurve = make(*arguments, **options)
        return curve


# ``step`` has a default for each strategy, which the compiled part knows.
_CHECK = {
    "criteria": None,
    "resolution": 0.0,
    "coplanarity": 0.2,
    "collinearity": 0.2,
    "tolerance": 1e-9,
}
_SEARCH = {**_CHECK, "strategy": "fairest", "step": None, "max_iterations": None}

#: Every method of `fit`, `fit_many` and ``shapespline fit`` for curves, the default first.
METHODS: Mapping[str, Method] = MappingProxyType(
    {
        "fair": Method(
            FairSpline,
            {**_CHECK, "energy": "parametric", "max_iterations": None, "straight": False},
            {},
            alone={"corners": None, "tangents": None, "max_deviation": None},
        ),
        "nu": Method(NuSpline, _SEARCH, {"tension": 0.0}),
        "tension": Method(TensionSpline, _SEARCH, {"tangent_scale": 1.0}),
        "catmull-rom": Method(
            CatmullRom,
            {**_CHECK, "safety": 0.9, "continuity": "C1", "directions": "balanced"},
            {"tension": 0.0, "continuity": "C1"},
            "centripetal",
        ),
    }
)


def method_of(name: object) -> Method:
    """Return the method of a name."""
    if not isinstance(name, str):
        raise TypeError(f"method must be a string, got {type(name).__name__}")
    if name not in METHODS:
        names = ", ".join(f"'{known}'" for known in METHODS)
        raise InputError(f"method must be one of {names}; got '{name}'", "method", value=name)
    return METHODS[name]


def given_options(
    method: str, options: Mapping[str, Any], known: Iterable[str], where: str = ""
) -> dict[str, Any]:
    """Return the options that are not None; refuse those that the method lacks.

    The error names the methods that have the option; ``where`` says when ``known`` holds.
    """
    given = {name: value for name, value in options.items() if value is not None}
    for name in given:
        if name not in known:
            having = [f"'{n}'" for n, other in METHODS.items() if name in other.all_options]
            raise TypeError(
                f"{name} is no option of method '{method}'{where}: its options are "
                f"{', '.join(known)}; methods that have it: {', '.join(having)}"
            )
    return given

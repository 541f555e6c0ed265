# SPDX-License-Identifier: MIT OR Apache-2.0

"""The methods that fit curves, and the kinds of monotone functions, by name.

Their options and the default of each stand in one place, the signatures of the compiled classes,
and are read from there.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from shapespline._core import (
    CatmullRom,
    FairSpline,
    InputError,
    MonotoneCubic,
    MonotoneQuartic,
    MonotoneQuintic,
    NuSpline,
    SpaceCurve,
    TensionSpline,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

__all__ = ["CHECKED", "KINDS", "METHODS", "Method", "entry_of", "given_options"]

#: The options of a check.
CHECKED = tuple(inspect.signature(SpaceCurve.check).parameters)[1:]
#: What every method has, and every kind: these are no options of one.
_COMMON = ("boundary", "closed", "repeated", "extrapolate")


def _keywords(make: Any) -> dict[str, Any]:
    """Return the options of a constructor with their defaults."""
    named = inspect.signature(make).parameters.values()
    return {p.name: p.default for p in named if p.kind is p.KEYWORD_ONLY and p.name not in _COMMON}


@dataclass(frozen=True)
class Method:
    """A method or a kind by what it makes and takes."""

    family: type[Any]
    #: Options of a fit that keeps the shape, with their defaults.
    options: Mapping[str, Any]
    #: The same of given tension; empty where there is none.
    given: Mapping[str, Any]
    #: Options of the fit of one curve, which speak of its points, with their defaults.
    alone: Mapping[str, Any]

    @classmethod
    def of(cls, family: type[Any], *alone: str) -> Method:
        """Return the method that makes curves or functions of a class."""
        make = getattr(family, "shape_preserving", family)
        own = _keywords(make)
        given = {} if make is family else _keywords(family)
        return cls(family, own, given, {name: own.pop(name) for name in alone})

    @property
    def all_options(self) -> dict[str, Any]:
        """The options of all kinds of fit, with their defaults."""
        return {**self.options, **self.given, **self.alone}

    @property
    def parameters(self) -> Any:
        """The default of the parameters."""
        return inspect.signature(self.family).parameters["parameters"].default

    def fit(self, *arguments: Any, **options: Any) -> Any:
        """Return the curve that keeps the shape, or the function."""
        return getattr(self.family, "shape_preserving", self.family)(*arguments, **options)


#: Every method of `fit`, `fit_many` and ``shapespline fit`` for curves, the default first.
METHODS: Mapping[str, Method] = MappingProxyType(
    {
        "fair": Method.of(FairSpline, "corners", "tangents", "max_deviation"),
        "nu": Method.of(NuSpline),
        "tension": Method.of(TensionSpline),
        "catmull-rom": Method.of(CatmullRom),
    }
)
#: Every kind of `fit_monotone`, `fit_many_monotone` and ``shapespline fit``, the default first.
KINDS: Mapping[str, Method] = MappingProxyType(
    {
        "cubic": Method.of(MonotoneCubic),
        "quintic": Method.of(MonotoneQuintic),
        "quartic": Method.of(MonotoneQuartic),
    }
)
_TABLES = {"method": METHODS, "kind": KINDS}


def entry_of(argument: str, name: object) -> Method:
    """Return the method or the kind of a name; ``argument`` says which of the two."""
    table = _TABLES[argument]
    if not isinstance(name, str):
        raise TypeError(f"{argument} must be a string, got {type(name).__name__}")
    if name not in table:
        names = ", ".join(f"'{known}'" for known in table)
        raise InputError(f"{argument} must be one of {names}; got '{name}'", argument, value=name)
    return table[name]


def given_options(
    argument: str, name: str, options: Mapping[str, Any], known: Iterable[str], where: str = ""
) -> dict[str, Any]:
    """Return the options that are not None; refuse those that the method or the kind lacks.

    The error names those that have the option; ``where`` says when ``known`` holds.
    """
    given = {option: value for option, value in options.items() if value is not None}
    for option in given:
        if option not in known:
            table = _TABLES[argument].items()
            having = [f"'{n}'" for n, other in table if option in other.all_options]
            raise TypeError(
                f"{option} is no option of {argument} '{name}'{where}: its options are "
                f"{', '.join(known)}; {argument}s that have it: {', '.join(having)}"
            )
    return given

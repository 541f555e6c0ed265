# SPDX-License-Identifier: MIT OR Apache-2.0

"""The kinds of monotone functions: their classes, and the options of each."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from shapespline._core import InputError, MonotoneCubic, MonotoneQuartic, MonotoneQuintic

if TYPE_CHECKING:
    from collections.abc import Mapping

    from shapespline._core import MonotoneSpline

__all__ = ["KINDS", "Kind", "kind_of"]


@dataclass(frozen=True)
class Kind:
    """A kind of monotone function by its class and the options that are its own."""

    family: type[MonotoneSpline]
    options: tuple[str, ...]

    def fit(self, *arguments: Any, **options: Any) -> MonotoneSpline:
        """Return the interpolant."""
        make: Any = self.family
        function: MonotoneSpline = make(*arguments, **options)
        return function


#: Every kind of `fit_monotone`, `fit_many_monotone` and ``shapespline fit``, the default first.
KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        "cubic": Kind(MonotoneCubic, ("convex", "slopes", "ends", "layer", "min_slope")),
        "quintic": Kind(MonotoneQuintic, ("slopes", "energy", "clip")),
        "quartic": Kind(MonotoneQuartic, ("slopes", "shape")),
    }
)


def kind_of(kind: object) -> Kind:
    """Return the kind of a name."""
    if not isinstance(kind, str):
        raise TypeError(f"kind must be a string, got {type(kind).__name__}")
    if kind not in KINDS:
        names = ", ".join(f"'{name}'" for name in KINDS)
        raise InputError(f"kind must be one of {names}; got '{kind}'", "kind", value=kind)
    return KINDS[kind]

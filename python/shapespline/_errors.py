"""Exceptions of shapespline."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from shapespline._core import ShapeReport, SpaceCurve


class ConvergenceError(RuntimeError):
    """The limit of iterations was reached before the curve kept the shape of its points.

    Attributes
    ----------
    curve : SpaceCurve
        The last curve: it interpolates the points, but violates what ``report`` lists.
    report : ShapeReport
        The complete check of that curve.

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    >>> try:
    ...     ss.NuSpline.shape_preserving(points, "uniform", max_iterations=1)
    ... except ss.ConvergenceError as error:
    ...     print(len(error.report.violations), error.curve.tension)
    4 [0. 0. 0. 0. 0.]
    """

    curve: SpaceCurve
    report: ShapeReport

    def __init__(self, message: str, curve: SpaceCurve, report: ShapeReport) -> None:
        # All three are args, so that pickling makes the exception again from them.
        super().__init__(message, curve, report)
        self.curve = curve
        self.report = report

    def __str__(self) -> str:
        """Return the message alone."""
        return str(self.args[0])

# SPDX-License-Identifier: MIT OR Apache-2.0

"""The exceptions of the compiled module, which compiles this text into itself.

With the stable ABI of CPython before 3.12 no class of Rust can extend an exception.
"""


class InputError(ValueError):
    """An argument that cannot be used; the text says which, where, what it must be and what it is.

    Attributes
    ----------
    argument : str
        Name of the argument.
    index : int, tuple of int, or None
        Where in the argument; of a collection, the index of the curve or row comes first.
    value : object
        The value there: a number, a name, a shape, or what was measured of it.

    Examples
    --------
    >>> import shapespline as ss
    >>> try:
    ...     ss.NuSpline([[0, 0], [1, 1], [2, float("nan")]])
    ... except ss.InputError as error:
    ...     print(error.argument, error.index, error.value)
    points 2 nan
    """

    def __init__(self, message, argument="", index=None, value=None):
        # Pickling makes the exception again from the message, and then sets the attributes.
        super().__init__(message)
        self.argument = argument
        self.index = index
        self.value = value


class ConvergenceError(RuntimeError):
    """No curve was found that keeps the shape of its points.

    The limit of iterations was reached first, or tension can rise no further where a criterion is
    violated: ``curve.diagnostics.status`` says which.

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
    6 [0. 0. 0. 0. 0.]
    """

    def __init__(self, message, curve, report):
        # All three are args, so that pickling makes the exception again from them.
        super().__init__(message, curve, report)
        self.curve = curve
        self.report = report

    def __str__(self):
        """Return the message alone."""
        return str(self.args[0])

# SPDX-License-Identifier: MIT OR Apache-2.0

"""Curves for other programs: exact B-splines, for geomdl, as SVG and as STEP.

Everything here is exact but for rounding: a curve is a piecewise polynomial already, and only its
writing changes. Each function takes what `check_shape` takes: a curve or a monotone function of
this module, a SciPy ``BSpline``, ``PPoly`` or ``BPoly``, or a `PiecewiseBezier`.

>>> import shapespline as ss
>>> ss.interchange.svg_path(ss.NuSpline([[0, 0], [3, 6]], "uniform"))
'M0.0,0.0 C1.0,2.0 2.0,4.0 3.0,6.0'
"""

from __future__ import annotations

import html
import json
import math
from numbers import Real
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from shapespline._bspline import fair_knots, fewest_knots
from shapespline._convert import piecewise
from shapespline._core import FairSpline, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["BSplineData", "bspline", "geomdl_json", "step", "svg", "svg_path"]


class BSplineData(NamedTuple):
    """A B-spline by its numbers: what every library and file format asks for.

    Attributes
    ----------
    knots : numpy.ndarray, shape (n + degree + 1,)
        Never falling, the first and the last degree + 1 times.
    control : numpy.ndarray, shape (n, dim)
        Control points.
    degree : int
        Degree of the pieces.
    weights : numpy.ndarray, shape (n,), or None
        Of a rational curve.

    Examples
    --------
    >>> import shapespline as ss
    >>> ss.interchange.bspline(ss.NuSpline([[0, 0], [3, 6]], "uniform")).knots
    array([0., 0., 0., 0., 1., 1., 1., 1.])
    """

    knots: Floats
    control: Floats
    degree: int
    weights: Floats | None


def _between(argument: str, value: Any, low: float, high: float) -> float:
    """Return a number between two others."""
    if not isinstance(value, Real):
        raise TypeError(f"{argument} must be a number, got {type(value).__name__}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not low < number < high:
        raise InputError(
            f"{argument} must be in ({low:g}, {high:g}), got {number:g}", argument, value=number
        )
    return number


def _text(argument: str, value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{argument} must be a string, got {type(value).__name__}")
    return value


def bspline(curve: Any) -> BSplineData:
    """Return a curve as one B-spline, with no more knots than its smoothness needs.

    Parameters
    ----------
    curve : SpaceCurve, MonotoneSpline, BSpline, PPoly, BPoly or PiecewiseBezier
        The curve; of a function, its graph. A `TensionSpline` gives the same image, in the
        parameter of its ``image_parameter``.

    Returns
    -------
    BSplineData
        Inner knots are degree-fold, one less for each derivative that is continuous to rounding: a
        C² cubic has simple ones, a `FairSpline` always, but for its corners. Those of a rational
        curve are degree-fold.

    Raises
    ------
    InputError
        If the pieces do not meet: a B-spline with such knots would join them.
    TypeError
        If it is no curve.

    See Also
    --------
    SpaceCurve.to_bspline : a SciPy ``BSpline``, with triple knots (but of a `FairSpline`).

    Notes
    -----
    Cost O(n).

    Examples
    --------
    >>> import shapespline as ss
    >>> points = [[0, 0], [1, 1], [2, 0], [3, 1]]
    >>> data = ss.interchange.bspline(ss.NuSpline(points, "uniform"))
    >>> data.degree, data.knots
    (3, array([0., 0., 0., 0., 1., 2., 3., 3., 3., 3.]))
    >>> from scipy.interpolate import BSpline
    >>> BSpline(data.knots, data.control, data.degree)(1.0).round(12)
    array([1., 1.])
    """
    if isinstance(curve, FairSpline):
        return BSplineData(*fair_knots(curve), 3, None)
    pieces = piecewise(curve)
    control, breaks, degree = pieces.control, pieces.breaks, pieces.degree
    gaps = np.abs(control[1:, 0] - control[:-1, -1]).max(axis=1, initial=0.0)
    if len(gaps) and gaps.max() > 1e-9 * np.ptp(control, axis=(0, 1)).max():
        i = int(gaps.argmax())
        raise InputError(
            f"the pieces must meet, but pieces {i} and {i + 1} are {gaps[i]:.3g} apart at "
            f"{breaks[i + 1]:g}",
            "curve",
            i + 1,
            float(gaps[i]),
        )
    if pieces.weights is None:
        return BSplineData(*fewest_knots(control, breaks), degree, None)
    # The end of a piece is the start of the next.
    kept = np.ones(control.shape[:2], dtype=bool)
    kept[1:, 0] = False
    knots = np.repeat(breaks, np.r_[degree + 1, np.full(len(control) - 1, degree), degree + 1])
    return BSplineData(knots, control[kept], degree, pieces.weights[kept])


def geomdl_json(curve: Any, *, delta: float = 0.01) -> str:
    """Return a curve as the JSON that geomdl (NURBS-Python) reads with ``exchange.import_json``.

    Parameters
    ----------
    curve : SpaceCurve, MonotoneSpline, BSpline, PPoly, BPoly or PiecewiseBezier
        The curve.
    delta : float
        geomdl's step of evaluation, in (0, 1).

    Returns
    -------
    str
        One curve. geomdl moves its parameters to [0, 1].

    Raises
    ------
    InputError
        If ``delta`` is out of range, or as for `bspline`.
    TypeError
        As for `bspline`.

    Examples
    --------
    >>> import json
    >>> import shapespline as ss
    >>> text = ss.interchange.geomdl_json(ss.NuSpline([[0, 0], [3, 6]], "uniform"))
    >>> json.loads(text)["shape"]["data"][0]["control_points"]["points"]
    [[0.0, 0.0], [1.0, 2.0], [2.0, 4.0], [3.0, 6.0]]
    """
    delta = _between("delta", delta, 0.0, 1.0)
    data = bspline(curve)
    control: dict[str, Any] = {"points": data.control.tolist()}
    if data.weights is not None:
        control["weights"] = data.weights.tolist()
    entries = {
        "type": "spline",
        "rational": data.weights is not None,
        "dimension": data.control.shape[1],
        "degree": data.degree,
        "knotvector": data.knots.tolist(),
        "control_points": control,
        "delta": delta,
    }
    return json.dumps({"shape": {"type": "curve", "count": 1, "data": [entries]}}, indent=1)


# SVG


def _planar(curve: Any) -> Floats:
    """Return the control points of a planar curve of degree 1 to 3."""
    pieces = piecewise(curve)
    if pieces.control.shape[2] != 2:
        text = "SVG is for curves in the plane, but the points of curve have 3 columns"
        raise InputError(text, "curve", value=3)
    if pieces.weights is not None or pieces.degree > 3:
        what = "rational ones" if pieces.weights is not None else f"degree {pieces.degree}"
        raise InputError(f"SVG knows polynomials of degree 1 to 3 only, not {what}", "curve")
    return pieces.control


def svg_path(curve: Any) -> str:
    """Return a planar curve as the data ``d`` of an SVG path.

    Parameters
    ----------
    curve : SpaceCurve, BSpline, PPoly, BPoly or PiecewiseBezier
        The curve, in the plane, of degree 1 to 3.

    Returns
    -------
    str
        Numbers that read back to the last bit. SVG's y points down: turn the picture over with
        ``transform="scale(1,-1)"``, or use `svg`.

    Raises
    ------
    InputError
        If the curve is in space, rational, or of a higher degree.
    TypeError
        If it is no curve.

    Examples
    --------
    >>> import shapespline as ss
    >>> arch = ss.PiecewiseBezier([[[0, 0], [0, 1], [2, 1], [2, 0]]], [0, 1])
    >>> ss.interchange.svg_path(arch)
    'M0.0,0.0 C0.0,1.0 2.0,1.0 2.0,0.0'
    """
    letters = {2: "L", 3: "Q", 4: "C"}
    control = _planar(curve)
    letter = letters[control.shape[1]]
    parts = [f"M{_pair(control[0, 0])}"]
    end = control[0, 0]
    for piece in control:
        if np.any(piece[0] != end):
            parts.append(f"M{_pair(piece[0])}")
        parts.append(letter + " ".join(_pair(point) for point in piece[1:]))
        end = piece[-1]
    return " ".join(parts)


def _pair(point: Floats) -> str:
    return f"{float(point[0])!r},{float(point[1])!r}"


def svg(curve: Any, *, stroke: str = "#1f5fa8", width: float | None = None) -> str:
    """Return a planar curve as an SVG document of its own, y upwards.

    Parameters
    ----------
    curve : SpaceCurve, BSpline, PPoly, BPoly or PiecewiseBezier
        The curve, in the plane, of degree 1 to 3.
    stroke : str
        Colour of the line.
    width : float, optional
        Width of the line in units of the points; default 1/200 of their extent.

    Returns
    -------
    str
        The document; its units are those of the points.

    Raises
    ------
    InputError
        If ``width`` is not positive, ``stroke`` not printable, or as for `svg_path`.
    TypeError
        As for `svg_path`.

    Examples
    --------
    >>> import shapespline as ss
    >>> ss.interchange.svg(ss.NuSpline([[0, 0], [3, 6]], "uniform"))[:39]
    '<svg xmlns="http://www.w3.org/2000/svg"'
    """
    corners = _planar(curve).reshape(-1, 2)
    low, high = corners.min(axis=0), corners.max(axis=0)
    extent = float(max(high - low)) or 1.0
    if width is None:
        width = extent / 200
    width = _between("width", width, 0.0, math.inf)
    if not _text("stroke", stroke).isprintable():
        raise InputError(f"stroke must be printable, got {stroke!r}", "stroke", value=stroke)
    low, high = low - 4 * width, high + 4 * width
    (left, bottom), (across, up) = low.tolist(), (high - low).tolist()
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" '
        f'viewBox="{left!r} {-bottom - up!r} {across!r} {up!r}">\n'
        f'<path transform="scale(1,-1)" fill="none" stroke="{html.escape(stroke)}" '
        f'stroke-width="{width!r}" stroke-linejoin="round" d="{svg_path(curve)}"/>\n</svg>\n'
    )


# STEP

#: Units of length: the prefix that STEP puts before the metre.
_UNITS = {"m": "$", "mm": ".MILLI.", "cm": ".CENTI.", "km": ".KILO.", "µm": ".MICRO."}

# ISO 10303-21 with the entities that a reader of AP 242 needs around one curve. A planar curve lies
# in z = 0.
_STEP = """ISO-10303-21;
HEADER;
FILE_DESCRIPTION(('a curve'),'2;1');
FILE_NAME('{name}','',(''),(''),'shapespline','shapespline','');
FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF'));
ENDSEC;
DATA;
#1=APPLICATION_CONTEXT('managed model based 3d engineering');
#2=APPLICATION_PROTOCOL_DEFINITION('international standard',
'ap242_managed_model_based_3d_engineering',2014,#1);
#3=PRODUCT_CONTEXT('',#1,'mechanical');
#4=PRODUCT('{name}','{name}','',(#3));
#5=PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#4));
#6=PRODUCT_DEFINITION_FORMATION('','',#4);
#7=PRODUCT_DEFINITION_CONTEXT('part definition',#1,'design');
#8=PRODUCT_DEFINITION('design','',#6,#7);
#9=PRODUCT_DEFINITION_SHAPE('','',#8);
#10=SHAPE_DEFINITION_REPRESENTATION(#9,#18);
#11=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT({unit},.METRE.));
#12=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));
#13=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT());
#14=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({uncertainty}),#11,'distance_accuracy_value','');
#15=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#14))
GLOBAL_UNIT_ASSIGNED_CONTEXT((#11,#12,#13))REPRESENTATION_CONTEXT('',''));
#16=GEOMETRIC_CURVE_SET('{name}',(#17));
#17={curve};
#18=GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION('',(#16),#15);
{points}
ENDSEC;
END-ISO-10303-21;
"""


def _real(value: float) -> str:
    """Return a number as STEP wants it: with a point, the exponent with a capital E."""
    text = repr(float(value)).upper()
    mantissa, e, exponent = text.partition("E")
    return f"{mantissa}{'' if '.' in mantissa else '.'}{e}{exponent}"


def _list(items: Any) -> str:
    return "(" + ",".join(items) + ")"


def step(curve: Any, *, name: str = "curve", unit: str = "mm") -> str:
    """Return a curve as a STEP file (ISO 10303-21, AP 242) that CAD programs read.

    Parameters
    ----------
    curve : SpaceCurve, MonotoneSpline, BSpline, PPoly, BPoly or PiecewiseBezier
        The curve; one in the plane lies in z = 0.
    name : str
        Name of the part and the curve: printable ASCII.
    unit : {"mm", "m", "cm", "km", "µm"}
        Unit of the points.

    Returns
    -------
    str
        One ``B_SPLINE_CURVE_WITH_KNOTS``, with its knots, points and weights to the last bit.

    Raises
    ------
    InputError
        If the unit is unknown, the name not printable ASCII, or as for `bspline`.
    TypeError
        If one of them is no string, or as for `bspline`.

    Notes
    -----
    No date is written: the same curve gives the same file.

    Examples
    --------
    >>> import shapespline as ss
    >>> text = ss.interchange.step(ss.NuSpline([[0, 0, 0], [3, 6, 0]]))
    >>> text.count("CARTESIAN_POINT"), "B_SPLINE_CURVE_WITH_KNOTS" in text
    (4, True)
    """
    if _text("unit", unit) not in _UNITS:
        text = f"unit must be one of {', '.join(map(repr, _UNITS))}; got {unit!r}"
        raise InputError(text, "unit", value=unit)
    if not (_text("name", name).isascii() and name.isprintable()):
        raise InputError(f"name must be printable ASCII, got {name!r}", "name", value=name)
    name = name.replace("\\", "\\\\").replace("'", "''")
    data = bspline(curve)
    control = np.zeros((len(data.control), 3))
    control[:, : data.control.shape[1]] = data.control
    first = 19
    points = "\n".join(
        f"#{first + i}=CARTESIAN_POINT('',{_list(map(_real, point))});"
        for i, point in enumerate(control)
    )
    knots, multiplicities = np.unique(data.knots, return_counts=True)
    references = _list(f"#{first + i}" for i in range(len(control)))
    closed = ".T." if np.array_equal(control[0], control[-1]) else ".F."
    shape = f"{data.degree},{references},.UNSPECIFIED.,{closed},.F."
    with_knots = f"{_list(map(str, multiplicities))},{_list(map(_real, knots))},.UNSPECIFIED."
    if data.weights is None:
        text = f"B_SPLINE_CURVE_WITH_KNOTS('{name}',{shape},{with_knots})"
    else:
        # A rational curve is of several kinds at once, named in the order of the alphabet.
        text = (
            f"(BOUNDED_CURVE()B_SPLINE_CURVE({shape})B_SPLINE_CURVE_WITH_KNOTS({with_knots})"
            f"CURVE()GEOMETRIC_REPRESENTATION_ITEM()"
            f"RATIONAL_B_SPLINE_CURVE({_list(map(_real, data.weights))})"
            f"REPRESENTATION_ITEM('{name}'))"
        )
    extent = float(np.ptp(control, axis=0).max())
    return _STEP.format(
        name=name,
        unit=_UNITS[unit],
        uncertainty=_real(1e-9 * extent or 1e-9),
        curve=text,
        points=points,
    )

# SPDX-License-Identifier: MIT OR Apache-2.0

"""Unusable input is refused with the argument, the index and the value in the message.

One table: what is called, which exception, and the pieces its message must contain. A good call
beside each family of bad ones shows that it is the fault, and nothing else, that is refused.
"""

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss

N = 6
POINTS = polygons.random_walk(np.random.default_rng(2), N)
CLOSED = polygons.close(POINTS)
U = np.arange(float(N))


def changed(array, index, value):
    """Return a copy of the array with one value replaced."""
    array = np.array(array, dtype=float)
    array[index] = value
    return array


def fit(points=POINTS, parameters="chordal", **options):
    return lambda: ss.NuSpline(points, parameters, **options)


def preserve(points=POINTS, parameters="chordal", **options):
    return lambda: ss.NuSpline.shape_preserving(points, parameters, **options)


def curve(method, *arguments, **options):
    return lambda: getattr(ss.NuSpline(POINTS), method)(*arguments, **options)


def call(*arguments, **options):
    return lambda: ss.NuSpline(POINTS)(*arguments, **options)


def scaled(tangent_scale, points=POINTS, **options):
    return lambda: ss.TensionSpline(points, tangent_scale=tangent_scale, **options)


def handles(**options):
    return lambda: ss.CatmullRom(POINTS, **options)


def safe(**options):
    return lambda: ss.CatmullRom.shape_preserving(POINTS, **options)


def reduced(**options):
    return lambda: ss.TensionSpline.shape_preserving(POINTS, strategy="reduction", **options)


def many(offsets=(0, 4, N), **options):
    return lambda: ss.fit_many(POINTS, offsets, **options)


ONES = np.ones(N - 1)

BAD_VALUES = {
    # what is wrong: (call, pieces of the message)
    "NaN point": (fit(changed(POINTS, (2, 1), np.nan)), ["points[2", "nan"]),
    "infinite point": (fit(changed(POINTS, (4, 0), np.inf)), ["points[4", "inf"]),
    "negative infinite point": (fit(changed(POINTS, (0, 2), -np.inf)), ["points[0", "-inf"]),
    "NaN in planar points": (fit(changed(POINTS[:, :2], (5, 1), np.nan)), ["points[5", "nan"]),
    "repeated neighbours": (fit(changed(POINTS, 4, POINTS[3])), ["points[3]", "points[4]"]),
    "repeated value shown": (
        fit([[0, 0, 0], [1.25, 2.5, 3.75], [1.25, 2.5, 3.75]]),
        ["points[1]", "points[2]", "1.25", "2.5", "3.75"],
    ),
    "one point": (fit([[1.0, 2.0, 3.0]]), ["points", "1"]),
    "no points": (fit(np.empty((0, 3))), ["points", "0"]),
    "points in one dimension": (fit([1.0, 2.0, 3.0]), ["points", "(3,)"]),
    "points with one coordinate": (fit(np.arange(4.0)[:, None]), ["points", "(4, 1)"]),
    "points with four coordinates": (fit(np.eye(4)), ["points", "(4, 4)"]),
    "points in three axes": (fit(np.zeros((2, 2, 3))), ["points", "(2, 2, 3)"]),
    "NaN parameter": (fit(parameters=changed(U, 3, np.nan)), ["parameters[3]", "nan"]),
    "infinite parameter": (fit(parameters=changed(U, 5, np.inf)), ["parameters[5]", "inf"]),
    "parameters that stand still": (
        fit(parameters=changed(U, 3, 2.0)),
        ["parameters[3]", "2", "increasing"],
    ),
    "parameters that go back": (
        fit(parameters=changed(U, 4, 0.25)),
        ["parameters[4]", "0.25", "increasing"],
    ),
    "too few parameters": (fit(parameters=U[:-1]), ["parameters", "5", "6"]),
    "too many parameters": (fit(parameters=np.arange(8.0)), ["parameters", "8", "6"]),
    "parameters in two axes": (fit(parameters=U[:, None]), ["parameters", "(6, 1)"]),
    "unknown parametrisation": (
        fit(parameters="chord"),
        ["parameters", "'chord'", "'uniform'", "'chordal'", "'centripetal'"],
    ),
    "NaN exponent": (fit(parameters=np.nan), ["parameters", "nan"]),
    "infinite exponent": (fit(parameters=np.inf), ["parameters", "inf"]),
    "negative exponent": (fit(parameters=-1.0), ["parameters", "exponent between 0 and 1", "-1"]),
    "exponent out of range": (
        fit(parameters=2**31),
        ["parameters", "exponent between 0 and 1", "2147483648"],
    ),
    "unknown boundary": (
        fit(boundary="clamped"),
        ["boundary", "'clamped'", "'zero-curvature'", "'natural'", "'periodic'", "'circular'"],
    ),
    "periodic data that do not close": (
        fit(changed(CLOSED, (6, 0), 17.5), boundary="periodic"),
        ["points[6]", "points[0]", "17.5", "periodic"],
    ),
    "periodic with two points": (
        fit([[0.0, 0], [1, 1]], boundary="periodic"),
        ["points", "periodic"],
    ),
    "circular with two points": (fit(POINTS[:2], boundary="circular"), ["points", "3", "2"]),
    "planar tangents for space data": (
        fit(boundary=ss.Tangents([1.0, 0.0], [0.0, 1.0])),
        ["boundary", "start", "2", "3"],
    ),
    "NaN tangent": (lambda: ss.Tangents([0.0, np.nan, 1.0], [1, 0, 0]), ["start[1]", "nan"]),
    "infinite tangent": (lambda: ss.Tangents([0, 1, 0], [1, 0, np.inf]), ["end[2]", "inf"]),
    "zero tangent": (lambda: ss.Tangents([1, 0, 0], [0, 0, 0]), ["end", "zero"]),
    "no tangent at all": (lambda: ss.Tangents(None, None), ["start", "natural"]),
    "tangents of two lengths": (lambda: ss.Tangents([1, 0, 0], [1, 0]), ["start", "end"]),
    "tangent of four components": (lambda: ss.Tangents([1] * 4, [1] * 4), ["start", "4"]),
    "negative tension": (fit(tension=changed(np.zeros(N), 4, -0.25)), ["tension[4]", "-0.25"]),
    "negative scalar tension": (fit(tension=-0.75), ["tension", "-0.75"]),
    "NaN tension": (fit(tension=changed(np.zeros(N), 1, np.nan)), ["tension[1]", "nan"]),
    "infinite tension": (fit(tension=np.inf), ["tension", "inf"]),
    "too few tensions": (fit(tension=[1.0, 2.0]), ["tension", "2", "6"]),
    "tension of one node given twice": (
        fit(CLOSED, boundary="periodic", tension=changed(np.zeros(N + 1), 6, 3.5)),
        ["tension[6]", "tension[0]", "3.5"],
    ),
    "λ of zero": (scaled(0.0), ["tangent_scale", "between 1e-65 and 1", "0"]),
    "λ whose derivatives overflow": (
        scaled(1e-310),
        ["tangent_scale", "between 1e-65 and 1", "0.000"],
    ),
    "λ above one": (scaled(1.25), ["tangent_scale", "between 1e-65 and 1", "1.25"]),
    "NaN λ of a point": (
        scaled(changed(np.ones(N), 2, np.nan)),
        ["tangent_scale[2]", "between 1e-65 and 1", "nan"],
    ),
    "negative λ⁰ of a segment": (
        scaled((changed(ONES, 3, -0.5), ONES)),
        ["tangent_scale[0][3]", "between 1e-65 and 1", "-0.5"],
    ),
    "λ¹ of a segment above one": (
        scaled((ONES, changed(ONES, 1, 1.5))),
        ["tangent_scale[1][1]", "between 1e-65 and 1", "1.5"],
    ),
    "too few λ¹": (scaled((ONES, ONES[:-1])), ["tangent_scale[1]", "4", "5"]),
    "too many λ⁰": (scaled((np.ones(N), ONES)), ["tangent_scale[0]", "6", "5"]),
    "too few λ": (scaled(np.ones(4)), ["tangent_scale", "4", "6"]),
    "λ in three axes": (scaled(np.ones((3, 2))), ["tangent_scale", "(3, 2)"]),
    "λ of one node given twice": (
        scaled(changed(np.ones(N + 1), 6, 0.5), CLOSED, boundary="periodic"),
        ["tangent_scale[6]", "tangent_scale[0]", "0.5"],
    ),
    "ρ of one": (reduced(step=1.0), ["step", "(0, 1)", "1"]),
    "fourth derivative in s": (lambda: ss.TensionSpline(POINTS)(0.5, 4), ["nu", "3", "4"]),
    "fourth derivatives in s": (lambda: ss.TensionSpline(POINTS)([0.5], 4), ["nu", "3", "4"]),
    "unclosed periodic tension cubic": (
        scaled(1.0, changed(CLOSED, (6, 0), 17.5), boundary="periodic"),
        ["points[6]", "points[0]", "17.5", "periodic"],
    ),
    "unclosed periodic Catmull–Rom": (
        handles(boundary="periodic"),
        ["points[5]", "points[0]", "periodic"],
    ),
    "cardinal tension of one": (handles(tension=1.0), ["tension", "[0, 1)", "1"]),
    "negative cardinal tension": (
        handles(tension=changed(np.zeros(N), 2, -0.1)),
        ["tension[2]", "[0, 1)", "-0.1"],
    ),
    "unknown continuity": (handles(continuity="C2"), ["continuity", "'C2'", "'C1'", "'G1'"]),
    "no safety": (safe(safety=0.0), ["safety", "(0, 1)", "0"]),
    "safety of one": (safe(safety=1.0), ["safety", "(0, 1)", "1"]),
    "unknown method": (
        many(method="cubic"),
        ["method", "'cubic'", "'nu'", "'tension'", "'catmull-rom'"],
    ),
    "unknown treatment of errors": (many(errors="ignore"), ["errors", "'ignore'", "'raise'"]),
    "offsets that begin late": (many([1, N]), ["offsets[0]", "0", "1"]),
    "offsets that fall": (many([0, 4, 2, N]), ["offsets[2]", "2"]),
    "offsets that end early": (many([0, 4]), ["offsets[1]", "4"]),
    "no offsets": (many([]), ["offsets[0]"]),
    "negative offset": (many([0, -3, N]), ["offsets[1]", "-3"]),
    "fractional offset": (many([0, 2.5, N]), ["offsets[1]", "2.5"]),
    "offsets in two axes": (many([[0, N]]), ["offsets", "(1, 2)"]),
    "no threads": (many(threads=0), ["threads", "0"]),
    "parameters of some points": (many(parameters=U[:-1]), ["parameters", "5", "6"]),
    "NaN exponent of many": (many(parameters=np.nan), ["parameters", "nan"]),
    "negative step of many": (many(method="nu", step=-1.0), ["step", "-1"]),
    "λ above one of many": (
        many(method="tension", shape_preserving=False, tangent_scale=2.0),
        ["tangent_scale", "between 1e-65 and 1", "2"],
    ),
    "points of many in four dimensions": (
        lambda: ss.fit_many(np.eye(4), [0, 4]),
        ["points", "(4, 4)"],
    ),
    "unknown strategy": (
        preserve(strategy="fair"),
        ["strategy", "'fair'", "'nussp'", "'growth'", "'fairest'"],
    ),
    "unknown criterion": (
        preserve(criteria=["torsion", "beauty"]),
        ["criteria", "'beauty'", "'convexity'", "'global-convexity'", "'collinearity'"],
    ),
    "unknown criterion to check": (
        curve("check", ["beauty"]),
        ["criteria", "'beauty'", "'convexity'", "'inflection'", "'coplanarity'"],
    ),
    "zero step": (preserve(step=0.0), ["step", "0"]),
    "negative step": (preserve(step=-0.5), ["step", "-0.5"]),
    "NaN step": (preserve(step=np.nan), ["step", "nan"]),
    "coplanarity above 1": (preserve(coplanarity=1.5), ["coplanarity", "1.5"]),
    "zero coplanarity": (preserve(coplanarity=0.0), ["coplanarity", "0"]),
    "collinearity above 1": (preserve(collinearity=2.5), ["collinearity", "2.5"]),
    "NaN collinearity to check": (curve("check", collinearity=np.nan), ["collinearity", "nan"]),
    "negative tolerance": (preserve(tolerance=-1e-9), ["tolerance", "-"]),
    "NaN tolerance": (preserve(tolerance=np.nan), ["tolerance", "nan"]),
    "no iterations": (preserve(max_iterations=0), ["max_iterations", "0"]),
    "NaN point to preserve": (preserve(changed(POINTS, (2, 1), np.nan)), ["points[2", "nan"]),
    "negative derivative": (call(0.5, -1), ["nu", "-1"]),
    "unknown side": (call(0.5, side="above"), ["side", "'above'", "'left'", "'right'"]),
    "unknown side of torsion": (
        curve("torsion", 0.5, side="above"),
        ["side", "'above'", "'left'", "'right'"],
    ),
    "NaN arc length": (curve("arc_length", 0.0, np.nan), ["b", "nan"]),
    "infinite arc length": (curve("arc_length", -np.inf, 1.0), ["a", "inf"]),
    "no samples": (curve("sample", 0), ["n", "0"]),
    "unknown way to sample": (
        curve("sample", 5, by="time"),
        ["by", "'time'", "'parameter'", "'arc-length'"],
    ),
}

BAD_KINDS = {
    "points of text": (fit([["a", "b"], ["c", "d"]]), ["points"]),
    "no points at all": (fit(None), ["points"]),
    "complex points": (fit(POINTS + 1j), ["points"]),
    "points of objects": (fit(np.array([[object()] * 3] * 3)), ["points"]),
    "complex parameters": (fit(parameters=U + 1j), ["parameters"]),
    "parameters of objects": (fit(parameters=object()), ["parameters"]),
    "numeric boundary": (fit(boundary=3), ["boundary"]),
    "tension of text": (fit(tension="much"), ["tension"]),
    "complex tension": (fit(tension=np.ones(N) * 1j), ["tension"]),
    "strategy of a number": (preserve(strategy=1), ["strategy"]),
    "criteria of a number": (preserve(criteria=3), ["criteria"]),
    "λ of text": (scaled("much"), ["tangent_scale"]),
    "complex λ¹": (scaled((ONES, 1j * ONES)), ["tangent_scale[1]"]),
    "safety of text": (safe(safety="some"), ["safety"]),
    "offsets of text": (many("ab"), ["offsets"]),
    "fractional threads": (many(threads=1.5), ["threads"]),
    "an option of another method": (
        many(safety=0.5),
        ["safety", "'catmull-rom'", "'fair'", "energy"],
    ),
    "tension where it is searched for": (
        many(method="nu", tension=1.0),
        ["tension", "shape_preserving"],
    ),
    "an option of another method of fit": (
        lambda: ss.fit(POINTS, strategy="growth"),
        ["strategy", "'nu', 'tension'", "'fair'"],
    ),
    "a method that is no name": (lambda: ss.fit(POINTS, method=3), ["method", "string", "int"]),
    "query of text": (call("middle"), ["u"]),
    "complex query": (call(1j), ["u"]),
    "fractional derivative": (call(0.5, 1.5), ["nu"]),
    "fractional number of samples": (curve("sample", 2.5), ["n"]),
    "fractional iterations": (preserve(max_iterations=2.5), ["max_iterations"]),
}


@pytest.mark.parametrize("name", BAD_VALUES)
def test_bad_value(name):
    bad, pieces = BAD_VALUES[name]
    with pytest.raises(ss.InputError) as caught:
        bad()
    message = str(caught.value)
    # What the text says, the attributes say.
    index = np.atleast_1d([] if caught.value.index is None else caught.value.index)
    place = "".join(f"[{i}]" for i in index)
    assert f"{caught.value.argument}{place}" in message
    assert any(piece.partition("[")[0] == caught.value.argument for piece in pieces)
    assert [piece for piece in pieces if piece.lower() not in message.lower()] == [], message


@pytest.mark.parametrize("name", BAD_KINDS)
def test_bad_kind(name):
    bad, pieces = BAD_KINDS[name]
    with pytest.raises(TypeError) as caught:
        bad()
    message = str(caught.value)
    assert [piece for piece in pieces if piece not in message] == [], message


@pytest.mark.parametrize(
    "good",
    [
        fit(),
        fit(POINTS[:, :2]),
        fit(POINTS[:2]),
        fit(parameters=U),
        fit(parameters=0.7),
        fit(parameters=0.0),
        fit(parameters=1.0),
        fit(CLOSED, boundary="periodic"),
        fit(CLOSED, boundary="periodic", tension=np.ones(N + 1)),
        fit(boundary="circular"),
        fit(POINTS[:3], boundary="circular"),
        fit(tension=1e12),
        preserve(step=1e-3, coplanarity=1.0, collinearity=1.0, tolerance=0.0),
        preserve(criteria=[], strategy="nussp"),
        scaled(1e-12),
        scaled((0.5, ONES)),
        scaled(np.full((2, N - 1), 0.25)),
        scaled([0.5, 0.25], POINTS[:2]),
        scaled(np.full(N + 1, 0.5), CLOSED, boundary="periodic"),
        reduced(step=0.999, max_iterations=10_000),
        lambda: ss.TensionSpline(POINTS)(0.5, 3),
        handles(tension=0.999, continuity="G1"),
        handles(boundary="circular"),
        safe(safety=0.999, continuity="G1"),
        many(),
        many([0, 3, N], method="tension", parameters=U, threads=3),
        many([0, 3, N], method="catmull-rom", safety=0.5, continuity="G1"),
        lambda: ss.fit_many(np.empty((0, 3)), [0]),
        call(0.5, 7),
        call([], side="left"),
        curve("arc_length", 1.0, 1.0),
        curve("sample", 1),
        curve("check", ["global-convexity"]),
    ],
)  # fmt: skip
def test_the_good_neighbours_are_accepted(good):
    good()


def test_the_first_fault_is_named():
    points = changed(changed(POINTS, (4, 1), np.nan), (2, 0), np.inf)
    with pytest.raises(ValueError, match=r"points\[2.*inf"):
        ss.NuSpline(points)


def test_a_fault_far_inside_is_named():
    points = polygons.gentle_track(200_000)
    points[123_456, 2] = np.nan
    with pytest.raises(ValueError, match=r"points\[123456.*nan|points\[123456.*NaN"):
        ss.NuSpline.shape_preserving(points)


@pytest.mark.parametrize("scale", [1e-300, 1e300])
@pytest.mark.parametrize("family", cases.FAMILIES)
def test_numbers_at_the_edge_are_fitted_or_refused_but_never_wrong(family, scale):
    """Beyond the promised 1e±100 an error is fine; a curve with NaN or the wrong points is not."""
    try:
        curve = cases.preserving(family)(POINTS * scale)
    except ValueError:
        return
    assert np.isfinite(curve.tangents).all()
    np.testing.assert_allclose(
        curve(curve.parameters) / scale, POINTS, atol=1e-12 * np.abs(POINTS).max()
    )

# SPDX-License-Identifier: MIT OR Apache-2.0

"""Closed data: ends that agree to rounding, and data that do not repeat their first point."""

import pickle

import numpy as np
import pytest

import cases
import shapespline as ss

every_family = pytest.mark.parametrize("family", cases.FAMILIES)


def circle(turns=1, n=9, dim=2, centre=0.0, radius=1.0):
    """Return points of a circle that closes but for rounding."""
    t = np.linspace(0, 2 * np.pi * turns, n * turns)
    z = [0.1 * np.sin(t)] if dim == 3 else []
    return centre + radius * np.column_stack([np.cos(t), np.sin(t), *z])


CIRCLES = {
    "plane": circle(),
    "space": circle(dim=3),
    "five turns": circle(turns=2),
    "off the centre": circle(centre=0.3),
    "small": circle(radius=1e-100),
    "large": circle(radius=1e100),
    "long": circle(n=20_000),
}


@every_family
@pytest.mark.parametrize("name", CIRCLES)
def test_ends_that_agree_to_rounding_close(family, name):
    points = CIRCLES[name]
    assert (points[-1] != points[0]).any()
    exact = points.copy()
    exact[-1] = exact[0]
    for make in (family, cases.preserving(family)):
        curve = make(points, boundary="periodic")
        np.testing.assert_array_equal(curve.points, exact)
        np.testing.assert_array_equal(curve.bezier, make(exact, boundary="periodic").bezier)
    assert curve.check().ok
    fits = ss.fit_many(np.vstack([points, points]), [0, len(points), 2 * len(points)],
                       method=cases.METHODS[family], boundary="periodic")  # fmt: skip
    assert fits.ok
    np.testing.assert_array_equal(fits[1].points, exact)


def test_polygons_and_foreign_curves_close_as_well():
    points = CIRCLES["plane"]
    shape = ss.polygon_shape(points, boundary="periodic")
    np.testing.assert_array_equal(shape.points[-1], shape.points[0])
    curve = ss.NuSpline(points, boundary="periodic")
    report = ss.check_shape(points, curve.to_bspline(), parameters=curve.parameters)
    assert report.boundary == "periodic"
    assert report.ok


@every_family
@pytest.mark.parametrize("gap", [1e-12, 1e-9, 0.5, -1.0])
def test_ends_that_are_apart_do_not_close(family, gap):
    points = circle()
    points[-1] = points[0] + [gap, 0]
    with pytest.raises(ss.InputError, match=r"needs points\[8\] = points\[0\], got \(") as caught:
        family(points, boundary="periodic")
    assert caught.value.index == 8
    assert len(caught.value.value) == 2


@pytest.mark.parametrize("dim", [2, 3])
def test_errors_show_points_in_their_own_dimension(dim):
    repeated = np.ones((3, dim)).cumsum(axis=0)
    repeated[2] = repeated[1]
    shown = "(2, 2)" if dim == 2 else "(2, 2, 2)"
    calls = [
        *(family for family in cases.FAMILIES),
        *(family.shape_preserving for family in cases.TENSE),
        ss.polygon_shape,
        ss.inflection_count,
        lambda p: ss.fit_many(p, [0, 3], errors="raise"),
        lambda p: ss.check_shape(p, ss.NuSpline(np.arange(3.0)[:, None] * np.ones(dim))),
    ]
    for call in calls:
        with pytest.raises(ss.InputError) as caught:
            call(repeated)
        assert f"points[2] repeats points[1]: {shown};" in str(caught.value)
        assert caught.value.value == (2.0,) * dim


#: The shape-preserving fit of each method.
FITS = {method: cases.preserving(family) for family, method in cases.METHODS.items()}
OPEN = np.array([[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4, 2, 5.0], [0, 2, 1]])
CLOSED = np.vstack([OPEN, OPEN[:1]])
KNOTS = np.array([0.0, 1, 3, 4, 5, 7, 8])
PARAMETERS = {"uniform": "uniform", "chordal": "chordal", "exponent": 0.7, "given": KNOTS}
every_parametrization = pytest.mark.parametrize("parameters", PARAMETERS.values(), ids=PARAMETERS)
every_dimension = pytest.mark.parametrize("dim", [2, 3])


def same(a, b):
    assert type(a) is type(b)
    for name in ("points", "parameters", "knots", "tangents", "bezier"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    np.testing.assert_array_equal(cases.tension_of(a), cases.tension_of(b))
    assert a.boundary == b.boundary == "periodic"
    assert a.check().to_dict() == b.check().to_dict()


@every_family
@every_dimension
@every_parametrization
def test_closed_data_need_not_repeat_the_first_point(family, dim, parameters):
    for make in (family, cases.preserving(family)):
        expected = make(CLOSED[:, :dim], parameters, boundary="periodic")
        for points in (OPEN, CLOSED):
            for boundary in ({}, {"boundary": "periodic"}):
                same(make(points[:, :dim], parameters, closed=True, **boundary), expected)
    same(pickle.loads(pickle.dumps(expected)), expected)


@every_parametrization
@pytest.mark.parametrize("method", cases.METHODS.values())
@pytest.mark.parametrize("threads", [None, 2])
def test_closed_collections(method, parameters, threads):
    """Each curve takes the parameters of its points, and one more where they do not return."""
    points, offsets = np.vstack([OPEN, CLOSED, OPEN]), [0, 6, 13, 19]
    if isinstance(parameters, np.ndarray):
        parameters = np.r_[parameters, 2 * parameters, 3 * parameters]
    fits = ss.fit_many(
        points, offsets, method=method, parameters=parameters, closed=True, threads=threads
    )
    assert fits.ok, fits.errors
    for k, fit in enumerate(fits):
        own = parameters
        if isinstance(parameters, np.ndarray):
            own = parameters[7 * k : 7 * k + 7]
        same(fit, FITS[method](OPEN, own, closed=True))
    if isinstance(parameters, np.ndarray):
        with pytest.raises(ss.InputError, match=r"parameters must have length 21 \(one for each"):
            ss.fit_many(points, offsets, method=method, parameters=parameters[:19], closed=True)


def test_values_of_points_are_those_of_the_points_given():
    tension, scale = np.arange(1.0, 7), 1 / np.arange(1.0, 7)
    for name, family, values in [("tension", ss.NuSpline, tension),
                                 ("tension", ss.CatmullRom, tension / 9),
                                 ("tangent_scale", ss.TensionSpline, scale)]:  # fmt: skip
        expected = family(CLOSED, boundary="periodic", **{name: np.r_[values, values[0]]})
        for points in (OPEN, CLOSED):
            for given in (
                (values, np.r_[values, values[0]])
                if points is OPEN
                else (np.r_[values, values[0]],)
            ):
                same(family(points, closed=True, **{name: given}), expected)
        with pytest.raises(ss.InputError, match=f"{name} must have length 6"):
            family(OPEN, closed=True, **{name: values[:-1]})
        with pytest.raises(ss.InputError, match=rf"{name}\[6\] must equal {name}\[0\]"):
            family(OPEN, closed=True, **{name: np.r_[values, values[1]]})
    pair = (scale, scale[::-1])
    expected = ss.TensionSpline(CLOSED, boundary="periodic", tangent_scale=pair)
    same(ss.TensionSpline(OPEN, closed=True, tangent_scale=pair), expected)


ENTRIES = {
    **{cases.METHODS[family]: family for family in cases.TENSE},
    **{f"{name} preserving": fit for name, fit in FITS.items()},
    "fit_many": lambda p, u="chordal", **o: ss.fit_many(p, [0, len(p)], parameters=u, **o),
    "polygon_shape": ss.polygon_shape,
    "check_shape": lambda p, u="chordal", **o: ss.check_shape(
        p, ss.NuSpline(CLOSED, boundary="periodic").to_bspline(), parameters=u, **o),
}  # fmt: skip
every_entry = pytest.mark.parametrize("entry", ENTRIES)


@every_entry
@pytest.mark.parametrize(
    ("boundary", "name"),
    [("natural", "natural"), ("zero-curvature", "natural"), ("circular", "circular"),
     (ss.Tangents([1.0, 0, 0], [0, 1.0, 0]), "Tangents")],
)  # fmt: skip
def test_closed_data_have_no_other_ends(entry, boundary, name):
    text = f"boundary must be 'periodic' with closed=True, got '{name}'"
    with pytest.raises(ss.InputError, match=text) as caught:
        ENTRIES[entry](OPEN, boundary=boundary, closed=True)
    assert caught.value.argument == "boundary"


@every_entry
def test_closed_is_true_or_false(entry):
    ENTRIES[entry](OPEN, closed=np.True_)
    with pytest.raises(TypeError, match="closed must be True or False, got str"):
        ENTRIES[entry](OPEN, closed="yes")


@pytest.mark.parametrize("entry", [e for e in ENTRIES if e != "fit_many"])
def test_closed_data_have_a_parameter_for_the_return(entry):
    ENTRIES[entry](OPEN, KNOTS if entry != "check_shape" else "chordal", closed=True)
    with pytest.raises(ss.InputError, match=r"parameters must have length 7 .*return to the"):
        ENTRIES[entry](OPEN, KNOTS[:-1], closed=True)


@every_entry
def test_two_points_do_not_close(entry):
    shape = "at least 3 points"
    if entry == "fit_many":
        assert "at least 3 points" in str(ENTRIES[entry](OPEN[:1], closed=True).errors[0])
        return
    with pytest.raises(ss.InputError, match=shape):
        ENTRIES[entry](OPEN[:1], closed=True)


def test_the_way_to_close_is_named():
    with pytest.raises(ss.InputError, match="pass closed=True where the curve returns"):
        ss.NuSpline(OPEN, boundary="periodic")
    curve = ss.NuSpline(OPEN, closed=True)
    with pytest.raises(ss.InputError, match="pass closed=True where it returns"):
        ss.check_shape(OPEN, curve.to_bspline())


def test_a_check_of_the_points_is_the_check_of_the_curve():
    curve = ss.NuSpline(OPEN, closed=True)
    own = curve.check().to_dict()
    assert ss.check_shape(OPEN, curve, closed=True).to_dict() == own
    assert ss.check_shape(CLOSED, curve).to_dict() == own
    foreign = ss.check_shape(OPEN, curve.to_ppoly(), closed=True)
    assert foreign.boundary == "periodic"
    assert foreign.counts() == curve.check().counts()
    shape = ss.polygon_shape(OPEN, closed=True)
    assert shape.to_dict() == ss.polygon_shape(CLOSED, boundary="periodic").to_dict()

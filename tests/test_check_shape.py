# SPDX-License-Identifier: MIT OR Apache-2.0

"""Checks of curves that shapespline did not make: SciPy's, raw Bézier points, NURBS."""

import json
import pickle
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import (
    Akima1DInterpolator,
    BPoly,
    CubicSpline,
    PchipInterpolator,
    PPoly,
    make_interp_spline,
)

import cases
import polygons
import shapespline as ss
from shape_by_sampling import CRITERIA, shape_by_sampling

ROOT = Path(__file__).parent.parent


def chordal(points):
    return np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]


def natural(u, points):
    return CubicSpline(u, points, bc_type="natural")


MAKERS = {
    "natural": natural,
    "not-a-knot": CubicSpline,
    "pchip": PchipInterpolator,
    "makima": lambda u, p: Akima1DInterpolator(u, p, method="makima"),
    "quadratic": lambda u, p: make_interp_spline(u, p, k=2),
    "quartic": lambda u, p: make_interp_spline(u, p, k=4),
    "quintic": lambda u, p: make_interp_spline(u, p, k=5),
    "septic": lambda u, p: make_interp_spline(u, p, k=7),
}


def one_sided(curve, u):
    """Derivatives of a SciPy curve on either side of its breaks."""
    u = np.asarray(u)
    shift = 1e-9 * np.diff(u).min()

    def derivative(at, order, side):
        # SciPy takes the right side; a hair to the left is the other.
        at = np.where(np.isin(at, u) & (side == "left"), at - shift, at)
        return curve(at, order)

    return derivative


def agree(points, u, curve, report, slack=1e-3, ends=None):
    """Assert that dense sampling and the report find the same, near misses apart."""
    sampled = shape_by_sampling(points, u, ends, one_sided(curve, u), count=401)
    stops = [v for v in report.violations if v.criterion == "regular"]
    for v in stops:
        speed = np.linalg.norm(curve(np.linspace(u[v.segment], u[v.segment + 1], 401), 1), axis=-1)
        assert speed.min() < 1e-2 * speed.max()
    asked = {(r.criterion, r.segment): r for r in report.segments if r.applicable}
    asked = {key: r for key, r in asked.items() if r.criterion != "regular"}
    expected = {(c, int(i)) for c in CRITERIA for i in np.flatnonzero(sampled.applicable[c])}
    assert set(asked) == expected
    reported = {(v.criterion, v.segment) for v in report.violations if v not in stops}
    undecided = {(v.criterion, v.segment) for v in report.undecided}
    missed = set(sampled.violations) - reported - undecided
    assert {k: asked[k].margin for k in missed if asked[k].margin > slack} == {}
    overlooked = reported - set(sampled.violations)
    assert {k: asked[k].margin for k in overlooked if asked[k].margin < -slack} == {}
    return len(missed), len(overlooked)


# Agreement


@pytest.mark.parametrize("maker", MAKERS)
def test_agrees_with_sampling_on_random_walks(maker, rng):
    for size in (9, 14, 30):
        for dim in (2, 3):
            points = polygons.random_walk(rng, size, dim)
            u = chordal(points)
            curve = MAKERS[maker](u, points)
            report = ss.check_shape(points, curve, parameters=u)
            agree(points, u, curve, report)


@pytest.mark.parametrize("family", ["near collinear", "near coplanar", "lattice walk"])
@pytest.mark.parametrize("maker", ["natural", "makima", "quintic"])
def test_agrees_with_sampling_on_difficult_points(family, maker, rng):
    for _ in range(4):
        points = polygons.FAMILIES[family](rng, 12)
        u = chordal(points)
        curve = MAKERS[maker](u, points)
        agree(points, u, curve, ss.check_shape(points, curve, parameters=u))


@pytest.mark.parametrize("maker", ["natural", "pchip", "makima", "quintic"])
@pytest.mark.parametrize("name", sorted(p.stem for p in polygons.DATA.glob("*.csv")))
def test_agrees_with_sampling_on_real_data(name, maker):
    points = polygons.load_points(name)
    u = chordal(points)
    curve = MAKERS[maker](u, points)
    agree(points, u, curve, ss.check_shape(points, curve, parameters=u))


@pytest.mark.parametrize("case", [*cases.shared(), *cases.small()], ids=str)
def test_our_own_curves_by_every_way(case):
    """The method, the function, and SciPy's forms of the same curve say the same."""
    curve = case.fit()
    own = curve.check()
    assert ss.check_shape(curve.points, curve).to_dict() == own.to_dict()
    forms = {
        "bezier": curve.bezier,
        "bspline": curve.to_bspline(),
        "ppoly": curve.to_ppoly(),
        "bpoly": BPoly(curve.bezier.swapaxes(0, 1), curve.parameters),
        "pieces": ss.PiecewiseBezier(curve.bezier, curve.parameters),
    }
    for name, form in forms.items():
        report = ss.check_shape(
            curve.points, form, parameters=curve.parameters, boundary=curve.boundary
        )
        for mine, theirs in zip(own.segments, report.segments, strict=True):
            assert mine.applicable == theirs.applicable, name
            if mine.applicable:
                assert theirs.margin == pytest.approx(mine.margin, abs=1e-6), (name, mine)
                if abs(mine.margin) > 1e-6:
                    assert mine.satisfied == theirs.satisfied, name


def test_a_shapespline_curve_at_other_points_is_judged_like_any_other():
    curve = cases.gm_line().preserve()
    u = curve.parameters[::2]
    report = ss.check_shape(curve(u), curve, parameters=u)
    assert len({r.segment for r in report.segments}) == len(u) - 1
    assert report.boundary == "zero-curvature"
    sampled = shape_by_sampling(
        curve(u), u, None, lambda at, order, side: curve(at, order, side=side), count=401
    )
    assert set(sampled.violations) <= {(v.criterion, v.segment) for v in report.violations}


def test_a_piece_more_or_less_changes_nothing():
    """Degrees raised and pieces cut: the same curve, by the way of certified subdivision."""
    points = polygons.load_points("protein_1a8o_ca")
    u = chordal(points)
    cubic = natural(u, points)
    exact = ss.check_shape(points, cubic)
    raised = BPoly.from_power_basis(cubic)
    control = raised.c
    d = len(control) - 1
    t = (np.arange(d + 2) / (d + 1))[:, None, None]
    padded = np.concatenate([control[:1], control, control[-1:]])
    raised = BPoly(t * padded[:-1] + (1 - t) * padded[1:], u)
    middle = np.sort(np.r_[u, 0.3 * u[:-1] + 0.7 * u[1:]])
    taylor = [
        cubic(middle[:-1], k) / factorial for k, factorial in ((3, 6), (2, 2), (1, 1), (0, 1))
    ]
    cut = PPoly(np.array(taylor), middle)
    for other in (raised, cut):
        report = ss.check_shape(points, other, parameters=u)
        assert not report.undecided
        for mine, theirs in zip(exact.segments, report.segments, strict=True):
            assert mine.applicable == theirs.applicable
            if mine.applicable and abs(mine.margin) > 1e-9:
                assert mine.satisfied == theirs.satisfied


# What SciPy has


def test_parameters_default_to_the_breaks():
    points = polygons.load_points("protein_1a8o_ca")
    u = chordal(points)
    for maker in ("natural", "not-a-knot", "pchip", "makima"):
        curve = MAKERS[maker](u, points)
        by_default = ss.check_shape(points, curve)
        assert by_default.to_dict() == ss.check_shape(points, curve, parameters=u).to_dict()
    by_name = ss.check_shape(points, MAKERS["quintic"](u, points), parameters="chordal")
    assert by_name.counts()["convexity"][1] == 47


def test_parameters_that_cannot_be_guessed_must_be_given():
    points = polygons.load_points("protein_1a8o_ca")
    u = chordal(points)
    quintic = MAKERS["quintic"](u, points)
    with pytest.raises(ValueError, match=r"parameters must be given.* 66 breaks.* 70 points"):
        ss.check_shape(points, quintic)
    with pytest.raises(ValueError, match="parameters must be given"):
        ss.check_shape(points[:4], np.zeros((3, 4, 3)))


def test_the_graph_of_a_function():
    columns = polygons.load("rpn14")
    x, y = columns["x"], columns["y"]
    points = np.column_stack([x, y])
    pchip = ss.check_shape(points, PchipInterpolator(x, y))
    cubic = ss.check_shape(points, CubicSpline(x, y))
    # The cubic overshoots after the step; a convexity-blind PCHIP bends less wrongly.
    assert pchip.counts()["convexity"][1] == cubic.counts()["convexity"][1] > 0
    as_curve = PPoly(
        np.stack(
            [np.array([[0.0] * 8, [0.0] * 8, [1.0] * 8, x[:-1]]), PchipInterpolator(x, y).c], 2
        ),
        x,
    )
    assert ss.check_shape(points, as_curve).to_dict() == pchip.to_dict()
    spline = make_interp_spline(x, y, k=3)
    assert ss.check_shape(points, spline, parameters=x).ok == cubic.ok
    bernstein = BPoly.from_power_basis(PchipInterpolator(x, y))
    assert ss.check_shape(points, bernstein).counts() == pchip.counts()


# Closed curves and ends


def test_a_smoothly_closed_curve_is_judged_as_closed():
    points = polygons.load_points("coil_m16n08_first")
    u = chordal(points)
    closed = ss.check_shape(points, CubicSpline(u, points, bc_type="periodic"))
    assert closed.boundary == "periodic"
    assert closed.counts()["torsion"][1] == 128
    corner = ss.check_shape(points, natural(u, points))
    assert corner.boundary == "zero-curvature"
    assert corner.counts()["torsion"][1] == 126
    forced = ss.check_shape(points, natural(u, points), boundary="periodic")
    assert forced.counts()["torsion"][1] == 128


def test_ends_can_be_chosen():
    case = cases.gm_line()
    curve = case.fit().to_ppoly()
    report = ss.check_shape(case.points, curve, boundary=case.boundary)
    assert report.boundary == case.boundary
    assert report.counts() == case.fit().check().counts()


# The report


def test_an_undecided_question_is_reported_with_its_interval():
    """A quintic piece that is straight to rounding where the points turn: its ω is zero."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1]])
    control = [[*np.linspace(p, q, 6)] for p, q in pairwise(points)]
    report = ss.check_shape(points, control, parameters=[0, 1, 2, 3], criteria="torsion")
    assert report.ok == (not report.violations)
    found = report.undecided + report.violations
    assert [r.segment for r in found] == [1]
    for record in report.undecided:
        assert record.criterion == "torsion"
        assert 1.0 <= record.interval[0] <= record.interval[1] <= 2.0
        assert "undecided" in str(report)
        assert "undecided" in repr(report)
        assert report.to_dict()["undecided"][0]["interval"] == list(record.interval)


def test_global_convexity_is_asked_for_by_name_only():
    points = polygons.load_points("protein_1a8o_ca")
    curve = natural(chordal(points), points)
    assert "global-convexity" not in ss.check_shape(points, curve).counts()
    for report in (
        ss.check_shape(points, curve, criteria="global-convexity"),
        ss.NuSpline(points).check("global-convexity"),
        ss.check_shape(points, ss.NuSpline(points), criteria=["global-convexity"]),
    ):
        assert list(report.counts()) == ["global-convexity"]
        assert report.counts()["global-convexity"][1] == 47
    kept = ss.NuSpline.shape_preserving(points, criteria=["convexity", "global-convexity"])
    assert kept.check(["convexity", "global-convexity"]).ok


def test_the_report_in_all_forms(tmp_path):
    import matplotlib as mpl

    mpl.use("Agg")
    points = polygons.load_points("protein_1a8o_ca")
    report = ss.check_shape(
        points, MAKERS["quintic"](chordal(points), points), parameters="chordal"
    )
    json.dumps(report.to_dict(), allow_nan=False)
    frame = report.to_dataframe()
    assert len(frame) == len(report.segments) == 69 * 6
    assert (frame.applicable & ~frame.satisfied).sum() == len(report.violations)
    axes = report.plot()
    assert [t.get_text() for t in axes.get_yticklabels()] == list(report.counts())
    assert report.plot(axes) is axes
    again = pickle.loads(pickle.dumps(report))
    assert again.to_dict() == report.to_dict()
    assert str(again) == str(report)
    assert again.boundary == report.boundary
    assert again.nodes == report.nodes
    mpl.pyplot.close("all")


# Invariance


@pytest.mark.parametrize("maker", ["natural", "makima", "quintic"])
def test_verdicts_do_not_depend_on_the_coordinates(maker, rng):
    points = polygons.load_points("protein_1a8o_ca")
    points = points - points.mean(axis=0)

    def records(points, reverse=False):
        u = chordal(points)
        pieces = ss._convert.piecewise(MAKERS[maker](u, points))
        report = ss.check_shape(points, pieces, parameters=u)
        found = [(r.criterion, r.segment, r.margin, r.satisfied) for r in report.segments]
        if reverse:
            found = [(c, 68 - i, m, s) for c, i, m, s in found]
        return {(c, i): (m, s) for c, i, m, s in found}

    expected = records(points)
    spin = polygons.rotation(rng)
    moved = {
        "rotation": records(points @ spin.T) if maker != "makima" else expected,
        "translation": records(points + np.array([1e3, -2e3, 5e2])),
        "reversal": records(points[::-1], reverse=True),
        "large": records(points * 2.0**100),
        "small": records(points * 2.0**-100),
    }
    for name, found in moved.items():
        for key, (margin, satisfied) in expected.items():
            if abs(margin) > 1e-6:
                assert found[key][1] == satisfied, (name, key)
                assert found[key][0] == pytest.approx(margin, abs=1e-6), (name, key)


@pytest.mark.parametrize("degree", [3, 5])
@pytest.mark.parametrize("scale", [1e-100, 1e100])
def test_verdicts_do_not_depend_on_extreme_scales(scale, degree, rng):
    """SciPy's own coefficients would overflow: the points of the pieces are scaled."""
    points = polygons.random_walk(rng, 12)
    u = chordal(points)
    pieces = ss._convert.piecewise(make_interp_spline(u, points, k=degree))
    expected = ss.check_shape(points, pieces, parameters=u)
    scaled = ss.PiecewiseBezier(pieces.control * scale, pieces.breaks * scale)
    report = ss.check_shape(points * scale, scaled, parameters=u * scale)
    assert report.counts() == expected.counts()


# The documentation


def test_the_page_on_others_curves_says_what_the_script_prints():
    sys.path.insert(0, str(ROOT / "python" / "docs" / "scripts"))
    try:
        import shape_of_others
    finally:
        sys.path.remove(str(ROOT / "python" / "docs" / "scripts"))
    page = (ROOT / "python" / "docs" / "shape-of-others.md").read_text(encoding="utf-8")
    assert shape_of_others.table() in page
    stems = {path.stem for path in polygons.DATA.glob("*.csv")}
    assert all(f"| {stem} |" in page for stem in stems)

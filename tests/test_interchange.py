# SPDX-License-Identifier: MIT OR Apache-2.0

"""Curves for other programs: what is written is the same curve when it is read by somebody else."""

import json
import re
import xml.etree.ElementTree as ET

import geomdl.exchange
import numpy as np
import pytest
from scipy.interpolate import BSpline, CubicSpline

import cases
import polygons
import shapespline as ss
from shapespline import interchange
from shapespline._convert import piecewise

HALF = 0.5**0.5
QUARTER = ss.PiecewiseBezier([[[1, 0], [1, 1], [0, 1]]], [0, 1], weights=[[1, HALF, 1]])
PLANAR = [[0, 0], [1, 1], [2, 0], [3, 1], [3, 4]]
FUNCTION = ss.MonotoneQuintic([0, 1, 2, 4], [0, 1, 1, 3])
CURVES = {str(case): case.preserve() for case in cases.of_every_family(cases.small())}
CURVES |= {"function": FUNCTION, "quarter": QUARTER}
CURVES["cubic of SciPy"] = CubicSpline(np.arange(5.0), PLANAR)
CURVES["C²"] = cases.helix().fit()
#: a corner at the middle break
CURVES["corner"] = ss.PiecewiseBezier([[[0, 0], [1, 1]], [[1, 1], [2, 0]]], [0, 1, 2])


def along(curve, count=400):
    pieces = piecewise(curve)
    u = np.linspace(pieces.breaks[0], pieces.breaks[-1], count)
    return u, pieces(u)


def value(data, u):
    """Evaluate a (rational) B-spline with SciPy."""
    weights = np.ones(len(data.control)) if data.weights is None else data.weights
    w = BSpline(data.knots, weights, data.degree)(u)
    return BSpline(data.knots, data.control * weights[:, None], data.degree)(u) / w[:, None]


def close(found, expected):
    size = np.abs(expected).max()
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * size)


@pytest.mark.parametrize("name", CURVES)
def test_the_b_spline_is_the_curve(name):
    data = interchange.bspline(CURVES[name])
    u, expected = along(CURVES[name])
    close(value(data, u), expected)
    assert len(data.knots) == len(data.control) + data.degree + 1


def multiplicities(data):
    """Return how often each inner knot is there."""
    return np.unique(data.knots, return_counts=True)[1][1:-1]


def jumps(curve, order):
    """Return how far a derivative jumps at each inner break, over its largest change elsewhere."""
    pieces = piecewise(curve)
    control, widths = pieces.control, np.diff(pieces.breaks)[:, None]
    legs = np.diff(control, order, axis=1)
    before, after = legs[:-1, -1] / widths[:-1] ** order, legs[1:, 0] / widths[1:] ** order
    size = np.abs(legs / widths[:, None] ** order).max()
    return np.abs(after - before).max(axis=1) / size


@pytest.mark.parametrize("case", cases.of_every_family(cases.small()), ids=str)
@pytest.mark.parametrize("way", ["fit", "preserve"])
def test_knots_are_as_many_as_the_smoothness_needs(case, way):
    """Simple where a cubic is C², double where it is C¹, triple at a corner of its parameter."""
    curve = getattr(case, way)()
    found = multiplicities(interchange.bspline(curve))
    c1, c2 = jumps(curve, 1) < 1e-9, jumps(curve, 2) < 1e-9
    np.testing.assert_array_equal(found, np.where(c1, np.where(c2, 1, 2), 3))
    if case.family is ss.FairSpline or (way == "fit" and case.family is not ss.CatmullRom):
        assert np.all(found == 1), "without tension the cubics are C²"


@pytest.mark.parametrize(
    ("curve", "inner"),
    [
        (CURVES["corner"], 1),
        (CURVES["cubic of SciPy"], 1),
        (FUNCTION, 3),  # C², of degree 5
        (ss.MonotoneQuartic([0, 1, 2, 4], [0, 1, 1, 3]), 3),  # C¹, of degree 4
        (ss.CatmullRom(PLANAR, "uniform"), 2),
        (ss.TensionSpline(PLANAR, tangent_scale=[1, 0.5, 1, 0.5, 1]), 2),
    ],
)
def test_knots_by_hand(curve, inner):
    np.testing.assert_array_equal(multiplicities(interchange.bspline(curve)), inner)


@pytest.mark.parametrize("ratio", [1e3, 1e8])
@pytest.mark.parametrize("away", [0.0, 1e6])
@pytest.mark.parametrize("scale", [1e-100, 1.0, 1e100])
def test_few_knots_are_still_the_curve(ratio, away, scale, rng):
    """Uneven spacing, points far from the origin, any scale: to rounding of the control points."""
    u = np.cumsum(np.where(np.arange(60) % 2, ratio, 1) * rng.uniform(1, 2, 60))
    points = (rng.normal(size=(60, 3)) + away) * scale
    for curve in (ss.NuSpline(points, u), ss.NuSpline(points, u, tension=rng.integers(0, 2, 60))):
        data = interchange.bspline(curve)
        back = ss.PiecewiseBezier.from_bspline(data.knots, data.control, 3).control
        size = np.abs(curve.bezier).max(axis=(1, 2))
        size = np.maximum(size, np.maximum(np.r_[0, size[:-1]], np.r_[size[1:], 0]))
        assert np.all(np.abs(back - curve.bezier).max(axis=(1, 2)) <= 1e-13 * size)
        assert len(data.control) <= 2 * len(points)


def test_pieces_that_do_not_meet_are_refused():
    with pytest.raises(ValueError, match=r"pieces 0 and 1 are 1 apart at 1"):
        interchange.bspline(ss.PiecewiseBezier([[[0, 0], [1, 1]], [[1, 2], [2, 0]]], [0, 1, 2]))


@pytest.mark.parametrize("name", CURVES)
def test_geomdl_reads_its_json(name, tmp_path):
    path = tmp_path / "curve.json"
    path.write_text(interchange.geomdl_json(CURVES[name]), encoding="utf-8")
    (curve,) = geomdl.exchange.import_json(str(path))
    u, expected = along(CURVES[name], 50)
    moved = (u - u[0]) / (u[-1] - u[0])
    close(np.array(curve.evaluate_list(moved.tolist())), expected)


# SVG


def evaluated(path, count):
    """Return points on an SVG path of absolute commands, ``count`` on each piece."""
    tokens = re.findall(r"[MLQC]|[-+.\deE]+", path)
    points, at, pen, command = [], 0, None, None
    while at < len(tokens):
        if tokens[at].isalpha():
            command = tokens[at]
            at += 1
        needed = {"M": 1, "L": 1, "Q": 2, "C": 3}[command]
        corners = np.array(tokens[at : at + 2 * needed], dtype=float).reshape(-1, 2)
        at += 2 * needed
        if command != "M":
            control = np.vstack([pen, corners])
            t = np.linspace(0, 1, count)
            points.append(ss.PiecewiseBezier(control[None], [0, 1])(t))
        pen = corners[-1]
    return np.concatenate(points)


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_the_svg_path_is_the_curve_to_the_last_bit(degree, rng):
    control = np.cumsum(rng.normal(size=(5, degree + 1, 2)) * 1e3, axis=0)
    control[1:3, 0] = control[0:2, -1]  # the others do not meet: the pen is lifted
    pieces = ss.PiecewiseBezier(control, np.arange(6.0))
    path = interchange.svg_path(pieces)
    assert path.count("M") == 3
    t = np.linspace(0, 1, 7)
    expected = np.concatenate([ss.PiecewiseBezier(c[None], [0, 1])(t) for c in control])
    np.testing.assert_array_equal(evaluated(path, 7), expected)


def test_the_svg_document_shows_the_whole_curve():
    curve = ss.NuSpline.shape_preserving(PLANAR)
    root = ET.fromstring(interchange.svg(curve))
    left, top, width, height = map(float, root.get("viewBox").split())
    (path,) = root
    assert path.get("d") == interchange.svg_path(curve)
    assert path.get("transform") == "scale(1,-1)"
    x, y = along(curve)[1].T
    assert left < x.min()
    assert x.max() < left + width
    assert top < (-y).min()
    assert (-y).max() < top + height


@pytest.mark.parametrize(
    ("curve", "what"),
    [
        (cases.helix().fit(), "in the plane"),
        (QUARTER, "not rational ones"),
        (FUNCTION, "not degree 5"),
    ],
)
def test_what_svg_cannot_draw(curve, what):
    for write in (interchange.svg_path, interchange.svg):
        with pytest.raises(ValueError, match=what):
            write(curve)


# STEP


def read_step(text):
    """Read the B-spline of a STEP file: entity by entity, as the standard writes them."""
    assert text.startswith("ISO-10303-21;\nHEADER;")
    assert text.endswith("END-ISO-10303-21;\n")
    entities = dict(re.findall(r"^#(\d+)=(.*?);$", text, re.MULTILINE | re.DOTALL))
    used = {n for body in entities.values() for n in re.findall(r"#(\d+)", body)}
    assert used <= set(entities), "every reference has an entity"
    (curve,) = [e for e in entities.values() if "B_SPLINE_CURVE_WITH_KNOTS" in e]
    shape = re.search(r"(\d+),\(([#\d,]+)\),\.UNSPECIFIED\.,\.[TF]\.,\.F\.", curve)
    knots = re.search(r"\(([\d,]+)\),\(([-+.\dE,]+)\),\.UNSPECIFIED\.\)", curve)
    control = [
        [float(x) for x in re.search(r"\('',\((.*)\)\)", entities[n[1:]]).group(1).split(",")]
        for n in shape.group(2).split(",")
    ]
    # STEP's numbers need a point.
    assert all("." in x for x in knots.group(2).split(","))
    times = [int(n) for n in knots.group(1).split(",")]
    values = [float(x) for x in knots.group(2).split(",")]
    weights = re.search(r"RATIONAL_B_SPLINE_CURVE\(\((.*?)\)\)", curve)
    return interchange.BSplineData(
        np.repeat(values, times),
        np.array(control),
        int(shape.group(1)),
        np.array([float(w) for w in weights.group(1).split(",")]) if weights else None,
    )


@pytest.mark.parametrize("name", CURVES)
def test_step_holds_the_curve_to_the_last_bit(name):
    data = interchange.bspline(CURVES[name])
    found = read_step(interchange.step(CURVES[name]))
    np.testing.assert_array_equal(found.knots, data.knots)
    np.testing.assert_array_equal(found.control[:, : data.control.shape[1]], data.control)
    assert not found.control[:, data.control.shape[1] :].any()
    assert found.degree == data.degree
    np.testing.assert_array_equal(found.weights, data.weights)


@pytest.mark.parametrize("name", ["helix", "quarter", "plane, closed", "function", "C²"])
@pytest.mark.parametrize("unit", ["mm", "m"])
def test_open_cascade_reads_the_step_file(name, unit, tmp_path):
    """Only where Open CASCADE is installed (pip install cadquery-ocp-novtk): it is too large."""
    pytest.importorskip("OCP", reason="Open CASCADE (cadquery-ocp-novtk) is not installed")
    from OCP.BRep import BRep_Tool
    from OCP.GeomAbs import GeomAbs_C2
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TopAbs import TopAbs_EDGE
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    path = tmp_path / "curve.step"
    path.write_text(interchange.step(CURVES[name], unit=unit), encoding="utf-8")
    reader = STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    explorer = TopExp_Explorer(reader.OneShape(), TopAbs_EDGE)
    curve = BRep_Tool.Curve_s(TopoDS.Edge(explorer.Current()), 0.0, 1.0)
    explorer.Next()
    assert not explorer.More(), "one edge"
    if name in ("C²", "function"):
        assert curve.Continuity().value >= GeomAbs_C2.value
    u, expected = along(CURVES[name])
    assert (curve.FirstParameter(), curve.LastParameter()) == (u[0], u[-1])
    # Open CASCADE works in millimetres.
    scale = 1000 if unit == "m" else 1
    found = [[p.X(), p.Y(), p.Z()] for p in map(curve.Value, u.tolist())]
    close(np.array(found)[:, : expected.shape[1]], scale * expected)


def test_names_and_units_of_step():
    curve = CURVES["helix"]
    assert "PRODUCT('it''s a \\\\ line'," in interchange.step(curve, name="it's a \\ line")
    assert "SI_UNIT($,.METRE.)" in interchange.step(curve, unit="m")
    with pytest.raises(ValueError, match="unit must be one of 'm', 'mm'"):
        interchange.step(curve, unit="mile")
    with pytest.raises(ss.InputError, match="printable ASCII"):
        interchange.step(curve, name="Gerät")


@pytest.mark.parametrize(
    ("write", "options", "exception", "message"),
    [
        ("geomdl_json", {"delta": np.nan}, ss.InputError, r"delta must be in \(0, 1\), got nan"),
        ("geomdl_json", {"delta": 0}, ss.InputError, r"delta must be in \(0, 1\), got 0"),
        ("geomdl_json", {"delta": "0.1"}, TypeError, "delta must be a number, got str"),
        ("svg", {"width": np.nan}, ss.InputError, r"width must be in \(0, inf\), got nan"),
        ("svg", {"width": -1.0}, ss.InputError, r"width must be in \(0, inf\), got -1"),
        ("svg", {"width": 10**400}, ss.InputError, r"width must be in \(0, inf\), got inf"),
        ("svg", {"stroke": "red\0"}, ss.InputError, "stroke must be printable"),
        ("svg", {"stroke": 5}, TypeError, "stroke must be a string, got int"),
        ("step", {"name": 5}, TypeError, "name must be a string, got int"),
        ("step", {"unit": ["mm"]}, TypeError, "unit must be a string, got list"),
    ],
)
def test_options_that_make_no_valid_file_are_refused(write, options, exception, message):
    with pytest.raises(exception, match=message):
        getattr(interchange, write)(ss.NuSpline(PLANAR), **options)


def test_text_is_escaped_in_svg():
    stroke = 'url("#a") <b> & c'
    (path,) = ET.fromstring(interchange.svg(ss.NuSpline(PLANAR), stroke=stroke))
    assert path.get("stroke") == stroke


# From the command line


@pytest.mark.parametrize("ending", ["svg", "step", "json"])
def test_fit_writes_them(ending, tmp_path):
    from shapespline import _cli

    points = tmp_path / "p.csv"
    points.write_text("x [cm],y [cm]\n0,0\n1,1\n2,0\n3,1\n", encoding="utf-8")
    out = tmp_path / f"o.{ending}"
    assert _cli.main(["fit", str(points), "-o", str(out)]) == 0
    text = out.read_text(encoding="utf-8")
    curve = ss.fit([[0, 0], [1, 1], [2, 0], [3, 1]])
    if ending == "svg":
        assert text == interchange.svg(curve)
    elif ending == "step":
        assert text == interchange.step(curve, name="p", unit="cm")
    else:
        np.testing.assert_array_equal(json.loads(text)["control"], curve.bezier)


def test_what_cannot_be_written_from_the_command_line(tmp_path, capsys):
    from shapespline import _cli

    points = str(polygons.DATA / "gm_feature_line.csv")
    assert _cli.main(["fit", points, "-o", str(tmp_path / "o.svg")]) == 2
    assert "in the plane" in capsys.readouterr().err

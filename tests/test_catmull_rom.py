# SPDX-License-Identifier: MIT OR Apache-2.0

"""Catmull–Rom curves: their definition, locality, and handles in closed form."""

from dataclasses import replace

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss

CASES = [replace(case, family=ss.CatmullRom) for case in [*cases.shared(), *cases.small()]]
every_case = pytest.mark.parametrize("case", CASES, ids=str)


@pytest.mark.parametrize("parameters", ["uniform", "centripetal", "chordal", 0.8])
def test_the_tangent_is_that_of_the_parabola(parameters, rng):
    """Barry & Goldman's definition, here by NumPy's polynomials through three points."""
    points = polygons.random_walk(rng, 9)
    curve = ss.CatmullRom(points, parameters)
    u = curve.parameters
    for i in range(1, 8):
        near = slice(i - 1, i + 2)
        for axis in range(3):
            parabola = np.polyfit(u[near] - u[i], points[near, axis], 2)
            assert curve.tangents[i, axis] == pytest.approx(parabola[1], rel=1e-9, abs=1e-9)


def test_uniform_is_the_textbook_curve(rng):
    points = polygons.random_walk(rng, 8)
    curve = ss.CatmullRom(points, "uniform")
    np.testing.assert_allclose(curve.tangents[1:-1], (points[2:] - points[:-2]) / 2, rtol=1e-13)
    half = ss.CatmullRom(points, "uniform", tension=0.5)
    np.testing.assert_allclose(half.tangents[1:-1], (points[2:] - points[:-2]) / 4, rtol=1e-13)
    # Natural ends: no second derivative.
    first, last = curve.parameters[[0, -1]]
    np.testing.assert_allclose(curve(first, 2), 0.0, atol=1e-13)
    np.testing.assert_allclose(curve(last, 2, side="left"), 0.0, atol=1e-13)


def test_default_parameters_are_centripetal(rng):
    points = polygons.random_walk(rng, 8)
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    np.testing.assert_allclose(np.diff(ss.CatmullRom(points).parameters), np.sqrt(lengths))


@every_case
def test_torsion_never_fails_and_closed_forms_suffice(case):
    assert case.fit().check(["torsion"]).ok
    curve = case.preserve()
    assert curve.check().ok
    assert curve.check(["global-convexity"]).ok
    # Only planes that are known to the tolerance alone ask for more than the closed forms.
    if case.fit().check(["coplanarity"]).counts()["coplanarity"][0] == 0:
        assert curve.diagnostics.iterations == 1


@every_case
def test_g1_handles_are_no_shorter_than_c1(case):
    c1, g1 = case.preserve(), case.preserve(continuity="G1")
    assert (c1.continuity, g1.continuity) == ("C1", "G1")
    assert g1.check().ok

    def handles(curve):
        legs = np.diff(curve.bezier, axis=1)[:, ::2]
        return np.linalg.norm(legs, axis=-1)

    if c1.diagnostics.iterations == g1.diagnostics.iterations == 1:
        # But at free ends the leg is (L − c)/2: a longer c can make it shorter.
        inner = slice(1, -1) if case.boundary == "zero-curvature" else slice(None)
        assert np.all(handles(g1)[inner] >= handles(c1)[inner] * (1 - 1e-12))


@every_case
def test_continuity(case):
    for continuity in ("C1", "G1"):
        curve = case.preserve(continuity=continuity)
        u = curve.parameters[1:-1]
        left, right = (curve(u, 1, side=side) for side in ("left", "right"))
        size = [np.linalg.norm(v, axis=1, keepdims=True) for v in (left, right)]
        np.testing.assert_allclose(left / size[0], right / size[1], atol=1e-8)
        if continuity == "C1":
            np.testing.assert_allclose(left, right, rtol=0, atol=1e-10 * np.abs(left).max())


def test_safety_scales_the_handles_that_are_limited():
    points = [[0, 0, 0], [4, 0, 0], [4.5, 0.5, 0], [4.5, 1, 0.5], [4.5, 1, 5]]
    near, far = (ss.CatmullRom.shape_preserving(points, safety=s) for s in (0.9, 0.45))
    limited = far.tension > 0
    assert np.any(near.tension[limited] > 0)
    assert np.all(far.tension >= near.tension)
    both = near.tension > 0
    np.testing.assert_allclose(1 - far.tension[both], (1 - near.tension[both]) / 2, rtol=1e-12)


def test_longer_handles_break_the_shape():
    """The bounds are sharp: with safety 0.999 a little more than 1/0.999 of the handles fails."""
    case = replace(cases.gm_line(), family=ss.CatmullRom)
    curve = case.preserve(safety=0.999)
    limited = np.flatnonzero(curve.tension > 0)
    assert len(limited)
    factors = 1 - curve.tension
    factors[limited] = np.minimum(1.0, factors[limited] * 1.01)
    assert not case.fit(tension=1 - factors).check().ok


@every_case
@pytest.mark.parametrize("continuity", ["C1", "G1"])
def test_directions_of_both_kinds_keep_the_shape(case, continuity):
    balanced, local = (
        case.preserve(continuity=continuity, directions=d) for d in ("balanced", "parametrization")
    )
    assert balanced.check().ok
    assert local.check().ok
    assert case.preserve(continuity=continuity).bezier.tobytes() == balanced.bezier.tobytes()


@pytest.mark.parametrize("case", cases.shared(), ids=str)
@pytest.mark.parametrize("continuity", ["C1", "G1"])
def test_balanced_directions_bend_no_sharper_on_the_shared_data(case, continuity):
    case = replace(case, family=ss.CatmullRom)
    balanced, local = (
        ss.fairness(case.preserve(continuity=continuity, directions=directions)).max_curvature
        for directions in ("balanced", "parametrization")
    )
    assert balanced <= local * 1.01


def test_tangents_of_the_parametrisation_are_kept_where_asked(rng):
    points = polygons.random_walk(rng, 12)
    plain, local = (
        fit(points, **options).tangents
        for fit, options in [
            (ss.CatmullRom, {}),
            (ss.CatmullRom.shape_preserving, {"directions": "parametrization"}),
        ]
    )
    unit = [t / np.linalg.norm(t, axis=1, keepdims=True) for t in (plain, local)]
    np.testing.assert_allclose(unit[1], unit[0], atol=1e-12)


def test_balanced_angles_are_more_alike(rng):
    """The two angles between tangents and chord of a segment, in the plane."""
    points = polygons.random_walk(rng, 30, 2)
    unlike = []
    for directions in ("balanced", "parametrization"):
        curve = ss.CatmullRom.shape_preserving(points, directions=directions)
        chord, tangents = np.diff(points, axis=0), curve.tangents

        def angle(u, v):
            cross = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
            return np.abs(np.arctan2(cross, np.sum(u * v, axis=1)))

        start, end = angle(tangents[1:-2], chord[1:-1]), angle(tangents[2:-1], chord[1:-1])
        unlike.append(np.sum(np.log(start / end) ** 2))
    assert unlike[0] < 0.5 * unlike[1]


@pytest.mark.parametrize(("word", "error"), [("straight", ValueError), (1, TypeError)])
def test_other_directions_are_refused_by_name(word, error, rng):
    points = polygons.random_walk(rng, 8)
    with pytest.raises(error, match="directions"):
        ss.CatmullRom.shape_preserving(points, directions=word)
    with pytest.raises(error, match="directions"):
        ss.fit_many(points, [0, 8], method="catmull-rom", directions=word)
    with pytest.raises(TypeError, match="directions"):
        ss.fit_many(points, [0, 8], method="nu", directions="balanced")

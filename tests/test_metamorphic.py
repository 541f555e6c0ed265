# SPDX-License-Identifier: MIT OR Apache-2.0

"""Relations between answers that need no known answer: moved data, other forms, other batches.

Every relation runs over families × boundaries × data sets. Rotations, translations and reversal
up to rounding are in test_invariance.py; here arithmetic allows the same bits, or another form of
the same curve is judged.
"""

from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BPoly

import cases
import polygons
import scale
import shapespline as ss
from batches import assert_long_batches_agree, assert_same_batches
from shapespline._cli import files

_RNG = np.random.default_rng(15)
#: data sets in space and in the plane
SETS = {
    "gm line": polygons.load_points("gm_feature_line"),
    "protein": polygons.load_points("protein_1a8o_ca"),
    "coil": polygons.load_points("coil_m16n08_first")[:-1],
    "helix": polygons.helix(),
    "walk": polygons.random_walk(_RNG, 30),
    "uneven chords": polygons.uneven_chords(_RNG, 20),
    "lattice walk": np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [2, 1, 1], [3, 1, 1]]),
    "zigzag": np.array([[-1.0, 0, -1], [0, -1, -1], [1, 1, 0]])[np.arange(100) % 3].cumsum(axis=0),
    "planar walk": polygons.random_walk(_RNG, 30, 2),
    "stairs": np.array([[1.0, 0], [1, 0], [0, 1]])[np.arange(40) % 3].cumsum(axis=0),
}
BOUNDARIES = ("zero-curvature", "periodic", "circular", "tangents")
PARAMETERS = ("uniform", "chordal", "centripetal")


def make_case(family, end, name, parameters):
    """Return the case of a data set with an end of a kind."""
    points = np.asarray(SETS[name], dtype=float)
    dim = points.shape[1]
    if end == "periodic":
        points = polygons.close(points)
    if end == "tangents":
        size = np.linalg.norm(np.diff(points, axis=0), axis=1)
        u = cases.Case(name, points, parameters).fit().parameters
        start, stop = np.array([1.0, 0.5, -0.25])[:dim], np.array([-0.25, 1.0, 0.5])[:dim]
        h = np.diff(u)
        end = ss.Tangents(start * size[0] / h[0], stop * size[-1] / h[-1])
    return cases.Case(f"{name}, {parameters}", points, parameters, end, family)


#: A fair curve is a minimum of its energy, and long irregular walks have several: rounding decides
#: which of them is found (limits.md). Small sets have one.
FAIR_SETS = ("lattice walk", "stairs")


# Each pair of a family and a boundary with each set; the parameters take turns.
CASES = [
    pytest.param(
        make_case(family, end, name, PARAMETERS[k % 3]), id=f"{family.__name__}-{end}-{name}"
    )
    for k, (family, end, name) in enumerate(product(cases.FAMILIES, BOUNDARIES, SETS))
    if family in cases.TENSE or name in FAIR_SETS
]
every_case = pytest.mark.parametrize("case", CASES)


@dataclass(frozen=True)
class Move:
    """A change of coordinates and parameters that rounds nothing."""

    matrix: np.ndarray
    #: factor of the parameters
    pace: float = 1.0

    def points(self, x):
        """Move points, or vectors."""
        return x @ self.matrix

    def tangents(self, x):
        """Move derivatives with respect to the parameter."""
        return self.points(x) / self.pace

    def case(self, case):
        """Move a case with explicit parameters."""
        moved = case.moved(self.points(case.points), self.tangents)
        return replace(moved, parameters=case.parameters * self.pace)


def exact_moves(dim):
    """Return mirrors, powers of two, and in the plane the exchange of the axes.

    In space, sums of three products are rounded in the order of the axes.
    """
    moves = {
        f"mirrored {'xyz'[axis]}": Move(np.diag(sign))
        for axis, sign in enumerate(1.0 - 2.0 * np.eye(dim))
    }
    moves["mirrored at the origin"] = Move(-np.eye(dim))
    moves["larger"] = Move(2.0**20 * np.eye(dim))
    moves["smaller"] = Move(2.0**-30 * np.eye(dim), 2.0**-30)
    moves["slower"] = Move(np.eye(dim), 2.0**25)
    if dim == 2:
        moves["axes exchanged"] = Move(np.eye(2)[::-1])
        moves["a quarter turn"] = Move(np.array([[0.0, 1.0], [-1.0, 0.0]]))
    return moves


def assert_moved_closely(move, before, after):
    """Compare two fair curves: their steps depend on rounding, the minimum does not."""
    chord = np.linalg.norm(np.diff(after.points, axis=0), axis=1).mean()
    u = np.linspace(*before.parameters[[0, -1]], 57)
    np.testing.assert_allclose(
        after(u * move.pace), move.points(before(u)), rtol=0, atol=1e-6 * chord
    )
    mine, theirs = before.check(), after.check()
    assert theirs.ok == mine.ok
    assert {k: asked for k, (_, asked) in theirs.counts().items()} == {
        k: asked for k, (_, asked) in mine.counts().items()
    }


def assert_moved_exactly(move, before, after):
    """Compare two curves, and what is said of them, bit by bit."""
    if isinstance(before, ss.FairSpline):
        assert_moved_closely(move, before, after)
        return
    np.testing.assert_array_equal(cases.tension_of(after), cases.tension_of(before))
    np.testing.assert_array_equal(after.tangents, move.tangents(before.tangents))
    np.testing.assert_array_equal(after.bezier, move.points(before.bezier))
    assert after.diagnostics == before.diagnostics
    u = np.linspace(*before.parameters[[0, -1]], 57)
    np.testing.assert_array_equal(after(u * move.pace), move.points(before(u)))
    mine, theirs = before.check(), after.check()
    assert theirs.counts() == mine.counts()
    records = [
        np.array([(r.segment, r.satisfied, r.margin, r.location / pace) for r in report.segments])
        for report, pace in [(mine, 1.0), (theirs, move.pace)]
    ]
    np.testing.assert_array_equal(*records)


@every_case
def test_mirrors_and_powers_of_two_change_no_bit(case):
    case = case.explicit()
    before = [case.preserve()] + [case.tense(0.7)] * (case.family in cases.TENSE)
    for move in exact_moves(case.points.shape[1]).values():
        moved = move.case(case)
        after = [moved.preserve()] + [moved.tense(0.7)] * (case.family in cases.TENSE)
        for mine, theirs in zip(before, after, strict=True):
            assert_moved_exactly(move, mine, theirs)


coordinates = st.integers(-3, 3) | st.floats(-4, 4, width=32)


@pytest.mark.parametrize("parameters", PARAMETERS)
@given(data=st.data())
def test_any_mirrored_or_scaled_polygon(parameters, data):
    """As above, for named parameters: a power of four scales centripetal ones by one of two."""
    dim = data.draw(st.sampled_from([2, 3]))
    points = data.draw(st.lists(st.tuples(*[coordinates] * dim), min_size=3, max_size=9))
    family = data.draw(st.sampled_from(cases.TENSE))
    case = cases.Case("any", np.array(points, dtype=float), parameters, family=family)
    sign = np.diag(data.draw(st.tuples(*[st.sampled_from([-1.0, 1.0])] * dim)))
    scale = 4.0 ** data.draw(st.integers(-20, 20))
    pace = {"uniform": 1.0, "chordal": scale, "centripetal": np.sqrt(scale)}[parameters]
    move = Move(scale * sign, pace)

    def outcome(case):
        try:
            return case.preserve()
        except ss.ConvergenceError as error:
            return error.curve
        except ValueError as error:
            return str(error).split(" ", maxsplit=1)[0]

    mine, theirs = outcome(case), outcome(case.moved(move.points(case.points)))
    if isinstance(mine, str):
        assert mine == theirs
    else:
        assert_moved_exactly(move, mine, theirs)


def assert_same_verdicts(mine, theirs, small, last=None):
    """Compare two reports: margins up to rounding, and the verdicts where margins are not small.

    ``last``: the number of the last segment, where the second report is on the reversed curve.
    """

    def record(r, flip):
        return (last - r.segment if flip else r.segment, r.criterion), r

    theirs = dict(record(r, last is not None) for r in theirs.segments)
    for key, a in (record(r, False) for r in mine.segments):
        b = theirs.pop(key)
        assert a.applicable == b.applicable, (a, b)
        if a.applicable:
            assert b.margin == pytest.approx(a.margin, abs=small), (a, b)
            assert a.satisfied == b.satisfied or abs(a.margin) <= small, (a, b)
    assert not theirs


def rounded_moves(case, rng):
    """Return the case with axes permuted, rotated, moved away and reversed."""
    dim = case.points.shape[1]
    order = np.roll(np.arange(dim), 1)
    spin = polygons.rotation(rng, dim)
    away = np.ptp(case.points) * rng.normal(size=dim)
    return {
        "permuted": case.moved(case.points[:, order], lambda v: v[order]),
        "rotated": case.moved(case.points @ spin, lambda v: v @ spin),
        "moved away": case.moved(case.points + away),
        "reversed": case.reversed(),
    }


@every_case
def test_reports_move_with_the_data(case, rng):
    """Up to rounding: what is preserved stays so, and margins are the same."""
    case = case.explicit()
    own = case.tense(0.7).check()
    # Where chords differ by 1e6, short ones lose digits when they are moved away; fair curves are
    # found by iterations, which end a little elsewhere.
    small = 1e-8 if case.family in cases.TENSE else 1e-3
    for name, moved in rounded_moves(case, rng).items():
        last = len(case.points) - 2 if name == "reversed" else None
        assert_same_verdicts(own, moved.tense(0.7).check(), small, last)
        assert moved.preserve().check().ok, name


def exports(curve, path):
    """Return the same curve in every form that it can leave in, with parameters to judge it by."""
    u, boundary = curve.parameters, curve.boundary
    files.write_curve(path, curve)
    stored = files.read_curve(path)
    given = {"parameters": u, "boundary": boundary}
    forms = {
        "pieces": (ss.PiecewiseBezier(curve.bezier, curve.knots), given),
        "bpoly": (BPoly(curve.bezier.swapaxes(0, 1), curve.knots), given),
        "ppoly": (curve.to_ppoly(), given),
        "bspline": (curve.to_bspline(), given),
        "json": (stored.curve, {"parameters": stored.parameters, "boundary": stored.boundary}),
    }
    if len(curve.bezier) == len(curve.points) - 1:
        # Without knots, pieces are taken to lie between neighbouring points.
        forms["bezier"] = (curve.bezier, given)
    return forms


# Control points of chords that differ by 1e6 hold few digits of the short legs: that is for the
# tests of error bounds.
@pytest.mark.parametrize("case", [case for case in CASES if "uneven chords" not in case.id])
def test_every_export_is_judged_like_the_curve(case, tmp_path):
    for curve in (case.tense(0.7), case.preserve()):
        own = curve.check()
        for name, (form, options) in exports(curve, tmp_path / "c.json").items():
            report = ss.check_shape(curve.points, form, **options)
            assert_same_verdicts(own, report, 1e-7)
            assert report.ok == own.ok or abs(own.margin) <= 1e-7, name


@pytest.mark.parametrize("count", [3, 9, 64, 65, 130])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("end", ["zero-curvature", "periodic"])
@pytest.mark.parametrize("family", cases.FAMILIES)
def test_curves_have_one_value_however_they_are_asked(family, end, dim, count, rng):
    points = polygons.random_walk(rng, count, dim)
    points = polygons.close(points) if end == "periodic" else points
    curve = cases.Case("walk", points, "chordal", end, family).tense(rng.uniform(0, 3))
    questions = {
        "curvature": curve.curvature,
        "curvature vector": curve.curvature_vector,
        "torsion": curve.torsion,
        "binormal": lambda u: curve.frame(u)[2],
        "from the left": lambda u: curve(u, 1, side="left"),
    }
    for order in range(3):
        questions[f"derivative {order}"] = lambda u, order=order: curve(u, order)
    for question in questions.values():
        assert_same_batches(question, curve.parameters, rng)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("family", cases.FAMILIES)
def test_long_batches_have_the_values_of_short_ones(family, dim, rng):
    count = 300 if family in cases.TENSE else 30
    curve = cases.Case("walk", polygons.random_walk(rng, count, dim), family=family).tense(0.7)
    assert_long_batches_agree(curve, curve.parameters[[0, -1]], rng)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("end", BOUNDARIES)
@pytest.mark.parametrize("family", cases.FAMILIES)
def test_fits_of_many_are_the_single_fits(family, end, dim, rng):
    """All sets of a dimension in one collection, and collections around the sizes of blocks."""
    sets_of = SETS if family in cases.TENSE else FAIR_SETS
    names = [name for name in sets_of if np.shape(SETS[name])[1] == dim]
    sets = [make_case(family, end, name, "chordal") for name in names]
    if end == "tangents":
        sets = [replace(case, boundary=sets[0].boundary) for case in sets]
    singles = [case.preserve() for case in sets]
    few = (3, 33) if family in cases.TENSE else (3,)
    for count in (1, 3, 4, 5, 8, 16, 33, 65) if scale.LONG else few:
        chosen = rng.integers(len(sets), size=count)
        points = np.concatenate([sets[k].points for k in chosen])
        offsets = np.cumsum([0, *(len(sets[k].points) for k in chosen)])
        threads = [None, 1, 3][count % 3]
        fits = ss.fit_many(
            points,
            offsets,
            method=cases.METHODS[family],
            parameters="chordal",
            boundary=sets[0].boundary,
            threads=threads,
        )
        for k, curve in zip(chosen, fits, strict=True):
            np.testing.assert_array_equal(curve.bezier, singles[k].bezier)
            np.testing.assert_array_equal(cases.tension_of(curve), cases.tension_of(singles[k]))
            assert curve.diagnostics == singles[k].diagnostics
            assert curve.check().to_dict() == singles[k].check().to_dict()

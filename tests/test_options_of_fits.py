# SPDX-License-Identifier: MIT OR Apache-2.0

"""A curve keeps the options of its fit, and its check asks them again."""

import copy
import pickle

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss
from scale import scaled
from shapespline import _cli
from shapespline._cli import files

every_family = pytest.mark.parametrize("family", cases.FAMILIES, ids=lambda c: c.__name__)

#: Options under which curves come out that the defaults, or other options, find fault with.
OPTIONS = {
    "tolerance": {"tolerance": 0.3},
    "coplanarity": {"coplanarity": 0.9, "criteria": ["coplanarity"]},
    "collinearity": {"collinearity": 0.9, "criteria": ["collinearity", "turning"]},
    "criteria": {"criteria": ["torsion"]},
    "one name": {"criteria": "convexity"},
    "all": {
        "criteria": ["convexity", "global-convexity"],
        "tolerance": 1e-6,
        "coplanarity": 0.5,
        "collinearity": 0.4,
    },
}


def points_of(rng, dim=3):
    """Return straight runs that meet in corners, and a walk: every criterion is asked for."""
    lattice = polygons.lattice_walk(rng, 20, dim) * 0.7
    walk = polygons.random_walk(rng, 20, dim)
    return np.vstack([lattice, lattice[-1] + 2.0 + walk])


def is_kept(curve, options):
    """Whether a check without arguments is the one with the options of the fit."""
    own, asked = curve.check(), curve.check(**options)
    assert own.ok
    assert own.to_dict() == asked.to_dict()
    names = options.get("criteria", [*cases.PAPERS, "turning"])
    assert set(own.counts()) == ({names} if isinstance(names, str) else set(names))


@pytest.mark.parametrize("options", OPTIONS.values(), ids=OPTIONS)
@every_family
def test_a_check_asks_what_the_fit_was_asked(family, options, rng, tmp_path):
    differ = 0
    for dim in (2, 3):
        for _ in range(6 if family in cases.TENSE else scaled(6)):
            points = points_of(rng, dim)
            curve = cases.preserving(family)(points, **options)
            is_kept(curve, options)
            for other in (
                pickle.loads(pickle.dumps(curve)),
                copy.copy(curve),
                copy.deepcopy(curve),
            ):
                is_kept(other, options)
            assert ss.check_shape(points, curve).to_dict() == curve.check().to_dict()
            report = pickle.loads(pickle.dumps(curve.check()))
            assert report.to_dict() == curve.check().to_dict()
            plain = family if family in cases.TENSE else ss.NuSpline
            differ += (
                not plain(points).check().ok
                and not curve.check(
                    ["regular", *cases.PAPERS, "turning"],
                    tolerance=1e-9,
                    coplanarity=0.2,
                    collinearity=0.2,
                ).ok
            )
    assert differ > 0


@every_family
def test_many_curves_keep_the_options_of_their_fit(family, rng):
    rows = [points_of(rng) for _ in range(8 if family in cases.TENSE else 3)]
    options = {"criteria": ["convexity", "inflection", "turning"], "tolerance": 0.05}
    offsets = np.cumsum([0, *map(len, rows)])
    for curve in ss.fit_many(
        np.concatenate(rows), offsets, method=cases.METHODS[family], **options
    ):
        is_kept(curve, options)


@every_family
def test_given_options_go_before_those_of_the_fit(family, rng):
    points = points_of(rng)
    curve = cases.preserving(family)(points, tolerance=0.3, coplanarity=0.5, criteria=["torsion"])
    report = curve.check("turning", tolerance=1e-9)
    assert list(report.counts()) == ["turning"]
    assert report.to_dict()["tolerance"] == 1e-9
    assert report.to_dict()["coplanarity"] == 0.5
    assert curve.check(collinearity=0.1).to_dict()["collinearity"] == 0.1


@pytest.mark.parametrize("family", cases.TENSE)
def test_a_curve_that_was_not_fitted_has_the_defaults(family, rng):
    report = family(points_of(rng)).check()
    assert set(report.counts()) - {"regular"} == {*cases.PAPERS, "turning"}
    found = report.to_dict()
    assert [found[name] for name in ("coplanarity", "collinearity", "tolerance")] == [
        0.2,
        0.2,
        1e-9,
    ]


@every_family
def test_the_last_curve_of_a_failed_fit_keeps_them_too(family, rng):
    if family is ss.CatmullRom:
        pytest.skip("has no limit of iterations")
    options = {"criteria": ["convexity", "turning"], "tolerance": 1e-6}
    with pytest.raises(ss.ConvergenceError) as caught:
        cases.preserving(family)(points_of(rng), max_iterations=1, **options)
    assert caught.value.curve.check().to_dict() == caught.value.report.to_dict()


@pytest.mark.parametrize("method", cases.METHODS.values())
def test_files_keep_them(method, rng, tmp_path, capsys):
    table, file = tmp_path / "p.csv", tmp_path / "c.json"
    np.savetxt(table, points_of(rng), delimiter=",", header="x,y,z", comments="")
    fit = ["fit", str(table), "--method", method, "--tolerance", "0.3", "-o", str(file)]
    assert _cli.main(fit) == 0
    assert files.read_curve(file).fit_options["tolerance"] == 0.3
    assert _cli.main(["check", str(table), str(file)]) == 0
    # By default the same curve does not pass.
    assert _cli.main(["check", str(table), str(file), "--tolerance", "1e-9"]) == 1
    if method == "fair":
        return
    # A curve of given tension was asked for nothing.
    plain = {"tension": "--tangent-scale=0.5"}.get(method, "--tension=0.5")
    _cli.main(["fit", str(table), "--method", method, plain, "-o", str(file)])
    assert files.read_curve(file).fit_options is None
    capsys.readouterr()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ('["torsion"]', "'fit_options' must be an object"),
        ('{"strategy": "growth"}', "'fit_options' must be an object"),
        ('{"criteria": "torsion"}', "'criteria' of 'fit_options' must be a list"),
        ('{"criteria": ["beauty"]}', "criteria must be one of"),
        ('{"tolerance": [0.1]}', "'tolerance' of 'fit_options' must be a number"),
        ('{"tolerance": true}', "must hold numbers only"),
        ('{"tolerance": 7}', "tolerance must be in"),
    ],
)
def test_bad_options_in_a_file_are_refused_in_one_line(given, message, tmp_path, capsys):
    table, file = tmp_path / "p.csv", tmp_path / "c.json"
    table.write_text("x,y\n0,0\n1,0\n1,1\n")
    files.write_curve(file, ss.NuSpline([[0, 0], [1, 0], [1, 1]]))
    text = file.read_text(encoding="utf-8")
    file.write_text(
        text.replace('"type"', f'"fit_options": {given},\n  "type"', 1), encoding="utf-8"
    )
    assert _cli.main(["check", str(table), str(file)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert message in error
    assert "c.json" in error

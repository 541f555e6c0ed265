# SPDX-License-Identifier: MIT OR Apache-2.0

"""Options stand in one place, the signatures of the compiled classes: all else agrees with them."""

import ast
import inspect
from pathlib import Path

import numpy as np
import pytest

import shapespline as ss
from shapespline import _cli, _core
from shapespline._cli.fit import OPTIONS
from shapespline._methods import KINDS, METHODS

STUB = Path(_core.__file__).with_name("_core.pyi")
#: Straight runs, a plane run, a run in space: every criterion is asked for.
POINTS = np.array(
    [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 1, 0], [3, 2, 0], [2, 3, 0], [1, 2.5, 1], [0, 2, 3],
     [0.5, 0, 4], [0.5, 0.1, 4.2]]
)  # fmt: skip
X, Y = np.arange(7.0), np.array([0, 0.01, 1, 1, 5, 5.5, 9])


def keywords(call):
    parameters = inspect.signature(call).parameters.values()
    return {p.name: p.default for p in parameters if p.kind is p.KEYWORD_ONLY}


def makers():
    for method in METHODS.values():
        yield method.family, POINTS
        if method.given:
            yield method.family.shape_preserving, POINTS
    for kind in KINDS.values():
        yield kind.family, X, Y


@pytest.mark.parametrize("maker", list(makers()), ids=lambda maker: maker[0].__qualname__)
def test_a_signature_shows_the_true_defaults(maker):
    """What a call takes where nothing is said is what its signature says: to the bit."""
    make, *data = maker
    expected = make(*data)
    for name, default in keywords(make).items():
        found = make(*data, **{name: default})
        if isinstance(expected, ss.SpaceCurve):
            np.testing.assert_array_equal(found.bezier, expected.bezier)
            assert found._fit_options() == expected._fit_options()
        else:
            np.testing.assert_array_equal(found._bernstein(), expected._bernstein())
            assert found.extrapolate == expected.extrapolate
            assert found.diagnostics == expected.diagnostics


@pytest.mark.parametrize(
    ("verb", "table", "own"),
    [
        (ss.fit, METHODS, {"method", "boundary", "closed", "repeated"}),
        (
            ss.fit_many,
            METHODS,
            {"method", "boundary", "closed", "repeated", "parameters", "shape_preserving"}
            | {"errors", "threads"},
        ),
        (ss.fit_monotone, KINDS, {"kind", "extrapolate"}),
        (ss.fit_many_monotone, KINDS, {"kind", "extrapolate", "offsets"}),
    ],
)
def test_verbs_take_the_options_of_all_their_classes(verb, table, own):
    expected = {name for entry in table.values() for name in entry.all_options}
    if verb is ss.fit:
        expected -= {"tension", "tangent_scale"}
    if verb is ss.fit_many:
        expected -= {name for entry in table.values() for name in entry.alone}
    assert set(keywords(verb)) - own == expected


def test_the_command_line_has_a_flag_for_every_option():
    parser = _cli._parser()._actions[-1].choices["fit"]
    flags = {action.dest for action in parser._actions}
    assert {name for known in OPTIONS.values() for name in known} <= flags
    rest = {"help", "points", "columns", "method", "out", "samples", "by", "report", "plot"}
    assert flags - rest == {name for known in OPTIONS.values() for name in known}


def test_the_stub_knows_the_names_that_options_take():
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    aliases = {
        node.targets[0].id: ast.literal_eval(node.value.slice)
        for node in tree.body
        if isinstance(node, ast.Assign)
        and isinstance(node.value, ast.Subscript)
        and ast.unparse(node.value.value) == "Literal"
    }
    types = {
        "boundary": "_Boundary",
        "continuity": "_Continuity",
        "criteria": "_Criterion",
        "directions": "_Directions",
        "energy": "_Energy",
        "strategy": "_Strategy",
    }
    assert {*types, "by", "repeated"} == set(_core._NAMES)
    for option, alias in types.items():
        assert set(aliases[alias]) == set(_core._NAMES[option])

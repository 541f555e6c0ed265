"""A curve answers `check()` with the options of its fit, and says where it stops."""

import pickle

import numpy as np
import pytest

import cases
import polygons
import shapespline as ss
from scale import scaled

OPTIONS = [
    {"tolerance": 0.05},
    {"criteria": ["convexity"]},
    {"coplanarity": 0.6, "collinearity": 0.5},
    {"criteria": ["convexity", "inflection"], "tolerance": 0.01},
]


@pytest.mark.parametrize("family", cases.FAMILIES)
@pytest.mark.parametrize("options", OPTIONS, ids=str)
def test_check_asks_what_the_fit_asked(family, options):
    rng = np.random.default_rng(6)
    differ = 0
    for _ in range(scaled(100)):
        points = polygons.random_walk(rng, 12)
        curve = family.shape_preserving(points, **options)
        own = curve.check()
        assert own.ok, own
        assert own.to_dict() == curve.check(**options).to_dict()
        assert pickle.loads(pickle.dumps(curve)).check().to_dict() == own.to_dict()
        differ += own.to_dict() != family(points).check().to_dict()
    assert differ > 0, "the options make a difference"


@pytest.mark.parametrize("family", cases.FAMILIES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_curve_that_stops_is_not_ok(family, dimension):
    points = np.zeros((3, dimension))
    points[1, 0] = 1
    report = family(points, boundary="periodic").check()
    assert not report.ok
    assert {v.criterion for v in report.violations} == {"regular"}
    assert ss.check_shape(points, family(points, boundary="periodic")).ok is False

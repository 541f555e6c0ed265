# SPDX-License-Identifier: MIT OR Apache-2.0

"""What a report says beyond the criteria: conditions at nodes, oscillations about planes."""

import numpy as np
import pytest

import cases
import shapespline as ss


def test_notes_on_nodes():
    report = cases.gm_line().fit().check()
    conditions = {record.condition for record in report.nodes}
    assert conditions <= {
        "compatibility", "same-torsion", "torsion-change", "convex-neighbourhood",
        "inflection-neighbourhood", "neighbourhood-torsion", "neighbourhood-coplanarity",
    }  # fmt: skip
    assert {"compatibility", "same-torsion"} <= conditions
    curve = cases.gm_line().fit()
    for record in report.nodes:
        assert record.satisfied == (record.margin > 0)
        assert 0 < record.node < 19
        if record.condition == "compatibility":
            # (12.1), written out.
            i, tangent = record.node, curve.tangents[record.node]
            before, after = np.diff(curve.points, axis=0)[i - 1 : i + 1]
            p = np.cross(before, after)
            between = np.cross(before, tangent) @ p > 0 and np.cross(tangent, after) @ p > 0
            assert record.satisfied == between
            assert record.location == curve.parameters[i]


@pytest.mark.parametrize(
    ("height", "condition"), [(0.5, "neighbourhood-torsion"), (0, "neighbourhood-coplanarity")]
)
def test_three_points_on_a_line_in_space(height, condition):
    points = [[-1, 1, 0], [0, 0, 0], [1, 0, 0], [2, 0, 0], [3, -1, height], [3, -2, 1]]
    curve = ss.NuSpline.shape_preserving(points)
    found = {r.condition: r for r in curve.check().nodes if r.node == 2}
    assert set(found) == {"inflection-neighbourhood", condition}
    assert found[condition].satisfied == (found[condition].margin > 0)
    u = curve.parameters
    assert u[1] <= found[condition].location <= u[3]


def test_oscillations_about_a_plane():
    # Four points in a plane with a turn each way, then out of it.
    points = np.array([[0.0, 0, 0], [1, 1, 0], [2, 0, 0], [3, 1, 0], [4, 1, 2], [5, 3, 1]])
    report = ss.NuSpline(points).check()
    assert report.counts()["coplanarity"][1] == len(report.oscillations) > 0
    for record in report.oscillations:
        assert record.satisfied == (record.crossings <= record.least)
        assert record.amplitude >= 0

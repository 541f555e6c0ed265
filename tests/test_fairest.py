"""The default strategy returns the fairest curve: no more tension than growth, none to spare."""

import numpy as np
import pytest

import cases


def runs(tension):
    """Return the connected runs of positive tension as lists of nodes."""
    nodes = np.flatnonzero(tension > 0)
    return [
        list(run) for run in np.split(nodes, np.flatnonzero(np.diff(nodes) > 1) + 1) if len(run)
    ]


def deviation(case, curve):
    """Return the largest distance from the C² cubic at the same parameter."""
    plain = case.fit()
    u = plain.parameters
    t = u[:-1, None] + np.diff(u)[:, None] * np.linspace(0, 1, 33)
    return np.linalg.norm(curve(t) - plain(t), axis=-1).max()


@pytest.mark.parametrize("case", [*cases.shared(), *cases.small()], ids=str)
def test_never_more_tension_than_growth(case):
    growth, fairest = case.preserve(strategy="growth"), case.preserve(strategy="fairest")
    assert fairest.tension.sum() <= growth.tension.sum()
    # Relaxed run by run: nowhere more, not only in total.
    assert np.all(fairest.tension <= growth.tension * (1 + 1e-12))


def test_never_farther_from_the_c2_cubic_than_growth(show_table):
    rows = [f"{'tension and distance from the C² cubic':42}{'growth':>24}{'fairest':>24}"]
    pairs = []
    for case in cases.shared():
        row = f"{case!s:42}"
        found = []
        for strategy in ("growth", "fairest"):
            curve = case.preserve(strategy=strategy)
            found.append(deviation(case, curve))
            row += f"{curve.tension.sum():12.5g}{found[-1]:12.5g}"
        rows.append(row)
        pairs.append((case, *found))
    show_table("\n".join(rows))
    assert [str(case) for case, growth, fairest in pairs if fairest > growth * (1 + 1e-9)] == []


@pytest.mark.parametrize("case", [*cases.shared(), *cases.small()], ids=str)
def test_no_run_can_be_lowered_any_more(case):
    """Each run scaled down by 2 % leaves a criterion violated or unproved."""
    curve = case.preserve()
    tension = curve.tension
    groups = runs(tension)
    if case.boundary == "periodic" and len(groups) > 1 and tension[0] > 0:
        groups[0] += groups.pop()  # the first and the last node are one
    for run in groups:
        lower = tension.copy()
        lower[run] *= 0.98
        report = case.fit(tension=lower).check()
        # A fit does not accept what rounding hides.
        assert not report.ok or report.undecided, run


def test_default_is_fairest():
    case = cases.gm_line()
    np.testing.assert_array_equal(
        case.preserve().tension, case.preserve(strategy="fairest").tension
    )

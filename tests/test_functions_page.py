# SPDX-License-Identifier: MIT OR Apache-2.0

"""python/docs/functions-compared.md says what python/docs/scripts/functions_table.py finds."""

import sys
import warnings
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def script():
    sys.path.insert(0, str(ROOT / "python" / "docs" / "scripts"))
    try:
        import functions_table
    finally:
        sys.path.pop(0)
    return functions_table


def printed(script, name):
    """Return the cells of a table on the page, without its heading."""
    begin, end = script.marked(name)
    page = script.PAGE.read_text(encoding="utf-8")
    lines = page.split(begin)[1].split(end)[0].splitlines()
    header, _, *rows = [[c.strip() for c in line.strip("|").split("|")] for line in lines]
    assert header == list(script.SHAPE if name == "shape" else script.RATES)
    return rows


@pytest.fixture(scope="module")
def shapes(script):
    with warnings.catch_warnings():
        # SciPy's makima divides 0 by 0 on flats.
        warnings.simplefilter("ignore", RuntimeWarning)
        return list(script.shape_rows())


def numbers(cell):
    return [float(part.strip("%")) for part in cell.split(" of ")]


def test_the_table_of_shape_is_up_to_date(script, shapes):
    """To the last digits, which may be the machine's: one sign near zero in a hundred."""
    page = printed(script, "shape")
    assert [cells[:2] for cells in page] == [cells[:2] for cells in shapes]
    for old, new in zip(page, shapes, strict=True):
        for a, b, last in zip(old[2:], new[2:], (0.0011, 0.11, 0, 0), strict=True):
            # Counts may differ by one in a hundred, those of published data not at all.
            assert numbers(a) == pytest.approx(numbers(b), rel=0.01, abs=last)


def test_monotone_classes_never_overshoot_and_the_cubic_has_the_least_energy(script, shapes):
    for name in {cells[0] for cells in shapes}:
        rows = {cells[1]: cells for cells in shapes if cells[0] == name}
        kept = [maker for maker, cells in rows.items() if cells[3] == "0"]
        assert {m for m in script.MAKERS if m.startswith("`Monotone")} | {"PCHIP"} <= {*kept}
        least = rows['`MonotoneCubic`, `ends="natural"`, `layer=0`'][2]
        assert least == "1.000"
        assert all(float(rows[maker][2]) >= 1 for maker in kept)


def test_the_accuracies_are_up_to_date(script):
    page = printed(script, "rates")
    found = list(script.accuracies())
    assert [cells[0] for cells in page] == [cells[0] for cells in found]
    for old, new in zip(page, found, strict=True):
        for a, b in zip(old[1:5], new[1:], strict=True):
            assert float(a) == pytest.approx(float(b), rel=0.06)
        assert all(float(ratio) > 0 for ratio in old[5:])
    orders = {cells[0]: float(cells[2]) for cells in found}
    assert orders["`MonotoneCubic`"] == pytest.approx(4, abs=0.2)


def cells_of(page, row):
    """Return the cells of a row of the only table in a page that has it."""
    (line,) = [line for line in page.read_text("utf-8").splitlines() if line.startswith(f"| {row}")]
    return [cell.strip() for cell in line.strip("|").split("|")][1:]


def test_the_summaries_repeat_the_page(script):
    makers = ["`MonotoneCubic`", "`MonotoneQuintic`", "`MonotoneQuartic`", "PCHIP"]
    made = {c[1]: c for c in printed(script, "shape") if c[0].startswith("rough")}
    rates = {cells[0]: cells for cells in printed(script, "rates")}
    chapter = ROOT / "python" / "docs" / "monotone.md"
    assert cells_of(chapter, "energy over the least") == [made[m][2] for m in makers]
    parts = [numbers(made[m][4]) for m in makers]
    broken = [float(cell.split()[0]) for cell in cells_of(chapter, "convex segments broken")]
    assert broken == [round(100 * bad / asked) for bad, asked in parts]
    assert made['`MonotoneCubic`, `convex="data"`'][4].startswith("0 of")
    orders = [rates[m][2] for m in makers]
    assert [f"{float(cell):.1f}" for cell in cells_of(chapter, "order of accuracy")] == orders
    times = [float(cell.split()[0]) for cell in cells_of(chapter, "time of a fit")]
    assert times == pytest.approx([float(rates[m][5]) for m in makers], abs=0.06)
    readme, makers = ROOT / "README.md", [*makers, "natural cubic spline"]
    assert cells_of(readme, "bending energy over the least") == [made[m][2] for m in makers]
    assert cells_of(readme, "largest overshoot") == [made[m][3] for m in makers]
    assert cells_of(readme, "order of accuracy") == [rates[m][2] for m in makers]

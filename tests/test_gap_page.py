# SPDX-License-Identifier: MIT OR Apache-2.0

"""python/docs/fair-splines.md says what python/docs/scripts/gap_table.py finds."""

import sys
from pathlib import Path

import pytest

from scale import LONG

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "python" / "docs" / "fair-splines.md"


@pytest.fixture(scope="module")
def script():
    sys.path.insert(0, str(ROOT / "python" / "docs" / "scripts"))
    try:
        import gap_table
    finally:
        sys.path.pop(0)
    return gap_table


def printed():
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    table = [line for line in lines if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def assert_same(page, rows, within):
    """Names and counts to the letter."""
    assert [cells[:3] for cells in page] == [cells[:3] for cells in rows]
    for old, new in zip(page, rows, strict=True):
        rel = within(old[0])
        numbers = [float(cell) for cell in new[3:]]
        assert [float(cell) for cell in old[3:]] == pytest.approx(numbers, rel=rel, abs=1e-9)


def test_the_shared_sets_are_up_to_date(script):
    """To the last digit, which may be the machine's; long irregular data have several minima."""
    header, _, *page = printed()
    assert header == list(script.COLUMNS)
    irregular = ("gps", "hiking")
    assert_same(
        page[:-2], script.shared_rows(), lambda name: 0.1 if name.startswith(irregular) else 0.006
    )


@pytest.mark.skipif(not LONG, reason="half a minute: in `make test-long`")
def test_the_walks_are_up_to_date(script):
    assert_same(printed()[-2:], script.walk_rows(), lambda _: 0.1)

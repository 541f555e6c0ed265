# SPDX-License-Identifier: MIT OR Apache-2.0

"""python/docs/faults.md names tests that are there."""

import ast
import re
from pathlib import Path

TESTS = Path(__file__).parent
RUST = [*TESTS.glob("rust/tests/*.rs"), *TESTS.parent.glob("crates/*/tests/*.rs"),
        *TESTS.parent.glob("crates/*/src/**/*.rs")]  # fmt: skip
PAGE = TESTS.parent / "python" / "docs" / "faults.md"


def assert_tests_exist(row):
    """Check that the tests that a row names are there, in Python or in Rust; return how many."""
    named = re.findall(r"`(\w+\.(?:py|rs))::(\w+)`", row)
    for file, test in named:
        if file.endswith(".rs"):
            texts = [path.read_text(encoding="utf-8") for path in RUST if path.name == file]
            assert any(f"fn {test}()" in text for text in texts), f"{file} has no {test}"
            continue
        tree = ast.parse((TESTS / file).read_text(encoding="utf-8"))
        functions = {f.name for f in ast.walk(tree) if isinstance(f, ast.FunctionDef)}
        assert test in functions, f"{file} has no {test}"
    return len(named)


def test_every_row_of_the_page_is_shown_by_tests():
    tried = PAGE.read_text(encoding="utf-8").partition("\n## Fuzzing")[0].splitlines()
    rows = [line for line in tried if line.startswith("| ") and not line.startswith("| fault")]
    assert len(rows) > 15
    for row in rows:
        assert assert_tests_exist(row), row


def test_every_known_fault_is_mended_or_said_to_be_open():
    page = PAGE.read_text(encoding="utf-8")
    section = page.partition("\n## Found by trying hard")[2].partition("\n## ")[0]
    rows = dict(re.findall(r"^\| ([CMIT]\d+) \|(.*)$", section, re.MULTILINE))
    known = {"C": 12, "M": 10, "I": 11, "T": 9}
    assert list(rows) == [f"{kind}{k}" for kind, n in known.items() for k in range(1, n + 1)]
    for name, row in rows.items():
        _, stands, _ = row.split("|")[:3]
        assert ("mended" in stands) or ("**open**" in stands), name
        assert bool(assert_tests_exist(row)) == ("mended" in stands), name


def test_every_fault_that_is_tried_is_on_the_page():
    page = PAGE.read_text(encoding="utf-8")
    tree = ast.parse((TESTS / "test_faults.py").read_text(encoding="utf-8"))
    tests = [f.name for f in tree.body if isinstance(f, ast.FunctionDef)]
    missing = [t for t in tests if t.startswith("test_") and f"test_faults.py::{t}`" not in page]
    assert missing == []

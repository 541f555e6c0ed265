"""python/docs/faults.md names tests that are there."""

import ast
import re
from pathlib import Path

TESTS = Path(__file__).parent
PAGE = TESTS.parent / "python" / "docs" / "faults.md"


def test_every_row_of_the_page_is_shown_by_tests():
    tried = PAGE.read_text(encoding="utf-8").partition("\n## Fuzzing")[0].splitlines()
    rows = [line for line in tried if line.startswith("| ") and not line.startswith("| fault")]
    assert len(rows) > 15
    for row in rows:
        named = re.findall(r"`(test_\w+\.py)::(test_\w+)`", row)
        assert named, row
        for file, test in named:
            tree = ast.parse((TESTS / file).read_text(encoding="utf-8"))
            functions = {f.name for f in ast.walk(tree) if isinstance(f, ast.FunctionDef)}
            assert test in functions, f"{file} has no {test}"


def test_every_fault_that_is_tried_is_on_the_page():
    page = PAGE.read_text(encoding="utf-8")
    tree = ast.parse((TESTS / "test_faults.py").read_text(encoding="utf-8"))
    tests = [f.name for f in tree.body if isinstance(f, ast.FunctionDef)]
    missing = [t for t in tests if t.startswith("test_") and f"test_faults.py::{t}`" not in page]
    assert missing == []

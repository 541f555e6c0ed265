# SPDX-License-Identifier: MIT OR Apache-2.0

"""The licences of the crates in the wheel come with it, and are those of Cargo.lock."""

from importlib.metadata import PackageNotFoundError, metadata
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


def test_every_linked_crate_has_its_licence_in_the_file(monkeypatch):
    if not (ROOT / ".ci").exists():
        pytest.skip("not in the tree")
    monkeypatch.syspath_prepend(str(ROOT / ".ci"))
    import notices

    written = notices.OUT.read_text(encoding="utf-8")
    assert written == notices.notices(), "run: python .ci/notices.py"
    linked = dict(notices.linked())
    # What is known to be linked in, under licences that ask for the notice.
    assert {"numpy", "pyo3", "mimalloc", "ndarray", "rayon"} <= set(linked)
    assert not any(name.startswith("shapespline") for name in linked)


def test_the_wheel_has_all_licences():
    try:
        found = metadata("shapespline").get_all("License-File")
    except PackageNotFoundError:
        pytest.skip("not installed")
    assert {"LICENSE-MIT", "LICENSE-APACHE", "THIRD-PARTY-LICENSES.txt"} <= set(found)

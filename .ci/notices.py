# SPDX-License-Identifier: MIT OR Apache-2.0

"""Write the licences of the crates that are compiled into the wheel: THIRD-PARTY-LICENSES.txt.

Of crates offered under several licences the MIT one is taken. Equal texts are written once.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).parent.parent
OUT = ROOT / "THIRD-PARTY-LICENSES.txt"
HEAD = """\
Licences of the crates that are compiled into the Python module shapespline.
Written by .ci/notices.py from Cargo.lock.
"""


def _cargo(*arguments: str) -> str:
    return subprocess.run(
        ["cargo", *arguments], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout


def linked() -> list[tuple[str, str]]:
    """Return name and version of every crate that is linked in, on any platform."""
    tree = _cargo(
        "tree", "--locked", "--package=shapespline-python", "--edges=normal,no-proc-macro",
        "--target=all", "--prefix=none", "--no-dedupe", "--format={p}",
    )  # fmt: skip
    rows = {tuple(line.split()[:2]) for line in tree.splitlines()}
    return sorted((name, v.removeprefix("v")) for name, v in rows if not _is_ours(name))


def _is_ours(name: str) -> bool:
    return name.split("-")[0] == "shapespline"


def _texts(folder: Path) -> list[str]:
    """Return the licence of a crate: MIT where it is offered, else all there are."""
    names = ("LICENSE", "LICENCE", "COPYING", "NOTICE", "UNLICENSE")
    found = sorted(p for p in folder.iterdir() if p.name.upper().startswith(names))
    mit = [p for p in found if "MIT" in p.name.upper()]
    others = [p for p in found if not any(w in p.name.upper() for w in ("APACHE", "ZLIB", "MIT"))]
    chosen = [*mit, *others] if mit else found
    return [p.read_text(encoding="utf-8").strip() for p in chosen]


def notices() -> str:
    """Return the text of the file."""
    metadata = json.loads(_cargo("metadata", "--locked", "--format-version=1"))
    packages = {(p["name"], p["version"]): p for p in metadata["packages"]}
    crates: dict[str, list[str]] = defaultdict(list)
    for key in linked():
        package = packages[key]
        texts = _texts(Path(package["manifest_path"]).parent)
        if not texts:
            raise SystemExit(f"{key[0]} {key[1]} ({package['license']}) has no licence text")
        for text in texts:
            crates[text].append(" ".join(key))
    line = "-" * 80
    parts = [f"{line}\n{', '.join(names)}\n{line}\n\n{text}\n" for text, names in crates.items()]
    return "\n".join([HEAD, *parts])


if __name__ == "__main__":
    OUT.write_text(notices(), encoding="utf-8")
    sys.stdout.write(f"{OUT.name}: {len(linked())} crates\n")

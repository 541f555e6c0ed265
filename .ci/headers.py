# SPDX-License-Identifier: MIT OR Apache-2.0

"""Name the licence in the first line of every source file that does not: python .ci/headers.py."""

import subprocess
from pathlib import Path

ROOT = Path(__file__).parent.parent
LICENCE = "SPDX-License-Identifier: MIT OR Apache-2.0"


def sources() -> list[Path]:
    """Return the source files that git knows or would add."""
    known = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    command = [*known, "*.rs", "*.py", "*.pyi"]
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    return [ROOT / name for name in done.stdout.splitlines() if (ROOT / name).is_file()]


def lacks(path: Path) -> bool:
    """Return whether a file does not begin with the name of the licence."""
    return not path.read_text(encoding="utf-8").partition("\n")[0].endswith(LICENCE)


if __name__ == "__main__":
    for path in filter(lacks, sources()):
        mark = "//" if path.suffix == ".rs" else "#"
        text = path.read_text(encoding="utf-8")
        path.write_text(f"{mark} {LICENCE}\n\n{text}", encoding="utf-8")
        print(path.relative_to(ROOT))

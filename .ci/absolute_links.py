# SPDX-License-Identifier: MIT OR Apache-2.0

"""Make the links of README.md absolute, in place: PyPI shows the page without the tree around it.

    python .ci/absolute_links.py README.md

In the tree they stay relative, so that they lead to the reader's own copy.
"""

import re
import sys
from pathlib import Path

PROJECT = "shapespline/shapespline"
PAGES = f"https://github.com/{PROJECT}/blob/main/"
PICTURES = f"https://raw.githubusercontent.com/{PROJECT}/main/"
#: An inline link or picture whose target has no scheme and is not a place on the page.
RELATIVE = re.compile(r"(!?)(\[[^\]]*\])\((?![a-z]+:|#|<)([^)]+)\)")


def absolute(text: str) -> str:
    """Return a page with absolute links."""

    def replaced(link: re.Match[str]) -> str:
        mark, name, target = link.groups()
        return f"{mark}{name}({PICTURES if mark else PAGES}{target})"

    return RELATIVE.sub(replaced, text)


if __name__ == "__main__":
    for path in map(Path, sys.argv[1:]):
        path.write_text(absolute(path.read_text(encoding="utf-8")), encoding="utf-8")

# SPDX-License-Identifier: MIT OR Apache-2.0

"""Print what `make` must install before it can build and test, one requirement a line.

    python .ci/requirements.py [--oldest] EXTRA …

pip can install a project's extras only together with the project, and building the extension is
maturin's task, later and in release mode. So the lists are read from pyproject.toml, where they
stand once: what the build needs, what the module needs, and the extras named as arguments.
With ``--oldest``, what users install beside the module has the oldest version that is promised to
do; the tools stay new.
"""

import re
import sys
from pathlib import Path

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10 has no parser of its own; pip carries one
    from pip._vendor import tomli as tomllib


def requirements(pyproject: dict, extras: list[str]) -> list[str]:
    """Return the requirements of the build, the module and the extras, each once.

    An extra may name others of this project (``shapespline[plot]``): they are followed.
    """
    project = pyproject["project"]
    own = re.compile(rf"{re.escape(project['name'])}\[([^\]]+)\]$")
    wanted = [*pyproject["build-system"]["requires"], *project["dependencies"]]
    waiting = list(extras)
    while waiting:
        for line in project["optional-dependencies"][waiting.pop(0)]:
            if nested := own.match(line.replace(" ", "")):
                waiting += nested.group(1).split(",")
            else:
                wanted.append(line)
    return list(dict.fromkeys(wanted))


def oldest(pyproject: dict, lines: list[str]) -> list[str]:
    """Return the lines with the lower bound of each dependency of users as its version."""
    extras = pyproject["project"]["optional-dependencies"]
    of_users = {*pyproject["project"]["dependencies"], *extras["scipy"], *extras["plot"]}
    of_users.update(extras["pandas"])
    return [f"{line.replace('>=', '==')}.*" if line in of_users else line for line in lines]


if __name__ == "__main__":
    path = Path(__file__).resolve().parent.parent / "pyproject.toml"
    project = tomllib.loads(path.read_text(encoding="utf-8"))
    asked = sys.argv[1:]
    lines = requirements(project, [name for name in asked if name != "--oldest"])
    print("\n".join(oldest(project, lines) if "--oldest" in asked else lines))

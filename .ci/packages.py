# SPDX-License-Identifier: MIT OR Apache-2.0

"""Build what is published, and try each part as a stranger would: alone, and nowhere near the tree.

    python .ci/packages.py [--python 3.10 …] [--pytest "-k published"] [--quick] [--built DIR]

The wheel (abi3: one for every CPython from 3.10 on) and the sdist are built once. For every
CPython that is found (on PATH, or under pyenv) a clean environment gets the wheel and what the
tests need, and the tests run against the installed module: the tree's ``python/`` is not on the
path, and the environment's own copy must be the one that is imported. The first of them gets the
sdist too, compiled by pip from the archive alone. Every crate is packaged by cargo and built from
its archive.

``--quick`` runs ``smoke.py`` instead of the whole test suite.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VERSIONS = ["3.10", "3.11", "3.12", "3.13", "3.14"]
# From a folder that is not the tree, and without the user's own packages and variables.
CLEAN = {"PYTHONNOUSERSITE": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}


def run(*command: str | Path, cwd: Path, **variables: str) -> None:
    """Run a command; its output is shown only when it fails."""
    environment = {k: v for k, v in os.environ.items() if k not in ("VIRTUAL_ENV", "PYTHONPATH")}
    done = subprocess.run(
        [str(part) for part in command],
        cwd=cwd,
        env=environment | CLEAN | variables,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}\nfailed with {done.returncode}")
    lines = done.stdout.strip().splitlines()
    print("    " + (lines[-1] if lines else "done"), flush=True)


def interpreters(wanted: list[str]) -> dict[str, Path]:
    """Return a CPython for each version that there is one of."""
    found = {}
    for version in wanted:
        pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
        of_pyenv = sorted(pyenv.glob(f"{version}.*/bin/python"))
        on_path = shutil.which(f"python{version}")
        if of_pyenv:
            found[version] = of_pyenv[-1]
        elif on_path:
            found[version] = Path(on_path)
        else:
            print(f"CPython {version}: not on this machine, left out")
    return found


def environment(python: Path, where: Path) -> Path:
    """Make a clean virtual environment; returns its interpreter."""
    run(python, "-m", "venv", where, cwd=ROOT)
    return where / "bin" / "python"


def try_python(python: Path, package: Path, folder: Path, options: argparse.Namespace) -> None:
    """Install a package into an environment of its own and run the tests against it."""
    own = environment(python, folder / "venv")
    extra = "" if options.quick else "[test]"
    run(own, "-m", "pip", "install", "--quiet", f"{package}{extra}", cwd=folder)
    run(own, ROOT / ".ci" / "smoke.py", "--installed", cwd=folder)
    if options.quick:
        return
    # The tests, and the pages that they read; the module's sources stay behind.
    left = shutil.ignore_patterns("fuzz", "rust", "shapespline", "__pycache__")
    for part in ("tests", "python"):
        shutil.copytree(ROOT / part, folder / part, ignore=left)
    for file in ("pyproject.toml", "README.md"):
        shutil.copy(ROOT / file, folder)
    # README's links lead to sources, which stay behind.
    links = ["--deselect", "tests/test_pages.py::test_links_and_pictures_exist"]
    command = [own, "-m", "pytest", "-q", "-p", "no:cacheprovider", *links]
    command += options.pytest.split()
    run(*command, cwd=folder, PATH=f"{own.parent}{os.pathsep}{os.environ['PATH']}")


def build(folder: Path) -> Path:
    """Build wheel and sdist; returns where they are."""
    print("wheel and sdist", flush=True)
    maturin = environment(Path(sys.executable), folder / "build")
    run(maturin, "-m", "pip", "install", "--quiet", "maturin>=1.16,<2", cwd=ROOT)
    built = folder / "dist"
    run(maturin, "-m", "maturin", "build", "--release", "--out", built, cwd=ROOT)
    run(maturin, "-m", "maturin", "sdist", "--out", built, cwd=ROOT)
    return built


def crates() -> None:
    """Package every crate that is published, and build each from its archive."""
    print("cargo package")
    private = ["--exclude", "shapespline-python", "--exclude", "shapespline-tests"]
    # All at once: cargo then builds each from its archive, beside the archives it depends on.
    run("cargo", "package", "--workspace", *private, "--allow-dirty", cwd=ROOT)


def main() -> None:
    """Build, then try everything."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--python", action="append", help="a version; all of them by default")
    parser.add_argument("--pytest", default="", help="further arguments for pytest")
    parser.add_argument("--quick", action="store_true", help="import and fit only")
    parser.add_argument("--built", type=Path, help="a folder with wheel and sdist, built before")
    parser.add_argument("--no-crates", action="store_true", help="leave cargo's packages out")
    options = parser.parse_args()
    pythons = interpreters(options.python or VERSIONS)
    if not pythons:
        sys.exit("no CPython of these versions is on this machine")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        built = options.built.resolve() if options.built else build(folder)
        (wheel,) = built.glob("*.whl")
        (sdist,) = built.glob("*.tar.gz")
        for package in (wheel, sdist):
            print(f"    {package.name}: {package.stat().st_size / 1e6:.1f} MB")
        assert "-abi3-" in wheel.name, wheel
        first = next(iter(pythons))
        for version, python in pythons.items():
            for package in (wheel, sdist) if version == first else (wheel,):
                start = time.perf_counter()
                print(f"CPython {version}, {package.name}", flush=True)
                own = folder / f"{version}-{package.suffix.lstrip('.')}"
                own.mkdir()
                try_python(python, package, own, options)
                print(f"    {time.perf_counter() - start:.0f} s", flush=True)
    if not options.no_crates:
        crates()


if __name__ == "__main__":
    main()

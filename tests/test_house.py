# SPDX-License-Identifier: MIT OR Apache-2.0

"""What belongs to the project as a whole: its places, its licences, what each crate shows, CI."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    from pip._vendor import tomli as tomllib

ROOT = Path(__file__).parent.parent
if not (ROOT / "crates").exists():
    pytest.skip("not in the tree", allow_module_level=True)

LICENCES = ("LICENSE-APACHE", "LICENSE-MIT")
TOP = {
    *("CHANGELOG.md", "CITATION.cff", "CONTRIBUTING.md", "README.md"),
    *("Cargo.lock", "Cargo.toml", "Makefile", "pyproject.toml"),
    *(*LICENCES, "THIRD-PARTY-LICENSES.txt"),
    *("crates", "python", "tests"),
}


def read(*parts):
    return ROOT.joinpath(*parts).read_text(encoding="utf-8")


def toml(*parts):
    return tomllib.loads(read(*parts))


MANIFESTS = {p.parent.name: toml(p) for p in ROOT.glob("crates/*/Cargo.toml")}
PUBLISHED = sorted(n for n, m in MANIFESTS.items() if m["package"].get("publish", True))
WORKSPACE = toml("Cargo.toml")["workspace"]


def tracked(*patterns):
    if not (ROOT / ".git").exists():
        pytest.skip("not a clone")
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", *patterns]
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    return [name for name in done.stdout.splitlines() if (ROOT / name).exists()]


def dependencies(manifest, *tables):
    """Names of the dependencies of a crate, those of single platforms included."""
    places = [manifest, *manifest.get("target", {}).values()]
    return {name for place in places for table in tables for name in place.get(table, {})}


# Places and licences


def test_the_visible_top_level_is_the_agreed_one():
    names = {name.split("/")[0] for name in tracked()}
    assert {name for name in names if not name.startswith(".")} == TOP


def test_every_source_file_names_the_licence(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / ".ci"))
    import headers

    tracked()
    files = headers.sources()
    assert len(files) > 400
    assert [path for path in files if headers.lacks(path)] == [], "run: python .ci/headers.py"


def test_found_counterexamples_of_proptest_are_not_ignored():
    tracked()
    for place in ("crates/shapespline-nu", "tests/rust"):
        path = f"{place}/proptest-regressions/system.txt"
        assert subprocess.run(["git", "check-ignore", path], cwd=ROOT, check=False).returncode == 1


def test_the_citation_has_the_version_and_all_sources():
    citation = yaml.safe_load(read("CITATION.cff"))
    assert citation["version"] == WORKSPACE["package"]["version"]
    assert " OR ".join(citation["license"]) == WORKSPACE["package"]["license"]
    readme = re.sub(r"\s+", " ", read("README.md"))
    assert len(citation["references"]) == 5
    for source in citation["references"]:
        assert source["title"] in readme
        assert source.get("doi", "") in readme
        assert all(author["family-names"] in readme for author in source["authors"])


# Crates


@pytest.mark.parametrize("crate", PUBLISHED)
def test_every_crate_carries_its_licences_and_shows_all_features(crate):
    for name in () if sys.platform == "win32" else LICENCES:  # links, where git makes them
        assert (ROOT / "crates" / crate / name).read_bytes() == (ROOT / name).read_bytes()
    package = MANIFESTS[crate]["package"]
    assert package["metadata"]["docs"]["rs"] == {"all-features": True}
    assert 20 < len(package["description"]) < 130
    assert len(package["keywords"]) == 5
    assert package["readme"] == "README.md"


def examples(text):
    return re.findall(r"^```rust\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("crate", PUBLISHED)
def test_the_readme_is_a_program_that_needs_its_crate_alone(crate):
    """That it compiles and runs is cargo's test: every lib.rs includes the README."""
    found = examples(read("crates", crate, "README.md"))
    assert found
    for example in found:
        assert "fn main() -> Result<(), " in example
        roots = set(re.findall(r"\b(\w+)::", example)) & {n.replace("-", "_") for n in MANIFESTS}
        used = set(re.findall(r"^use (\w+)", example, re.MULTILINE))
        assert roots | used <= {crate.replace("-", "_"), "std"}


@pytest.mark.parametrize("crate", PUBLISHED)
def test_every_crate_opens_with_an_example(crate):
    lib = read("crates", crate, "src", "lib.rs")
    readme = '#[doc = include_str!("../README.md")]'
    opening = re.split(r"^(?:pub )?(?:mod|use) ", lib, maxsplit=1, flags=re.MULTILINE)[0]
    assert "\n//! ```\n" in opening or readme.replace("#", "#!") in opening
    assert readme in lib.replace("#!", "#")


def test_the_facade_documents_its_modules_itself():
    """Links to a crate that is documented later, or elsewhere, are dead."""
    lib = read("crates", "shapespline", "src", "lib.rs")
    modules = re.findall(r"^(.*)\npub use (shapespline_\w+) as \w+;$", lib, re.MULTILINE)
    below = dependencies(MANIFESTS["shapespline"], "dependencies")
    assert {crate for _, crate in modules} == {name.replace("-", "_") for name in below}
    assert {before for before, _ in modules} == {"#[doc(inline)]"}


def test_what_is_declared_is_used():
    members = [*MANIFESTS, "../tests/rust"]
    everywhere = set()
    for member in members:
        folder = ROOT / "crates" / member
        manifest = toml(folder, "Cargo.toml")
        text = "".join(read(p) for p in folder.rglob("*.rs") if "target" not in p.parts)
        named = dependencies(manifest, "dependencies", "dev-dependencies")
        everywhere |= named
        unused = [n for n in named if not re.search(rf"\b{n.replace('-', '_')}\b", text)]
        assert unused == [], member
    assert everywhere == set(WORKSPACE["dependencies"]) - {"shapespline-tests"}


def test_the_makefile_names_the_published_crates_from_below():
    line = re.compile(r"^CRATES := .*shapespline-,(.*)\) (\w+)$", re.MULTILINE)
    short, last = line.search(read("Makefile")).groups()
    crates = [*(f"shapespline-{name}" for name in short.split()), last]
    assert sorted(crates) == PUBLISHED
    for k, crate in enumerate(crates):
        below = dependencies(MANIFESTS[crate], "dependencies") & set(PUBLISHED)
        assert below <= set(crates[:k])


def test_the_fuzzers_lock_file_knows_what_they_reach():
    """They are a workspace of their own (nightly), which no other command brings up to date."""
    locked = {
        package["name"]: package for package in toml("tests", "fuzz", "Cargo.lock")["package"]
    }
    reached = dependencies(toml("tests", "rust", "Cargo.toml"), "dependencies")
    assert reached <= {d.split()[0] for d in locked["shapespline-tests"]["dependencies"]}
    for crate in PUBLISHED:
        needed = {d for d in dependencies(MANIFESTS[crate], "dependencies") if d in MANIFESTS}
        assert needed <= {d.split()[0] for d in locked[crate]["dependencies"]}, crate


# CI


def workflows():
    files = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
    assert [path.stem for path in files] == ["ci", "release", "wheels"]
    return {path.stem: yaml.safe_load(read(path)) for path in files}


def test_every_action_is_pinned_and_every_path_exists():
    for name, workflow in workflows().items():
        assert workflow["permissions"] == {"contents": "read"}, name
        for job in workflow["jobs"].values():
            for step in [job, *job.get("steps", [])]:
                uses, run = step.get("uses"), step.get("run", "")
                if uses and uses.startswith("./"):
                    assert (ROOT / uses).exists()
                elif uses:
                    assert re.fullmatch(r"[\w.-]+/[\w.-]+@[0-9a-f]{40}", uses)
                paths = re.findall(r"(?:\.ci|tests|crates|python)/[\w./-]+", run)
                assert all((ROOT / path).exists() for path in paths)


def test_a_release_waits_for_the_tests_and_needs_no_secret():
    jobs = workflows()["release"]["jobs"]
    for publisher in ("pypi", "crates"):
        assert jobs[publisher]["needs"] == ["ci", "wheels"]
        assert jobs[publisher]["permissions"]["id-token"] == "write"
        assert "environment" in jobs[publisher]
    assert "secrets." not in read(".github", "workflows", "release.yml")


def test_the_other_files_of_github_and_the_hidden_settings_can_be_read():
    files = [*ROOT.glob(".github/*.yml"), *ROOT.glob(".github/ISSUE_TEMPLATE/*.yml")]
    assert len(files) == 4
    assert all(yaml.safe_load(read(path)) for path in files)
    assert all(toml(name) for name in (".deny.toml", ".clippy.toml", ".rustfmt.toml"))


def test_the_oldest_requirements_are_the_lower_bounds(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / ".ci"))
    import requirements

    pyproject = toml("pyproject.toml")
    lines = requirements.requirements(pyproject, ["test"])
    oldest = requirements.oldest(pyproject, lines)
    changed = {old: new for old, new in zip(lines, oldest, strict=True) if old != new}
    assert {line.split(">=")[0] for line in changed} == {"numpy", "scipy", "matplotlib", "pandas"}
    assert all(new == old.replace(">=", "==") + ".*" for old, new in changed.items())


def test_links_become_absolute_for_package_pages(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / ".ci"))
    import absolute_links

    text = read("README.md")
    before = re.findall(r"\]\(([^)]*)\)", text)
    after = re.findall(r"\]\(([^)]*)\)", absolute_links.absolute(text))
    relative = [b for b in before if not b.startswith(("http", "<http", "#"))]
    assert len(relative) > 10
    for old, new in zip(before, after, strict=True):
        assert new.endswith(old)
        assert new.startswith(("https://", "<https://"))
    assert absolute_links.absolute("[a](#b) [c](https://d) ![e](f/g.png)").endswith("main/f/g.png)")


def test_the_smoke_test_of_packages_passes():
    command = [sys.executable, ROOT / ".ci" / "smoke.py"]
    assert subprocess.run(command, check=True, capture_output=True).stdout.startswith(
        b"shapespline"
    )


def test_every_test_file_is_explained():
    folder = ROOT / "tests"
    python = {path.name for path in folder.glob("*.py")} - {"conftest.py"}
    rust = {f"rust/tests/{path.name}" for path in (folder / "rust" / "tests").glob("*.rs")}
    named = set(re.findall(r"`((?:rust/tests/)?\w+\.(?:py|rs))`", read("tests/README.md")))
    assert named == python | rust

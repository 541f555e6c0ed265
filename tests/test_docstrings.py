# SPDX-License-Identifier: MIT OR Apache-2.0

"""Every public object is documented, and every example in its documentation is true."""

import doctest
import inspect
from pathlib import Path

import numpy as np
import pytest

import shapespline as ss

ROOT = Path(__file__).parent.parent
FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


def members(cls):
    """Yield a class's own public methods and attributes: written in Python or in Rust alike.

    By name: what is written in Rust stands in another order in every process.
    """
    for name, value in sorted(vars(cls).items()):
        is_public = not name.startswith("_") or name == "__call__"
        is_method = inspect.isroutine(value) or isinstance(value, (classmethod, staticmethod))
        if is_public and (is_method or inspect.isdatadescriptor(value)):
            yield name, getattr(cls, name)


def public():
    """Return name → object for all that a user can reach from the module."""
    found = {}
    for name in ss.__all__:
        value = getattr(ss, name)
        found[name] = value
        if inspect.isclass(value):
            found |= {f"{name}.{key}": member for key, member in members(value)}
        if inspect.ismodule(value):
            found |= {f"{name}.{key}": getattr(value, key) for key in value.__all__}
    # Constants, such as the colours of figures, have no docstring of their own.
    return {name: value for name, value in found.items() if documents(value)}


def documents(value):
    """Whether an object carries a docstring of its own: strings and numbers do not."""
    return not isinstance(value, (str, int, float))


PUBLIC = public()
CALLABLE = [n for n, v in PUBLIC.items() if inspect.isclass(v) or inspect.isroutine(v)]


def examples(name):
    """Return the doctest of an object, or ``None`` when its docstring has no example."""
    text = inspect.getdoc(PUBLIC[name]) or ""
    names = {"ss": ss, "np": np}
    test = doctest.DocTestParser().get_doctest(text, names, name, None, None)
    return test if test.examples else None


def test_the_module_offers_what_it_should():
    assert {"NuSpline", "Tangents", "ShapeReport", "ConvergenceError"} <= set(PUBLIC)
    assert {"NuSpline.shape_preserving", "SpaceCurve.check", "SpaceCurve.frame"} <= set(PUBLIC)
    assert {"plot.curve", "plot.curvature_comb", "plot.interpolant"} <= set(PUBLIC)
    assert issubclass(ss.NuSpline, ss.SpaceCurve)
    assert ss.__doc__


def test_the_stub_carries_the_docstrings_of_the_extension(monkeypatch):
    if not (ROOT / ".ci").exists():
        pytest.skip("not in the tree")
    monkeypatch.syspath_prepend(str(ROOT / ".ci"))
    import stub

    text = stub.STUB.read_text(encoding="utf-8")
    assert stub.documented(text) == text, "run: python .ci/stub.py"
    assert text.count(">>> ") > 200  # examples


@pytest.mark.parametrize("name", PUBLIC)
def test_documented(name):
    assert len((inspect.getdoc(PUBLIC[name]) or "").strip()) > 20


@pytest.mark.parametrize("name", CALLABLE)
def test_public_calls_name_their_arguments(name):
    """A signature that help() and editors can show, not (*args, **kwargs)."""
    kinds = {p.kind for p in inspect.signature(PUBLIC[name]).parameters.values()}
    if not (inspect.isclass(PUBLIC[name]) and issubclass(PUBLIC[name], Exception)):
        assert not kinds & {inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD}


@pytest.mark.parametrize(
    "name", [n for n in CALLABLE if "." not in n or n.startswith(("plot.", "interchange."))]
)
def test_public_classes_and_functions_show_an_example(name):
    assert examples(name) is not None


@pytest.mark.parametrize("name", [n for n in PUBLIC if examples(n)])
def test_examples(name):
    output = []
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    runner.run(examples(name), out=output.append)
    assert runner.summarize(verbose=False).failed == 0, "".join(output)

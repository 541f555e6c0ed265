# SPDX-License-Identifier: MIT OR Apache-2.0

"""Pickles of every class: whole ones come back, damaged ones are refused by name."""

import pickle

import numpy as np
import pytest

import shapespline as ss
import things

every_class = pytest.mark.parametrize(
    "thing", things.everything(), ids=lambda thing: type(thing).__name__
)


def sealed(thing):
    """Return what makes the object again, and the bytes it takes, with what stands beside them."""
    make, arguments = thing.__reduce__()
    at = next(i for i, part in enumerate(arguments) if isinstance(part, bytes))
    return lambda data: make(*arguments[:at], data, *arguments[at + 1 :]), arguments[at]


def public(thing):
    """Return all that an object says of itself."""
    found = {"text": str(thing)}
    for name in dir(type(thing)):
        if name.startswith("_"):
            continue
        value = getattr(thing, name, None)  # a FairSpline has no tension
        if isinstance(value, (int, float, str, tuple, list, np.ndarray)):
            found[name] = repr(value)
    return found


def test_the_list_is_complete():
    """A class that is added to the module has to be added to the list."""
    classes = {type(thing) for thing in things.everything()}
    public = {value for value in vars(ss).values() if isinstance(value, type)}
    bases = {ss.SpaceCurve, ss.MonotoneSpline}
    errors = {value for value in public if issubclass(value, Exception)}
    assert public - bases - errors - classes == set()


@every_class
@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_every_object_comes_back(thing, protocol):
    again = pickle.loads(pickle.dumps(thing, protocol))
    assert type(again) is type(thing)
    assert public(again) == public(thing)


@every_class
def test_every_changed_byte_is_refused(thing):
    make, whole = sealed(thing)
    random = np.random.default_rng(3)
    places = range(len(whole)) if len(whole) < 600 else random.integers(len(whole), size=600)
    for at in places:
        damaged = bytearray(whole)
        damaged[at] ^= 1 << random.integers(8)
        with pytest.raises(ss.InputError, match="pickle") as caught:
            make(bytes(damaged))
        assert caught.value.argument == "data"


@every_class
def test_a_pickle_cut_short_or_lengthened_is_refused(thing):
    make, whole = sealed(thing)
    for size in {*range(7), *range(0, len(whole), 1 + len(whole) // 100), len(whole) - 1}:
        with pytest.raises(ss.InputError, match="pickle"):
            make(whole[:size])
    for more in (b"\0", b"\0" * 4, whole):
        with pytest.raises(ss.InputError, match="pickle"):
            make(whole + more)


def test_a_function_that_falls_does_not_come_out_of_a_damaged_pickle():
    """Found in review: certified, of changed slopes."""
    make, whole = sealed(ss.MonotoneQuintic([0, 1, 2, 5], [0, 0.1, 3, 3.2]))
    falling = np.float64(-1.0).tobytes()
    for at in range(2, len(whole) - len(falling)):
        damaged = whole[:at] + falling + whole[at + len(falling) :]
        if damaged != whole:
            with pytest.raises(ss.InputError, match="function is damaged"):
                make(damaged)


def test_a_pickle_of_another_version_is_named():
    make, whole = sealed(ss.NuSpline([[0, 0], [1, 1]]))
    with pytest.raises(ss.InputError, match="curve is of version 2, this shapespline reads"):
        make(whole[:1] + b"\2" + whole[2:])

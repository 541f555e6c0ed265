# SPDX-License-Identifier: MIT OR Apache-2.0

"""Arrays that come in: masked values, dates, objects, errors on the way, changes meanwhile."""

import datetime as dt
import pickle
import re
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pandas as pd
import pytest

import shapespline as ss
from arguments import ARGUMENTS, CURVES, POINTS, U
from scale import scaled
from test_processes import script

every_argument = pytest.mark.parametrize("argument", ARGUMENTS, ids=str)


def same(a, b):
    assert pickle.dumps(a) == pickle.dumps(b)


def nested(array, leaf):
    """Return the array as lists of lists, down to rows that ``leaf`` makes."""
    return leaf(array) if array.ndim < 2 else [nested(row, leaf) for row in array]


# Masked arrays


@every_argument
def test_masked_values_are_refused(argument):
    index = tuple(length - 1 for length in argument.good.shape)
    masked = np.ma.array(argument.good, mask=False)
    masked[index] = np.ma.masked
    place = f"{argument.name} is masked at [{', '.join(map(str, index))}]; fill or drop it first"
    for given in (masked, nested(masked, lambda row: row), tuple(nested(masked, list))):
        with pytest.raises(ss.InputError, match=re.escape(place)) as caught:
            argument.work(given)
        assert caught.value.argument == argument.name
        assert caught.value.index == (index if len(index) > 1 else index[0])


@every_argument
def test_masks_that_mask_nothing_are_no_fault(argument):
    for mask in (False, np.zeros(argument.good.shape, dtype=bool)):
        same(argument.work(np.ma.array(argument.good, mask=mask)), argument.work(argument.good))


@pytest.mark.parametrize("call", [CURVES["NuSpline"], CURVES["NuSpline"].curvature])
def test_a_masked_scalar_is_refused(call):
    with pytest.raises(ss.InputError, match=r"u is masked; fill"):
        call(np.ma.masked)


# Objects


@every_argument
@pytest.mark.parametrize("number", [Decimal, Fraction, float], ids=lambda n: n.__name__)
def test_objects_that_numpy_turns_into_floats_are_taken(argument, number):
    objects = np.vectorize(lambda x: number(float(x)), otypes=[object])(argument.good)
    expected = argument.work(argument.good)
    same(argument.work(objects), expected)
    same(argument.work(objects.tolist()), expected)
    if objects.ndim < 3:
        frame = (pd.Series if objects.ndim == 1 else pd.DataFrame)(objects, dtype=object)
        same(argument.work(frame), expected)


@every_argument
@pytest.mark.parametrize("bad", ["1.5", b"2", 1j, np.complex128(1), [1.0], pd.NA, object()],
                         ids=lambda bad: type(bad).__name__)  # fmt: skip
def test_objects_that_are_no_real_numbers_are_named(argument, bad):
    objects = argument.good.astype(object)
    index = tuple(length - 1 for length in argument.good.shape)
    objects[index] = bad
    place = f"{argument.name}[{', '.join(map(str, index))}] must be a real number, got "
    with pytest.raises(TypeError, match=re.escape(place + type(bad).__name__)):
        argument.work(objects)


@every_argument
def test_an_integer_beyond_floats_is_named(argument):
    objects = argument.good.astype(object)
    objects.flat[0] = 10**400
    index = ", ".join("0" * objects.ndim)
    text = re.escape(f"{argument.name}[{index}] is too large for a float")
    with pytest.raises(ss.InputError, match=text):
        argument.work(objects)


def test_a_list_that_holds_itself_is_refused():
    loop = []
    loop.append(loop)
    with pytest.raises((TypeError, ValueError), match="points"):
        ss.NuSpline(loop)


# Dates

DATES = pd.to_datetime(["2020-01-01", "2020-01-02", "2020-01-05", "2020-01-09", "2020-01-10"])


@pytest.mark.parametrize("unit", ["ns", "us", "ms", "s", "m", "h", "D", "W"])
@pytest.mark.parametrize("kind", ["datetime64", "timedelta64"])
def test_the_remedy_for_dates_is_one(kind, unit):
    times = DATES.to_numpy() if kind == "datetime64" else DATES.to_numpy() - DATES.to_numpy()[0]
    x = times.astype(f"{kind}[{unit}]")
    expected = times.astype(f"{kind}[{unit}]").astype(f"{kind}[s]").astype(float)
    for given in (x, list(x)):
        with pytest.raises(TypeError, match="pass seconds: ") as caught:
            ss.MonotoneQuintic(given, U)
        remedy = str(caught.value).partition("pass seconds: ")[2]
        np.testing.assert_array_equal(eval(remedy, {"np": np, "x": given}), expected)


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns"])
def test_the_remedy_for_dates_of_pandas_is_one(unit):
    for x in (DATES.as_unit(unit), pd.Series(DATES.as_unit(unit))):
        with pytest.raises(TypeError, match=f"x must hold .* got datetime64.{unit}") as caught:
            ss.MonotoneQuartic(x, U)
        remedy = str(caught.value).partition("pass seconds: ")[2]
        assert eval(remedy, {"x": x})[1] == pd.Timestamp("2020-01-02").timestamp()


@pytest.mark.parametrize(
    ("times", "remedy"),
    [
        ([dt.datetime(2020, 1, 1, tzinfo=dt.timezone.utc)] * 5, "[t.timestamp() for t in x]"),
        (DATES.tz_localize("UTC"), "[t.timestamp() for t in x]"),
        ([dt.timedelta(days=1)] * 5, "[t.total_seconds() for t in x]"),
        ([dt.date(2020, 1, 1)] * 5, "[t.toordinal() for t in x]"),
    ],
    ids=["datetime", "with a zone", "timedelta", "date"],
)
def test_the_remedy_for_objects_that_are_dates(times, remedy):
    with pytest.raises(TypeError, match=re.escape("x[0] must be a real number")) as caught:
        ss.MonotoneQuintic(times, U)
    assert str(caught.value).endswith("; pass " + remedy)
    assert len(eval(remedy, {"x": times})) == 5


@every_argument
def test_dates_are_refused_with_a_remedy_everywhere(argument):
    with pytest.raises(TypeError, match=re.escape(argument.name) + ".*pass seconds: "):
        argument.work(np.zeros(argument.good.shape, dtype="datetime64[us]"))


# Errors on the way


class Computed:
    """An array that is computed when it is asked for, as those of dask or h5py are."""

    def __init__(self, error):
        self.error = error

    def __array__(self, dtype=None, copy=None):
        raise self.error

    def __float__(self):
        raise self.error

    __len__ = __index__ = __bool__ = __float__


@every_argument
@pytest.mark.parametrize("error", [KeyboardInterrupt(), MemoryError(), ZeroDivisionError()],
                         ids=lambda error: type(error).__name__)  # fmt: skip
def test_an_error_that_is_not_about_the_value_passes(argument, error):
    with pytest.raises(type(error)):
        argument.work(Computed(error))


@pytest.mark.parametrize("error", [ValueError("no file"), TypeError("no file")],
                         ids=lambda error: type(error).__name__)  # fmt: skip
@pytest.mark.parametrize("argument", [a for a in ARGUMENTS if a.name != "control"], ids=str)
def test_an_error_about_the_value_is_the_cause(argument, error):
    with pytest.raises(ValueError, match=re.escape(argument.name) + ".*no file") as caught:
        argument.work(Computed(error))
    assert caught.value.__cause__ is error


NU = ss.NuSpline
SCALARS = {
    "tolerance": lambda v: NU.shape_preserving(POINTS, tolerance=v),
    "coplanarity": lambda v: CURVES["NuSpline"].check(coplanarity=v),
    "step": lambda v: NU.shape_preserving(POINTS, step=v),
    "max_iterations": lambda v: NU.shape_preserving(POINTS, max_iterations=v),
    "safety": lambda v: ss.CatmullRom.shape_preserving(POINTS, safety=v),
    "threads": lambda v: ss.fit_many(POINTS, [0, 5], threads=v),
    "nu": lambda v: CURVES["NuSpline"](0.5, v),
    "n": lambda v: CURVES["NuSpline"].sample(v),
    "a": lambda v: CURVES["NuSpline"].arc_length(v),
    "axis": lambda v: ss.MonotoneQuintic(U, U, v),
    "shape": lambda v: ss.MonotoneQuartic(U, U, shape=v),
    "y": lambda v: ss.MonotoneQuintic(U, U).solve(v),
    "degree": lambda v: ss.bezier_like(v, POINTS[:4], 0.5),
    "row": lambda v: ss.fit_many_monotone([U], [U])[v],
    "criteria": lambda v: CURVES["NuSpline"].check(v),
}


@pytest.mark.parametrize("name", SCALARS)
@pytest.mark.parametrize("error", [KeyboardInterrupt(), ZeroDivisionError()],
                         ids=lambda error: type(error).__name__)  # fmt: skip
def test_an_error_of_a_number_passes(name, error):
    class Names(Computed):
        __iter__ = Computed.__float__

    with pytest.raises(type(error)):
        SCALARS[name](Names(error))


@pytest.mark.parametrize("name", [name for name in SCALARS if name not in ("criteria", "row")])
def test_an_error_about_a_number_is_the_cause(name):
    error = TypeError("no number")
    with pytest.raises((TypeError, ValueError), match=name) as caught:
        SCALARS[name](Computed(error))
    assert caught.value.__cause__ is error


# Changes meanwhile

CHANGES = """
import sys, threading, warnings
import numpy as np
import shapespline as ss

warnings.simplefilter("ignore")  # NumPy 2.4 would have strides left alone
n = 60_000
t = np.linspace(0, 400, n)
points = np.column_stack([np.cos(t), np.sin(t), t / 10])
families = (ss.NuSpline, ss.TensionSpline, ss.CatmullRom, ss.FairSpline)
curves = [family(points, t) for family in families]
f, rows = ss.MonotoneQuintic(t, t), ss.fit_many_monotone([t[:9]] * 2, [t[:9]] * 2)
pieces = ss.PiecewiseBezier(curves[0].bezier, t)
offsets = np.arange(0, n + 1, 100)
calls = [
    *(lambda a, c=c: c(a) for c in curves),
    lambda a: curves[0].curvature(a),
    lambda a: curves[0].frame(a),
    lambda a: curves[1].image_parameter(a),
    lambda a: pieces(a),
    lambda a: ss.NuSpline(points, a),
    lambda a: ss.NuSpline(points, tension=a),
    lambda a: ss.TensionSpline(points, tangent_scale=1 / (1 + a)),
    lambda a: ss.MonotoneQuartic(a, t),
    lambda a: ss.MonotoneQuartic(t, a),
    lambda a: ss.MonotoneQuintic(t, a, slopes="fritsch-butland"),
    lambda a: f(a),
    lambda a: f.inverse(a),
    lambda a: rows(a),
    lambda a: ss.fit_many_monotone(a.reshape(-1, 100), t.reshape(-1, 100)),
    lambda a: ss.fit_many(points, offsets, method="catmull-rom", parameters=a),
    lambda a: ss.fit_many(np.stack([a, a * a], 1), offsets, method="catmull-rom"),
    lambda a: ss.NuSpline(np.stack([a, a * a], 1)),
]

class Later(int):
    '''An argument that changes another one while it is converted.'''
    def __new__(cls, change):
        self = super().__new__(cls, 0)
        self.change = change
        return self
    def __index__(self):
        self.change()
        return 0

def set_(array, name, value):
    try:
        setattr(array, name, value)
    except (AttributeError, TypeError, ValueError):
        pass

for name, value in (("strides", (0,)), ("dtype", np.int8), ("shape", (n // 2, 2))):
    for call in (lambda a, later: curves[0](a, later), lambda a, later: f(a, later)):
        a = t.copy()
        class Lazy:
            def __index__(self):
                set_(a, name, value)
                return 0
        call(a, Lazy())

random = np.random.default_rng(int(sys.argv[1]))
for call in calls:
    a = t.copy()
    stop = threading.Event()
    def change():
        while not stop.is_set():
            for name, value in (("shape", (n // 2, 2)), ("shape", (n,)), ("dtype", np.int8),
                                ("dtype", np.float64), ("strides", (0,)), ("strides", (8,))):
                set_(a, name, value)
    thread = threading.Thread(target=change)
    thread.start()
    try:
        for _ in range(int(sys.argv[2])):
            try:
                call(a)
            except (TypeError, ValueError):
                pass
    finally:
        stop.set()
        thread.join()
print("alive")
"""


def test_arrays_that_change_during_a_call_give_an_answer_or_an_error():
    done = script(CHANGES, 1, scaled(80), timeout=600)
    assert (done.returncode, done.stdout) == (0, "alive\n"), done.stderr[-2000:]

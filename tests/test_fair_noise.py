# SPDX-License-Identifier: MIT OR Apache-2.0

"""Fair curves on smooth data with noise: no spikes, with or without a resolution."""

import numpy as np
import pytest

import shapespline as ss
from scale import scaled


def airfoil(code, count):
    """Return a NACA four-digit airfoil from the trailing edge around the nose and back."""
    camber, place, thick = int(code[0]) / 100, int(code[1]) / 10, int(code[2:]) / 100
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, count)))
    half = (
        5 * thick * (0.2969 * np.sqrt(x) + x * (-0.126 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))))
    )
    line = np.zeros_like(x)
    if camber:
        front = camber / place**2 * (2 * place * x - x**2)
        back = camber / (1 - place) ** 2 * (1 - 2 * place + 2 * place * x - x**2)
        line = np.where(x < place, front, back)
    upper, lower = np.column_stack([x, line + half]), np.column_stack([x, line - half])
    return np.vstack([upper[::-1], lower[1:]])


def smooth_curves():
    t = np.linspace(0, 2 * np.pi, 60)
    curves = {
        "helix": np.column_stack([np.cos(2 * t), np.sin(2 * t), 0.3 * t]),
        "Lissajous": np.column_stack([np.cos(t), np.sin(2 * t)]),
        "arc": np.column_stack([np.cos(t / 2), np.sin(t / 2)]),
        "trefoil": np.column_stack(
            [np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)]
        ),
    }
    for height in (1e-2, 1e-4, 1e-6, 1e-8):
        x = np.arange(30.0)
        curves[f"nearly straight, {height:g}"] = np.column_stack([x, height * np.sin(0.3 * x)])
    for code in ("0006", "0012", "2408", "2412", "4412", "4424", "6409"):
        for count in (20, 41, 70):
            curves[f"NACA {code}, {count}"] = airfoil(code, count)
    return curves


CURVES = smooth_curves()


@pytest.mark.parametrize("name", CURVES)
def test_noise_makes_no_spikes(name, rng):
    """Largest curvature at most three times the plain cubic's where the noise is known.

    Where it is not, nearly always ten times (of 3,900 fits one had 14), and one fit in some
    hundreds leaves a sign undecided.
    """
    undecided, fits = 0, 0
    points = CURVES[name]
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1).mean()
    for noise in (0.0, 1e-6, 1e-4, 1e-2):
        for _ in range(scaled(10) if noise else 1):
            given = points + noise * chord * rng.uniform(-1, 1, points.shape)
            cubic = ss.NuSpline(given).fairness().max_curvature
            known = np.sqrt(3) * noise * chord
            for resolution, most in ((0.0, 20.0), (known, 3.0 if noise else 20.0)):
                curve = ss.fit(given, resolution=resolution)
                report = curve.check()
                assert not report.violations
                undecided, fits = undecided + bool(report.undecided), fits + 1
                assert not (resolution and report.undecided)
                assert curve.fairness().max_curvature <= most * cubic, (noise, resolution)
    assert undecided <= fits // 20

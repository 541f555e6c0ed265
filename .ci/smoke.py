# SPDX-License-Identifier: MIT OR Apache-2.0

"""Try shapespline: import it, fit curves and functions. Needs NumPy alone.

With ``--installed``, the copy that is imported must be that of this environment.
"""

import sys
from pathlib import Path

import shapespline as ss

if "--installed" in sys.argv:
    assert Path(ss.__file__).is_relative_to(sys.prefix), ss.__file__
points = [(0, 0, 0), (2, 0, 0.1), (4, 0.1, 0.1), (4.5, 0.4, 0.2), (4.6, 3, 0.2), (4.6, 6, 0.3)]
for method in ("fair", "tension", "nu", "catmull-rom"):
    assert ss.fit(points, method=method).check().ok, method
for kind in ("cubic", "quintic", "quartic"):
    f = ss.fit_monotone([0, 1, 2, 5], [0, 0.1, 3, 3.2], kind=kind)
    assert abs(f(f.inverse(1.5)) - 1.5) < 1e-14, kind
print("shapespline", ss.__version__, "from", ss.__file__)

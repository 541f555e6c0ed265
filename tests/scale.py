# SPDX-License-Identifier: MIT OR Apache-2.0

"""How much the large generators of the tests run: a tenth, or everything in `make test-long`."""

import os

#: whether the large generators run whole
LONG = os.environ.get("SHAPESPLINE_TESTS") == "long"


def scaled(n: int, part: int = 10) -> int:
    """Return how many of ``n`` generated cases to run: all in `make test-long`, else a tenth.

    Of those that take long, fair curves mostly, it may be another part.
    """
    return n if LONG else max(1, n // part)

# SPDX-License-Identifier: MIT OR Apache-2.0

"""``python -m shapespline``: the command ``shapespline``."""

import sys

from shapespline._cli import main

if __name__ == "__main__":
    sys.exit(main())

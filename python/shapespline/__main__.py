"""``python -m shapespline``: the command ``shapespline``."""

import sys

from shapespline.cli import main

if __name__ == "__main__":
    sys.exit(main())

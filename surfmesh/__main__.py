"""``python -m surfmesh``."""

import sys

from surfmesh.cli import main

if __name__ == "__main__":
    sys.exit(main())

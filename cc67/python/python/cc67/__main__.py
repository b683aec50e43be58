"""`python -m cc67`: the command `cc67`."""

import sys

from cc67._command import main

if __name__ == "__main__":
    sys.exit(main())

"""``python -m slipfit`` is the command line."""

import sys

from slipfit._command import main

sys.exit(main())

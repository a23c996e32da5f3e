"""The command line, as the script ``slipfit`` of the wheel runs it."""

import signal
import sys

from slipfit import _slipfit

#: What starts the command line as a process of its own.
PROGRAM = [sys.executable, "-m", "slipfit"]


def main() -> int:
    """Runs the command line. Returns its exit code."""
    # The program itself ends its work in order at Ctrl-C.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _slipfit.main(["slipfit", *sys.argv[1:]], PROGRAM)

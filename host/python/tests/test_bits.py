"""The same bits on every system: x86-64, aarch64, Linux, Windows.

Needs no package: ``python tests/test_bits.py`` compares where there is no pytest, such as in an emulator.
"""

import hashlib
import sys
import tempfile
from pathlib import Path

import slipfit


def of_columns(columns):
    """The sum of all values; ``repr`` of a number has all its digits."""
    return hashlib.sha256(repr(columns.to_dict()).encode()).hexdigest()[:16]


def of_table():
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "table.bin")
        slipfit.Scene("cd-rom-slide").table(output=path, n="0:1:0.5")
        return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


SUMS = {
    "a stroke of a slide": (lambda: of_columns(slipfit.Scene("cd-rom-slide").simulate(n=2.5).columns), "7ef97ec8ec7aa5fd"),
    "units of a slide": (
        lambda: of_columns(slipfit.Scene("cd-rom-slide-drawing").population(units=64, columns=True).columns),
        "42a2275f811bcd51",
    ),
    "units of a slider-crank": (
        lambda: of_columns(slipfit.Scene("slider-crank").population(units=16, columns=True).columns),
        "ef81364909e2068d",
    ),
    "measures of a clutch": (lambda: of_columns(slipfit.Scene("clutch").tolerance(samples=2000, draws=True).draws), "eaa9685a772619a0"),
    "a force table": (of_table, "2612d2343237b4f3"),
}


def test_bits():
    assert {name: sum() for name, (sum, _) in SUMS.items()} == {name: expected for name, (_, expected) in SUMS.items()}


if __name__ == "__main__":
    test_bits()
    print(f"the same bits on {sys.platform}")

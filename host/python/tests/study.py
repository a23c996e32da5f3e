"""What calls from Python cost beside the command line of the same wheel: import, time and memory of 100,000 strokes."""

import json
import os
import statistics
import subprocess
import sys
import time

UNITS = 100_000
SCENE = "cd-rom-slide-drawing"
COMMAND = [sys.executable, "-m", "slipfit", "population", SCENE, f"--units={UNITS}", "--json"]
CALL = f"""
import slipfit, sys
result = slipfit.Scene({SCENE!r}).population(units={UNITS}, columns=True)
assert result.columns.rows == {UNITS}
print(result.statistics.malfunctions.units)
"""


def measured(command):
    """What a process prints, its time (s) and the most memory that it had (MB)."""
    begun = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    printed = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    assert status == 0
    return printed, time.monotonic() - begun, usage.ru_maxrss / 1024


imports = []
for _ in range(7):
    begun = time.monotonic()
    subprocess.run([sys.executable, "-c", "pass"], check=True)
    empty = time.monotonic() - begun
    subprocess.run([sys.executable, "-c", "import slipfit, sys; assert 'numpy' not in sys.modules"], check=True)
    imports.append(time.monotonic() - begun - 2 * empty)
print(f"import: {1e3 * statistics.median(imports):.0f} ms")
assert statistics.median(imports) <= 0.150

times, memory = ([], []), ([], [])
for _ in range(3):
    for k, command in enumerate((COMMAND, [sys.executable, "-c", CALL])):
        printed, seconds, most = measured(command)
        units = json.loads(printed)["statistics"]["malfunctions"]["units"] if k == 0 else int(printed)
        times[k].append(seconds)
        memory[k].append(most)
        print(f"{'command line' if k == 0 else 'Python':12} {seconds:6.2f} s {most:6.0f} MB, {units} of {UNITS} malfunction")
ratio, more = min(times[1]) / min(times[0]), min(memory[1]) - min(memory[0])
print(f"{UNITS} strokes: {ratio:.3f} times the command line's time, {more:.0f} MB more")
assert ratio <= 1.05 and more <= 60

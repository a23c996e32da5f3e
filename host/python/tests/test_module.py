"""The module against the command line of the same wheel: same numbers, same bytes, documented exceptions."""

import copy
import json
import math
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import slipfit

SCENE = "cd-rom-slide"
DRAWING = "cd-rom-slide-drawing"
#: Wall-clock time, which no two runs share.
TIMES = {"integration_ms"}


def command_line(*arguments):
    done = subprocess.run([sys.executable, "-m", "slipfit", *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def fields(value):
    """JSON without times, in the form in which results have it: columns as lists."""
    if isinstance(value, dict):
        names, rows = value.get("columns"), value.get("samples")
        if names and rows and isinstance(rows, list):
            value = {**value, "samples": {name: [row[k] for row in rows] for k, name in enumerate(names)}}
        return {key: fields(one) for key, one in value.items() if key not in TIMES}
    return [fields(one) for one in value] if isinstance(value, list) else value


@pytest.mark.parametrize(
    "command, scene, options",
    [
        ("check", SCENE, {"n": 1.5}),
        ("check", "slider-crank", {}),
        ("simulate", SCENE, {"n": 2.5}),
        ("simulate", "slider-crank", {"n": 1.0}),
        ("sweep", SCENE, {"n": "0:2:1"}),
        ("population", DRAWING, {"units": 64, "seed": 7}),
        ("tolerance", DRAWING, {"samples": 2000, "seed": 3}),
        ("allocate", "clutch-processes", {"samples": 2000}),
    ],
)
def test_numbers_are_those_of_the_command_line(command, scene, options):
    words = [f"--{name}={value}" for name, value in options.items()]
    printed = json.loads(command_line(command, scene, *words, "--json"))
    found = getattr(slipfit.Scene(scene), command)(**options).to_dict()
    printed.setdefault("warnings", found["warnings"])
    assert fields(found) == fields(printed)


@pytest.mark.parametrize(
    "command, ending", [("table", "bin"), ("table", "h"), ("kernel", "rs"), ("kernel", "h")]
)
def test_bytes_are_those_of_the_command_line(command, ending, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = Path(f"one.{ending}")
    options = {"n": "0:1:0.5"} if command == "table" else {}
    command_line(command, SCENE, "-o", path, *(f"--{name}={value}" for name, value in options.items()))
    expected = path.read_bytes()
    path.unlink()
    getattr(slipfit.Scene(SCENE), command)(path, **options)
    assert path.read_bytes() == expected
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_every_command_of_the_program_is_in_the_module():
    usage = slipfit._slipfit.call([])[1].split("Commands:")[1].split("Options:")[0]
    commands = {line.split()[0] for line in usage.splitlines() if line.startswith("  ") and line[2] != " "} - {"help"}
    assert {"simulate", "population", "table"} <= commands
    names = {"import": "import_qif"}
    assert [
        name for name in commands if not hasattr(slipfit.Scene, name) and not hasattr(slipfit, names.get(name, name))
    ] == []


def test_columns_share_their_memory_with_numpy():
    samples = slipfit.Scene(SCENE).simulate(n=2.5).samples
    one, two = np.asarray(samples["force"]), np.asarray(samples["force"])
    assert one.dtype == np.float64 and one.shape == (len(samples["t"]),) and not one.flags.writeable
    assert one.__array_interface__["data"][0] == two.__array_interface__["data"][0]
    assert one.max() == max(samples["force"].tolist())


def test_overrides_have_units_and_lists():
    scene = slipfit.Scene(SCENE, {"slide.mass": "90 g", "slide.gravity": [0.0, -9.81, 0.0]})
    expected = json.loads(
        command_line("simulate", SCENE, "--set", 'slide.mass="90 g"', "--set", "slide.gravity=[0,-9.81,0]", "--json")
    )
    assert scene.simulate().peak_force == expected["peak_force"]
    assert scene.with_overrides({"slide.mass": 50.0}).simulate().peak_force != expected["peak_force"]


def test_mistakes_of_a_scene_have_places(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(slipfit.SceneError) as caught:
        slipfit.Scene.from_text("[slide]\nmass = -1\nmas = 2\n").check()
    assert {problem.line for problem in caught.value.problems} >= {2, 3}
    assert caught.value.column >= 1 and any(problem.allowed for problem in caught.value.problems)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(slipfit.SceneError) as caught:
        slipfit.Scene(SCENE, {"slide.mass": "90 N"}).check()
    assert caught.value.file == "command line"
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.problems == caught.value.problems and str(again) == str(caught.value)


BAD = [
    lambda value=value, call=call: call(value)
    for value in [math.nan, math.inf, "a", b"a", object(), [1.0, 2.0], [math.nan] * 16, {}, "1;2", "\0", (None,), 1j]
    for call in [
        lambda value: slipfit.Scene(SCENE).simulate(n=value),
        lambda value: slipfit.Scene(SCENE).population(units=value),
        lambda value: slipfit.Scene(SCENE).population(seed=value),
        lambda value: slipfit.Scene(SCENE).population(threads=value),
        lambda value: slipfit.Scene(SCENE).sweep(n=value),
        lambda value: slipfit.Scene(SCENE).simulate(every=value),
        lambda value: slipfit.Scene(SCENE, {"slide.mass": value}).check(),
        lambda value: slipfit.Scene(SCENE, {"slide.gravity": value}).check(),
        lambda value: slipfit.Scene(SCENE).simulate(unheard=value),
    ]
]


@pytest.mark.parametrize("call", BAD)
def test_bad_calls_raise_documented_exceptions(call):
    with pytest.raises(slipfit.InputError):
        call()


def test_results_can_be_pickled_and_copied():
    result = slipfit.Scene(SCENE).simulate(n=2.5)
    for again in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result), copy.copy(result)):
        assert again.to_dict() == result.to_dict() and again.verdict == result.verdict
    assert "<table>" in result._repr_html_()


def test_the_gil_is_released():
    thread = threading.Thread(target=slipfit.Scene(DRAWING).population, kwargs={"units": 256})
    thread.start()
    counted = 0
    while thread.is_alive():
        counted += 1
        time.sleep(0.001)
    assert counted > 10


def test_ctrl_c_ends_a_command_and_the_next_one_works():
    threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        slipfit.Scene(DRAWING).population(units=1_000_000)
    assert time.monotonic() - started < 30
    assert slipfit.Scene(SCENE).check().n == 0.0


def test_exit_codes_of_the_command_line():
    def code(*arguments):
        return subprocess.run([sys.executable, "-m", "slipfit", *arguments], capture_output=True).returncode

    assert [code("check"), code("check", "--unheard"), code("check", "nowhere.toml"), code("--version")] == [0, 2, 2, 0]


def test_ten_thousand_calls_keep_their_memory():
    def pages():
        return int(Path("/proc/self/statm").read_text().split()[1])

    scene = slipfit.Scene(SCENE)
    for _ in range(1000):
        scene.check()
    before = pages()
    for _ in range(10_000):
        scene.check()
    assert (pages() - before) * 4096 < 8 << 20

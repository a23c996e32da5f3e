"""Types, copies, threads, Ctrl-C, progress, memory, pictures."""

import copy
import decimal
import io
import json
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pandas
import polars
import pyarrow
import pytest
from conftest import command_line

import slipfit

SLIDE = "cd-rom-slide"
DRAWING = "cd-rom-slide-drawing"


def test_results_are_typed():
    result = slipfit.Scene(DRAWING).population(units=64)
    assert isinstance(result, slipfit.results.Population)
    assert isinstance(result.statistics.malfunctions, slipfit.results.Share)
    assert isinstance(result.levels[0], slipfit.results.LevelInPopulation)
    assert result["statistics"]["malfunctions"]["share"] == result.statistics.malfunctions.share
    assert result.rare is None and result.columns is None and "columns" not in result
    with pytest.raises(AttributeError, match="it has .*title"):
        result.unheard
    with pytest.raises(KeyError):
        result["unheard"]


def test_a_field_of_another_kind_of_scene_is_none():
    assert slipfit.Scene("slider-crank").check().degrees_of_freedom is None
    assert slipfit.Scene(SLIDE).check().freedom is None


def test_results_can_be_compared_pickled_and_copied():
    result = slipfit.Scene(SLIDE).simulate(n=2.5)
    for again in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result), copy.copy(result)):
        assert again == result and type(again) is type(result) and again.columns == result.columns
        assert again.verdict == result.verdict
    assert result != slipfit.Scene(SLIDE).simulate(n=1.0)
    with pytest.raises(AttributeError, match="cannot be set"):
        result.verdict = "runs"


def test_overrides_have_units_and_lists():
    scene = slipfit.Scene(SLIDE, {"slide.mass": "90 g", "slide.gravity": np.array([0.0, -9.81, 0.0])})
    expected = json.loads(
        command_line("simulate", SLIDE, "--set", 'slide.mass="90 g"', "--set", "slide.gravity=[0,-9.81,0]", "--json")
    )
    assert scene.simulate().peak_force == expected["peak_force"]
    friction = {"law": "regularised", "coefficient": 0.1, "stick_band": 0.1}
    set_again = scene.with_overrides({"friction.coefficient": 0.2, "friction": friction}).with_overrides({"friction.coefficient": 0.3})
    assert set_again.simulate().columns == scene.with_overrides({"friction": {**friction, "coefficient": 0.3}}).simulate().columns
    assert scene.with_overrides({"slide.mass": 50.0}).simulate().peak_force != expected["peak_force"]


STACK = """
title = "Two parts"
[[dimension]]
name = "a"
value = 10.0
tolerance = 0.1
[[dimension]]
name = "b"
value = 20.0
tolerance = 0.1
[[measure]]
name = "sum"
is = "a + b"
"""


@pytest.mark.parametrize("kind", [dict, pandas.DataFrame, pyarrow.table, polars.DataFrame])
def test_measured_parts_as_arrays(kind, here):
    """Own samples take the place of a dimension's distribution: mean and standard deviation of the sum are those of numpy."""
    sample = np.random.default_rng(2).gamma(4.0, 0.01, 5000) + 9.96
    measured = {"measured.file": kind({"a": sample})}
    text = STACK + '[measured]\nfile = "x.csv"\n[[measured.column]]\nof = "a"\n'
    result = slipfit.Scene.from_text(text, measured).tolerance(samples=200_000)
    found = result.measures[0]
    # b is normal with 3 sigma at its limits. Means of 200,000 units scatter by 1e-4 mm.
    assert found.mean == pytest.approx(sample.mean() + 20.0, abs=6e-4)
    assert found.sd == pytest.approx(np.hypot(sample.std(ddof=1), 0.1 / 3), rel=0.02)
    assert list(here.iterdir()) == []


def test_the_gil_is_released():
    thread = threading.Thread(target=slipfit.Scene(DRAWING).population, kwargs={"units": 512})
    thread.start()
    counted = 0
    while thread.is_alive():
        counted += 1
        time.sleep(0.001)
    assert counted > 10


def test_threads_have_answers_of_their_own():
    expected = {n: slipfit.Scene(SLIDE).simulate(n=n) for n in (0.0, 1.0, 2.0, 3.0)}
    found = {}
    threads = [threading.Thread(target=lambda n=n: found.update({n: slipfit.Scene(SLIDE).simulate(n=n)})) for n in expected]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert {n: one.columns for n, one in found.items()} == {n: one.columns for n, one in expected.items()}


def test_the_number_of_threads_changes_nothing():
    one, two = (slipfit.Scene(DRAWING).population(units=600, threads=threads, columns=True) for threads in (1, 2))
    assert one == two and one.columns == two.columns


def test_ctrl_c_ends_a_command_and_the_next_one_works():
    # A process that was started in the background ignores it.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.5, signal.raise_signal, [signal.SIGINT]).start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        slipfit.Scene(DRAWING).population(units=1_000_000)
    signal.signal(signal.SIGINT, before)
    assert time.monotonic() - started < 30
    assert slipfit.Scene(SLIDE).check().n == 0.0


def test_progress_goes_to_a_function_from_nothing_to_all():
    told = []
    slipfit.Scene(DRAWING).population(units=2000, progress=lambda *now: told.append(now))
    assert {what for what, _, _ in told} == {"simulating"} and told[-1][1:] == (2000, 2000)
    assert [done for _, done, _ in told] == sorted(done for _, done, _ in told)


def test_a_line_says_how_far_the_work_is(monkeypatch):
    from slipfit import _progress

    shown = io.StringIO()
    monkeypatch.setattr(sys, "stderr", shown)
    monkeypatch.setattr(_progress, "FIRST", 0.0)
    monkeypatch.setattr(_progress, "BETWEEN", 0.0)
    slipfit.Scene(DRAWING).population(units=2000, progress=True)
    assert "simulating 2,000 of 2,000" in shown.getvalue() and shown.getvalue().endswith("\r")


def test_pictures_for_notebooks():
    for command, scene, options in [("simulate", SLIDE, {}), ("check", "slider-crank", {}), ("tolerance", "clutch", {"samples": 500})]:
        result = getattr(slipfit.Scene(scene), command)(picture=True, **options)
        assert result.pictures and all(svg.startswith("<svg") for svg in result.pictures.values())
        assert "<svg" in result._repr_html_() and "<table>" in result._repr_html_()
    assert slipfit.Scene(SLIDE).simulate().pictures == {}
    assert "<svg" in slipfit.Scene("slider-crank")._repr_html_()


def test_plots_with_matplotlib():
    import matplotlib

    matplotlib.use("agg")
    result = slipfit.Scene(SLIDE).simulate(n=2.5)
    assert [axis.get_ylabel() for axis in result.plot("force", "vz").axes] == ["force (N)", "vz (m/s)"]
    assert len(result.plot().axes) == 5
    units = slipfit.Scene(DRAWING).population(units=64, columns=True)
    assert {axis.get_ylabel() for axis in units.plot().axes} == {"units"}
    assert len(slipfit.Scene("clutch").tolerance(samples=500, draws=True).plot().axes) == 1
    over = ["friction.coefficient=0.2:0.3:0.1", "slide.mass=80:100:10"]
    axis = slipfit.Scene(SLIDE).sweep(over=over).plot("peak_force_N").axes[0]
    assert [len(line.get_xdata()) for line in axis.get_lines()] == [2, 2, 2]
    with pytest.raises(slipfit.InputError, match="no columns to draw"):
        slipfit.Scene("clutch").tolerance(samples=500).plot()


def test_a_standard_error_that_is_closed_or_only_writes(monkeypatch):
    class Writes:
        def write(self, text):
            raise OSError("full")

    closed = io.StringIO()
    closed.close()
    for stream in (None, closed, Writes()):
        monkeypatch.setattr(sys, "stderr", stream)
        for progress in (None, True):
            assert slipfit.Scene(SLIDE).check(progress=progress).n == 0.0


def test_the_modules_own_example():
    import doctest

    assert doctest.testmod(slipfit).failed == 0


def test_ctrl_c_ends_a_compiler():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(1.0, signal.raise_signal, [signal.SIGINT]).start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        slipfit.Scene(SLIDE).fmu(output="never.fmu")
    signal.signal(signal.SIGINT, before)
    assert time.monotonic() - started < 5 and not Path("never.fmu").exists()


def test_scripts_that_type_checkers_see(tmp_path):
    """What works passes mypy, and what does not is an error."""
    good = """
import numpy as np
import slipfit
scene = slipfit.Scene("cd-rom-slide")
column: slipfit.Column = scene.simulate(n=np.ones(16)).columns["force"]
most = max(column)
share: float = scene.population(units=np.int64(3)).statistics.malfunctions.share
part = scene.tolerance(shard="1/2", out="part")
name: str = part.file if isinstance(part, slipfit.results.Shard) else ""
again = slipfit.Column(np.ones(3))
"""
    bad = good + "scene.check().titel\nscene.tolerance(shard='1/2').measures\nscene.simulate(level=1)\n"
    for text, wrong in ((good, 0), (bad, 3)):
        (tmp_path / "script.py").write_text(text, "utf-8")
        words = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), str(tmp_path / "script.py")]
        done = subprocess.run(words, capture_output=True, encoding="utf-8")
        assert done.stdout.count(": error:") == wrong, done.stdout + done.stderr


def test_exit_codes_of_the_command_line():
    def code(*arguments):
        return subprocess.run([sys.executable, "-m", "slipfit", *arguments], capture_output=True).returncode

    assert [code("check"), code("check", "--unheard"), code("check", "nowhere.toml"), code("--version")] == [0, 2, 2, 0]


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the memory of a process is read from /proc")
def test_ten_thousand_calls_keep_their_memory():
    def pages():
        return int(Path("/proc/self/statm").read_text().split()[1])

    scene, bad = slipfit.Scene(SLIDE), slipfit.Scene(SLIDE, {"slide.mass": -1.0})

    def calls(count):
        for _ in range(count):
            scene.simulate(n=1.0, every="50ms") if _ % 10 == 0 else scene.check()
            if _ % 10 == 5:
                with pytest.raises(slipfit.SceneError):
                    bad.check()

    calls(1000)
    before = pages()
    calls(10_000)
    assert (pages() - before) * 4096 < 8 << 20


def test_overrides_are_tables_and_lists_of_tables():
    mean = {"uncertain.friction.coefficient": {"mean": 0.3, "deviation": 0.005}}
    assert slipfit.Scene(SLIDE, mean).check().n == 0.0
    measured = {"measured": {"file": {"a": np.random.default_rng(1).normal(10.0, 0.01, 60)}, "column": [{"of": "a"}]}}
    found = slipfit.Scene.from_text(STACK, measured).tolerance(samples=2000)
    assert found.measures[0].sd == pytest.approx(np.hypot(0.01, 0.1 / 3), rel=0.1)


def test_texts_of_scenes(here):
    assert slipfit.Scene(SLIDE).text == slipfit.shipped()[SLIDE] and len(slipfit.shipped()) >= 20
    Path("own.toml").write_text(STACK, "utf-8")
    assert slipfit.Scene("own.toml").text == slipfit.Scene.from_text(STACK).text == STACK
    with pytest.raises(slipfit.InputError, match="cannot read the scene nowhere"):
        slipfit.Scene("nowhere").text


def test_a_data_frame_has_its_index_and_other_columns():
    frame = pandas.DataFrame({"part": [f"p{k}" for k in range(30)], "width (mm)": np.random.default_rng(1).normal(10.0, 0.01, 30)})
    frame["good"] = True
    expected = slipfit.capability(frame, label="part", ignore=["good"])
    assert slipfit.capability(frame.set_index("part"), label="part", ignore=["good"]) == expected
    frame["time"] = pandas.date_range("2026-01-01", periods=30, tz="UTC")
    assert slipfit.capability(frame, label="part", ignore=["good", "time"]).characteristics == expected.characteristics
    with pytest.raises(slipfit.InputError, match="two columns"):
        slipfit.capability(frame.set_index(frame["part"]), label="part")


def test_cells_of_data_frames():
    """Numbers of numpy and decimals, what is missing, times in nanoseconds, and names that are numbers."""
    width = np.random.default_rng(1).normal(10.0, 0.01, 30).round(4)
    expected = slipfit.capability({"width (mm)": width})
    of_numpy = slipfit.capability({"width (mm)": list(width)})
    decimals = slipfit.capability({"width (mm)": [decimal.Decimal(repr(float(one))) for one in width]})
    assert of_numpy == decimals == expected
    missing = pandas.DataFrame({"width (mm)": pandas.array([*width, pandas.NA], dtype="Float64"), "height (mm)": np.arange(31.0)})
    first = slipfit.capability(missing).characteristics[0]
    assert (first.count, first.missing) == (30, 1)
    of_numpy = np.arange(30).astype("datetime64[D]").astype("datetime64[ns]")
    for times in (of_numpy, pandas.Series(of_numpy), of_numpy.astype("datetime64[s]").tolist()):
        labelled = slipfit.capability({"time": times, "width (mm)": width}, label="time").characteristics[0]
        assert labelled.outliers[0].label == f"1970-01-{labelled.outliers[0].part + 1}T00:00:00"
    assert slipfit.capability(pandas.DataFrame({3: width})).characteristics[0].name.startswith("3")


def test_a_field_whose_name_is_a_keyword():
    measure = slipfit.Scene("clutch").tolerance(samples=500).measures[0]
    assert measure.yield_ == measure["yield"]


def test_whole_numbers_as_floats():
    assert slipfit.Scene(DRAWING).population(units=64.0) == slipfit.Scene(DRAWING).population(units=64)

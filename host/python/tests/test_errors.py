"""Whatever is wrong raises a documented exception; nothing aborts."""

import math
import multiprocessing
import pickle
import threading
from pathlib import Path

import numpy as np
import pandas
import pyarrow
import pytest

import slipfit

SLIDE = "cd-rom-slide"


def closed():
    file = open(__file__)
    file.close()
    return file


def in_itself():
    endless = []
    endless.append(endless)
    return endless


VALUES = [[1, 2], {1: 2}, math.nan, math.inf, "a", b"a", object(), [1.0, 2.0], [math.nan] * 16, {}, "1;2", "\0", (None,), 1j, closed(), np.zeros((2, 2))]
CALLS = {
    "n": lambda value: slipfit.Scene(SLIDE).simulate(n=value),
    "units": lambda value: slipfit.Scene(SLIDE).population(units=value),
    "seed": lambda value: slipfit.Scene(SLIDE).population(seed=value),
    "threads": lambda value: slipfit.Scene(SLIDE).population(threads=value),
    "levels": lambda value: slipfit.Scene(SLIDE).sweep(n=value),
    "over": lambda value: slipfit.Scene(SLIDE).sweep(over=value),
    "every": lambda value: slipfit.Scene(SLIDE).simulate(every=value),
    "override": lambda value: slipfit.Scene(SLIDE, {"slide.mass": value}).check(),
    "list": lambda value: slipfit.Scene(SLIDE, {"slide.gravity": value}).check(),
    "drive": lambda value: slipfit.Scene("slider-crank").population(drive=value),
    "parts": lambda value: slipfit.capability(value),
    "records": lambda value: slipfit.Scene(SLIDE).identify(value),
    "merged": lambda value: slipfit.merge([value]),
}


@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
@pytest.mark.parametrize("name", CALLS)
def test_bad_values(name, value):
    with pytest.raises(slipfit.InputError):
        CALLS[name](value)


OTHERS = {
    "no such option": lambda: slipfit.Scene(SLIDE).simulate(unheard=1),
    "no such scene": lambda: slipfit.Scene("nowhere.toml").check(),
    "a folder": lambda: slipfit.Scene("/").check(),
    "a scene of bytes": lambda: slipfit.Scene(b"x"),
    "a scene of a number": lambda: slipfit.Scene(3),
    "a closed file": lambda: slipfit.Scene(closed()),
    "a text of bytes": lambda: slipfit.Scene.from_text(b"x"),
    "no key of a scene": lambda: slipfit.Scene(SLIDE, {"slide.mas": 1.0}).check(),
    "a key that is no text": lambda: slipfit.Scene(SLIDE, {3: 1.0}).check(),
    "another unit": lambda: slipfit.Scene(SLIDE, {"slide.mass": "90 N"}).check(),
    "a negative mass": lambda: slipfit.Scene(SLIDE, {"slide.mass": -1.0}).check(),
    "too few gaps": lambda: slipfit.Scene(SLIDE).simulate(n=[1.0] * 15),
    "columns of different lengths": lambda: slipfit.capability({"a": [1.0, 2.0], "b": [1.0]}),
    "columns of lists": lambda: slipfit.capability({"a": np.zeros((3, 2))}),
    "no columns": lambda: slipfit.capability(pandas.DataFrame()),
    "words": lambda: slipfit.capability({"a": ["x", "y"]}),
    "columns without time": lambda: slipfit.Scene.from_text('[identify]\nmodel = "drive-train"\n').identify({"force (N)": [1.0]}),
    "columns where none are": lambda: slipfit.Scene(SLIDE, {"slide.mass": {"a": [1.0]}}).check(),
    "an output that is a folder": lambda: slipfit.Scene(SLIDE).table(output="/"),
    "a NUL in a scene's name": lambda: slipfit.Scene("a\0b").text,
    "half a character": lambda: slipfit.Scene.from_text("title = '\udc80'").check(),
    "overrides that are a list": lambda: slipfit.Scene(SLIDE, [("slide.mass", 1.0)]),
    "further overrides that are a text": lambda: slipfit.Scene(SLIDE).with_overrides("slide.mass=1"),
    "a result as parts": lambda: slipfit.capability(slipfit.Scene(SLIDE).check()),
    "names of several levels": lambda: slipfit.capability(pandas.DataFrame({("a", "b"): [1.0]})),
    "columns that differ in length": lambda: slipfit.capability({"a": [1.0], "b": [1.0, 2.0]}),
    "plot without columns": lambda: slipfit.Scene(SLIDE).check().plot(),
    "two columns of one name": lambda: slipfit.capability(pandas.DataFrame(np.ones((40, 2)), columns=["a (mm)", "a (mm)"])),
    "two columns of one name in Arrow": lambda: slipfit.capability(pyarrow.table([pyarrow.array([1.0] * 40)] * 2, names=["a", "a"])),
    "two columns of one name, one a number": lambda: slipfit.capability({1: [1.0] * 40, "1": [1.0] * 40}),
    "durations as times": lambda: slipfit.Scene.from_text('[identify]\nmodel = "drive-train"\n').identify(
        {"t (s)": np.arange(100).astype("timedelta64[ns]"), "force (N)": np.ones(100), "speed (m/s)": np.ones(100)}
    ),
    "no levels": lambda: slipfit.Scene(SLIDE).simulate(n=[]),
    "levels that a filter has left": lambda: slipfit.Scene(SLIDE).simulate(n=np.array([])),
    "a flag as a level": lambda: slipfit.Scene(SLIDE).simulate(n=False),
    "a flag as a seed": lambda: slipfit.Scene(SLIDE).population(seed=True),
    "a number as a flag": lambda: slipfit.Scene(SLIDE).simulate(stroke=2),
    "more digits than Python prints": lambda: slipfit.Scene(SLIDE).simulate(n=10**5000),
    "more digits than Python prints, as an override": lambda: slipfit.Scene(SLIDE, {"slide.mass": 10**5000}).check(),
    "a list in itself": lambda: slipfit.Scene(SLIDE, {"slide.gravity": in_itself()}).check(),
    "half a character as a name": lambda: slipfit.capability({"a\udc80": [1.0, 2.0]}),
    "nothing to merge": lambda: slipfit.merge(None),
    "a number to merge": lambda: slipfit.merge(5),
    "a column that is not there": lambda: slipfit.Scene(SLIDE).simulate().plot("colour"),
    "too many random points": lambda: slipfit.Scene(SLIDE).precision(stability=True, random=10**9),
    "parts with columns in memory": lambda: slipfit.Scene("clutch", {"measured": {"file": {"a": [1.0]}, "column": [{"of": "hub"}]}}).tolerance(
        shard="1/2", out="part"
    ),
    "a page of a shipped scene": lambda: slipfit.Scene(SLIDE).watch(),
    "a port that is none": lambda: slipfit.Scene(__file__).watch(port="x"),
    "an ending": lambda: slipfit.Scene(SLIDE).kernel(output="kernel.png"),
    "0 threads": lambda: slipfit.Scene(SLIDE).population(threads=0),
    "1.5 units": lambda: slipfit.Scene(SLIDE).population(units=1.5),
    "a negative seed": lambda: slipfit.Scene(SLIDE).population(seed=-1),
    "half a shard": lambda: slipfit.Scene(SLIDE).population(shard="1/2"),
    "no parts": lambda: slipfit.merge([]),
    "a model that is none": lambda: slipfit.import_qif(__file__),
    "a scene without a drive": lambda: slipfit.Scene("clutch").population(),
}


@pytest.mark.parametrize("name", OTHERS)
def test_bad_calls(name, here):
    with pytest.raises((slipfit.InputError, TypeError) if name == "no such option" else slipfit.InputError):
        OTHERS[name]()
    assert list(here.iterdir()) == []


def test_there_are_a_hundred():
    assert len(VALUES) * len(CALLS) + len(OTHERS) >= 100


def test_mistakes_of_a_scene_have_places(here):
    text = '[slide]\nmass = -1\nmas = 2\n'
    with pytest.raises(slipfit.SceneError) as caught:
        slipfit.Scene.from_text(text, name="mine.toml").check()
    problems = caught.value.problems
    assert any((one.file, one.line) == ("mine.toml", 3) and "mas" in one.message for one in problems)
    assert caught.value.line == problems[0].line and all(one.column >= 1 for one in problems)
    assert any(one.allowed for one in problems) and "mine.toml:3" in str(caught.value)
    assert list(here.iterdir()) == []
    with pytest.raises(slipfit.SceneError) as caught:
        slipfit.Scene(SLIDE, {"slide.mass": "90 N"}).check()
    assert caught.value.file == "command line"
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.problems == caught.value.problems and str(again) == str(caught.value)


def test_work_without_a_result(here):
    """A full disk: every write to this file fails."""
    if not Path("/dev/full").exists():
        pytest.skip("the system has no /dev/full")
    with pytest.raises(slipfit.WorkError, match="cannot write /dev/full"):
        slipfit.Scene(SLIDE).simulate(csv="/dev/full")
    with pytest.raises(slipfit.WorkError, match="/dev/full: No space left"):
        slipfit.Scene("cd-rom-slide-drawing").population(units=600, csv="/dev/full")


def test_an_exception_of_the_progress_function_stops_the_work():
    class Enough(Exception):
        pass

    def tell(what, done, of):
        raise Enough

    with pytest.raises(Enough):
        slipfit.Scene("cd-rom-slide-drawing").population(units=1_000_000, progress=tell)
    assert slipfit.Scene(SLIDE).check().n == 0.0


def test_what_does_not_fit_into_memory():
    with pytest.raises(slipfit.WorkError, match="do not fit into memory"):
        slipfit.Scene("cd-rom-slide-drawing").tolerance(samples=10**12, draws=True)


def test_bad_calls_from_many_threads():
    caught = []

    def call():
        for _ in range(20):
            try:
                slipfit.Scene(SLIDE, {"slide.mass": -1.0}).check()
            except slipfit.SceneError as error:
                caught.append(error.line)

    threads = [threading.Thread(target=call) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(caught) == 160


def test_an_exception_stops_one_command_and_no_other():
    class Enough(Exception):
        pass

    found = []
    thread = threading.Thread(target=lambda: found.append(slipfit.Scene("cd-rom-slide-drawing").population(units=4000)))
    thread.start()
    stopped = 0
    while thread.is_alive():
        def tell(what, done, of):
            raise Enough

        with pytest.raises(Enough):
            slipfit.Scene("cd-rom-slide-drawing").population(units=1_000_000, progress=tell)
        stopped += 1
    assert stopped >= 2 and found[0].statistics.units == 4000


def in_a_process(queue):
    try:
        slipfit.Scene(SLIDE, {"slide.mass": -1.0}).check()
    except slipfit.SceneError:
        queue.put(slipfit.Scene("cd-rom-slide-drawing").population(units=64).statistics.units)


@pytest.mark.filterwarnings("ignore:This process")
@pytest.mark.parametrize("start", ["fork", "spawn"])
def test_forked_and_spawned_processes(start):
    slipfit.Scene("cd-rom-slide-drawing").population(units=64)
    context = multiprocessing.get_context(start)
    queue = context.Queue()
    process = context.Process(target=in_a_process, args=(queue,))
    process.start()
    assert queue.get(timeout=60) == 64
    process.join()
    assert process.exitcode == 0


def test_messages_speak_of_keywords_and_columns():
    with pytest.raises(slipfit.InputError) as caught:
        slipfit.Scene(SLIDE).population(force_limit="x")
    assert "force_limit" in str(caught.value) and "--" not in str(caught.value)
    with pytest.raises(slipfit.InputError) as caught:
        slipfit.capability({"width": [1.0] * 20 + ["wide"]})
    assert "columns-1.csv" in str(caught.value) and "tmp" not in str(caught.value) and "--" not in str(caught.value)
    with pytest.raises(slipfit.InputError, match="^a--n.csv: "):
        slipfit.capability("a--n.csv")
    with pytest.raises(slipfit.InputError, match="invalid float") as caught:
        slipfit.Scene(SLIDE).check(n="x")
    assert str(caught.value).startswith("invalid value 'x' for 'n <") and "For more" not in str(caught.value)
    with pytest.raises(slipfit.InputError, match="^cannot read p: "):
        slipfit.merge("p")
    with pytest.raises(slipfit.SceneError) as caught:
        slipfit.Scene("clutch", {"measured": {"file": {"a": [1.0]}, "column": [{"of": "b"}]}}).check()
    assert all("/" not in problem.message for problem in caught.value.problems) and "/" not in str(caught.value)

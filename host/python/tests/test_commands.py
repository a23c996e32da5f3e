"""Every command of the program is in the module, with the same numbers and the same bytes."""

import csv
import io
import json
import math
import urllib.error
import urllib.request
from pathlib import Path

import numpy as np
import pytest
from conftest import command_line

import slipfit
from slipfit import _slipfit

STACK = """
[[dimension]]
name = "a"
value = 8.0
tolerance = 0.1
[[dimension]]
name = "b"
value = 12.0
tolerance = 0.1
[[measure]]
name = "sum"
is = "a + b"
"""
SLIDE = "cd-rom-slide"
DRAWING = "cd-rom-slide-drawing"
#: Wall-clock time, which no two runs share.
TIMES = {"integration_ms"}


def without_times(value):
    if isinstance(value, dict):
        return {name: without_times(one) for name, one in value.items() if name not in TIMES}
    return [without_times(one) for one in value] if isinstance(value, list) else value


def same(printed: str, found: slipfit.Result, without=("columns", "draws", "samples")):
    """Whether a result has the numbers that the command line prints."""
    expected, got = json.loads(printed), found.to_dict()
    for name in without:
        expected.pop(name, None)
        got.pop(name, None)
    # The command line tells of some warnings on standard error alone.
    expected.setdefault("warnings", got["warnings"])
    assert without_times(got) == without_times(expected)


NUMBERS = [
    ("check", SLIDE, {"n": 1.5}),
    ("check", "slider-crank", {}),
    ("check", "clutch", {}),
    ("simulate", SLIDE, {"n": 2.5}),
    ("simulate", SLIDE, {"n": [0.5 * k for k in range(16)]}),
    ("simulate", DRAWING, {"unit": 3, "seed": 7}),
    ("simulate", "slider-crank", {"n": 1.0}),
    ("sweep", SLIDE, {"n": "0:2:1"}),
    ("sweep", "slider-crank", {"over": "friction.coefficient=0.1:0.2:0.1"}),
    ("population", DRAWING, {"units": 64, "seed": 7}),
    ("population", "four-bar", {"units": 32, "threads": 1}),
    ("tolerance", DRAWING, {"samples": 2000, "seed": 3}),
    ("tolerance", "three-part-stack", {"method": "sobol", "samples": 1024}),
    ("allocate", "clutch-processes", {"samples": 2000}),
    ("precision", SLIDE, {"stability": True, "random": 1}),
]


@pytest.mark.parametrize("command, scene, options", NUMBERS)
def test_numbers_are_those_of_the_command_line(command, scene, options):
    text = {name: ",".join(map(str, value)) if isinstance(value, list) else value for name, value in options.items()}
    words = [f"--{name}" if value is True else f"--{name}={value}" for name, value in text.items()]
    found = getattr(slipfit.Scene(scene), command)(**options)
    same(command_line(command, scene, *words, "--json"), found)


BYTES = [
    ("table", "table.bin", {"n": "0:1:0.5"}),
    ("table", "table.h", {"n": "0:1:0.5"}),
    ("table", "production.bin", {"production": True, "units": 600}),
    ("kernel", "kernel.rs", {}),
    ("kernel", "kernel.h", {}),
    ("fmu", "slide.fmu", {}),
]


@pytest.mark.parametrize("command, name, options", BYTES)
def test_bytes_are_those_of_the_command_line(command, name, options, here):
    words = [f"--{option}" if value is True else f"--{option}={value}" for option, value in options.items()]
    printed = command_line(command, SLIDE, "-o", name, *words, "--json")
    expected = Path(name).read_bytes()
    Path(name).unlink()
    same(printed, getattr(slipfit.Scene(SLIDE), command)(output=name, **options))
    assert Path(name).read_bytes() == expected
    assert [file.name for file in here.iterdir()] == [name]


def test_the_whole_job_writes_the_same_files(here):
    options = {"n": "0:1:1", "units": 16}
    printed = command_line("run", "slider-crank", "--out", "out", "--n", "0:1:1", "--units", "16", "--json")
    expected = {file.name: file.read_bytes() for file in Path("out").iterdir()}
    for file in Path("out").iterdir():
        file.unlink()
    same(printed, slipfit.Scene("slider-crank").run(out="out", **options))
    assert {file.name: file.read_bytes() for file in Path("out").iterdir()} == expected and "report.html" in expected


def test_shards_are_merged(here):
    scene = slipfit.Scene(DRAWING)
    for part in ("1/2", "2/2"):
        scene.population(units=600, shard=part, out=f"part-{part[0]}")
    merged = slipfit.merge(["part-1", "part-2"])
    same(command_line("merge", "part-1", "part-2", "--json"), merged)
    assert merged.statistics == scene.population(units=600).statistics


def parts(count=60):
    draw = np.random.default_rng(1)
    return {"width (mm)": np.round(draw.normal(10.0, 0.01, count), 6), "height (mm)": np.round(draw.normal(5.0, 0.02, count), 6)}


def write_csv(path, columns):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*(column.tolist() for column in columns.values())))


def test_capability_of_a_file_and_of_arrays(here):
    write_csv("parts.csv", parts())
    printed = command_line("capability", "parts.csv", "--json")
    same(printed, slipfit.capability("parts.csv"))
    same(printed, slipfit.capability(parts()), without=("file", "title"))


def test_identify_of_a_file_and_of_columns(here):
    t = np.arange(0.0, 1.0, 0.001)
    speed = 0.05 * np.sin(2 * math.pi * 2.0 * t)
    force = 1.7 * 0.05 * 2 * math.pi * 2.0 * np.cos(2 * math.pi * 2.0 * t) + 0.4 * speed / 0.05
    record = {"t (s)": t, "speed (m/s)": speed, "force (N)": force}
    write_csv("record.csv", record)
    text = '[identify]\nmodel = "drive-train"\n'
    Path("train.toml").write_text(text, "utf-8")
    printed = command_line("identify", "train.toml", "record.csv", "--json")
    same(printed, slipfit.Scene("train.toml").identify("record.csv"))
    same(printed, slipfit.Scene.from_text(text, name="train.toml").identify(record), without=("records",))


def test_import_and_schema(here):
    model = Path(__file__).parents[2] / "qif" / "tests" / "data" / "nist_ctc_01_asme1_ap242.qif"
    assert slipfit.import_qif(model) == command_line("import", model)
    assert slipfit.schema() == slipfit.Scene.schema() == json.loads(command_line("schema"))


def test_watch_serves_a_page_until_it_is_stopped(here):
    Path("scene.toml").write_text("title = 'x'\n", "utf-8")
    with slipfit.Scene("scene.toml").watch() as page:
        assert "<iframe" in page._repr_html_()
        with urllib.request.urlopen(page.address) as answer:
            assert b"watch.js" in answer.read()
        with pytest.raises(urllib.error.HTTPError):
            urllib.request.urlopen(page.address.split("?")[0].rstrip("/") + "/../x")
    # Refused, or reset where a process that the page was starting still had its socket.
    with pytest.raises(OSError):
        urllib.request.urlopen(page.address)
    with pytest.raises(slipfit.InputError, match="cannot read the scene nowhere"):
        slipfit.Scene("nowhere").watch()
    with pytest.raises(slipfit.InputError, match="only a file"):
        slipfit.Scene.from_text("").watch()


def test_a_live_page_computes_with_this_python(here):
    """The page starts the command line again, which is no program of its own in a wheel."""
    Path("scene.toml").write_text(STACK, "utf-8")
    with slipfit.Scene("scene.toml").watch() as page:
        with urllib.request.urlopen(page.address.rstrip("/") + "/events", timeout=60) as events:
            seen = ""
            # What a stage found about the sum of 8 and 12 mm, or that it did not start.
            while "cannot compute" not in seen and not ("sum" in seen and "20.0" in seen):
                seen += events.readline().decode()
    assert "cannot compute" not in seen


def test_no_command_is_missing():
    names = {name for name, *_ in _slipfit.commands()} - {"help"}
    usage = command_line("--help").split("Commands:")[1].split("Options:")[0]
    assert names == {line.split()[0] for line in usage.splitlines() if line.startswith("  ") and line[2] != " "} - {"help"}
    functions = {"import": "import_qif"}
    assert [name for name in names if not hasattr(slipfit.Scene, name) and not hasattr(slipfit, functions.get(name, name))] == []
    tested = {command for command, *_ in [*NUMBERS, *BYTES]}
    assert names - tested == {"run", "merge", "capability", "identify", "import", "schema", "watch"}


def test_columns_are_those_of_the_csv_files(here):
    for scene, command, options in [
        (SLIDE, "simulate", {"n": 1.0}),
        ("slider-crank", "simulate", {"n": 1.0}),
        (SLIDE, "sweep", {"n": "0:2:1"}),
        ("slider-crank", "sweep", {"over": "friction.coefficient=0.1:0.2:0.1"}),
        (DRAWING, "population", {"units": 300, "columns": True}),
        ("three-part-stack", "tolerance", {"samples": 500, "draws": True}),
    ]:
        option = "draws" if command == "tolerance" else "csv"
        words = [f"--{name}={value}" for name, value in options.items() if value is not True]
        command_line(command, scene, *words, f"--{option}=rows.csv")
        rows = list(csv.reader(io.StringIO(Path("rows.csv").read_text("utf-8"))))
        columns = getattr(slipfit.Scene(scene), command)(**options)["draws" if option == "draws" else "columns"]
        assert list(columns) == rows[0] and columns.rows == len(rows) - 1
        for name, values in zip(rows[0], zip(*rows[1:])):
            for value, text in zip(columns[name].tolist(), values):
                if isinstance(value, float):
                    # The file has ten digits.
                    assert math.isclose(value, float(text), rel_tol=1e-9, abs_tol=1e-300), (name, value, text)
                else:
                    assert ("" if value is None else str(value).lower() if isinstance(value, bool) else str(value)) == text

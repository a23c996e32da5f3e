"""Columns are shared with numpy and data frames, not copied."""

import copy
import gc
import pickle

import numpy as np
import pandas
import polars
import pyarrow
import pytest

import slipfit

NUMBERS = ["tightness", "peak_force_N", "travel_m", "unit", "left front left (m)", "breakaway_s"]


@pytest.fixture(scope="module")
def columns():
    return slipfit.Scene("cd-rom-slide-drawing").population(units=300, columns=True).columns


def address(array):
    return array.__array_interface__["data"][0]


@pytest.mark.parametrize("name", NUMBERS)
def test_all_libraries_see_the_same_memory(columns, name):
    own = np.asarray(columns[name])
    assert own.shape == (300,) and not own.flags.writeable and own.dtype == (np.int64 if name == "unit" else np.float64)
    table = pyarrow.table(columns)
    frame = table.to_pandas(types_mapper=pandas.ArrowDtype)
    series = polars.DataFrame(columns)[name]
    found = [
        address(np.asarray(columns[name])),
        address(np.asarray(memoryview(columns[name]))),
        table[name].chunk(0).buffers()[1].address,
        frame[name].array.__arrow_array__().chunk(0).buffers()[1].address,
        series.to_arrow().buffers()[1].address,
        pyarrow.array(columns[name]).buffers()[1].address,
    ]
    assert found == [address(own)] * len(found)


def test_what_is_missing_is_nan_and_null():
    column = slipfit.Column([1.0, None, 3.0], name="force (N)", unit="N")
    assert column.tolist() == [1.0, None, 3.0] and np.isnan(np.asarray(column)[1])
    assert pyarrow.array(column).null_count == 1 and polars.Series(column).null_count() == 1


def test_words_and_flags(columns):
    verdicts = columns["verdict"]
    assert set(verdicts.tolist()) <= {"runs", "crawls", "jammed", "overruns", "undecided"}
    assert polars.DataFrame(columns)["verdict"].cast(polars.String).to_list() == verdicts.tolist()
    assert np.asarray(verdicts).tolist() == verdicts.tolist()
    assert pyarrow.table(columns)["at_desk"].to_pylist() == columns["at_desk"].tolist()
    with pytest.raises(BufferError):
        memoryview(verdicts)


def test_units_are_in_names_attributes_and_the_schema(columns):
    assert columns["peak_force_N"].unit == "N" and columns["left front left"].unit == "m" and columns["tightness"].unit == ""
    schema = pyarrow.schema(pyarrow.table(columns).schema)
    assert schema.field("peak_force_N").metadata == {b"unit": b"N"} and schema.field("tightness").metadata is None


def test_names_and_rows(columns):
    assert len(columns) == len(list(columns)) == len(columns.keys()) and columns.rows == 300
    assert columns["left front left"] is columns["left front left (m)"] and "left front left" in columns and "x" not in columns
    with pytest.raises(KeyError, match='there is no column "x"'):
        columns["x"]
    assert columns["tightness"][3:9:2] == columns["tightness"].tolist()[3:9:2]
    assert columns["tightness"][-1] == columns["tightness"].tolist()[-1]
    for index in (300, -301):
        with pytest.raises(IndexError):
            columns["tightness"][index]


def test_memory_outlives_the_result():
    def numbers():
        return np.asarray(slipfit.Scene("cd-rom-slide").simulate(n=2.5).columns["force"])

    kept, expected = numbers(), numbers().tolist()
    gc.collect()
    assert kept.tolist() == expected
    table = pyarrow.table(slipfit.Scene("cd-rom-slide").simulate(n=2.5).columns)
    gc.collect()
    assert table["force (N)"].to_pylist() == expected


def test_copies_are_equal(columns):
    for again in (pickle.loads(pickle.dumps(columns)), copy.deepcopy(columns), copy.copy(columns)):
        assert again == columns and again["verdict"] == columns["verdict"] and again["unit"].unit == columns["unit"].unit
    assert columns != slipfit.Columns([columns["unit"]])
    with pytest.raises(ValueError, match="equally long"):
        slipfit.Columns([slipfit.Column([1.0]), slipfit.Column([1.0, 2.0])])


def test_kinds_of_columns():
    kinds = {"numbers": [1.5, None], "counts": [1, 2], "flags": [True, False], "words": ["a", None]}
    for kind, values in kinds.items():
        column = slipfit.Column(values, kind=kind)
        assert column.kind == slipfit.Column(values).kind == kind and column.tolist() == values
        empty = slipfit.Column([], kind=kind)
        assert pickle.loads(pickle.dumps(empty)).kind == kind and pickle.loads(pickle.dumps(column)) == column
    assert slipfit.Column(np.array([1, 2])).kind == "counts" and slipfit.Column([]).kind == slipfit.Column([1, -2]).kind == "numbers"
    with pytest.raises(ValueError, match="beyond"):
        slipfit.Column([2**63])
    for values in ([1.0, "a"], [True, 2], [True, 1.5], "words", b"12", 3, [[1.0]], [1, "a"]):
        with pytest.raises(ValueError, match="one kind"):
            slipfit.Column(values)
    for values, kind in (([1.5], "counts"), ([-1], "counts"), ([True], "counts"), (["a"], "numbers"), ([1.0], "flags"), ([1.0], "colours")):
        with pytest.raises(ValueError, match="allowed is"):
            slipfit.Column(values, kind=kind)


def test_counts_are_signed(columns):
    difference = np.diff(np.asarray(columns["unit"])[::-1])
    assert (difference == -1).all()


def test_columns_without_a_column():
    none = slipfit.Columns([])
    assert none.rows == 0 and len(none) == 0 and pyarrow.table(none).num_columns == 0 and pickle.loads(pickle.dumps(none)) == none


def test_pandas(columns):
    frame = columns.to_pandas()
    assert list(frame.columns) == list(columns) and frame["tightness"].tolist() == columns["tightness"].tolist()
    assert frame["tightness"].array.__arrow_array__().chunk(0).buffers()[1].address == address(np.asarray(columns["tightness"]))
    # The names alone would be no data frame of the columns.
    for wrong in (pandas.DataFrame, np.asarray):
        with pytest.raises(TypeError, match="to_pandas"):
            wrong(columns)


def test_whatever_is_asked_for(columns):
    assert 3 not in columns and None not in columns and "tightness" in columns
    with pytest.raises(TypeError):
        columns[3]

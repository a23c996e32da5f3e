"""How a command is called: options as words of the command line, columns as files, pictures, progress."""

from __future__ import annotations

import csv
import decimal
import functools
import json
import os
import re
import reprlib
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol, Union

from slipfit import _slipfit
from slipfit._errors import InputError, SlipfitError, reword
from slipfit._progress import Progress, line
from slipfit._result import result
from slipfit._slipfit import Columns


class Frame(Protocol):
    """A data frame."""

    @property
    def columns(self) -> Any: ...
    @property
    def shape(self) -> Any: ...
    def __getitem__(self, name: Any, /) -> Any: ...


#: A value of an option: text, number, path, or a list of them. True sets an option that has no value. None leaves an option out.
Option = Union[str, int, float, bool, "os.PathLike[str]", Sequence[Any], None]
#: A file, or what it would hold: names of columns and their values, as a dict, a data frame or :class:`Columns`.
Table = Union[str, "os.PathLike[str]", Mapping[str, Any], Columns, Frame]


@functools.cache
def options_of(command: str) -> dict[str, bool]:
    """The options of a command, and whether they may be repeated."""
    options = next((options for name, _, options in _slipfit.commands() if name == command), [])
    return {name: repeated for name, _, _, repeated, is_place in options if not is_place}


def words(command: str, options: Mapping[str, Option]) -> list[str]:
    """Options as the command line has them. Lists of options that may not be repeated are joined by commas."""
    all_words: list[str] = []
    for name, value in options.items():
        option = name.rstrip("_").replace("_", "-")
        value = plain(value)
        if value is None or value is False or (isinstance(value, (list, tuple)) and not value):
            continue
        if value is True:
            all_words.append(f"--{option}")
        elif isinstance(value, (list, tuple)):
            parts = [_word(one) for one in value]
            all_words += [f"--{option}={part}" for part in (parts if options_of(command)[option] else [",".join(parts)])]
        else:
            all_words.append(f"--{option}={_word(value)}")
    return all_words


def plain(value: Any) -> Any:
    """Numbers and arrays of numpy and others as Python's own."""
    return value.tolist() if hasattr(value, "tolist") else value


def _word(value: object) -> str:
    value = plain(value)
    if isinstance(value, float):
        # 1e2 units are 100.
        return str(int(value)) if value.is_integer() and abs(value) < 2**53 else float.__repr__(value)
    if isinstance(value, (str, int)) and not isinstance(value, bool):
        return str(value)
    if isinstance(value, os.PathLike):
        return path_of(value)
    raise InputError(f"an option is {reprlib.repr(value)}, allowed are texts, numbers, paths, and lists of them")


def path_of(path: object) -> str:
    """A path as text."""
    if not isinstance(path, (str, os.PathLike)) or not isinstance(text := os.fspath(path), str):
        raise InputError(f"a path is {reprlib.repr(path)}, allowed are texts and pathlib's paths")
    return text


def is_table(value: object) -> bool:
    """Whether it has columns by their names: a mapping, or a data frame."""
    return isinstance(value, (Mapping, Columns)) or (hasattr(value, "columns") and hasattr(value, "shape"))


class Files:
    """Columns as CSV files, which are gone afterwards. Messages call them "columns"."""

    def __init__(self) -> None:
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._count = 0

    def __enter__(self) -> Files:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._folder is None:
            return
        self._folder.cleanup()
        if isinstance(error, SlipfitError):
            folder = self._folder.name + os.sep
            reword(error, lambda text: text.replace(folder, ""))

    def of(self, table: Table) -> str:
        """The path of a file with these columns, or of this file."""
        if not is_table(table):
            return path_of(table)
        if self._folder is None:
            self._folder = tempfile.TemporaryDirectory(prefix="slipfit-")
        self._count += 1
        path = Path(self._folder.name, f"columns-{self._count}.csv")
        _write(path, table)
        return str(path)


def _write(path: Path, table: Any) -> None:
    """Writes columns as CSV; the index of a data frame, if it has a name."""
    if any(name is not None for name in getattr(getattr(table, "index", None), "names", ())):
        table = table.reset_index()
    if hasattr(table, "to_pydict"):
        # pyarrow's tables.
        table = table.to_pydict()
    # polars' data frames have no items.
    items = table.items() if hasattr(table, "items") else ((name, table[name]) for name in table.columns)
    columns = {_name(name): _values(name, values) for name, values in items}
    first = len(next(iter(columns.values()), ()))
    for name, values in columns.items():
        if len(values) != first:
            raise InputError(f"the column {name!r} has {len(values)} values, the first column has {first}")
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([[_cell(name, one) for name, one in zip(columns, row)] for row in zip(*columns.values())])


def _name(name: object) -> str:
    if isinstance(name, (str, int)):
        return str(name)
    raise InputError(f"the name of a column is {reprlib.repr(name)}, allowed are texts and whole numbers")


def _values(name: object, values: Any) -> Sequence[Any]:
    """The values of a column."""
    if getattr(getattr(values, "dtype", None), "kind", "") == "M" and hasattr(values, "astype"):
        # As lists, numpy's nanoseconds are whole numbers.
        values = values.astype("datetime64[us]")
    values = plain(values)
    values = values.to_list() if hasattr(values, "to_list") else values
    if isinstance(values, (str, bytes)) or not isinstance(values, Sequence):
        raise InputError(f"the column {name!r} is {reprlib.repr(values)}, allowed is a list or an array with one dimension")
    return values


def _cell(name: str, value: Any) -> str:
    """A value of a column as CSV has it. What is missing is empty; pandas has two objects for that."""
    value = plain(value)
    if value is None or type(value).__name__ in ("NAType", "NaTType"):
        return ""
    if isinstance(value, float):
        return float.__repr__(value)
    if isinstance(value, (str, int, decimal.Decimal)):
        return str(value)
    if hasattr(value, "isoformat"):
        return str(value.isoformat())
    raise InputError(f"the column {name!r} has the value {reprlib.repr(value)}, allowed are numbers, texts and times")


def in_notebook() -> bool:
    """Whether results are shown in a notebook."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return shell is not None and hasattr(shell, "kernel")


def call(
    kind: Any,
    command: str,
    first: Sequence[str],
    options: Mapping[str, Option],
    *,
    scene: str | None = None,
    columns: bool = False,
    draws: bool = False,
    picture: bool | None = False,
    progress: Progress = None,
) -> Any:
    """Runs a command, whose result is of this ``kind``: a class of results, or a union of them.

    ``first`` are its arguments by place, ``scene`` is the scene's text if it is not in a file. ``picture`` says whether the result has
    pictures; None: in notebooks.
    """
    arguments = [command, *words(command, options), "--json", "--", *first]
    pictures = in_notebook() if picture is None else bool(picture)
    text, warnings, found, drawn, drawings = run(arguments, scene, columns, draws, pictures, progress)
    fields: dict[str, Any] = json.loads(text)
    fields["warnings"] = [*(fields.get("warnings") or []), *warnings]
    if command == "simulate":
        # They are the columns.
        del fields["samples"]
    fields.update({name: one for name, one in (("columns", found), ("draws", drawn)) if one is not None})
    return result(kind, fields, dict(drawings))


def run(
    arguments: Sequence[str],
    scene: str | None = None,
    columns: bool = False,
    draws: bool = False,
    pictures: bool = False,
    progress: Progress = None,
) -> _slipfit._Returned:
    """Runs a command with the ``arguments`` of the command line."""
    if any("\0" in word for word in arguments):
        raise InputError("an argument has a NUL character")
    shown = line(progress)
    tell = progress if callable(progress) else shown
    try:
        return _slipfit.call(arguments, scene, columns, draws, pictures, tell)
    except UnicodeEncodeError as error:
        raise InputError(f"a text is not Unicode: {error}") from None
    except SlipfitError as error:
        names = "|".join(options_of(arguments[0]))
        reword(error, lambda text: re.sub(rf"(?<![\w./\\-])--({names})(?![\w-])", lambda option: option[1].replace("-", "_"), text))
        raise
    finally:
        if shown is not None:
            shown.end()

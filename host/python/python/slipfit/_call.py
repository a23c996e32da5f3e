"""How a command is called: options as words of the command line, columns as files, pictures, progress."""

from __future__ import annotations

import contextlib
import csv
import decimal
import functools
import json
import os
import re
import reprlib
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple, Protocol, Union

from slipfit import _slipfit
from slipfit._errors import InputError, SlipfitError, reword
from slipfit._progress import Progress, line
from slipfit._result import in_notebook, result
from slipfit._slipfit import Columns


class Frame(Protocol):
    """A data frame."""

    @property
    def columns(self) -> Any: ...
    @property
    def shape(self) -> Any: ...
    def __getitem__(self, name: Any, /) -> Any: ...


class Listed(Protocol):
    """An array or a number of numpy."""

    def tolist(self) -> Any: ...


#: A value of an option: text, number, path, or a list or an array of them, not empty. None leaves an option out.
Option = Union[str, int, float, "os.PathLike[str]", Sequence[Any], Listed, None]
#: One file or several.
Paths = Union[str, "os.PathLike[str]", Sequence[Union[str, "os.PathLike[str]"]]]
#: A file, or what it would hold: names of columns and their values, as a dict, a data frame or :class:`Columns`.
Table = Union[str, "os.PathLike[str]", Mapping[str, Any], Columns, Frame]


class Kind(NamedTuple):
    """What an option takes."""

    has_value: bool
    is_repeated: bool


@functools.cache
def options_of(command: str) -> dict[str, Kind]:
    """The options of a command."""
    options = next((options for name, _, options in _slipfit.commands() if name == command), [])
    return {name: Kind(value is not None, repeated) for name, value, _, repeated, is_place in options if not is_place}


def words(command: str, options: Mapping[str, Option]) -> list[str]:
    """Options as the command line has them. Lists of options that may not be repeated are joined by commas."""
    all_words: list[str] = []
    for name, value in options.items():
        option = name.rstrip("_").replace("_", "-")
        value, kind = plain(value), options_of(command)[option]
        if value is None:
            continue
        if not kind.has_value:
            if not isinstance(value, bool):
                raise InputError(f"{name} is {_shown(value)}, allowed is True or False")
            all_words += [f"--{option}"] if value else []
        elif isinstance(value, (list, tuple)) and value:
            parts = [_word(name, one) for one in value]
            all_words += [f"--{option}={part}" for part in (parts if kind.is_repeated else [",".join(parts)])]
        else:
            all_words.append(f"--{option}={_word(name, value)}")
    return all_words


def plain(value: Any) -> Any:
    """Numbers and arrays of numpy and others as Python's own."""
    return value.tolist() if hasattr(value, "tolist") else value


def _shown(value: object) -> str:
    """A value in a message."""
    try:
        return reprlib.repr(value)
    # Of very long numbers.
    except ValueError:
        return f"a {type(value).__name__}"


def _word(name: str, value: object) -> str:
    value = plain(value)
    if isinstance(value, float):
        # 1e2 units are 100.
        return str(int(value)) if value.is_integer() and abs(value) < 2**53 else float.__repr__(value)
    if isinstance(value, (str, int)) and not isinstance(value, bool):
        with contextlib.suppress(ValueError):
            return str(value)
    if isinstance(value, os.PathLike):
        return path_of(value)
    raise InputError(f"{name} is {_shown(value)}, allowed are texts, numbers, paths, lists of them that are not empty, and None")


def path_of(path: object) -> str:
    """A path as text."""
    if not isinstance(path, (str, os.PathLike)) or not isinstance(text := os.fspath(path), str):
        raise InputError(f"a path is {_shown(path)}, allowed are texts and pathlib's paths")
    return text


def paths_of(paths: object) -> list[str]:
    """Paths as texts."""
    if isinstance(paths, (str, os.PathLike)):
        return [path_of(paths)]
    if isinstance(paths, (list, tuple)):
        return [path_of(path) for path in paths]
    raise InputError(f"paths are {_shown(paths)}, allowed are texts, pathlib's paths, and lists of them")


def is_table(value: object) -> bool:
    """Whether it has columns by their names: a mapping, or a data frame."""
    return isinstance(value, (Mapping, Columns)) or (hasattr(value, "columns") and hasattr(value, "shape"))


class Files:
    """Columns as CSV files, which are gone afterwards. Messages call them "columns"."""

    def __init__(self) -> None:
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        #: How many there are.
        self.count = 0

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
        self.count += 1
        path = Path(self._folder.name, f"columns-{self.count}.csv")
        _write(path, table)
        return str(path)


def _write(path: Path, table: Any) -> None:
    """Writes columns as CSV; the index of a data frame, if it has a name."""
    names: list[str] = []
    columns: list[Sequence[Any]] = []
    for name, values in _items(table):
        names.append(_name(name))
        columns.append(_values(names[-1], values))
        if names.count(names[-1]) > 1:
            raise InputError(f"there are two columns {names[-1]!r}; each needs a name that no other has")
        if len(columns[-1]) != len(columns[0]):
            raise InputError(f"the column {names[-1]!r} has {len(columns[-1])} values, the first column has {len(columns[0])}")
    cells = [[_cell(name, one) for name, one in zip(names, row)] for row in zip(*columns)]
    with path.open("w", encoding="utf-8", errors="surrogatepass", newline="") as file:
        csv.writer(file).writerows([names, *cells])


def _items(table: Any) -> Iterable[tuple[Any, Any]]:
    """Names and columns."""
    if hasattr(table, "column_names"):
        # pyarrow's tables.
        return zip(table.column_names, table.columns)
    if hasattr(table, "items"):
        index: Any = getattr(table, "index", None)
        # pandas: with the index, if it has a name.
        named = [(name, index.get_level_values(k)) for k, name in enumerate(getattr(index, "names", ())) if name is not None]
        return [*named, *table.items()]
    # polars' data frames.
    return ((name, table[name]) for name in table.columns)


def _name(name: object) -> str:
    if isinstance(name, (str, int)) and (text := str(name)).isprintable():
        return text
    raise InputError(f"the name of a column is {_shown(name)}, allowed are texts and whole numbers")


def _values(name: object, values: Any) -> Sequence[Any]:
    """The values of a column."""
    if type(values).__module__ == "numpy" and values.dtype.kind in ("M", "m"):
        # As a list, numpy's nanoseconds are whole numbers.
        values = values.astype(values.dtype.kind + "8[us]")
    values = plain(values)
    values = next((getattr(values, of)() for of in ("to_list", "to_pylist") if hasattr(values, of)), values)
    if isinstance(values, (str, bytes)) or not isinstance(values, Sequence):
        raise InputError(f"the column {name!r} is {_shown(values)}, allowed is a list or an array with one dimension")
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
    raise InputError(f"the column {name!r} has the value {_shown(value)}, allowed are numbers, texts and times")


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


def spoken(text: str, command: str) -> str:
    """A message of the command line, whose options are keywords here."""
    names = "|".join(options_of(command))
    return re.sub(rf"(?<![\w./\\-])--({names})(?![\w-])", lambda option: option[1].replace("-", "_"), text)


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
        reword(error, lambda text: spoken(text, arguments[0]))
        raise
    finally:
        if shown is not None:
            shown.end()

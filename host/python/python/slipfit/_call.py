"""How a command is called: options as words of the command line, columns as files, pictures, progress."""

from __future__ import annotations

import contextlib
import csv
import json
import os
import re
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, TypeVar, Union

from slipfit import _slipfit
from slipfit._errors import InputError, Problem, SceneError, SlipfitError
from slipfit._progress import Progress, line
from slipfit._result import Result

#: A value of an option: text, number, path, or a list of them. True sets an option that has no value. None leaves an option out.
Option = Union[str, int, float, bool, "os.PathLike[str]", Sequence[Any], None]
#: A file, or what it would hold: names of columns and their values, as a dict, a data frame or :class:`Columns`.
Table = Union[str, "os.PathLike[str]", Mapping[str, Any]]

Found = TypeVar("Found", bound=Result)


def words(options: Mapping[str, Option], repeated: frozenset[str]) -> list[str]:
    """Options as the command line has them. Lists of options that are not ``repeated`` are joined by commas."""
    all_words: list[str] = []
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        value = plain(value)
        if value is None or value is False or (isinstance(value, (list, tuple)) and not value):
            continue
        if value is True:
            all_words.append(option)
        elif isinstance(value, (list, tuple)):
            parts = [_word(one) for one in value]
            all_words += [f"{option}={part}" for part in (parts if name in repeated else [",".join(parts)])]
        else:
            all_words.append(f"{option}={_word(value)}")
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
    raise InputError(f"an option is {value!r}, allowed are texts, numbers, paths, and lists of them")


def path_of(path: object) -> str:
    """A path as text."""
    if not isinstance(path, (str, os.PathLike)) or not isinstance(text := os.fspath(path), str):
        raise InputError(f"a path is {path!r}, allowed are texts and pathlib's paths")
    return text


def is_table(value: object) -> bool:
    """Whether it has columns by their names."""
    return isinstance(value, Mapping) or (any(hasattr(value, name) for name in ("keys", "columns")) and not hasattr(value, "tolist"))


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
            error.args = _without(error.args, self._folder.name + os.sep)
            if isinstance(error, SceneError):
                error.problems = [Problem(*_without(tuple(problem), self._folder.name + os.sep)) for problem in error.problems]

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


def _without(value: Any, folder: str) -> Any:
    """Texts without the name of a folder that nobody knows."""
    if isinstance(value, str):
        return value.replace(folder, "")
    return type(value)(_without(one, folder) for one in value) if type(value) in (list, tuple) else value


def _write(path: Path, table: Any) -> None:
    """Writes columns as CSV; the index of a data frame, if it has a name."""
    if any(name is not None for name in getattr(getattr(table, "index", None), "names", ())):
        table = table.reset_index()
    names = [str(name) for name in (table.keys() if hasattr(table, "keys") else table.columns)]
    columns = [plain(table[name]) for name in names]
    columns = [column.to_list() if hasattr(column, "to_list") else column for column in columns]
    for name, column in zip(names, columns):
        if isinstance(column, (str, bytes)) or not isinstance(column, Sequence):
            raise InputError(f"the column {name!r} is {column!r}, allowed is a list or an array with one dimension")
        if len(column) != len(columns[0]):
            raise InputError(f"the column {name!r} has {len(column)} values, the first column has {len(columns[0])}")
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows([[_cell(name, one) for name, one in zip(names, row)] for row in zip(*columns)])


def _cell(name: str, value: object) -> str:
    """A value of a column as CSV has it."""
    if value is None:
        return ""
    if isinstance(value, float):
        return float.__repr__(value)
    if isinstance(value, (str, int)):
        return str(value)
    if hasattr(value, "isoformat"):
        return str(value.isoformat())
    raise InputError(f"the column {name!r} has the value {value!r}, allowed are numbers, texts and times")


def in_notebook() -> bool:
    """Whether results are shown in a notebook."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return shell is not None and hasattr(shell, "kernel")


def call(
    kind: type[Found],
    command: str,
    first: Sequence[str],
    options: Mapping[str, Option],
    *,
    repeated: frozenset[str] = frozenset(),
    scene: str | None = None,
    columns: bool = False,
    draws: bool = False,
    picture: bool | None = False,
    progress: Progress = None,
) -> Found:
    """Runs a command. ``first`` are its arguments by place, ``scene`` is the scene's text if it is not in a file.

    Pictures are those of the option ``plot`` or ``plots``, whichever is among the options; ``picture`` says whether the result has them.
    """
    option = next((name for name in ("plot", "plots") if name in options), None)
    drawn = option is not None and options[option] is None and (in_notebook() if picture is None else picture)
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="slipfit-"))) if drawn else None
        if folder is not None and option is not None:
            options = {**options, option: folder if option == "plots" else folder / "picture.svg"}
        arguments = [command, *words(options, repeated), "--json", "--", *first]
        text, warnings, found, drawn_units = run(arguments, scene, columns, draws, progress)
        pictures = {} if folder is None else {path.stem: path.read_text("utf-8") for path in sorted(folder.glob("*.svg"))}
    fields: dict[str, Any] = json.loads(text)
    fields["warnings"] = [*(fields.get("warnings") or []), *warnings]
    if command == "simulate":
        # They are the columns.
        del fields["samples"]
    fields.update({name: one for name, one in (("columns", found), ("draws", drawn_units)) if one is not None})
    return kind(fields, pictures)


def run(
    arguments: Sequence[str],
    scene: str | None = None,
    columns: bool = False,
    draws: bool = False,
    progress: Progress = None,
) -> _slipfit._Returned:
    """Runs a command with the ``arguments`` of the command line."""
    if any("\0" in word for word in arguments):
        raise InputError("an argument has a NUL character")
    shown = line(progress)
    tell = progress if callable(progress) else shown
    try:
        return _slipfit.call(arguments, scene, columns, draws, tell)
    except InputError as error:
        if not isinstance(error, SceneError):
            # Options are keywords here.
            text = str(error).split("\n\nFor more information")[0]
            error.args = (re.sub(r"--([a-z]+(?:-[a-z]+)*)", lambda option: option[1].replace("-", "_"), text),)
        raise
    finally:
        if shown is not None:
            shown.end()

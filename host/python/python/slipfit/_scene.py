"""Scenes, and functions for other files."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from types import TracebackType
from typing import Any

from slipfit import results
from slipfit._call import Found, Option, Table, call, is_table, path_of, plain, run, words, write_table
from slipfit._command import PROGRAM
from slipfit._commands import REPEATED, SceneCommands
from slipfit._errors import InputError, WorkError
from slipfit._progress import Progress


def _toml(value: Any) -> str:
    """An override's value as TOML."""
    value = plain(value)
    if isinstance(value, (bool, str)):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, float):
        return float.__repr__(value)
    if isinstance(value, int):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_toml(one) for one in value)}]"
    raise InputError(f"an override is {value!r}, allowed are numbers, texts, lists, and columns where a file is asked for")


class Scene(SceneCommands):
    """A scene: a file (TOML), a shipped scene by its name, or a text (:meth:`from_text`).

    ``overrides`` set keys, as ``--set`` does: numbers in the key's unit, texts with their unit such as ``"90 g"``, lists. Where a key
    asks for a file of measured parts, columns will do: a dict of names and arrays, or a data frame. They are passed as CSV.
    The scene is read anew by each command. Mistakes in it raise :class:`SceneError`.
    """

    def __init__(self, source: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None) -> None:
        self._source = path_of(source)
        self._text: str | None = None
        self._overrides: dict[str, Any] = dict(overrides or {})

    @classmethod
    def from_text(
        cls, text: str, overrides: Mapping[str, Any] | None = None, *, name: str | os.PathLike[str] = "scene.toml"
    ) -> Scene:
        """A scene of this TOML text. Messages call it ``name``; files that it names are found in the folder of ``name``."""
        if not isinstance(text, str):
            raise InputError(f"the text of a scene is {text!r}, allowed is a str")
        scene = cls(name, overrides)
        scene._text = text
        return scene

    def with_overrides(self, overrides: Mapping[str, Any]) -> Scene:
        """The same scene with further keys set, after those that are set already."""
        scene = Scene(self._source, {**self._overrides, **overrides})
        scene._text = self._text
        return scene

    def __repr__(self) -> str:
        return f"Scene({self._source!r}, {self._overrides!r})"

    def _repr_html_(self) -> str:
        return self.check(picture=True)._repr_html_()

    def _call(
        self, kind: type[Found], command: str, options: Mapping[str, Option], others: Sequence[Table] = (), **wanted: Any
    ) -> Found:
        with contextlib.ExitStack() as stack:
            sets, paths = [], [path_of(one) for one in others if not is_table(one)]
            folder = Path(stack.enter_context(TemporaryDirectory(prefix="slipfit-"))) if self._has_tables(others) else None
            for number, (key, value) in enumerate([*self._overrides.items(), *(("", one) for one in others if is_table(one))]):
                if folder is not None and is_table(value):
                    write_table(path := folder / f"columns-{number}.csv", value)
                    value = str(path)
                    if not key:
                        paths.append(value)
                        continue
                sets.append(f"{key}={_toml(value)}")
            first = [self._source, *paths]
            return call(kind, command, first, {"set": sets, **options}, repeated=REPEATED, scene=self._text, **wanted)

    def _has_tables(self, others: Sequence[Table]) -> bool:
        return any(is_table(one) for one in (*self._overrides.values(), *others))

    def identify(
        self,
        records: Table | Sequence[Any],
        *,
        each: bool = False,
        n: Option = None,
        output: str | os.PathLike[str] | None = None,
        page: str | os.PathLike[str] | None = None,
        progress: Progress = None,
    ) -> results.Identification:
        """Estimates parameters from measured motion, and says what the record does not determine.

        Args:
            records: CSV files, folders of them, or columns with names such as "t (s)" and "force (N)".
            each: Takes each record, or folder of records, as a unit of its own.
            n: Tolerance level of the unit, one for all gaps or one for each.
            output: Writes what was found as a scene file that other scenes include.
            page: Writes a page with measured and computed motion (HTML).
            progress: See :mod:`slipfit`.

        Raises:
            SceneError, InputError, WorkError: As for all commands.
        """
        if is_table(records) or isinstance(records, (str, os.PathLike)):
            records = [records]
        elif not isinstance(records, Sequence):
            raise InputError(f"records are {records!r}, allowed are files, columns, and lists of them")
        options: dict[str, Option] = {"each": each, "n": n, "output": output, "page": page}
        return self._call(results.Identification, "identify", options, records, progress=progress)

    def watch(self, *, port: int | None = None) -> Watch:
        """Serves a page of the scene's file, which follows each save, until it is stopped: the command ``watch``."""
        if self._text is not None:
            raise InputError("only a file can be watched; this scene is a text")
        sets = [f"{key}={_toml(value)}" for key, value in self._overrides.items()]
        return Watch(["watch", *words({"set": sets, "port": port}, REPEATED), "--", self._source])

    @staticmethod
    def schema() -> dict[str, Any]:
        """The JSON Schema of scenes."""
        return schema()


class Watch:
    """A page that follows a scene's file. ``address`` is where; :meth:`stop` ends it, as the end of a ``with`` does."""

    def __init__(self, arguments: Sequence[str]) -> None:
        self._process = subprocess.Popen([*PROGRAM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self._process.stdout is not None and self._process.stderr is not None
        #: The page's address, on this machine alone.
        self.address: str = self._process.stdout.readline().strip()
        if not self.address:
            message = self._process.stderr.read().strip().removeprefix("error: ")
            raise InputError(message) if self._process.wait() == 2 else WorkError(message)

    def stop(self) -> None:
        """Ends the page."""
        self._process.terminate()
        self._process.communicate()

    def __enter__(self) -> Watch:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.stop()

    def __repr__(self) -> str:
        return f"<Watch {self.address}>"

    def _repr_html_(self) -> str:
        return f'<iframe src="{self.address}" width="100%" height="700"></iframe>'


def import_qif(
    model: str | os.PathLike[str],
    *,
    output: str | os.PathLike[str] | None = None,
    name: str | None = None,
    update: str | os.PathLike[str] | None = None,
) -> str:
    """The features, datums and tolerances of a QIF 3.0 model as a ``[[part]]`` (TOML): the command ``import``.

    Written to ``output``, or into the scene ``update``, if one is given; then the text is what the command says about it.
    """
    options = words({"output": output, "name": name, "update": update}, frozenset())
    return run(["import", *options, "--", path_of(model)])[0]


def schema() -> dict[str, Any]:
    """The JSON Schema of scenes."""
    found: dict[str, Any] = json.loads(run(["schema"])[0])
    return found

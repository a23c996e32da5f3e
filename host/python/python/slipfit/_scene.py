"""Scenes, and functions for other files."""

from __future__ import annotations

import json
import os
import reprlib
import subprocess
import weakref
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from slipfit import _slipfit, results
from slipfit._call import Files, Option, Table, call, is_table, path_of, plain, run, spoken, words
from slipfit._command import PROGRAM
from slipfit._commands import SceneCommands
from slipfit._errors import InputError, WorkError, reword
from slipfit._progress import Progress


def _toml(key: str, value: Any, files: Files | None) -> str:
    """The value of a key as TOML. Columns become one of the ``files``, where the key asks for a file."""
    value = plain(value)
    if files is not None and is_table(value) and key.rpartition(".")[2] == "file":
        return _toml(key, files.of(value), None)
    if isinstance(value, Mapping):
        return "{{{}}}".format(", ".join(f"{_key(name)} = {_toml(_key(name), one, files)}" for name, one in value.items()))
    if isinstance(value, (bool, str)):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, float):
        return float.__repr__(value)
    if isinstance(value, int):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_toml(key, one, files) for one in value)}]"
    allowed = "allowed are numbers, texts, lists, dicts, and columns where a file is asked for"
    raise InputError(f"the override {key} is {reprlib.repr(value)}, {allowed}")


def _key(name: object) -> str:
    if not isinstance(name, str):
        raise InputError(f"a key is {name!r}, allowed is a str")
    return name


def _overrides(overrides: Mapping[str, Any] | None) -> dict[str, Any]:
    if overrides is not None and not isinstance(overrides, Mapping):
        raise InputError(f"overrides are {reprlib.repr(overrides)}, allowed is a dict of keys and values")
    return dict(overrides or {})


def _later(first: dict[str, Any], then: Mapping[str, Any]) -> dict[str, Any]:
    """All overrides; what is set again is set later, and not in its old place."""
    then = _overrides(then)
    return {**{key: value for key, value in first.items() if key not in then}, **then}


class Scene(SceneCommands):
    """A scene: a file (TOML), a shipped scene by its name, or a text (:meth:`from_text`).

    ``overrides`` set keys, as ``--set`` does: numbers in the key's unit, texts with their unit such as ``"90 g"``, lists, dicts. Where a
    key asks for a file of columns, such as ``measured.file``, a dict of names and arrays or a data frame will do.
    The scene is read anew by each command. Mistakes in it raise :class:`SceneError`.
    """

    def __init__(self, source: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None) -> None:
        self._source = path_of(source)
        self._text: str | None = None
        self._overrides = _overrides(overrides)

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
        scene = Scene(self._source, _later(self._overrides, overrides))
        scene._text = self._text
        return scene

    @property
    def text(self) -> str:
        """The scene's text (TOML), without the overrides."""
        if self._text is not None:
            return self._text
        try:
            if not Path(self._source).is_file() and self._source in (scenes := _slipfit.shipped()):
                return scenes[self._source]
            return Path(self._source).read_text("utf-8")
        # A name with a NUL, and what is not UTF-8, are ValueErrors.
        except (OSError, ValueError) as error:
            raise InputError(f"cannot read the scene {self._source}: {error}") from None

    def __repr__(self) -> str:
        return f"Scene({self._source!r}, {self._overrides!r})"

    def _repr_html_(self) -> str:
        return self.check(picture=True)._repr_html_()

    def _call(
        self, kind: Any, command: str, options: Mapping[str, Option], others: Sequence[Table] = (), **wanted: Any
    ) -> Any:
        with Files() as files:
            try:
                sets = [f"{_key(key)}={_toml(key, value, files)}" for key, value in self._overrides.items()]
            # Lists in themselves, and numbers of thousands of digits.
            except (RecursionError, ValueError) as error:
                raise error if isinstance(error, InputError) else InputError(f"an override has no value in TOML: {error}") from None
            if files.count and options.get("out") is not None:
                raise InputError("out: parts of a work need overrides whose columns are in a file")
            first = [self._source, *(files.of(one) for one in others)]
            return call(kind, command, first, {"set": sets or None, **options}, scene=self._text, **wanted)

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
            progress: A function, or whether a line on standard error says how far it is.

        Raises:
            SceneError, InputError, WorkError: As for all commands.
        """
        if is_table(records) or isinstance(records, (str, os.PathLike)):
            records = [records]
        elif not isinstance(records, Sequence):
            raise InputError(f"records are {records!r}, allowed are files, columns, and lists of them")
        options: dict[str, Option] = {"each": each, "n": n, "output": output, "page": page}
        found: results.Identification = self._call(results.Identification, "identify", options, records, progress=progress)
        return found

    def watch(self, *, port: int | None = None) -> Watch:
        """Serves a page of the scene's file, which follows each save, until it is stopped: the command ``watch``."""
        if self._text is not None or (self._source in _slipfit.shipped() and not Path(self._source).exists()):
            raise InputError(f"only a file can be watched, {self!r} is none: write Scene.text into one")
        sets = [f"{_key(key)}={_toml(key, value, None)}" for key, value in self._overrides.items()]
        return Watch(["watch", *words("watch", {"set": sets or None, "port": port}), "--", self._source])

    @staticmethod
    def schema() -> dict[str, Any]:
        """The JSON Schema of scenes."""
        return schema()


class Watch:
    """A page that follows a scene's file. ``address`` is where; :meth:`stop` ends it, as the end of a ``with`` does."""

    def __init__(self, arguments: Sequence[str]) -> None:
        self._process = subprocess.Popen([*PROGRAM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self._process.stdout is not None and self._process.stderr is not None
        # Not longer than Python.
        weakref.finalize(self, self._process.terminate)
        #: The page's address, on this machine alone.
        self.address: str = self._process.stdout.readline().strip()
        if not self.address:
            message = self._process.stderr.read().strip().removeprefix("error: ")
            failure = InputError(message) if self._process.wait() == 2 else WorkError(message)
            reword(failure, lambda text: spoken(text.split("\n\n")[0], "watch"))
            raise failure

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
    options = words("import", {"output": output, "name": name, "update": update})
    return run(["import", *options, "--", path_of(model)])[0]


def schema() -> dict[str, Any]:
    """The JSON Schema of scenes."""
    found: dict[str, Any] = json.loads(run(["schema"])[0])
    return found

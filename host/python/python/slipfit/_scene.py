"""Scenes, and the commands that work on them.

Every function passes its arguments to the command of the same name and returns what the command's ``--json`` prints. The
command line's own help, ``slipfit COMMAND --help``, explains each option. A keyword is the option with ``-`` for ``_``.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from slipfit import _slipfit
from slipfit._errors import InputError
from slipfit._result import Result

Option = str | int | float | bool | os.PathLike[str] | Sequence[Any] | None


def _words(options: Mapping[str, Option]) -> list[str]:
    """Options as the command line has them. ``None`` and ``False`` leave an option out."""
    words: list[str] = []
    for name, value in options.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        value = _plain(value)
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
        elif isinstance(value, (list, tuple)):
            # Levels of gaps are one list, everything else is an option that is repeated.
            parts = [_word(one) for one in value]
            words += [f"{option}={','.join(parts)}"] if name == "n" else [f"{option}={part}" for part in parts]
        else:
            words.append(f"{option}={_word(value)}")
    return words


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy as Python's own."""
    return value.tolist() if hasattr(value, "tolist") else value


def _word(value: object) -> str:
    value = _plain(value)
    if isinstance(value, float):
        return float.__repr__(value)
    if isinstance(value, (str, int)) and not isinstance(value, bool):
        return str(value)
    if isinstance(value, os.PathLike):
        return str(Path(value))
    raise InputError(f"an option is {value!r}, allowed are texts, numbers, paths, and lists of them")


def _call(command: str, first: Sequence[str], options: Mapping[str, Option]) -> Result:
    words = [command, *_words(options), "--json", "--", *first]
    if any("\0" in word for word in words):
        raise InputError("an argument has a NUL character")
    value, _, warnings = _slipfit.call(words)
    fields: dict[str, Any] = value or {}
    fields["warnings"] = [*(fields.get("warnings") or []), *warnings]
    return Result(fields)


def _toml(value: Any) -> str:
    """An override's value as TOML."""
    value = _plain(value)
    if isinstance(value, (bool, str)):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, float):
        return float.__repr__(value)
    if isinstance(value, int):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(_toml(one) for one in value)}]"
    raise InputError(f"an override is {value!r}, allowed are numbers, texts and lists")


class Scene:
    """A scene: a file (TOML), a shipped scene by its name, or a text (:meth:`from_text`).

    ``overrides`` set keys, as ``--set`` does: numbers in the key's unit, texts with their unit such as ``"90 g"``, lists.
    The scene is read anew by each command, and mistakes raise :class:`SceneError` at once.
    """

    def __init__(self, source: str | os.PathLike[str], overrides: Mapping[str, Any] | None = None) -> None:
        if not isinstance(source, (str, os.PathLike)):
            raise InputError(f"a scene is {source!r}, allowed are a path and the name of a shipped scene")
        self._source = os.fspath(source)
        self._text: str | None = None
        self._overrides: dict[str, Any] = dict(overrides or {})

    @classmethod
    def from_text(cls, text: str, overrides: Mapping[str, Any] | None = None) -> Scene:
        """A scene of this TOML text. Files that it names are found from the current folder."""
        scene = cls("scene.toml", overrides)
        scene._text = text
        return scene

    def with_overrides(self, overrides: Mapping[str, Any]) -> Scene:
        """The same scene with further keys set, after those that are set already."""
        scene = Scene(self._source, {**self._overrides, **overrides})
        scene._text = self._text
        return scene

    def __repr__(self) -> str:
        return f"Scene({self._source!r}, {self._overrides!r})"

    def _run(self, command: str, options: Mapping[str, Option], *others: str) -> Result:
        sets = [f"{key}={_toml(value)}" for key, value in self._overrides.items()]
        options = {"set": sets, **options}
        if self._text is None:
            return _call(command, [self._source, *others], options)
        # A command reads a file; it is gone when the command is done.
        descriptor, name = tempfile.mkstemp(suffix=".toml", prefix=".slipfit-scene-", dir=".")
        try:
            with open(descriptor, "w", encoding="utf-8") as file:
                file.write(self._text)
            return _call(command, [name, *others], options)
        finally:
            Path(name).unlink(missing_ok=True)

    def check(self, *, n: float = 0.0, plot: str | os.PathLike[str] | None = None) -> Result:
        """Degrees of freedom, gaps (mm) at the level ``n``, the level that closes each, warnings."""
        return self._run("check", {"n": n, "plot": plot})

    def simulate(self, *, n: float | Sequence[float] | None = None, unit: int | None = None, **options: Option) -> Result:
        """One unit: of a tolerance level ``n``, of one for each gap, or a ``unit`` of the production by its number.

        ``samples`` has the motion over time, in SI units. ``every="1ms"`` is their interval.
        """
        return self._run("simulate", {"n": n, "unit": unit, **options})

    def sweep(self, *, n: str | float | None = None, over: str | Sequence[str] | None = None, **options: Option) -> Result:
        """Many levels, such as ``n="-3:5:0.1"``, or values of keys, such as ``over="friction.coefficient=0.1:0.4:0.02"``."""
        return self._run("sweep", {"n": n, "over": over, **options})

    def population(self, *, units: int = 5000, seed: int = 1, threads: int | None = None, **options: Option) -> Result:
        """The first ``units`` units of the production: which share malfunctions, and why."""
        return self._run("population", {"units": units, "seed": seed, "threads": threads, **options})

    def tolerance(self, *, samples: int | None = None, seed: int | None = None, **options: Option) -> Result:
        """How the measures of the product vary (mm and °)."""
        return self._run("tolerance", {"samples": samples, "seed": seed, **options})

    def allocate(self, *, require: str | None = None, seed: int = 1, **options: Option) -> Result:
        """The cheapest tolerances that meet the requirements."""
        return self._run("allocate", {"require": require, "seed": seed, **options})

    def table(self, output: str | os.PathLike[str], **options: Option) -> Result:
        """Writes the flash table to ``output`` (.bin, .hex, .h or .rs)."""
        return self._run("table", {"output": output, **options})

    def kernel(
        self,
        output: str | os.PathLike[str] | None = None,
        *,
        crate: str | os.PathLike[str] | None = None,
        **options: Option,
    ) -> Result:
        """Writes the model for firmware to ``output`` (.rs or .h), or as a ``crate`` into a folder."""
        return self._run("kernel", {"output": output, "crate": crate, **options})

    def fmu(self, output: str | os.PathLike[str], **options: Option) -> Result:
        """Writes an FMI co-simulation unit to ``output``. Cargo has to be installed."""
        return self._run("fmu", {"output": output, **options})

    def identify(self, records: str | os.PathLike[str] | Sequence[str | os.PathLike[str]], **options: Option) -> Result:
        """Parameters from measured motion: ``records`` are CSV files or folders of them."""
        all_records = [records] if isinstance(records, (str, os.PathLike)) else list(records)
        return self._run("identify", options, *(os.fspath(record) for record in all_records))

    def run(self, out: str | os.PathLike[str], **options: Option) -> Result:
        """The whole job, into the folder ``out``."""
        return self._run("run", {"out": out, **options})

    def precision(self, **options: Option) -> Result:
        """Error against run time for every integrator and step of the controller."""
        return self._run("precision", options)


def capability(file: str | os.PathLike[str], **options: Option) -> Result:
    """Performance and capability of measured parts (CSV or QIF results) by ISO 22514-2."""
    return _call("capability", [os.fspath(file)], options)


def merge(parts: Sequence[str | os.PathLike[str]], **options: Option) -> Result:
    """Joins the results of shards."""
    return _call("merge", [os.fspath(part) for part in parts], options)


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
    words = _words({"output": output, "name": name, "update": update})
    _, text, _ = _slipfit.call(["import", *words, "--", os.fspath(model)])
    return text


def schema() -> dict[str, Any]:
    """The JSON Schema of scenes."""
    _, text, _ = _slipfit.call(["schema"])
    found: dict[str, Any] = json.loads(text)
    return found

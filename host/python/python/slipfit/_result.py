"""Results of commands."""

from __future__ import annotations

import html
import importlib
from collections.abc import Iterator, Mapping
from typing import Any

from slipfit._slipfit import Column


class Result(Mapping[str, Any]):
    """What a command found: the fields of its ``--json`` output, with the same names, units and numbers.

    Fields are items and attributes: ``result["title"]`` is ``result.title``. ``samples``, where there are some, are a dict of
    :class:`Column`. ``warnings`` is a list of texts. Results can be pickled and copied.
    """

    def __init__(self, fields: Mapping[str, Any]) -> None:
        self._fields = dict(fields)

    def __getitem__(self, key: str) -> Any:
        return self._fields[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def __getattr__(self, name: str) -> Any:
        # Not of a result that is being unpickled and has no fields yet.
        if name != "_fields" and name in self._fields:
            return self._fields[name]
        raise AttributeError(f"the result has no field {name!r}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._fields]

    def __repr__(self) -> str:
        return f"<Result {self._fields.get('title', '')!r}: {', '.join(self._fields)}>"

    def _repr_html_(self) -> str:
        rows = (
            f"<tr><th>{html.escape(key)}</th><td>{html.escape(_short(value))}</td></tr>"
            for key, value in self._fields.items()
        )
        return f"<table>{''.join(rows)}</table>"

    def to_dict(self) -> dict[str, Any]:
        """The fields as a new dict; columns become lists."""
        plain: dict[str, Any] = _plain(self._fields)
        return plain

    def plot(self) -> Any:
        """Draws the samples over time with matplotlib, which has to be installed. Returns the figure."""
        plt: Any = importlib.import_module("matplotlib.pyplot")
        samples: dict[str, Column] = self._fields["samples"]
        (_, time), *rest = sorted(samples.items(), key=lambda item: not item[0].startswith("t"))
        figure, axes = plt.subplots(len(rest), sharex=True, squeeze=False, figsize=(6, 1.6 * len(rest)))
        for axis, (name, column) in zip(axes[:, 0], rest):
            axis.plot(memoryview(time), memoryview(column))
            axis.set_ylabel(name)
        axes[-1, 0].set_xlabel("t (s)")
        return figure


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_plain(one) for one in value]
    return value.tolist() if isinstance(value, Column) else value


def _short(value: Any) -> str:
    text = ", ".join(value) if isinstance(value, dict) else str(value)
    return text if len(text) <= 200 else text[:199] + "…"

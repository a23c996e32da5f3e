"""Results of commands."""

from __future__ import annotations

import html
import importlib
import types
import typing
from collections.abc import Iterator, Mapping
from typing import Any, Union

from slipfit._slipfit import Column, Columns


class Result:
    """What a command found: the fields of its ``--json`` output, with the same names, units and numbers.

    Fields are items and attributes: ``result["title"]`` is ``result.title``, and ``list(result)`` are the names. Where a field is an
    object it is a result, too. A field that a scene of another kind would have is None as an attribute. Results can be compared,
    pickled and copied.
    """

    #: Pictures (SVG) by their names, if they were asked for.
    pictures: dict[str, str]

    def __init__(self, fields: Mapping[str, Any], pictures: Mapping[str, str] | None = None) -> None:
        kinds = _kinds(type(self))
        self._fields = {name: _converted(value, kinds.get(name) or kinds.get(name + "_", Any)) for name, value in fields.items()}
        self.pictures = dict(pictures or {})

    def __getitem__(self, key: str) -> Any:
        return self._fields[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __contains__(self, name: object) -> bool:
        return name in self._fields

    def __len__(self) -> int:
        return len(self._fields)

    def __getattr__(self, name: str) -> Any:
        # Not of a result that is being unpickled and has no fields yet.
        if name != "_fields":
            # A field whose name is a keyword of Python, such as yield, is yield_ as an attribute.
            field = name[:-1] if name.endswith("_") and name[:-1] in self._fields else name
            if field in self._fields:
                return self._fields[field]
            if not name.startswith("_") and name in _kinds(type(self)):
                return None
        raise AttributeError(f"the result has no field {name!r}, it has {', '.join(self.__dict__.get('_fields', ()))}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._fields]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Result) and self._fields == other._fields

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {', '.join(f'{name} {_short(value, 60)}' for name, value in self._fields.items())}>"

    def _repr_html_(self) -> str:
        rows = (
            f"<tr><th style='text-align:left'>{html.escape(name)}</th><td style='text-align:left'>{html.escape(_short(value))}</td></tr>"
            for name, value in self._fields.items()
        )
        return "".join([*self.pictures.values(), "<table>", *rows, "</table>"])

    def to_dict(self) -> dict[str, Any]:
        """The fields as dicts, lists, texts and numbers."""
        plain: dict[str, Any] = _plain(self._fields)
        return plain

    def plot(self, *names: str) -> Any:
        """Draws columns with matplotlib, which has to be installed: those of these ``names``, or the first six that are numbers.

        They are drawn over time or level, those of units as histograms. Returns the figure.
        """
        columns = self._fields.get("columns")
        if not isinstance(columns, Columns):
            raise AttributeError("the result has no columns to draw")
        plt: Any = importlib.import_module("matplotlib.pyplot")
        first, *rest = columns.values()
        numbers = [column for column in rest if isinstance(column[0], float)]
        drawn = [columns[name] for name in names] or numbers[:MOST_DRAWN]
        figure, axes = plt.subplots(len(drawn), sharex=first.name != "unit", squeeze=False, figsize=(7, 1.8 * len(drawn)), layout="constrained")
        for axis, column in zip(axes[:, 0], drawn):
            if first.name == "unit":
                axis.hist([number for number in column.tolist() if number is not None], bins=50)
                axis.set_xlabel(_labelled(column))
                axis.set_ylabel("units")
            else:
                axis.plot(first.tolist(), column.tolist())
                axis.set_ylabel(_labelled(column))
                axis.set_xlabel(_labelled(first) if column is drawn[-1] else "")
        return figure


#: Columns that are drawn if none is named.
MOST_DRAWN = 6


def _labelled(column: Column) -> str:
    stated = not column.unit or column.name.endswith(f"({column.unit})")
    return column.name if stated else f"{column.name} ({column.unit})"


#: The types of the fields of each class.
_KINDS: dict[type, dict[str, Any]] = {}


def _kinds(kind: type) -> dict[str, Any]:
    """The types of a result's fields."""
    if kind not in _KINDS:
        _KINDS[kind] = {name: of for name, of in typing.get_type_hints(kind).items() if name != "pictures"}
    return _KINDS[kind]


def _converted(value: Any, kind: Any) -> Any:
    """``value`` with the objects in it as results."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin in (Union, types.UnionType):
        fitting = [one for one in arguments if _fits(value, one)]
        return _converted(value, fitting[0] if fitting else Any)
    if isinstance(value, list):
        return [_converted(one, arguments[0] if origin is list else Any) for one in value]
    if isinstance(value, dict):
        if origin is dict:
            return {name: _converted(one, arguments[1]) for name, one in value.items()}
        return (kind if isinstance(kind, type) and issubclass(kind, Result) else Result)(value)
    return float(value) if kind is float and isinstance(value, int) else value


def _fits(value: Any, kind: Any) -> bool:
    origin = typing.get_origin(kind) or kind
    if isinstance(value, dict):
        return origin is dict or (isinstance(origin, type) and issubclass(origin, Result))
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return isinstance(origin, type) and isinstance(value, origin)
    return origin in (int, float)


def _plain(value: Any) -> Any:
    if isinstance(value, Columns):
        return value.to_dict()
    if isinstance(value, Result):
        return _plain(value._fields)
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_plain(one) for one in value]
    return value


def _short(value: Any, most: int = 200) -> str:
    if isinstance(value, Columns):
        text = f"{value.rows} rows of {', '.join(value)}"
    elif isinstance(value, Result):
        text = _short(value._fields)
    elif isinstance(value, dict):
        text = ", ".join(f"{name} {_short(one)}" for name, one in value.items())
    elif isinstance(value, list):
        text = f"[{', '.join(_short(one) for one in value)}]"
    else:
        text = f"{value:.6g}" if isinstance(value, float) else str(value)
    return text if len(text) <= most else text[: most - 1] + "…"

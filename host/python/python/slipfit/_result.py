"""Results of commands."""

from __future__ import annotations

import html
import importlib
import keyword
import math
import sys
import types
import typing
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Union

from slipfit._errors import InputError
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
        # Results do not change.
        self.__dict__["_fields"] = {name: _converted(value, kinds.get(name, Any)) for name, value in fields.items()}
        self.__dict__["pictures"] = dict(pictures or {})

    def __getitem__(self, key: str) -> Any:
        return self._fields[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __contains__(self, name: object) -> bool:
        return name in self._fields

    def __len__(self) -> int:
        return len(self._fields)

    if TYPE_CHECKING:
        _fields: dict[str, Any]
    else:
        # Type checkers know the annotated fields alone.
        def __getattr__(self, name: str) -> Any:
            # A result that is being unpickled has no fields yet.
            fields = self.__dict__.get("_fields", {})
            field = _field(name)
            if field in fields:
                return fields[field]
            if field in _kinds(type(self)):
                return None
            raise AttributeError(f"the result has no field {name!r}, it has {', '.join(fields)}")

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("fields of a result cannot be set; to_dict() is a copy of which they can")

    def __delattr__(self, name: str) -> None:
        raise AttributeError("fields of a result cannot be deleted")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._fields]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self._fields == other._fields

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
        """Draws ``columns`` or ``draws`` with matplotlib, which has to be installed: those of these ``names``, or the first six of numbers.

        They are drawn over time, level or the values of a key, with a line for each value of a second key. Those of units are drawn
        as histograms. Returns the figure.
        """
        columns = self._fields.get("columns") or self._fields.get("draws")
        if not isinstance(columns, Columns):
            raise InputError("the result has no columns to draw; population and tolerance have them if they are asked for")
        keys = len(self._fields.get("keys", ())) or 1
        first, *second = columns.values()[:keys]
        numbers = [column for column in columns.values()[keys:] if column.kind == "numbers"]
        try:
            drawn = [columns[name] for name in names] or numbers[:MOST_DRAWN]
        except KeyError as error:
            raise InputError(*error.args) from None
        if not drawn:
            raise InputError(f"no column has numbers to draw, there is {', '.join(columns)}")
        plt: Any = importlib.import_module("matplotlib.pyplot")
        of_units = first.name == "unit"
        figure, axes = plt.subplots(len(drawn), sharex=not of_units, squeeze=False, figsize=(7, 1.8 * len(drawn)), layout="constrained")
        for axis, column in zip(axes[:, 0], drawn):
            if of_units:
                axis.hist([number for number in column.tolist() if number is not None], bins=50)
                axis.set_xlabel(_labelled(column))
                axis.set_ylabel("units")
                continue
            rows = list(zip(first.tolist(), *(key.tolist() for key in second), column.tolist()))
            for value in dict.fromkeys(row[1:-1] for row in rows):
                line = [(row[0], row[-1]) for row in rows if row[1:-1] == value]
                label = ", ".join(f"{_labelled(key)} {_short(one)}" for key, one in zip(second, value))
                axis.plot(*zip(*line), marker="o" if len(line) == 1 else "", label=label)
            axis.set_ylabel(_labelled(column))
            axis.set_xlabel(_labelled(first) if column is drawn[-1] else "")
        if second and not of_units:
            axes[0, 0].legend()
        if in_notebook():
            # It is shown as the value of its cell, and not a second time.
            plt.close(figure)
        return figure


def in_notebook() -> bool:
    """Whether results are shown in a notebook."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return shell is not None and hasattr(shell, "kernel")


#: Columns that are drawn if none is named.
MOST_DRAWN = 6


def _labelled(column: Column) -> str:
    stated = not column.unit or column.name.endswith(f"({column.unit})")
    return column.name if stated else f"{column.name} ({column.unit})"


def _field(name: str) -> str:
    """The field of an attribute: yield of yield_, as yield is a keyword of Python."""
    return name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name


#: The types of the fields of each class.
_KINDS: dict[type, dict[str, Any]] = {}


def _kinds(kind: type) -> dict[str, Any]:
    """The types of a result's fields."""
    if kind not in _KINDS:
        hints = typing.get_type_hints(kind).items()
        _KINDS[kind] = {_field(name): of for name, of in hints if name not in ("_fields", "pictures")}
    return _KINDS[kind]


def result(kind: Any, fields: Mapping[str, Any], pictures: Mapping[str, str]) -> Any:
    """The result of this kind, or of the kind of a union that fits best."""
    return _best(fields, kind)(fields, pictures)


def _converted(value: Any, kind: Any) -> Any:
    """``value`` with the objects in it as results."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin in (Union, types.UnionType):
        return _converted(value, _best(value, kind))
    if isinstance(value, list):
        return [_converted(one, arguments[0] if origin is list else Any) for one in value]
    if isinstance(value, dict):
        if origin is dict:
            return {name: _converted(one, arguments[1]) for name, one in value.items()}
        return (kind if isinstance(kind, type) and issubclass(kind, Result) else Result)(value)
    return float(value) if kind is float and isinstance(value, int) else value


def _best(value: Any, kind: Any) -> Any:
    """The kind itself, or that of a union which fits the value best."""
    union = typing.get_origin(kind) in (Union, types.UnionType)
    return min(typing.get_args(kind), key=lambda one: _misfit(value, one)) if union else kind


def _misfit(value: Any, kind: Any) -> float:
    """How many fields of a value a kind does not have, or the value of the kind; infinite for another sort of value."""
    kind = _best(value, kind)
    origin = typing.get_origin(kind) or kind
    if kind is Any:
        return 0.0
    if isinstance(value, Mapping):
        if isinstance(origin, type) and issubclass(origin, Result):
            of = _kinds(origin)
            needed = {name for name, kind in of.items() if type(None) not in typing.get_args(kind)}
            return len(value.keys() - of.keys()) + len(needed - value.keys())
        return 0.0 if origin is dict else math.inf
    if isinstance(value, list):
        if origin is not list:
            return math.inf
        return max((_misfit(one, typing.get_args(kind)[0]) for one in value), default=0.0)
    if origin in (int, float):
        return 0.0 if isinstance(value, (int, float)) and not isinstance(value, bool) and (origin is float or value == int(value)) else math.inf
    return 0.0 if isinstance(origin, type) and isinstance(value, origin) else math.inf


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

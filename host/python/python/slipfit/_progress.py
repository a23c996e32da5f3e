"""How far a command is, shown on standard error."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable
from typing import Union

#: Called with what is done, how much of it, and of how much (None if that is not known). What it raises stops the command.
Tell = Callable[[str, int, Union[int, None]], object]
#: A function to call, or whether a line on standard error says how far the command is. None: if that is a terminal.
Progress = Union[Tell, bool, None]

#: Seconds before the line is shown, and between two changes of it.
FIRST, BETWEEN = 2.0, 0.25


class Line:
    """A line on standard error, shown once the work takes longer than two seconds."""

    def __init__(self) -> None:
        self._next = time.monotonic() + FIRST
        self._width = 0

    def __call__(self, what: str, done: int, of: int | None) -> None:
        """Shows how far the work is."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + BETWEEN
        text = f"{what} {done:,}" if of is None else f"{what} {done:,} of {of:,}"
        _print(f"\r{text:{self._width}}")
        self._width = len(text)

    def end(self) -> None:
        """Removes the line."""
        if self._width:
            _print(f"\r{'':{self._width}}\r")


def _print(text: str) -> None:
    """On standard error, which may be closed, or none."""
    if sys.stderr is not None:
        with contextlib.suppress(ValueError, OSError):
            print(text, end="", file=sys.stderr, flush=True)


def _is_terminal() -> bool:
    try:
        return bool(sys.stderr.isatty())
    # None, closed, or an object that only writes.
    except (AttributeError, ValueError):
        return False


def line(progress: Progress) -> Line | None:
    """The line that ``progress`` asks for."""
    asked = _is_terminal() if progress is None else progress is True
    return Line() if asked else None

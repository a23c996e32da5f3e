"""Exceptions of the module."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple


class Problem(NamedTuple):
    """A mistake in a scene."""

    #: What is wrong.
    message: str
    #: The scene file, or "command line" for an override.
    file: str
    #: Line, from 1 on.
    line: int
    #: Column in characters, from 1 on.
    column: int
    #: What is allowed there; may be empty.
    allowed: str


class SlipfitError(Exception):
    """Base of all exceptions of this module."""


class InputError(SlipfitError, ValueError):
    """An argument that is not allowed; exit code 2 of the command line."""


class SceneError(InputError):
    """A scene that cannot be read. Its message is that of the command line."""

    def __init__(self, message: str, problems: list[tuple[str, str, int, int, str]]) -> None:
        super().__init__(message, problems)

    @property
    def problems(self) -> list[Problem]:
        """All mistakes, in the order of the text."""
        return [Problem(*problem) for problem in self.args[1]]

    def __str__(self) -> str:
        return str(self.args[0])

    @property
    def file(self) -> str:
        """File of the first mistake."""
        return self.problems[0].file

    @property
    def line(self) -> int:
        """Line of the first mistake, from 1 on."""
        return self.problems[0].line

    @property
    def column(self) -> int:
        """Column of the first mistake, in characters, from 1 on."""
        return self.problems[0].column

    @property
    def allowed(self) -> str:
        """What is allowed at the first mistake."""
        return self.problems[0].allowed


class WorkError(SlipfitError, RuntimeError):
    """Valid input without a result, such as a full disk; exit code 1 of the command line."""


def reword(error: SlipfitError, change: Callable[[str], str]) -> None:
    """Changes all texts of an error."""

    def changed(value: Any) -> Any:
        if isinstance(value, str):
            return change(value)
        return type(value)(map(changed, value)) if isinstance(value, (list, tuple)) else value

    error.args = changed(error.args)

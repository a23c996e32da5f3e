"""Tolerance analysis and dynamics of mechanisms with play.

>>> import slipfit
>>> scene = slipfit.Scene("cd-rom-slide")
>>> scene.simulate(n=2.5, stroke=True).verdict
'runs'

Functions that take long have the keyword ``progress``: a function that is called with what is done, how much, and of how much; or whether a
line on standard error shows it. Without it a line is shown where standard error is a terminal.
"""

from slipfit import results
from slipfit._commands import capability, merge
from slipfit._errors import InputError, Problem, SceneError, SlipfitError, WorkError
from slipfit._result import Result
from slipfit._scene import Scene, Watch, import_qif, schema
from slipfit._slipfit import Column, Columns, __version__, shipped

__all__ = [
    "Column",
    "Columns",
    "InputError",
    "Problem",
    "Result",
    "Scene",
    "SceneError",
    "SlipfitError",
    "Watch",
    "WorkError",
    "__version__",
    "capability",
    "import_qif",
    "merge",
    "results",
    "schema",
    "shipped",
]

"""Tolerance analysis and dynamics of mechanisms with play.

>>> import slipfit
>>> scene = slipfit.Scene("cd-rom-slide")
>>> scene.simulate(n=2.5).verdict
'runs'
"""

from slipfit._errors import InputError, Problem, SceneError, SlipfitError, WorkError
from slipfit._result import Result
from slipfit._scene import Scene, capability, import_qif, merge, schema
from slipfit._slipfit import Column, __version__, shipped

__all__ = [
    "Column",
    "InputError",
    "Problem",
    "Result",
    "Scene",
    "SceneError",
    "SlipfitError",
    "WorkError",
    "__version__",
    "capability",
    "import_qif",
    "merge",
    "schema",
    "shipped",
]

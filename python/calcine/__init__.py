"""Calcine from Python: cases, runs that are stepped and changed, and results.

Units are SI throughout. Times are process time in s unless a name begins with ``motion_``.
"""

from ._calcine import (
    CalcineError,
    CaseError,
    DivergedError,
    Gas,
    RunInterruptedError,
    Mesh,
    Particles,
    Simulation,
    SolverError,
)
from .case import Case
from .results import Results

__all__ = [
    "CalcineError",
    "Case",
    "CaseError",
    "DivergedError",
    "Gas",
    "RunInterruptedError",
    "Mesh",
    "Particles",
    "Results",
    "Simulation",
    "SolverError",
]

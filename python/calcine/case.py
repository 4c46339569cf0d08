"""A case file with changed keys."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from . import _calcine
from .results import Results


@dataclass(frozen=True)
class Case:
    """A case file and the keys that are changed in it. It is never written; each change gives a new ``Case``."""

    path: Path
    changes: tuple[str, ...] = ()

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Case:
        """A case file. It is read when the case is checked or run."""
        return cls(Path(path))

    def set(self, key: str, value: object) -> Case:
        """Changes a key, as ``--set KEY=VALUE`` of the command line does.

        Values with a unit are text, for example ``set("time.end", "10 s")``.
        """
        return replace(self, changes=(*self.changes, f"{key}={_written(value)}"))

    def check(self, *, gas: str = "native", particles: str = "native") -> str:
        """Checks the case as a run would and tells its clocks, sizes and flow.

        Raises ``CaseError`` with all errors at once.
        """
        return _calcine.check(self.path, list(self.changes), gas, particles)

    def start(
        self,
        out: str | os.PathLike[str] | None = None,
        *,
        resume: bool = False,
        origin: str | os.PathLike[str] | None = None,
        gas: str = "native",
        particles: str = "native",
    ) -> _calcine.Simulation:
        """Starts the solvers and stands before the first window.

        out: the results folder; ``results/NAME`` below the working directory unless given.
        resume: goes on from the last checkpoint in ``out``.
        origin: results folder of another run to continue from (``--from`` of the command line).
        gas: ``native``, ``openfoam`` or ``external``; particles: ``native``, ``liggghts``, ``openfoam`` or
        ``external``.
        """
        return _calcine.start(
            self.path, list(self.changes), gas, particles, out, resume, origin
        )

    def run(
        self,
        out: str | os.PathLike[str] | None = None,
        *,
        progress: Callable[[float, float], object] | None = None,
        resume: bool = False,
        origin: str | os.PathLike[str] | None = None,
        gas: str = "native",
        particles: str = "native",
    ) -> Results:
        """Runs the case to its end and opens its results.

        ``progress(time, end)`` is called after each window, both in s of process time. Ctrl-C leaves a checkpoint
        and raises ``KeyboardInterrupt``; the other arguments are those of ``start``.
        """
        simulation = self.start(
            out, resume=resume, origin=origin, gas=gas, particles=particles
        )
        try:
            simulation.run(progress)
            return Results(simulation.folder)
        finally:
            simulation.close()


def _written(value: object) -> str:
    """A value as the command line takes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_element(one) for one in value) + "]"
    return str(value)


def _element(value: object) -> str:
    quoted = isinstance(value, str)
    return '"' + value + '"' if quoted else _written(value)

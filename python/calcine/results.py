"""Results folders as xarray and pandas.

h5py, pandas and xarray are imported where results are read, so that a run starts without them.
"""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._calcine import CaseError, report

if TYPE_CHECKING:
    import h5py
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes


class Results:
    """The results folder of a run, of a finished one or one that goes on.

    Nothing is kept open: each call reads what is there now.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        if not (self.folder / "summary.json").is_file():
            raise CaseError(
                f"{self.folder} is not the results folder of a run: it has no summary.json"
            )

    def __repr__(self) -> str:
        return f"Results({str(self.folder)!r})"

    @property
    def summary(self) -> dict[str, Any]:
        """``summary.json``: what was run and what came out."""
        return json.loads((self.folder / "summary.json").read_text(encoding="utf-8"))

    def report(self) -> Path:
        """Writes the page ``report.html`` of the run, as ``calcine report`` does, and gives its path."""
        return report(self.folder)

    def quantity(self, name: str) -> float:
        """The value of a quantity of the case at the end, in the unit of ``summary['quantities']``."""
        return self.summary["quantities"][name]["value"]

    def series(self) -> pd.DataFrame:
        """``series.csv``, a row each ``output.series_every``; the index is the process time in s.

        Columns have the names of the file without units, which are in ``attrs["units"]``.
        """
        import pandas as pd

        text = (self.folder / "series.csv").read_text(encoding="utf-8")
        # A run that goes on, or was killed, may have written part of a line.
        head, *rows = csv.reader(text[: text.rfind("\n") + 1].splitlines())
        heads = [one.removesuffix("]").rsplit(" [", 1) for one in head]
        values = [[float(value) for value in row] for row in rows]
        table = pd.DataFrame(values, columns=[name for name, _ in heads], dtype=float)
        table = table.set_index("process_time")
        table.attrs["units"] = dict(heads)
        return table

    def series_xarray(self) -> xr.Dataset:
        """The same as xarray, with the dimension ``process_time`` (s) and the unit of each variable in its attributes."""
        table = self.series()
        series = table.to_xarray()
        for name, unit in table.attrs["units"].items():
            series[name].attrs["units"] = unit
        return series

    def fields(self) -> xr.Dataset:
        """Gas fields of all snapshots over ``process_time`` (s) and ``cell``, with the centres (m) and volumes (m³) of cells."""
        import xarray as xr

        with self._store() as store:
            snapshots = [store["snapshots"][key] for key in sorted(store["snapshots"])]
            times = [float(one.attrs["process_time"]) for one in snapshots]
            time = ("process_time", times, {"units": "s"})
            fields = xr.Dataset(coords={"process_time": time, **self._cells(store["mesh"])})
            for name, first in snapshots[0]["gas"].items() if snapshots else ():
                values = np.stack([one["gas"][name][()] for one in snapshots])
                dims = ("process_time", "cell", "component")[: values.ndim]
                fields[name] = (dims, values, _described(first))
        return fields

    def particles(self, snapshot: int = -1) -> pd.DataFrame:
        """The particles of a snapshot (the last unless told); the index is the id.

        Vectors are columns such as ``position.x``. ``attrs`` has ``units`` and ``process_time`` (s).
        """
        import pandas as pd

        with self._store() as store:
            group = store["snapshots"][sorted(store["snapshots"])[snapshot]]
            columns, units = {}, {}
            for name, field in group["particles"].items():
                values, unit = field[()], _described(field)["units"]
                if values.ndim == 1:
                    parts = {name: values}
                else:
                    # Vectors by components, values inside particles by number.
                    marks = "xyz" if _is_vector(name, values) else range(values.shape[1])
                    parts = {f"{name}.{mark}": values[:, at] for at, mark in enumerate(marks)}
                columns |= parts
                units |= dict.fromkeys(parts, unit)
            table = pd.DataFrame(columns).set_index("id")
            table.attrs["units"] = units
            table.attrs["process_time"] = float(group.attrs["process_time"])
        return table

    def means(self) -> xr.Dataset:
        """Means over time (``output.means``) over ``cell``: ``FIELD_mean`` and ``FIELD_rms``, the fluctuation about the mean.

        ``attrs`` has the interval ``from`` and ``to``, and how much of it was ``averaged`` (s). Those of particles are NaN in cells that
        held none.
        """
        import xarray as xr

        with self._store() as store:
            if "means" not in store:
                raise CaseError(
                    f"{self.folder} has no means: name fields in `output.means` of the case; they are written when its interval is over"
                )
            group = store["means"]
            means = xr.Dataset(coords=self._cells(store["mesh"]))
            for name, field in group.items():
                values = field[()]
                means[name] = (("cell", "component")[: values.ndim], values, _described(field))
            means.attrs |= {name: float(group.attrs[name]) for name in ("from", "to", "averaged")}
        return means

    def plot_series(self, *names: str, axes: Axes | None = None) -> Axes:
        """Draws columns of the series over process time with matplotlib."""
        import matplotlib.pyplot as plt

        table = self.series()
        axes = axes or plt.subplots(layout="constrained")[1]
        for name in names:
            axes.plot(table.index, table[name], label=name)
        units = dict.fromkeys(table.attrs["units"][name] for name in names)
        what = f"{names[0]} " if len(names) == 1 else ""
        axes.set_xlabel("process time [s]")
        axes.set_ylabel(what + ", ".join(f"[{unit}]" for unit in units))
        axes.legend()
        return axes

    def plot_profile(
        self, name: str, *, along: str = "z", snapshot: int = -1, axes: Axes | None = None
    ) -> Axes:
        """Draws the mean of a scalar gas field of a snapshot over a coordinate (``x``, ``y`` or ``z``) with matplotlib.

        Means are by volume over the cells of one coordinate, or over 50 layers where cells do not stand in layers.
        """
        import matplotlib.pyplot as plt

        field = self.fields()[name].isel(process_time=snapshot)
        axes = axes or plt.subplots(layout="constrained")[1]
        place, mean = _layers(field[along].values, field.values, field["cell_volume"].values)
        axes.plot(place, mean, ".-", label=f"{float(field.process_time):g} s")
        axes.set_xlabel(f"{along} [m]")
        axes.set_ylabel(f"{name} [{field.attrs['units']}]")
        axes.legend()
        return axes

    def pyvista(self, snapshot: int = -1) -> tuple[Any, Any]:
        """Gas and particles of a snapshot as PyVista meshes; needs the package ``pyvista``."""
        import pyvista

        def read(name: str) -> Any:
            reader = pyvista.get_reader(str(self.folder / name))
            reader.set_active_time_value(reader.time_values[snapshot])
            return reader.read()[0]

        return read("gas.pvd"), read("particles.pvd")

    @staticmethod
    def _cells(mesh: h5py.Group) -> dict[str, Any]:
        """Coordinates of the cells, with their volumes, and of the components of vectors."""
        centre = mesh["cell_centre"][()]
        return {
            "component": ["x", "y", "z"],
            **{axis: ("cell", centre[:, at], {"units": "m"}) for at, axis in enumerate("xyz")},
            "cell_volume": ("cell", mesh["cell_volume"][()], {"units": "m^3"}),
        }

    def _store(self) -> h5py.File:
        import h5py

        path = self.folder / "results.h5"
        if not path.is_file():
            raise CaseError(f"{path} is not there: the run was made without HDF5")
        # A run that goes on is not disturbed.
        return h5py.File(path, "r", locking=False)


def _described(field: h5py.Dataset) -> dict[str, str]:
    def text(name: str) -> str:
        value = field.attrs[name]
        return value.decode() if isinstance(value, bytes) else str(value)

    return {"units": text("unit"), "long_name": text("description")}


def _is_vector(name: str, values: np.ndarray) -> bool:
    return values.shape[1] == 3 and name in {"position", "velocity", "force"}


def _layers(
    place: np.ndarray, values: np.ndarray, volume: np.ndarray, most: int = 50
) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates of layers of cells, and the means of values by volume over them."""
    span = np.ptp(place)
    # Cells of one layer, but for round-off.
    layer = np.round((place - place.min()) / (span or 1.0), 9)
    if len(np.unique(layer)) > max(most, len(place) // 2):
        layer = np.minimum((layer * most).astype(int), most - 1)
    _, layer = np.unique(layer, return_inverse=True)
    total = np.bincount(layer, volume)
    return np.bincount(layer, volume * place) / total, np.bincount(layer, volume * values) / total

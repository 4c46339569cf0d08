"""Reads the results of a run with VTK and h5py and prints what it found as JSON."""
import json, math, sys
import xml.etree.ElementTree as tree
import h5py, numpy, vtk
from vtk.util.numpy_support import vtk_to_numpy

folder = sys.argv[1]


def paraview(kind, reader, stored):
    """Snapshots of one collection; `stored` are the same snapshots in results.h5."""
    snapshots = []
    for number, entry in enumerate(tree.parse(f"{folder}/{kind}.pvd").getroot().findall("Collection/DataSet")):
        reader.SetFileName(f"{folder}/{entry.get('file')}")
        reader.Update()
        grid = reader.GetOutput()
        data = grid.GetCellData() if kind == "gas" else grid.GetPointData()
        fields = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
        if kind == "particles":
            fields["position"] = vtk_to_numpy(grid.GetPoints().GetData())
        inside = stored[f"{number:04}/{kind}"]
        temperature = fields["temperature"]
        found = {
            "collection_time": float(entry.get("timestep")),
            "time": grid.GetFieldData().GetArray("TimeValue").GetValue(0),
            "stored_time": float(stored[f"{number:04}"].attrs["process_time"]),
            "points": grid.GetNumberOfPoints(),
            "cells": grid.GetNumberOfCells(),
            "fields": sorted(fields),
            "stored_fields": sorted(inside),
            "differing": [name for name in inside if not numpy.array_equal(inside[name][:], fields.get(name))],
            "min": float(temperature.min()),
            "max": float(temperature.max()),
            "mean": math.fsum(temperature) / len(temperature),
        }
        if kind == "gas":
            sizes = vtk.vtkCellSizeFilter()
            sizes.SetInputData(grid)
            sizes.Update()
            volumes = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
            found["volume_error"] = float(abs(volumes / results["mesh/cell_volume"][:] - 1).max())
        snapshots.append(found)
    return snapshots


with h5py.File(f"{folder}/results.h5") as results:
    datasets, series = [], {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            unit, text = item.attrs.get("unit"), item.attrs.get("description")
            datasets.append({"name": name, "unit": unit, "description": text})
            if name.startswith("series/"):
                # Hexadecimal, so that every bit arrives.
                values = [float(value).hex() for value in item[:]]
                series[name[7:].replace("/", ".")] = {"unit": unit, "values": values}

    results.visititems(visit)
    print(json.dumps({
        "case": results.attrs["case"],
        "hash": results.attrs["case_hash"],
        "datasets": datasets,
        "series": series,
        "gas": paraview("gas", vtk.vtkXMLUnstructuredGridReader(), results["snapshots"]),
        "particles": paraview("particles", vtk.vtkXMLPolyDataReader(), results["snapshots"]),
        "volume": math.fsum(results["mesh/cell_volume"][:]),
    }))

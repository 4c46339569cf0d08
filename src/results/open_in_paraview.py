"""Opens this run in ParaView: particles as spheres, the gas as a slice through its middle, all snapshots.

paraview --script=open_in_paraview.py
pvpython open_in_paraview.py PICTURE.png     (the last snapshot, without a window)
"""

import os
import sys

from paraview import simple

# ParaView does not tell a script its file in every way of starting it: the working directory then.
FOLDER = os.path.dirname(os.path.abspath(globals().get("__file__", "open_in_paraview.py")))


def show(view):
    """Adds the slice of the gas and the particles to a view; gives those that are coloured."""
    gas = simple.PVDReader(FileName=os.path.join(FOLDER, "gas.pvd"))
    gas.UpdatePipeline()
    low, high = gas.GetDataInformation().GetBounds()[0::2], gas.GetDataInformation().GetBounds()[1::2]
    cut = simple.Slice(Input=gas)
    cut.SliceType.Origin = [0.5 * (a + b) for a, b in zip(low, high)]
    cut.SliceType.Normal = [0.0, 1.0, 0.0]
    middle = simple.Show(cut, view)
    shown = [colour(middle, gas.CellData, "CELLS", view)]
    if shown[0] is None:
        # A gas without fields, as of a bed without gas: the box of its mesh alone.
        simple.Hide(cut, view)
        simple.Show(simple.Outline(Input=gas), view)
    rows = os.path.join(FOLDER, "particles.pvd")
    if os.path.exists(rows):
        particles = simple.PVDReader(FileName=rows)
        particles.UpdatePipeline()
        spheres = simple.Glyph(Input=particles, GlyphType="Sphere")
        spheres.GlyphMode = "All Points"
        spheres.OrientationArray = ["POINTS", "No orientation array"]
        spheres.ScaleArray = ["POINTS", "radius"]
        # The sphere of a glyph has a diameter of one.
        spheres.ScaleFactor = 2.0
        shown.append(colour(simple.Show(spheres, view), particles.PointData, "POINTS", view))
    return [one for one in shown if one is not None]


def colour(shown, fields, kind, view):
    """Colours by the temperature, else by the velocity, where there are."""
    for name in ("temperature", "velocity"):
        if fields.GetArray(name) is not None:
            simple.ColorBy(shown, (kind, name))
            shown.SetScalarBarVisibility(view, True)
            bar = simple.GetScalarBar(simple.GetColorTransferFunction(name), view)
            bar.RangeLabelFormat = "%.4g"
            bar.LabelFormat = "%.4g"
            return shown
    return None


def main():
    view = simple.GetActiveViewOrCreate("RenderView")
    shown = show(view)
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    # One scale for gas and particles, from the first snapshot to the last.
    scene.GoToFirst()
    for number, one in enumerate(shown):
        one.RescaleTransferFunctionToDataRange(number > 0)
    scene.GoToLast()
    for one in shown:
        one.RescaleTransferFunctionToDataRange(True)
    # Along y, with z upwards, as the pictures of the report.
    picture = len(sys.argv) > 1 and sys.argv[1].endswith(".png")
    if picture:
        view.ViewSize = [1000, 1000]
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0, -1, 0], [0, 0, 0], [0, 0, 1]
    simple.ResetCamera(view)
    simple.Render(view)
    if picture:
        simple.SaveScreenshot(sys.argv[1], view)


main()

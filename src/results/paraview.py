"""Opens this run in ParaView: particles as spheres, the gas as a slice through its middle, all snapshots.

paraview --script=paraview.py
pvpython paraview.py PICTURE.png     (the last snapshot, without a window)
"""

import os
import sys

from paraview import simple

# ParaView does not tell a script its file in every way of starting it: the working directory then.
FOLDER = os.path.dirname(os.path.abspath(globals().get("__file__", "paraview.py")))


def show(view):
    """Adds the slice of the gas and the particles to a view."""
    gas = simple.PVDReader(FileName=os.path.join(FOLDER, "gas.pvd"))
    gas.UpdatePipeline()
    low, high = gas.GetDataInformation().GetBounds()[0::2], gas.GetDataInformation().GetBounds()[1::2]
    cut = simple.Slice(Input=gas)
    cut.SliceType.Origin = [0.5 * (a + b) for a, b in zip(low, high)]
    cut.SliceType.Normal = [0.0, 1.0, 0.0]
    colour(simple.Show(cut, view), gas.CellData, "CELLS", view)
    rows = os.path.join(FOLDER, "particles.pvd")
    if not os.path.exists(rows):
        return
    particles = simple.PVDReader(FileName=rows)
    particles.UpdatePipeline()
    spheres = simple.Glyph(Input=particles, GlyphType="Sphere")
    spheres.GlyphMode = "All Points"
    spheres.OrientationArray = ["POINTS", "No orientation array"]
    spheres.ScaleArray = ["POINTS", "radius"]
    # The sphere of a glyph has a diameter of one.
    spheres.ScaleFactor = 2.0
    colour(simple.Show(spheres, view), particles.PointData, "POINTS", view)


def colour(shown, fields, kind, view):
    """Colours by the temperature, else by the velocity, where there are."""
    for name in ("temperature", "velocity"):
        if fields.GetArray(name) is not None:
            simple.ColorBy(shown, (kind, name))
            shown.SetScalarBarVisibility(view, True)
            return


def main():
    view = simple.GetActiveViewOrCreate("RenderView")
    show(view)
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()
    # Along y, with z upwards, as the pictures of the report.
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0, -1, 0], [0, 0, 0], [0, 0, 1]
    simple.ResetCamera(view)
    simple.Render(view)
    if len(sys.argv) > 1 and sys.argv[1].endswith(".png"):
        simple.SaveScreenshot(sys.argv[1], view)


main()

#!/usr/bin/python3
"""How long VTK's volume mappers take for the picture that `octascope bench display` times.

The same volume, views, window, opacity and step; one JSON object on stdout. Needs the Debian
packages python3-vtk9 and xvfb; not part of the tests.

  octascope bench display --json --dump shots > ours.json
  xvfb-run tests/figures/vtk_volume.py --volume shots/volume.nrrd --window=-10,23 > vtk.json

The window is what the former says ("window_db").
"""

import argparse
import json
import math
import pathlib
import statistics
import sys
import time

import numpy
import vtk
from vtk.util import numpy_support

FIELD_OF_VIEW_DEG = 36  # ui/view/camera.h
LOWEST_LEVEL_DB, LEVEL_STEP_DB = -40.0, 0.5  # pipeline/volume/level_scale.h
BLANK_DEPTH_BINS = 2  # pipeline/volume/volume_geometry.h
REFERENCE_STEPS_PER_DIAGONAL = 192  # ui/view/plane_box.cpp


def read_volume(path):
    """Levels [b][a][z] and spacings (depth, fast, slow) in mm."""
    content = pathlib.Path(path).read_bytes()
    end = content.index(b"\n\n") + 2
    fields = {}
    for line in content[:end].decode().splitlines():
        key, separator, value = line.partition(": ")
        if separator:
            fields[key] = value
    sizes = [int(size) for size in fields["sizes"].split()]
    directions = fields["space directions"].strip("()").split(") (")
    spacings = [math.hypot(*map(float, direction.split(","))) for direction in directions]
    if fields["type"] not in ("uint8", "unsigned char", "uchar"):
        sys.exit(f"{path}: type is {fields['type']}, expected uint8")
    levels = numpy.frombuffer(content, numpy.uint8, math.prod(sizes), end)
    return levels.reshape(sizes[::-1]).copy(), spacings


def make_image(levels, spacings):
    levels[:, :, :BLANK_DEPTH_BINS] = 0
    image = vtk.vtkImageData()
    image.SetDimensions(*levels.shape[::-1])
    image.SetSpacing(*spacings)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(levels.ravel(), deep=True))
    return image


def make_property(window, opacity, unit_mm):
    first = (window[0] - LOWEST_LEVEL_DB) / LEVEL_STEP_DB
    last = first + window[1] / LEVEL_STEP_DB
    opacities, greys = vtk.vtkPiecewiseFunction(), vtk.vtkPiecewiseFunction()
    opacities.AddPoint(first, 0)
    opacities.AddPoint(last, opacity)
    greys.AddPoint(first, 0)
    greys.AddPoint(last, 1)
    look = vtk.vtkVolumeProperty()
    look.SetScalarOpacity(opacities)
    look.SetColor(greys)
    look.SetInterpolationTypeToLinear()
    look.SetScalarOpacityUnitDistance(unit_mm)
    look.ShadeOff()
    return look


def make_mapper(kind, image, step_mm):
    mapper = {"gpu": vtk.vtkGPUVolumeRayCastMapper, "cpu": vtk.vtkFixedPointVolumeRayCastMapper}[
        kind]()
    mapper.SetInputData(image)
    mapper.SetBlendModeToComposite()
    mapper.SetAutoAdjustSampleDistances(False)
    if kind == "gpu":
        mapper.SetUseJittering(False)
        mapper.SetMaxMemoryInBytes(1 << 30)
        mapper.SetMaxMemoryFraction(1.0)
    mapper.SetImageSampleDistance(1)
    mapper.SetSampleDistance(step_mm)
    return mapper


def place_camera(camera, extents, yaw_deg, tilt_deg, distance):
    """ui/view/camera.h: x fast, y against the depth, z slow; here the axes are depth, fast, slow."""
    yaw, tilt = math.radians(yaw_deg), math.radians(tilt_deg)
    radius = math.hypot(*extents) / 2 * distance
    eye = [radius * math.sin(yaw) * math.cos(tilt), radius * math.sin(tilt),
           radius * math.cos(yaw) * math.cos(tilt)]
    centre = [extent / 2 for extent in extents]
    camera.SetFocalPoint(*centre)
    camera.SetPosition(centre[0] - eye[1], centre[1] + eye[0], centre[2] + eye[2])
    camera.SetViewUp(-1, 0, 0)
    camera.SetViewAngle(FIELD_OF_VIEW_DEG)


def time_mapper(kind, arguments, levels, spacings, opacity):
    extents = [size * spacing for size, spacing in zip(levels.shape[::-1], spacings)]
    image = make_image(levels, spacings)
    step_mm = max(extents) / arguments.steps
    volume = vtk.vtkVolume()
    volume.SetMapper(make_mapper(kind, image, step_mm))
    volume.SetProperty(
        make_property(arguments.window, opacity, math.hypot(*extents) / REFERENCE_STEPS_PER_DIAGONAL))
    renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetSize(*arguments.size)
    window.AddRenderer(renderer)
    renderer.AddVolume(volume)
    times = []
    for turn in range(-1, 8 * arguments.repeats):
        place_camera(renderer.GetActiveCamera(), extents, arguments.yaw + 45 * turn, arguments.tilt,
                     arguments.distance)
        renderer.ResetCameraClippingRange()
        start = time.perf_counter()
        window.Render()
        window.WaitForCompletion()
        if turn >= 0:
            times.append(1e3 * (time.perf_counter() - start))
    if arguments.dump:
        grab = vtk.vtkWindowToImageFilter()
        grab.SetInput(window)
        writer = vtk.vtkPNGWriter()
        writer.SetFileName(f"{arguments.dump}/vtk_{kind}_{opacity}.png")
        writer.SetInputConnection(grab.GetOutputPort())
        writer.Write()
    return {"mapper": kind, "opacity": opacity, "step": f"1/{arguments.steps}",
            "size": "{}x{}".format(*arguments.size), "ms_p50": round(statistics.median(times), 1),
            "ms_p95": round(sorted(times)[int(0.95 * (len(times) - 1))], 1)}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    numbers = lambda separator, kind: lambda text: [kind(part) for part in text.split(separator)]
    parser.add_argument("--volume", required=True)
    parser.add_argument("--size", type=numbers("x", int), default=[1280, 720])
    parser.add_argument("--window", type=numbers(",", float), required=True, help="offset,size in dB")
    parser.add_argument("--steps", type=int, default=512)
    parser.add_argument("--yaw", type=float, default=35)
    parser.add_argument("--tilt", type=float, default=35)
    parser.add_argument("--distance", type=float, default=2.4)
    parser.add_argument("--repeats", type=int, default=1, help="of the eight angles")
    parser.add_argument("--mappers", type=numbers(",", str), default=["cpu", "gpu"])
    parser.add_argument("--dump", help="folder for pictures")
    arguments = parser.parse_args()
    levels, spacings = read_volume(arguments.volume)
    cases = [time_mapper(kind, arguments, levels, spacings, opacity)
             for kind in arguments.mappers for opacity in (0.5, 0.03)]
    print(json.dumps({"vtk": vtk.vtkVersion().GetVTKVersion(), "cases": cases}, indent=2))


main()

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws an elevation surface as a block diagram.

Parallel projection, so that one scale bar holds everywhere. The light comes from the upper left,
as on maps, or relief would be seen inside out. Coordinates are shifted to the surface's middle
before rendering: graphics cards work with 24 bits, which is too few for map coordinates.
"""

import contextlib
import ctypes
import math
import os
import sys

import numpy
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (the window)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkColorTransferFunction,
    vtkLight,
    vtkMapper,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)

from ..clouds import cells_of, coordinates_of, id_lists, triangles_of
from .display import screen, why_no_server
from ..exaggeration import choose_exaggeration, nice_number
from ..first_view import BEARING, ERROR, FILLED, HEIGHT, LAND, OPEN, SEA
from ..messages import PictureError
from ..passes import corner_flags
from .signs import (
    BOTTOM,
    INK,
    LEFT,
    RIGHT,
    TOP,
    WIDTH,
    add_frame,
    add_map_signs,
    add_scalar_bar,
    exaggeration_words,
    poly_data,
    round_text,
)
from .screen_mesh import Cells, mesh_for_screen

WALL = (0.66, 0.63, 0.59)

MOST_TRIANGLES = 500_000  # of more, no more are drawn than the picture can show
CELL_PIXELS = 2.0
MOST_SAMPLES = 1_000_000


OPEN_WINDOWS = []


def open_window():
    """A window that the end of screen_for() closes."""
    window = vtkRenderWindow()
    OPEN_WINDOWS.append(window)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    return window


@contextlib.contextmanager
def screen_for(path):
    """A screen to draw a picture on, while the context lasts. Raises PictureError."""
    with screen() as reason:
        refuse(path, reason or why_no_picture())
        try:
            yield
        finally:
            # Before the screen goes: a window without one ends the program.
            while OPEN_WINDOWS:
                OPEN_WINDOWS.pop().Finalize()


def check_screen(path):
    """Raises PictureError where it is certain, before any work, that no picture can be drawn."""
    refuse(path, why_no_picture() if os.environ.get("DISPLAY") else why_no_server())


def refuse(path, reason):
    if reason:
        raise PictureError(path, reason + "; Utilities/reconstruct sets everything up")


def why_no_picture():
    """Why no window can be opened here, or None. VTK itself would end the program."""
    if not sys.platform.startswith("linux"):
        return None
    if not os.environ.get("DISPLAY"):
        return "there is no display (DISPLAY is not set)"
    try:
        x11 = ctypes.CDLL("libX11.so.6")
    except OSError:
        return None
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    display = x11.XOpenDisplay(None)
    if not display:
        return f"the display {os.environ['DISPLAY']} does not answer"
    x11.XCloseDisplay(display)
    return None


def why_not_drawn(x, y, z):
    """Why a surface of such points cannot be drawn, or None."""
    low, high = numpy.array([(column.min(), column.max()) for column in (x, y, z)]).T
    if max(abs(low).max(), abs(high).max()) > 1e30:
        return "coordinates beyond 1e30 are too large for it"
    if min(high[:2] - low[:2]) < 1e-30:
        return "the surface is smaller than 1e-30, too small for it"
    return None


def columns(points, used):
    """(x and y, z) of the used points."""
    points = points if used.all() else points[used]
    return points[:, :2].T.astype("f8", copy=False), numpy.ascontiguousarray(points[:, 2], dtype="f8")


def common_range(z):
    """(lowest, highest) elevation to show, and whether elevations beyond it are cut.

    A few outliers would leave one colour, and a flat line, for everything else. So 0.5 % at both ends
    are left out where that makes the range less than a third.
    """
    low, high = float(z.min()), float(z.max())
    a, b = (float(value) for value in numpy.percentile(z, (0.5, 99.5)))
    if b > a and high - low > 3.0 * (b - a):
        return a, b, True
    return low, high, False


def choose_stretch(xy):
    """(direction across the surface, factor to widen it by): 1, but for narrow strips."""
    _, vectors = numpy.linalg.eigh(numpy.cov((xy - xy.mean(axis=0)).T))
    across, along = numpy.ptp(xy @ vectors, axis=0)
    ratio = along / max(across, 1e-6 * along)
    return vectors[:, 0], nice_number(ratio / 10.0) if ratio > 30.0 else 1.0


def choose_bearing(xy):
    """Compass bearing in degrees from the surface to the eye.

    The longer side runs across the picture, and the eye stands to the south if it can: then the
    north is at the back, as on a map.
    """
    values, vectors = numpy.linalg.eigh(numpy.cov((xy - xy.mean(axis=0)).T))
    ratio = math.sqrt(max(values[1], 1e-300) / max(values[0], 1e-300))
    if ratio < 1.7:
        return BEARING
    short = vectors[:, 0]
    if short[1] > 0:
        short = -short
    # Strips are seen straight from the side, for all of their length to be across.
    turn = 12.0 if ratio < 30.0 else 0.0
    return (math.degrees(math.atan2(short[0], short[1])) + 360.0 + turn) % 360.0


def colour(text):
    return tuple(int(text[i : i + 2], 16) / 255.0 for i in (1, 3, 5))


def colour_map(low, high, stops=None):
    stops = stops or (SEA if high <= 0 and low < 0 else LAND)
    result = vtkColorTransferFunction()
    result.SetColorSpaceToLab()
    if high <= low:
        high = low + 1.0
    for i, stop in enumerate(stops):
        result.AddRGBPoint(low + (high - low) * i / (len(stops) - 1), *colour(stop))
    result.SetNanColor(*colour(OPEN))
    return result


def error_colours(errors):
    """The colours of standard errors: up to what 98 % of those above 0 are."""
    known = errors[numpy.isfinite(errors) & (errors > 0.0)]
    return colour_map(0.0, float(numpy.percentile(known, 98)) if len(known) else 1.0, ERROR)


def segments(paths):
    """Paths as index arrays -> (n, 2) index pairs."""
    pairs = [numpy.column_stack((p[:-1], p[1:])) for p in paths if len(p) > 1]
    return numpy.concatenate(pairs) if pairs else numpy.empty((0, 2), dtype="i8")


class Frame:
    """Real coordinates -> picture coordinates: shifted to the middle, z cut to what is shown and
    exaggerated, narrow strips widened."""

    def __init__(self, middle, floor, exaggeration, cut, across, stretch):
        self.shift = numpy.array((middle[0], middle[1], floor))
        self.scale = numpy.array((1.0, 1.0, exaggeration))
        self.cut = cut
        self.widen = numpy.eye(2) + (stretch - 1.0) * numpy.outer(across, across)

    def __call__(self, points):
        points = points.copy()
        points[:, 2] = numpy.clip(points[:, 2], *self.cut)
        points = (points - self.shift) * self.scale
        points[:, :2] = points[:, :2] @ self.widen
        return points

    def points_in(self, data):
        return self(coordinates_of(data).astype("f8"))


def actor_of(data, rgb=None, width=0.0):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    if rgb:
        mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    if rgb:
        actor.GetProperty().SetColor(*rgb)
    if width:
        actor.GetProperty().SetLineWidth(width)
        actor.GetProperty().LightingOff()
        actor.GetProperty().SetRenderLinesAsTubes(False)
    return actor


def lines_actor(points, pairs, rgb, width, layer=0):
    data = poly_data(points, lines=cells_of(pairs))
    actor = actor_of(data, rgb, width)
    # Lines lie in the surface; drawn at equal depth they would flicker in and out of it. Much more
    # than this, and they would show through from behind.
    mapper = actor.GetMapper()
    # A higher layer lies above a lower one.
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0, -60.0 - 30.0 * layer)
    return actor


def walls_actor(points, pairs, floor):
    """Vertical walls from the surface's rim down to the floor."""
    top = points[pairs.ravel()]
    bottom = top.copy()
    bottom[:, 2] = floor
    n = len(top)
    first = numpy.arange(0, n, 2)
    quads = numpy.column_stack((first, first + 1, n + first + 1, n + first))
    actor = actor_of(poly_data(numpy.concatenate((top, bottom)), polys=cells_of(quads)), WALL)
    actor.GetProperty().SetInterpolationToFlat()
    actor.GetProperty().SetAmbient(0.60)
    actor.GetProperty().SetDiffuse(0.55)
    return actor


def patches_to_outline(surface):
    """Which triangles are patches, or None: where most are, outlines would hide the surface."""
    ids = surface.GetCellData().GetArray("HoleId")
    flags = None if ids is None else vtk_to_numpy(ids) >= 0
    return None if flags is None or 2 * numpy.count_nonzero(flags) > len(flags) else flags


def draw(surface, path, title, subtitle, holes=None, plane=None, **options):
    """Renders the surface into a PNG file; starts a virtual display where there is no screen.

    surface   vtkPolyData with triangles; with a cell array HoleId, patches are outlined, unless most
              triangles are patches
    holes     None, or the second output of vtkFillElevationHoles
    plane     None, or the Plane that the surface is drawn over; colours show how far off it lies
    view      None, or (bearing, height) of the eye in degrees; height 90 looks straight down
    exaggeration  None, or the factor for z
    progress      None, or a function that is called with the fraction done
    show_errors   colours show FilledError, a point array of vtkFillElevationHoles, not elevation
    Returns {"bearing", "height", "exaggeration"} as used. Raises PictureError. Takes about a second for
    100,000 triangles where a software renderer draws; of more than 500,000, only as many are drawn as
    the picture can show.
    """
    if plane:
        surface, holes = plane.levelled(surface), plane.levelled(holes) if holes else None
        subtitle += "   \u00b7   drawn over its best plane"
    with screen_for(path):
        return render(surface, path, title, subtitle, holes, plane is not None, **options)


def render(
    surface,
    path,
    title,
    subtitle,
    holes,
    is_in_plane,
    *,
    view=None,
    exaggeration=None,
    show_errors=False,
    progress=None,
):
    """draw() on a screen that is there."""
    progress = progress or (lambda fraction: None)
    real = coordinates_of(surface)
    triangles = triangles_of(surface)
    used = corner_flags(triangles, len(real))
    (x, y), z = columns(real, used)
    reason = why_not_drawn(x, y, z)
    if reason:
        raise PictureError(path, reason)
    low, high, is_cut = common_range(z)
    middle = 0.5 * numpy.array((x.min() + x.max(), y.min() + y.max()))
    few = slice(None, None, 1 + len(x) // MOST_SAMPLES)
    xy = numpy.column_stack((x[few], y[few]))
    del x, y, z
    across, stretch = choose_stretch(xy)
    bearing, height = view or (choose_bearing(xy - middle), HEIGHT)
    margin = 0.3 * (high - low) if is_cut else 0.0
    cut = (low - margin, high + margin) if is_cut else (-numpy.inf, numpy.inf)
    frame = Frame(middle, low, 1.0, cut, across, stretch)
    cells = None
    progress(0.1)
    if len(triangles) > MOST_TRIANGLES:
        cells = Cells(real, frame.widen, used, (WIDTH - LEFT - RIGHT) / CELL_PIXELS)
    mesh = mesh_for_screen(triangles, patches_to_outline(surface), cells)
    progress(0.5)
    real = real[mesh.ids].astype("f8")
    exaggeration = exaggeration or choose_exaggeration(frame(real), mesh.triangles)
    frame.scale[2] = exaggeration
    points = frame(real)

    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    colours = colour_map(low, high)

    data = poly_data(points, polys=cells_of(mesh.triangles))
    normals = vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SplittingOff()
    normals.ConsistencyOff()
    normals.Update()
    shaded = normals.GetOutput()
    shown = real[:, 2]
    if show_errors:
        shown = vtk_to_numpy(surface.GetPointData().GetArray("FilledError"))[mesh.ids]
        colours = error_colours(shown)
    scalars = numpy_to_vtk(numpy.ascontiguousarray(shown), deep=True)
    scalars.SetName("Shown")
    shaded.GetPointData().SetScalars(scalars)
    actor = actor_of(shaded)
    actor.GetMapper().SetLookupTable(colours)
    actor.GetMapper().InterpolateScalarsBeforeMappingOn()
    actor.GetMapper().SetScalarRange(*colours.GetRange())
    look = actor.GetProperty()
    look.SetInterpolationToPhong()
    look.SetAmbient(0.22)
    look.SetDiffuse(1.0)
    look.SetSpecular(0.0)
    renderer.AddActor(actor)
    vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()

    # The block: walls under every rim. Rims of holes that stay open get walls too, as pits.
    extent = numpy.ptp(points[:, :2], axis=0)
    floor = -0.05 * math.sqrt(max(float(numpy.prod(extent)), 1e-300)) - margin * exaggeration
    if height < 89.0:
        renderer.AddActor(walls_actor(points, mesh.rim, floor))
    renderer.AddActor(lines_actor(points, mesh.rim, INK, 2.5))
    legend = [("boundary", INK)]
    if len(mesh.patches):
        renderer.AddActor(lines_actor(points, mesh.patches, colour(FILLED), 2.0, 1))
        legend.append(("filled hole", colour(FILLED)))
    if holes is not None and holes.GetNumberOfLines():
        # 0: filled; 4: triangles that bridged it were replaced
        status = vtk_to_numpy(holes.GetCellData().GetArray("Status"))
        still_open = (status != 0) & (status != 4)
        pairs = segments([p for p, o in zip(id_lists(holes.GetLines()), still_open) if o])
        if len(pairs):
            renderer.AddActor(lines_actor(frame.points_in(holes), pairs, colour(OPEN), 3.5, 2))
            legend.append(("hole left open", colour(OPEN)))

    progress(0.7)
    window = place_camera(renderer, points, floor, bearing, height)
    scale = renderer.GetActiveCamera().GetParallelScale()
    width, tall = window.GetSize()
    add_lights(renderer, bearing)
    scales = [exaggeration_words(exaggeration)]
    if stretch != 1.0:
        scales.append(f"width drawn {round_text(stretch)}\u00d7")
    if is_cut:
        scales.append("outliers cut: colours of 99 % of the points")
    add_frame(renderer, width, tall, title, subtitle, legend, scales)
    title = "standard error" if show_errors else "off the plane" if is_in_plane else "elevation"
    add_scalar_bar(renderer, colours, title, width, tall)
    pixels = tall / (2.0 * scale)
    if stretch != 1.0:
        # The scale bar then holds along the strip.
        b = math.radians(bearing)
        pixels *= max(abs(across[0] * math.sin(b) + across[1] * math.cos(b)), 0.05)
    add_map_signs(
        renderer, width, pixels, bearing, height, frame.widen, "up" if is_in_plane else "N")

    save(window, path)
    return {"bearing": bearing, "height": height, "exaggeration": exaggeration}


def save(window, path):
    """Renders a window into a PNG file."""
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    grab.SetInputBufferTypeToRGB()
    grab.Update()
    writer = vtkPNGWriter()
    # In memory first: VTK's writer gives no reason where it cannot write.
    writer.WriteToMemoryOn()
    writer.SetInputData(grab.GetOutput())
    # A tenth larger than with the default of 5, in half of the time.
    writer.SetCompressionLevel(2)
    writer.Write()
    with open(path, "wb") as stream:
        stream.write(vtk_to_numpy(writer.GetResult()).tobytes())


def place_camera(renderer, points, floor, bearing, height):
    """Frames the block between the margins and opens a window as tall as it needs."""
    b, h = math.radians(bearing), math.radians(height)
    eye = numpy.array((math.sin(b) * math.cos(h), math.cos(b) * math.cos(h), math.sin(h)))
    up = numpy.array((-math.sin(b) * math.sin(h), -math.cos(b) * math.sin(h), math.cos(h)))
    right = numpy.cross(up, eye)
    low = points.copy()
    low[:, 2] = floor if height < 89.0 else low[:, 2]
    across = points @ right
    along = numpy.concatenate((points @ up, low @ up))
    span = max(float(numpy.ptp(across)), 1e-300), max(float(numpy.ptp(along)), 1e-300)
    room = WIDTH - LEFT - RIGHT
    tall = int(min(max(room * span[1] / span[0], 520.0), 1100.0)) + TOP + BOTTOM
    pixel = max(span[0] / room, span[1] / (tall - TOP - BOTTOM))
    # The middle of the block goes to the middle between the margins.
    focal = (0.5 * (across.min() + across.max()) + 0.5 * (RIGHT - LEFT) * pixel) * right + (
        0.5 * (along.min() + along.max()) + 0.5 * (TOP - BOTTOM) * pixel
    ) * up
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*focal)
    camera.SetPosition(*(focal + 4.0 * max(span) * eye))
    camera.SetViewUp(*up)
    camera.SetParallelScale(0.5 * tall * pixel)
    window = open_window()
    window.SetSize(WIDTH, tall)
    window.AddRenderer(renderer)
    renderer.ResetCameraClippingRange()
    return window


def add_lights(renderer, bearing):
    """A main light from the upper left of the picture, and two weak ones against black shadows."""
    renderer.RemoveAllLights()
    renderer.AutomaticLightCreationOff()
    for turn, height, strength in ((115.0, 40.0, 0.76), (10.0, 50.0, 0.16), (-70.0, 60.0, 0.14)):
        b, h = math.radians(bearing + turn), math.radians(height)
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPositional(False)
        light.SetFocalPoint(0.0, 0.0, 0.0)
        light.SetPosition(math.sin(b) * math.cos(h), math.cos(b) * math.cos(h), math.sin(h))
        light.SetIntensity(strength)
        renderer.AddLight(light)

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What stands around a drawn surface: title, legend, colour bar, scale bar, arrow to the north."""

import math
import re
import subprocess

import numpy
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (text)
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor2D, vtkCoordinate, vtkPolyDataMapper2D, vtkTextActor

from ..clouds import cells_of
from ..exaggeration import nice_number

INK = (0.13, 0.14, 0.16)
VTK_FONT_FILE = 4  # as in vtkTextProperty.h; not wrapped
WIDTH = 1800
TOP, BOTTOM, LEFT, RIGHT = 150, 120, 70, 230


def poly_data(points, polys=None, lines=None):
    data = vtkPolyData()
    holder = vtkPoints()
    holder.SetData(numpy_to_vtk(numpy.ascontiguousarray(points, dtype="f4"), deep=True))
    data.SetPoints(holder)
    if polys is not None:
        data.SetPolys(polys)
    if lines is not None:
        data.SetLines(lines)
    return data


def add_text(renderer, text, x, y, size, align="left", bold=False, rgb=INK):
    actor = vtkTextActor()
    actor.SetInput(text)
    look = actor.GetTextProperty()
    look.SetFontFamilyToArial()
    look.SetFontSize(size)
    look.SetColor(*rgb)
    look.SetBold(bold)
    {
        "left": look.SetJustificationToLeft,
        "right": look.SetJustificationToRight,
        "centre": look.SetJustificationToCentered,
    }[align]()
    actor.SetPosition(x, y)
    renderer.AddViewProp(actor)
    return actor


def missing_glyphs(text):
    """The characters that the built-in font may lack: it has Latin, Greek and Cyrillic letters."""
    return sorted({c for c in text if ord(c) > 0x04FF and c not in "\u2013\u2014\u2026\u00b7"})


def font_for(characters):
    """A font file of the system that has all these characters, or None."""
    codes = " ".join(f"{ord(c):x}" for c in characters)
    try:
        found = subprocess.run(
            ["fc-list", f":charset={codes}", "file"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            timeout=20,
            check=True,
        ).stdout.split("\n")
    except (OSError, subprocess.SubprocessError):
        return None
    names = sorted(line.strip().rstrip(":") for line in found)
    return next((n for n in names if n.lower().endswith((".ttf", ".otf", ".ttc"))), None)


def add_title(renderer, text, x, y, room):
    """The title, shortened in its middle to fit. Characters that no font has become an ellipsis."""
    font = None
    strange = missing_glyphs(text)
    if strange:
        font = font_for(strange)
        if font is None:
            text = re.sub("[" + re.escape("".join(strange)) + "]+", "\u2026", text)
    actor = add_text(renderer, text, x, y, 40, bold=True)
    if font:
        actor.GetTextProperty().SetFontFamily(VTK_FONT_FILE)
        actor.GetTextProperty().SetFontFile(font)

    def too_wide():
        box = [0.0] * 4
        actor.GetBoundingBox(renderer, box)
        return box[1] - box[0] > room

    keep = len(text)
    while too_wide() and keep > 8:
        keep -= 1 + keep // 40
        head = (keep + 1) // 2
        actor.SetInput(text[:head] + "\u2026" + text[len(text) - (keep - head) :])


def add_strokes(renderer, paths, rgb=INK, width=3.0):
    """Polylines in pixels over the picture."""
    points, rows = [], []
    for path in paths:
        for a, b in zip(path[:-1], path[1:]):
            rows.append((len(points), len(points) + 1))
            points += [(*a, 0.0), (*b, 0.0)]
    place = vtkCoordinate()
    place.SetCoordinateSystemToDisplay()
    mapper = vtkPolyDataMapper2D()
    mapper.SetInputData(poly_data(numpy.array(points), lines=cells_of(numpy.array(rows))))
    mapper.SetTransformCoordinate(place)
    actor = vtkActor2D()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*rgb)
    actor.GetProperty().SetLineWidth(width)
    renderer.AddViewProp(actor)


def round_text(value):
    """A number with no more digits than it needs, thousands set apart."""
    if value != 0 and (abs(value) < 1e-3 or abs(value) >= 1e7):
        return f"{value:.3g}"
    text = f"{value:,.4f}" if abs(value) < 10 else f"{value:,.1f}"
    return text.rstrip("0").rstrip(".")


def exaggeration_words(factor):
    if factor == 1.0:
        return "vertical scale as horizontal"
    if factor > 1.0:
        return f"vertical exaggeration {round_text(factor)}\u00d7"
    return f"z drawn {round_text(factor)}\u00d7"


def add_frame(renderer, width, tall, title, subtitle, legend, scales):
    add_title(renderer, title, LEFT, tall - 78, width - 2 * LEFT)
    add_text(renderer, subtitle, LEFT, tall - 120, 24, rgb=(0.35, 0.37, 0.40))
    x = LEFT
    for name, rgb in legend:
        add_strokes(renderer, [[(x, 50), (x + 44, 50)]], rgb, 4.0)
        label = add_text(renderer, name, x + 56, 42, 22)
        box = [0.0] * 4
        label.GetBoundingBox(renderer, box)
        x += 56 + box[1] - box[0] + 44
    # Several do not fit next to the legend: the others go above it.
    add_text(renderer, scales[0], x, 42, 22)
    if scales[1:]:
        add_text(renderer, "   \u00b7   ".join(scales[1:]), LEFT, 84, 22)


def add_scalar_bar(renderer, colours, title, width, tall):
    bar = vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle(title)
    low, high = colours.GetRange()
    step = nice_number((high - low) / 5.0, (1.0, 2.0, 5.0))
    ticks = numpy.arange(math.ceil(low / step), math.floor(high / step) + 1) * step
    bar.SetCustomLabels(numpy_to_vtk(ticks, deep=True))
    bar.UseCustomLabelsOn()
    bar.SetTextPad(8)
    bar.SetLabelFormat(f"%.{max(0, -math.floor(math.log10(step)))}f")
    bar.UnconstrainedFontSizeOn()
    for look, size in ((bar.GetTitleTextProperty(), 24), (bar.GetLabelTextProperty(), 22)):
        look.SetFontFamilyToArial()
        look.SetFontSize(size)
        look.SetColor(*INK)
        look.BoldOff()
        look.ItalicOff()
        look.ShadowOff()
    bar.SetVerticalTitleSeparation(14)
    place = bar.GetPositionCoordinate()
    place.SetCoordinateSystemToDisplay()
    length = min(460, tall - TOP - BOTTOM)
    middle = BOTTOM + 0.5 * (tall - TOP - BOTTOM)
    place.SetValue(width - RIGHT + 45, middle - 0.5 * length)
    size = bar.GetPosition2Coordinate()
    size.SetCoordinateSystemToDisplay()
    size.SetValue(150, length)
    bar.SetBarRatio(0.22)
    renderer.AddViewProp(bar)


def add_map_signs(renderer, width, pixels, bearing, height, widen, name):
    """A scale bar that holds across the picture, and an arrow towards +y with its name."""
    length = nice_number(0.13 * WIDTH / pixels, (1.0, 2.0, 5.0))
    right = width - RIGHT - 60
    left = right - length * pixels
    add_strokes(
        renderer,
        [[(left, 62), (left, 50), (right, 50), (right, 62)]],
    )
    add_text(renderer, round_text(length), 0.5 * (left + right), 66, 22, "centre")
    # +y as the camera sees it: turned by the bearing, foreshortened by the height of the eye.
    b, h = math.radians(bearing), math.radians(height)
    seen = numpy.array(
        ((-math.cos(b), math.sin(b)), (-math.sin(b) * math.sin(h), -math.cos(b) * math.sin(h)))
    )
    north = seen @ widen[:, 1]
    north /= max(1.0, float(numpy.linalg.norm(north)))
    east = numpy.array((north[1], -north[0])) if widen[0, 1] or widen[0, 0] != 1 else seen[:, 0]
    middle = numpy.array((width - RIGHT + 110.0, 62.0))
    tip, tail = middle + 34 * north, middle - 34 * north
    barbs = [tip - 15 * north + 9 * east, tip, tip - 15 * north - 9 * east]
    add_strokes(renderer, [[tail, tip], barbs])
    label = tip + 18 * north / max(float(numpy.linalg.norm(north)), 1e-6)
    add_text(renderer, name, label[0], label[1] - 9, 22, "centre", bold=True)

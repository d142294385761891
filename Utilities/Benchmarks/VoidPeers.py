# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fills voids for void-bench: a program of its own for each method.

    VoidPeers.py ours METHOD | vtk | gdal | gmt TENSION | rst | fillnulls

Speaks what void-bench expects of any method (VoidKriging.R and FillVoidsCGAL.cxx speak it, too):
first it writes the line "ready" to its output. Then it reads lines of two paths with a tab between
them, and answers each with a line: "done SECONDS" (of its processor, for filling alone), or "failed"
and why. Files hold little-endian doubles, row after row of a raster:

    first path    width, height, step of x, step of y; heights, NaN where there is none; and, for
                  each node, 1 where its height is asked for, else 0
    second path   heights, NaN where the method leaves them open; then it may write two more
                  rasters, the ends of an interval for each height
"""

import os
import subprocess
import sys
import tempfile
import time

import numpy

STANDARD_ERRORS = 2.0  # of the interval, where a method gives no interval of its own
OURS = ("NeighborMean", "Membrane", "ThinPlate", "CubicSpline", "Adaptive")
BLANK = 1.70141e38  # no value, in a Surfer grid


class Failed(Exception):
    """A void could not be filled."""


# ---- files --------------------------------------------------------------------------------------


def write_void(path, heights, lost, steps):
    header = numpy.array([heights.shape[1], heights.shape[0], *steps])
    numpy.concatenate((header, heights.ravel(), lost.ravel())).astype("<f8").tofile(path)


def read_void(path):
    """(heights, lost, steps)"""
    values = numpy.fromfile(path, "<f8")
    width, height = int(values[0]), int(values[1])
    heights, lost = values[4:].reshape(2, height, width)
    return heights.copy(), lost > 0, (values[2], values[3])


def write_filled(path, *rasters):
    numpy.concatenate([raster.ravel() for raster in rasters]).astype("<f8").tofile(path)


def read_filled(path, shape):
    """[heights], or [heights, lows, highs]"""
    rasters = numpy.fromfile(path, "<f8").reshape(-1, *shape)
    if len(rasters) not in (1, 3):
        raise Failed(f"{len(rasters)} rasters in the answer")
    return rasters


# ---- meshes -------------------------------------------------------------------------------------


def triangles_of(known):
    """Of a raster: two in each cell of four known nodes, one in a cell of three."""
    ids = numpy.arange(known.size).reshape(known.shape)
    a, b, c, d = ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]  # counter-clockwise
    ka, kb, kc, kd = known[:-1, :-1], known[:-1, 1:], known[1:, 1:], known[1:, :-1]
    has_all = ka & kb & kc & kd
    parts = ((has_all | (ka & kb & kc & ~kd), (a, b, c)), (has_all | (ka & kc & kd & ~kb), (a, c, d)),
             (ka & kb & kd & ~kc, (a, b, d)), (kb & kc & kd & ~ka, (b, c, d)))
    return numpy.concatenate(
        [numpy.column_stack([corner[where] for corner in corners]) for where, corners in parts])


def poly_data(heights, steps):
    """The mesh of a raster with gaps, and how many triangles it has."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    known = ~numpy.isnan(heights)
    triangles = triangles_of(known)
    used = numpy.unique(triangles)
    rows, columns = numpy.divmod(used, heights.shape[1])
    places = numpy.column_stack((columns * steps[0], rows * steps[1], heights.ravel()[used]))
    cells = numpy.full((len(triangles), 4), 3, numpy.int64)
    cells[:, 1:] = numpy.searchsorted(used, triangles)
    mesh = vtkPolyData()
    mesh.SetPoints(vtkPoints())
    mesh.GetPoints().SetData(numpy_to_vtk(places, deep=True))
    polys = vtkCellArray()
    polys.SetCells(len(triangles), numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
    mesh.SetPolys(polys)
    return mesh, len(triangles)


def patch_of(mesh, first):
    """(points, triangles) of a mesh from one triangle on."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype("f8")
    return points, vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)[first:]


def at_nodes(points, values, triangles, shape, steps):
    """Values of a patch at the nodes under it; NaN elsewhere."""
    from VoidDraw import draw_triangles

    nodes = numpy.column_stack((points[:, 0] / steps[0], points[:, 1] / steps[1], values))
    raster = numpy.full(shape, numpy.nan)
    draw_triangles(nodes, triangles, raster)
    return raster


# ---- methods ------------------------------------------------------------------------------------


def interval_of(data, heights):
    """(lows, highs) of the points of a filled surface; None where the filter makes none."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    ends = data.GetArray("FilledLow"), data.GetArray("FilledHigh")
    if None not in ends:
        return [vtk_to_numpy(end) for end in ends]
    errors = data.GetArray("FilledError")
    if errors is None:
        return None
    away = STANDARD_ERRORS * vtk_to_numpy(errors)
    return [heights - away, heights + away]


def fill_by_us(method):
    from vtkelevationsurface import vtkFillElevationHoles

    def fill(heights, lost, steps):
        fill = vtkFillElevationHoles()
        mesh, count = poly_data(heights, steps)
        fill.SetInputData(mesh)
        fill.SetNumberOfThreads(1)
        if method == "linear":
            fill.SetSpacing(1e300)
        else:
            getattr(fill, f"SetInterpolationTo{method}")()
        began = time.process_time()
        fill.Update()
        seconds = time.process_time() - began
        filled = fill.GetOutput()
        points, triangles = patch_of(filled, count)
        values = [points[:, 2]]
        if method != "linear":
            values += interval_of(filled.GetPointData(), points[:, 2]) or []
        rasters = [numpy.full(heights.shape, numpy.nan) for _ in values]
        new = points[mesh.GetNumberOfPoints():, :2] / steps  # on nodes, but for rounding
        nodes = numpy.rint(new).astype(int)
        hit = (numpy.abs(new - nodes) < 1e-3).all(axis=1)
        for raster, value in zip(rasters, values):
            raster[nodes[hit, 1], nodes[hit, 0]] = value[mesh.GetNumberOfPoints():][hit]
        if numpy.isnan(rasters[0][lost]).any():
            for raster, value in zip(rasters, values):
                between = at_nodes(points, value, triangles, heights.shape, steps)
                raster[:] = numpy.where(numpy.isnan(raster), between, raster)
        return seconds, rasters

    return fill


def fill_by_vtk(heights, lost, steps):
    """Loops up to a size are filled: a little above that of the rim, whose sphere VTK finds roughly."""
    from vtkmodules.vtkFiltersModeling import vtkFillHolesFilter

    rows, columns = numpy.nonzero(lost)
    box = slice(rows.min() - 1, rows.max() + 2), slice(columns.min() - 1, columns.max() + 2)
    around = heights[box]
    sides = ((around.shape[1] - 1) * steps[0], (around.shape[0] - 1) * steps[1],
             numpy.nanmax(around) - numpy.nanmin(around))
    fill = vtkFillHolesFilter()
    mesh, count = poly_data(heights, steps)
    fill.SetInputData(mesh)
    fill.SetHoleSize(0.7 * numpy.sqrt(numpy.square(sides).sum()))
    began = time.process_time()
    fill.Update()
    seconds = time.process_time() - began
    points, triangles = patch_of(fill.GetOutput(), count)
    return seconds, [at_nodes(points, points[:, 2], triangles, heights.shape, steps)]


def fill_by_gdal(heights, lost, steps):
    from GDALFill import fill

    began = time.process_time()
    filled = fill(heights)
    return time.process_time() - began, [filled]


def run(*command, cwd=None):
    """@return processor seconds"""
    before = os.times()
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, errors="replace", cwd=cwd, check=False)
    after = os.times()
    if done.returncode:
        lines = [line.strip() for line in done.stderr.splitlines() if line.strip()]
        raise Failed(lines[-1] if lines else f"{command[0]} ended with code {done.returncode}")
    return (after.children_user - before.children_user) + (after.children_system - before.children_system)


def around_void(lost, away):
    rows, columns = numpy.nonzero(lost)
    return (slice(max(0, rows.min() - away), rows.max() + away + 1),
            slice(max(0, columns.min() - away), columns.max() + away + 1))


def write_surfer(path, heights, steps):
    """Single precision: heights are to be around 0."""
    height, width = heights.shape
    limits = [0, (width - 1) * steps[0], 0, (height - 1) * steps[1],
              numpy.nanmin(heights), numpy.nanmax(heights)]
    with open(path, "wb") as stream:
        stream.write(b"DSBB")
        numpy.array([width, height], "<i2").tofile(stream)
        numpy.array(limits, "<f8").tofile(stream)
        numpy.where(numpy.isnan(heights), BLANK, heights).astype("<f4").tofile(stream)


def read_surfer(path):
    with open(path, "rb") as stream:
        stream.seek(4)
        width, height = numpy.fromfile(stream, "<i2", 2)
        stream.seek(56)
        heights = numpy.fromfile(stream, "<f4", int(width) * int(height)).astype("f8")
    return numpy.where(heights > 0.99 * BLANK, numpy.nan, heights).reshape(height, width)


def fill_by_gmt(tension):
    """grdfill looks at the nodes up to two rows around the box of a hole, so it gets no more."""

    def fill(heights, lost, steps):
        filled = numpy.full(heights.shape, numpy.nan)
        box = around_void(lost, 3)
        middle = numpy.nanmean(heights[box])
        with tempfile.TemporaryDirectory() as folder:
            write_surfer(os.path.join(folder, "void.grd"), heights[box] - middle, steps)
            seconds = run("gmt", "grdfill", "void.grd=sf", f"-As{tension}", "-Gfilled.grd=sf",
                          "--GMT_HISTORY=false", cwd=folder)
            filled[box] = read_surfer(os.path.join(folder, "filled.grd")) + middle
        return seconds, [filled]

    return fill


def fill_by_fillnulls(heights, lost, steps):
    """In a session of GRASS. r.fillnulls looks at three rows around a hole, so it gets few more."""
    filled = numpy.full(heights.shape, numpy.nan)
    box = around_void(lost, 8)
    part, middle = heights[box], numpy.nanmean(heights[box])
    # Other gaps, which are not asked for, are farther away than it looks.
    part = numpy.where(numpy.isnan(part) & ~lost[box], 0.0, part - middle)
    rows, columns = part.shape
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "raster")
        part[::-1].astype("<f8").tofile(path)  # from the north
        run("r.in.bin", "-d", "--overwrite", f"input={path}", "output=void", "bytes=8",
            f"north={rows * steps[1]!r}", "south=0", f"east={columns * steps[0]!r}", "west=0",
            f"rows={rows}", f"cols={columns}", "anull=nan")
        run("g.region", "raster=void")
        seconds = run("r.fillnulls", "--overwrite", "input=void", "output=filled")
        run("r.out.bin", "--overwrite", "input=filled", f"output={path}", "bytes=8", "null=nan")
        filled[box] = numpy.fromfile(path, "<f8").reshape(part.shape)[::-1] + middle
    return seconds, [filled]


RST_EDGE, RST_SEGMENT, RST_LEAST = 3, 300, 600  # defaults of r.fillnulls: edge, segmax, npmin


def fill_by_rst(heights, lost, steps):
    """In a session of GRASS: the spline of r.fillnulls from the same points, without its dozen steps."""
    filled = numpy.full(heights.shape, numpy.nan)
    box = around_void(lost, 2 * RST_EDGE)
    part, inside = heights[box], lost[box]
    middle = numpy.nanmean(part)
    rows, columns = part.shape
    near = inside.copy()
    reach = 2 * RST_EDGE  # in rows or columns, where steps are unequal
    padded = numpy.pad(inside, reach)
    for i in range(2 * reach + 1):
        for j in range(2 * reach + 1):
            away = numpy.hypot((i - reach) * steps[1], (j - reach) * steps[0])
            if away <= (RST_EDGE + 0.01) * numpy.sqrt(steps[0] * steps[1]):
                near |= padded[i : i + rows, j : j + columns]
    y, x = numpy.nonzero(near & ~inside & ~numpy.isnan(part))
    many = len(x) >= RST_SEGMENT
    points = numpy.column_stack(((x + 0.5) * steps[0], (y + 0.5) * steps[1], part[y, x] - middle))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "points")
        numpy.savetxt(path, points, fmt="%.17g")
        seconds = run("g.region", f"n={rows * steps[1]!r}", "s=0", f"e={columns * steps[0]!r}", "w=0",
                      f"rows={rows}", f"cols={columns}")
        seconds += run("v.in.ascii", "-z", "-t", "--overwrite", f"input={path}", "output=void", "x=1",
                       "y=2", "z=3", "separator=space")
        seconds += run("v.surf.rst", "--overwrite", "input=void", "elevation=filled", "tension=40",
                       "smooth=0.1", f"segmax={RST_SEGMENT if many else 2 * len(x)}",
                       f"npmin={RST_LEAST if many else len(x)}")
        run("r.out.bin", "--overwrite", "input=filled", f"output={path}", "bytes=8", "null=nan")
        filled[box] = numpy.fromfile(path, "<f8").reshape(part.shape)[::-1] + middle
    return seconds, [filled]


# ---- conversation -------------------------------------------------------------------------------


def serve(fill, asked=sys.stdin, answers=sys.stdout):
    def answer(line):
        answers.write(line + "\n")
        answers.flush()

    answer("ready")
    for line in iter(asked.readline, ""):
        source, _, target = line.rstrip("\n").partition("\t")
        try:
            seconds, rasters = fill(*read_void(source))
            write_filled(target, *rasters)
        except Exception as error:  # whatever a method may do, the next void is filled
            words = " ".join(str(error).split()) or type(error).__name__
            answer(f"failed {words}")
        else:
            answer(f"done {seconds:.6f}")


def main(what, *arguments):
    if what == "ours":
        serve(fill_by_us(arguments[0]))
    elif what == "gmt":
        serve(fill_by_gmt(arguments[0] if arguments else ""))
    else:
        serve({"vtk": fill_by_vtk, "gdal": fill_by_gdal, "rst": fill_by_rst,
               "fillnulls": fill_by_fillnulls}[what])


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    main(*sys.argv[1:])

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The clouds of reproduce-paper: as many points as the paper's, of real surfaces where there are any."""

import os

import numpy

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Data")
EXTRA = "ELEVATION_SURFACE_EXTRA_DATA"
SIZES = (15626, 32402, 60511, 68956, 98231, 148317, 886639)
# Which file a size is cut from; without it, or with too few points, jacksboro_fault, or a made cloud.
SOURCES = {
    15626: "autzen_trim_ground",
    32402: "nankai_channels",
    60511: "nankai_channels",
    98231: "srtm_pyrenees_voids400",
    148317: "st_helens_after_usgs",
}
ELSE = "jacksboro_fault"
# What the accuracy table is made of, as far as it is there.
SURFACES = (
    "horizon_synthetic", "olinda_land", "jacksboro_fault", "f3_truncation", "st_helens_after_usgs"
)
# Middle x, y and radius of the holes of a made cloud, in parts of its own radius.
VOIDS = ((0.35, 0.2, 0.2), (-0.4, 0.25, 0.1), (-0.1, -0.45, 0.15), (0.45, -0.3, 0.05), (0.0, 0.6, 0.03))


def points_of(name):
    """(n, 3) points of a file of Data/ or of the folder that EXTRA names; None where it is absent."""
    for suffix in (".vtp", ".csv", ".xyz"):
        path = os.path.join(DATA, name + suffix)
        if os.path.exists(path):
            from vtkelevationsurface import read
            from vtkmodules.util.numpy_support import vtk_to_numpy

            return vtk_to_numpy(read(path).points.GetPoints().GetData()).astype("f8")
    path = os.path.join(os.environ.get(EXTRA, ""), name + ".f64")
    if not os.environ.get(EXTRA) or not os.path.exists(path):
        return None
    points = numpy.fromfile(path, "<f8").reshape(-1, 3)
    return points[numpy.isfinite(points).all(axis=1)]


def cut(points, count):
    """Those in a window around the middle, of the proportions of all; in the order that they had."""
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    away = numpy.abs((points[:, :2] - 0.5 * (low + high)) / (high - low)).max(axis=1)
    kept = numpy.argsort(away, kind="stable")[:count]
    return points[numpy.sort(kept)]


def make_horizon(count):
    """A horizon that is made: nodes of a turned lattice within a wavy outline, with five holes."""
    steps = numpy.array([12.5, 18.75])
    area = numpy.pi * (1.025 - sum(radius**2 for _, _, radius in VOIDS))
    radius = (count * steps.prod() / area) ** 0.5
    sides = [numpy.arange(-1.5 * radius, 1.5 * radius, step) for step in steps]
    u, v = (axis.ravel() for axis in numpy.meshgrid(*sides))
    angle = numpy.arctan2(v, u)
    outline = 1.0 + 0.2 * numpy.sin(5.0 * angle) + 0.1 * numpy.sin(11.0 * angle + 1.0)
    level = numpy.hypot(u, v) / outline
    for x, y, size in VOIDS:
        level[numpy.hypot(u / radius - x, v / radius - y) < size] = numpy.inf
    nodes = numpy.sort(numpy.argsort(level, kind="stable")[:count])
    u, v = u[nodes], v[nodes]
    turn = numpy.radians(33.7)
    x = u * numpy.cos(turn) - v * numpy.sin(turn) + 464000.0
    y = u * numpy.sin(turn) + v * numpy.cos(turn) + 6219000.0
    z = -2000.0 - 0.02 * u + 60.0 * numpy.sin(u / 900.0) * numpy.cos(v / 1100.0)
    z += 8.0 * numpy.sin(u / 140.0 + v / 190.0) + 0.6 * numpy.random.default_rng(1).standard_normal(count)
    return numpy.round(numpy.column_stack((x, y, z)), 1)


def cloud_of(count):
    """(points, what they are): a cloud of exactly so many points."""
    for name in (SOURCES.get(count), ELSE):
        points = points_of(name) if name else None
        if points is not None and len(points) >= count:
            return cut(points, count), f"{name}, cut from {len(points):,}"
    return make_horizon(count), "made: a turned lattice with five holes"


def write_doubles(path, points):
    points.astype("<f8").tofile(path)


def write_ply(path, points):
    """For MeshLab, which keeps single precision: around their middle."""
    low, high = points.min(axis=0), points.max(axis=0)
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += ["element face 0", "property list uchar int vertex_indices", "end_header", ""]
    with open(path, "wb") as stream:
        stream.write("\n".join(lines).encode())
        (points - (low + high) / 2).astype("<f4").tofile(stream)


def ply_used_points(path):
    """(faces, points that are corners of any) of a surface as MeshLab writes it: binary triangles."""
    with open(path, "rb") as stream:
        head = b""
        while not head.endswith(b"end_header\n"):
            line = stream.readline()
            if not line:
                raise ValueError(f"{path}: no end of its header")
            head += line
        words = [line.split() for line in head.decode().splitlines()]
        counts = {word[1]: int(word[2]) for word in words if word[0] == "element"}
        sizes = {"float": 4, "double": 8, "uchar": 1, "int": 4}
        element, size = "", 0
        for word in words:
            element = word[1] if word[0] == "element" else element
            if word[0] == "property" and element == "vertex":
                size += sizes[word[1]]
        stream.seek(size * counts["vertex"], os.SEEK_CUR)
        faces = numpy.fromfile(stream, [("n", "u1"), ("ids", "<i4", 3)], counts["face"])
    if len(faces) != counts["face"] or (faces["n"] != 3).any():
        raise ValueError(f"{path}: not all faces are triangles")
    return len(faces), len(numpy.unique(faces["ids"]))

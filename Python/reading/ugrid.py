# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nodes of the meshes of ocean and river models in netCDF, by the conventions of UGRID. GDAL reads the
arrays; what they are to each other stands in their attributes."""

import re

import numpy

from ..clouds import Cloud, make_points
from ..gdal_common import choose_layer, gdal_module, one_line, quiet
from ..messages import FileError, Reason
from ..names import option
from .column_names import z_direction, meaning

AXES = {"longitude": 0, "projection_x_coordinate": 0, "latitude": 1, "projection_y_coordinate": 1}
NAMES = tuple(re.compile(rf"(^|_)({names})$", re.IGNORECASE) for names in ("x|lon|longitude", "y|lat|latitude"))
HEIGHT = re.compile(r"node_z$|bed_?level|_bl$", re.IGNORECASE)  # besides those of column_names
DAMAGES = (AttributeError, IndexError, NotImplementedError, RuntimeError, TypeError, ValueError)


def open_group(path):
    """The root group of a netCDF file."""
    gdal = gdal_module()
    try:
        data = gdal.OpenEx(path, gdal.OF_MULTIDIM_RASTER, ["netCDF"])
    except RuntimeError:  # netCDF-4, which is HDF5, with another suffix than .nc
        data = gdal.OpenEx(f"NETCDF:{path}", gdal.OF_MULTIDIM_RASTER, ["netCDF"])
    return data.GetRootGroup()


def open_arrays(group):
    return {name: group.OpenMDArray(name) for name in group.GetMDArrayNames(["SHOW_ALL=YES"])}


def text(thing, name):
    """An attribute of an array or a group as text, also of several texts; "" where there is none."""
    try:
        value = thing.GetAttribute(name).Read()
    except RuntimeError:
        return ""
    return " ".join(" ".join(map(str, value if isinstance(value, (list, tuple)) else [value])).split())


def find_meshes(arrays):
    """[(name, names of the coordinates of its nodes)], those of two dimensions first."""
    meshes = [
        (text(array, "topology_dimension") != "2", name, text(array, "node_coordinates").split())
        for name, array in arrays.items() if text(array, "cf_role") == "mesh_topology"
    ]
    return [(name, places) for _, name, places in sorted(meshes) if len(places) > 1]


def is_ugrid(path):
    try:
        with quiet():
            group = open_group(path)
            return "UGRID" in text(group, "Conventions") or bool(find_meshes(open_arrays(group)))
    except DAMAGES:
        return False  # another kind of netCDF or HDF5, or damaged


def array_axis(array):
    """0 for x, 1 for y, or None where neither names nor the unit say so."""
    unit, name = (array.GetUnit() or "").lower(), array.GetName()
    by_unit = {"east": 0, "north": 1}.get(unit.rpartition("_")[2]) if unit.startswith("degree") else None
    by_name = next((axis for axis, names in enumerate(NAMES) if names.search(name)), None)
    by_standard = AXES.get(text(array, "standard_name"))
    return next((axis for axis in (by_standard, by_unit, by_name) if axis is not None), None)


def sorted_places(names, arrays):
    """(x, y, [others that may be heights]) of the names of coordinates, which come in any order."""
    names = list(dict.fromkeys(names))
    axes = [array_axis(arrays[name]) for name in names]
    x, y = names[0], names[-1 if len(names) < 2 else 1]
    if 0 in axes and 1 in axes:
        x, y = names[axes.index(0)], names[axes.index(1)]
    return x, y, [name for name, axis in zip(names, axes) if axis is None and name not in (x, y)]


def all_names(array):
    return [array.GetName(), text(array, "standard_name"), text(array, "long_name")]


def means_height(array):
    return HEIGHT.search(array.GetName()) is not None or any(meaning(name).axis == "z" for name in all_names(array))


def z_name(array):
    """What the variable says that its values are."""
    if text(array, "positive") == "down":
        return "depth"
    return next((name for name in all_names(array) if name and z_direction(name)), "")


def node_values(path, array, count):
    """float64, NaN where there is no data."""
    if [one.GetSize() for one in array.GetDimensions()] != [count]:
        raise FileError(f"{path}: {array.GetName()} has not one value for each of the {count:,} nodes")
    values = array.ReadAsArray().astype("f8")
    values[values == array.GetNoDataValueAsDouble()] = numpy.nan  # of None nothing is
    return values * (array.GetScale() or 1.0) + (array.GetOffset() or 0.0)


def node_variables(mesh, others, arrays, count):
    """The names of the variables with one value for each node, heights among the coordinates first."""
    return others + [
        name for name, array in arrays.items()
        if name not in others and text(array, "location").lower() == "node" and text(array, "mesh") == mesh
        and [one.GetSize() for one in array.GetDimensions()] == [count]
    ]


def choose(path, options, arrays):
    """(x, y, z, the number of nodes): of the first mesh that has variables at its nodes."""
    meshes = find_meshes(arrays)
    if not meshes:
        raise FileError(f"{path}: is a mesh of UGRID whose nodes have no coordinates")
    for mesh, places in meshes:
        x, y, others = sorted_places(places, arrays)
        sizes = [one.GetSize() for one in arrays[x].GetDimensions()]
        if len(sizes) != 1:
            raise FileError(f"{path}: {x} has not one value for each node")
        names = node_variables(mesh, others, arrays, sizes[0])
        heights = [name for name in names if name in others or means_height(arrays[name])]
        what = "variables with one value for each node"
        if names and (options.layer or len(names) == 1 or len(heights) == 1):
            some = names if options.layer else heights or names
            z = choose_layer(path, options.layer, some, what)
            return arrays[x], arrays[y], arrays[z], sizes[0]
        if names:
            raise FileError(f"{path}: holds {what} {', '.join(names[:20])}: choose one by {option('layer')}")
    raise FileError(
        f"{path}: a mesh of UGRID without a variable that has one value for each node; those at faces or "
        "that change with time are not read"
    )


def read_points(path, options):
    """The nodes of a mesh, with one of the variables at its nodes as z."""
    with quiet():
        try:
            x, y, z, count = choose(path, options, open_arrays(open_group(path)))
            xyz = numpy.column_stack([node_values(path, array, count) for array in (x, y, z)])
            reference = z.GetSpatialRef()
        except FileError:
            raise
        except KeyError as error:
            raise FileError(f"{path}: is damaged: it has no variable {error.args[0]}") from None
        except DAMAGES as error:
            raise FileError(f"{path}: a mesh of UGRID that cannot be read: {one_line(error)}") from None
        cloud = Cloud(None, [f"UGRID mesh, elevation: variable {z.GetName()}"], crs=reference and reference.ExportToWkt())
        cloud.z_name = z_name(z)
        cloud.angles = "are angles" if (x.GetUnit() or "").lower().startswith("degree") else ""
    keep = numpy.isfinite(xyz[:, 2])
    if not keep.any():
        raise FileError(f"{path}: all {count:,} nodes are without data")
    cloud.points = make_points(xyz[keep])
    cloud.notes.append("only the points are used, not the file's cells")
    if not keep.all():
        cloud.left_out[Reason("node", "without data")] = int(count - numpy.count_nonzero(keep))
    return cloud

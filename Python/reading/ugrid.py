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
from .column_names import direction_of, meaning

AXES = {"longitude": 0, "projection_x_coordinate": 0, "latitude": 1, "projection_y_coordinate": 1}
NAMES = tuple(re.compile(rf"(^|_)({names})$", re.IGNORECASE) for names in ("x|lon|longitude", "y|lat|latitude"))
HEIGHT = re.compile(r"node_z$|bed_?level|_bl$", re.IGNORECASE)  # besides those of column_names
DAMAGES = (AttributeError, IndexError, NotImplementedError, RuntimeError, TypeError, ValueError)


def arrays_of(path):
    """{name: (array, {attribute: value})} of a netCDF file."""
    gdal = gdal_module()
    try:
        data = gdal.OpenEx(path, gdal.OF_MULTIDIM_RASTER, ["netCDF"])
    except RuntimeError:  # netCDF-4, which is HDF5, with another suffix than .nc
        data = gdal.OpenEx(f"NETCDF:{path}", gdal.OF_MULTIDIM_RASTER, ["netCDF"])
    group, found = data.GetRootGroup(), {}
    for name in group.GetMDArrayNames(["SHOW_ALL=YES"]):
        array = group.OpenMDArray(name)
        found[name] = array, {one.GetName(): one.Read() for one in array.GetAttributes()}
    return found


def words_in(attributes, name):
    """The words of an attribute of text, or of several texts."""
    value = attributes.get(name, "")
    return " ".join(map(str, value if isinstance(value, (list, tuple)) else [value])).split()


def meshes_of(arrays):
    """[(name, names of the coordinates of its nodes)], those of two dimensions first."""
    meshes = [
        (attributes.get("topology_dimension") != 2, name, words_in(attributes, "node_coordinates"))
        for name, (_, attributes) in arrays.items() if words_in(attributes, "cf_role") == ["mesh_topology"]
    ]
    return [(name, places) for _, name, places in sorted(meshes) if len(places) > 1]


def is_ugrid(path):
    try:
        with quiet():
            return bool(meshes_of(arrays_of(path)))
    except DAMAGES:
        return False  # another kind of netCDF or HDF5, or damaged


def axis_of(array, attributes):
    """0 for x, 1 for y, or None where neither names nor the unit say so."""
    unit, name = (array.GetUnit() or "").lower(), array.GetName()
    by_unit = {"east": 0, "north": 1}.get(unit.rpartition("_")[2]) if unit.startswith("degree") else None
    by_name = next((axis for axis, names in enumerate(NAMES) if names.search(name)), None)
    by_standard = AXES.get(" ".join(words_in(attributes, "standard_name")))
    return next((axis for axis in (by_standard, by_unit, by_name) if axis is not None), None)


def sorted_places(names, arrays):
    """(x, y, [others that may be heights]) of the names of coordinates, which come in any order."""
    names = list(dict.fromkeys(names))
    axes = [axis_of(*arrays[name]) for name in names]
    x, y = names[0], names[-1 if len(names) < 2 else 1]
    if 0 in axes and 1 in axes:
        x, y = names[axes.index(0)], names[axes.index(1)]
    return x, y, [name for name, axis in zip(names, axes) if axis is None and name not in (x, y)]


def texts_of(name, attributes):
    return [name] + [" ".join(words_in(attributes, key)) for key in ("standard_name", "long_name")]


def means_height(name, attributes):
    texts = texts_of(name, attributes)
    return HEIGHT.search(name) is not None or any(meaning(text).axis == "z" for text in texts)


def name_of_z(name, attributes):
    """What the variable says that its values are."""
    if words_in(attributes, "positive") == ["down"]:
        return "depth"
    return next((text for text in texts_of(name, attributes) if text and direction_of(text)), "")


def values_of(path, name, arrays, count):
    """float64, NaN where there is no data."""
    array, _ = arrays[name]
    if [one.GetSize() for one in array.GetDimensions()] != [count]:
        raise FileError(f"{path}: {name} has not one value for each of the {count:,} nodes")
    values = array.ReadAsArray().astype("f8")
    values[values == array.GetNoDataValueAsDouble()] = numpy.nan  # of None nothing is
    return values * (array.GetScale() or 1.0) + (array.GetOffset() or 0.0)


def variables_of(mesh, others, arrays, count):
    """The names of the variables with one value for each node, heights among the coordinates first."""
    found = list(others)
    for name, (array, attributes) in arrays.items():
        is_at_nodes = [word.lower() for word in words_in(attributes, "location")] == ["node"]
        if is_at_nodes and words_in(attributes, "mesh") == [mesh] and name not in found:
            found += [name] if [one.GetSize() for one in array.GetDimensions()] == [count] else []
    return found


def chosen(path, options, arrays):
    """(x, y, z, the number of nodes): of the first mesh that has variables at its nodes."""
    for mesh, places in meshes_of(arrays):
        x, y, others = sorted_places(places, arrays)
        sizes = [one.GetSize() for one in arrays[x][0].GetDimensions()]
        if len(sizes) != 1:
            raise FileError(f"{path}: {x} has not one value for each node")
        names = variables_of(mesh, others, arrays, sizes[0])
        heights = [name for name in names if name in others or means_height(name, arrays[name][1])]
        what = "variables with one value for each node"
        if names and (options.layer or len(names) == 1 or len(heights) == 1):
            some = names if options.layer else heights or names
            return x, y, choose_layer(path, options.layer, some, what), sizes[0]
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
            arrays = arrays_of(path)
            *names, count = chosen(path, options, arrays)
            xyz = numpy.column_stack([values_of(path, name, arrays, count) for name in names])
            array, attributes = arrays[names[2]]
            reference = array.GetSpatialRef()
        except FileError:
            raise
        except KeyError as error:
            raise FileError(f"{path}: is damaged: it has no variable {error.args[0]}") from None
        except DAMAGES as error:
            raise FileError(f"{path}: a mesh of UGRID that cannot be read: {one_line(error)}") from None
    keep = numpy.isfinite(xyz[:, 2])
    if not keep.any():
        raise FileError(f"{path}: all {count:,} nodes are without data")
    cloud = Cloud(make_points(xyz[keep]), [f"UGRID mesh, elevation: variable {names[2]}"])
    cloud.notes.append("only the points are used, not the file's cells")
    if not keep.all():
        cloud.left_out[Reason("node", "without data")] = int(count - numpy.count_nonzero(keep))
    cloud.z_name = name_of_z(names[2], attributes)
    cloud.crs = reference.ExportToWkt() if reference else None
    is_in_degrees = (arrays[names[0]][0].GetUnit() or "").lower().startswith("degree")
    cloud.angles = "are angles" if is_in_degrees else ""
    return cloud

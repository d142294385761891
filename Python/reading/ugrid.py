# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nodes of the meshes of ocean and river models in netCDF, by the conventions of UGRID. GDAL reads the
arrays; what they are to each other stands in their attributes."""

import numpy

from ..clouds import Cloud, make_points
from ..gdal_common import choose_layer, gdal_module, one_line, quiet
from ..messages import FileError, Reason
from .column_names import direction_of, meaning


def attributes_of(array):
    return {one.GetName(): one.Read() for one in array.GetAttributes()}


def arrays_of(path):
    """{name: (array, attributes)} of a netCDF file."""
    gdal = gdal_module()
    group = gdal.OpenEx(path, gdal.OF_MULTIDIM_RASTER, ["netCDF"]).GetRootGroup()
    arrays = {name: group.OpenMDArray(name) for name in group.GetMDArrayNames(["SHOW_ALL=YES"])}
    return {name: (array, attributes_of(array)) for name, array in arrays.items()}


def mesh_of(arrays):
    """(name, attributes) of the first mesh, or None."""
    meshes = ((name, attributes) for name, (_, attributes) in arrays.items() if attributes.get("cf_role") == "mesh_topology")
    return next((mesh for mesh in meshes if mesh[1].get("node_coordinates")), None)


def is_ugrid(path):
    try:
        with quiet():
            return mesh_of(arrays_of(path)) is not None
    except (AttributeError, RuntimeError, TypeError):
        return False  # another kind of netCDF or HDF5, or damaged


def values_of(array):
    """float64, NaN where there is no data."""
    values = array.ReadAsArray().astype("f8")
    values[values == array.GetNoDataValueAsDouble()] = numpy.nan  # of None nothing is
    return values * (array.GetScale() or 1.0) + (array.GetOffset() or 0.0)


def means_height(name, attributes):
    names = (name, attributes.get("standard_name", ""), attributes.get("long_name", ""))
    return name.endswith("node_z") or any(meaning(one).axis == "z" for one in names)


def name_of_z(name, attributes):
    """What the variable says that its values are."""
    if str(attributes.get("positive", "")).lower() == "down":
        return "depth"
    names = (name, attributes.get("standard_name", ""), attributes.get("long_name", ""))
    return next((one for one in names if one and direction_of(one)), "")


def read_points(path, options):
    """The nodes, with a variable that has one value for each as z."""
    with quiet():
        try:
            arrays = arrays_of(path)
            mesh, attributes = mesh_of(arrays)
            x, y, *height = (arrays[name] for name in attributes["node_coordinates"].split())
            count = x[0].GetDimensions()[0].GetSize()
            of_nodes = [
                name for name, (array, attributes) in arrays.items()
                if attributes.get("mesh") == mesh and attributes.get("location") == "node"
                and [one.GetSize() for one in array.GetDimensions()] == [count]
            ] or [array.GetName() for array, _ in height]
            heights = [name for name in of_nodes if means_height(name, arrays[name][1])]
            of_nodes = of_nodes if options.layer or len(heights) != 1 else heights
            name = choose_layer(path, options.layer, of_nodes, "variables with one value for each node")
            array, attributes = arrays[name]
            columns = [values_of(one) for one in (x[0], y[0], array)]
            reference = array.GetSpatialRef()
        except FileError:
            raise
        except KeyError as error:
            raise FileError(f"{path}: is damaged: it has no variable {error.args[0]}") from None
        except (IndexError, RuntimeError, TypeError, ValueError) as error:
            raise FileError(f"{path}: cannot be read: {one_line(error)}") from None
    keep = numpy.isfinite(columns[2])
    if not keep.any():
        raise FileError(f"{path}: all {count:,} nodes are without data")
    cloud = Cloud(make_points(numpy.column_stack(columns)[keep]), [f"UGRID mesh, elevation: variable {name}"])
    cloud.notes.append("only the points are used, not the file's cells")
    if not keep.all():
        cloud.left_out[Reason("node", "without data")] = int(count - numpy.count_nonzero(keep))
    cloud.z_name = name_of_z(name, attributes)
    cloud.crs = reference.ExportToWkt() if reference else None
    cloud.angles = "are angles" if x[0].GetUnit().lower().startswith("degree") else ""
    return cloud

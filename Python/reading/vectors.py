# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points, lines and polygons of vector files. OGR reads them, whatever their format."""

import collections
import os

import numpy

from ..clouds import LINE_NAMES, WITHOUT_Z, Cloud, add_array, add_words, make_lines, make_points, set_crs
from .column_names import meaning
from .formats import HEAD, is_table_with_geometry
from ..gdal_common import GDAL_ERRORS, choose_layer, gdal_module, kind_of, one_line, quiet
from ..messages import FileError, Reason
from ..names import option
from ..progress import items_with_progress, no_progress, share
from ..selecting import words_of

OPEN_OPTIONS = {
    "CSV": ["AUTODETECT_TYPE=YES", "GEOM_POSSIBLE_NAMES=WKT,*wkt*,*geom*,shape"],
    "GML": ["WRITE_GFS=NO"],  # nothing next to the user's file
}


# Layers of GPX that have the same vertices, as points and as lines.
POINTS_OF_LINES = (("track_points", "tracks"), ("route_points", "routes"))

# Attributes of elevations of points and contours, as ArcGIS names them.
GIVEN_BY_TOOLS = ("grid_code", "gridcode", "rastervalu", "contour")


def read_head(path):
    with open(path, "rb") as stream:
        return stream.read(HEAD)


def open_file(path):
    """The dataset of a file, open for reading."""
    gdal = gdal_module()
    kind = "CSV" if os.path.isfile(path) and is_table_with_geometry(read_head(path), path) else kind_of(path, "vectors")
    if kind is None:
        raise FileError(f"{path}: GDAL knows no vector format that this could be")
    settings = OPEN_OPTIONS.get(kind, [])
    gdal.SetConfigOption("GPX_ELE_AS_25D", "YES")
    try:
        return gdal.OpenEx(path, gdal.OF_VECTOR | gdal.OF_VERBOSE_ERROR, [kind], settings)
    except GDAL_ERRORS as error:
        raise FileError(f"{path}: is cut off or damaged: {one_line(error)}") from None


def open_layer(path, data, wanted, as_lines):
    """(layer, notes). A drawing is one layer to GDAL; its own layers are chosen by an attribute."""
    from osgeo import ogr

    layers = [data.GetLayer(i) for i in range(data.GetLayerCount())]
    of_drawing = len(layers) == 1 and layers[0].GetLayerDefn().GetFieldIndex("Layer") == 0
    if of_drawing:
        if wanted:
            names = sorted({feature.GetField(0) or "" for feature in layers[0]})
            name = choose_layer(path, wanted, names, "layers").replace("'", "''")
            layers[0].SetAttributeFilter(f"Layer = '{name}'")
        return layers[0], []
    if not wanted:
        layers = [
            layer
            for layer in layers
            if layer.GetGeomType() != ogr.wkbNone and layer.GetFeatureCount() != 0
        ]
    names = [layer.GetName() for layer in layers]
    twice = [pair[not as_lines] for pair in POINTS_OF_LINES if set(pair) <= set(names) and not wanted]
    name = choose_layer(path, wanted, [name for name in names if name not in twice], "layers with geometry")
    notes = [f"layer {name} (of {', '.join(names)})"] if len(names) > 1 else []
    return layers[names.index(name)], notes


def geometry_parts(geometry):
    """Yields (kind, points) of a geometry, kind one of point, line and ring."""
    if geometry.HasCurveGeometry():
        geometry = geometry.GetLinearGeometry()
    if geometry.GetGeometryCount():
        for i in range(geometry.GetGeometryCount()):
            yield from geometry_parts(geometry.GetGeometryRef(i))
    elif geometry.GetPointCount():
        name = geometry.GetGeometryName()
        yield {"POINT": "point", "LINEARRING": "ring"}.get(name, "line"), geometry.GetPoints()


class Layer:
    """All that is used of a layer.

    parts     [(kind, (n, 3) array of points)], z NaN where there is none
    features  for each part, the number of its feature from 0
    ids       for each part, the id of its feature
    z_name    the attribute that z is from, or the layer's name
    fields    {attribute: its value for each feature}
    empty     how many features have no geometry
    labels    how many are texts of a drawing
    """

    def __init__(self, path, layer, kind, progress):
        self.path = path
        self.parts, self.features, self.empty, self.labels, self.flat = [], [], 0, 0, 0
        self.ids, self.z_name = [], layer.GetName()
        definition = layer.GetLayerDefn()
        names = [
            definition.GetFieldDefn(i).GetName() for i in range(definition.GetFieldCount())
        ]
        columns = [[] for _ in names]
        count = 0
        try:
            for number, feature in enumerate(items_with_progress(layer, progress, layer.GetFeatureCount(0))):
                count = number + 1
                for i, column in enumerate(columns):
                    column.append(feature.GetField(i))
                self.add(number, feature, names)
            # Where this format is cut off, newer GDALs end without a word.
            announced = layer.GetFeatureCount() if kind == "FlatGeobuf" else 0
        except GDAL_ERRORS as error:
            raise FileError(f"{path}: is cut off or damaged: {one_line(error)}") from None
        if announced > count:
            raise FileError(
                f"{path}: is cut off or damaged: {announced:,} features are announced, "
                f"{count:,} found"
            )
        self.fields = dict(zip(names, columns))

    def add(self, number, feature, names):
        geometry = feature.GetGeometryRef()
        if geometry is None or geometry.IsEmpty():
            self.empty += 1
            return
        if "SubClasses" in names and feature.GetField(names.index("Text")) is not None:
            self.labels += 1
            return
        for kind, points in geometry_parts(geometry):
            points = numpy.array(points, dtype="f8")
            if points.shape[1] == 2 or not geometry.Is3D():
                self.flat += 1
                points = numpy.column_stack((points[:, :2], numpy.full(len(points), numpy.nan)))
            self.parts.append((kind, points))
            self.features.append(number)
            self.ids.append(feature.GetFID())

    def coordinates(self):
        """(n, 3): all points of all parts."""
        return numpy.concatenate([points for _, points in self.parts])

    def numbers(self, name):
        """The values of an attribute as doubles, or None where one of them is not a number."""
        try:
            return numpy.array([numpy.nan if v is None else v for v in self.fields[name]], "f8")
        except (TypeError, ValueError):
            return None

    def set_heights(self, columns, is_needed=True):
        """Takes z from an attribute where the geometry has none. Returns notes.

        columns    None, or three names of which the third is the attribute
        is_needed  False: where several attributes could be z, or one that holds words, none is
        """
        name = self.height_attribute(columns, is_needed)
        has_z = bool(numpy.nan_to_num(self.coordinates()[:, 2]).any())
        if name is None or has_z and not columns and not self.flat:
            return [] if name is None or not has_z else [f"z from the geometry, not from {name}"]
        values = self.numbers(name)
        if values is None and not is_needed:
            return []
        if values is None:
            bad = next(v for v in self.fields[name] if not is_number(v))
            raise FileError(f"{self.path}: '{bad}' in attribute {name} is not a number")
        some = has_z and not columns
        for number, (_, points) in zip(self.features, self.parts):
            if not some or numpy.isnan(points[:, 2]).all():
                points[:, 2] = values[number]
        self.z_name = name
        return [f"z from attribute {name}" + ", where the geometry has none" * some]

    def height_attribute(self, columns, is_needed):
        """The name of the attribute of elevations, or None."""
        if columns:
            if columns[2] not in self.fields:
                names = ", ".join(self.fields) or "none"
                raise FileError(f"{self.path}: has no attribute {columns[2]}; attributes: {names}")
            return columns[2]
        named = [name for name in self.fields if meaning(name).axis == "z"]
        # A time of a clock, or an altitudeMode, is none.
        named = [name for name in named if meaning(name).rank < 4 or self.numbers(name) is not None]
        # Those that tools give are doubtful names, so they count last.
        named = named or [name for name in self.fields if name.lower() in GIVEN_BY_TOOLS]
        named = [name for name in named if any(v is not None for v in self.fields[name])]
        best = min((meaning(name).rank for name in named), default=0)
        named = [name for name in named if meaning(name).rank == best]
        if len(named) > 1 and self.flat and is_needed:
            raise FileError(
                f"{self.path}: attributes {', '.join(named)} could be the elevation; choose one by "
                f"{option('columns')} x,y,{named[0]}"
            )
        return named[0] if len(named) == 1 else None


def is_number(value):
    try:
        float(0 if value is None else value)
        return True
    except (TypeError, ValueError):
        return False


def are_angles(layer):
    """Whether x and y of all points can be degrees."""
    return (numpy.abs(layer.coordinates()[:, :2]) <= (540.0, 90.0)).all()


def add_attribute(data, name, values):
    """Adds a cell array: numbers, also those that a file has as text, where nothing is none (NaN); or text."""
    values = [None if isinstance(value, str) and not value.strip() else value for value in values]
    if all(is_number(value) for value in values):
        add_array(data, name, numpy.array([numpy.nan if v is None else float(v) for v in values]), "Cell")
    else:
        add_words(data.GetCellData(), name, ["" if value is None else str(value) for value in values])


def read_layer(path, wanted, columns, progress, as_lines=False, needs_z=True):
    """(Layer with its elevations, notes, crs)."""
    with quiet():
        data = open_file(path)
        found, notes = open_layer(path, data, wanted, as_lines)
        layer = Layer(path, found, data.GetDriver().ShortName, share(progress, 0.0, 0.8))
        reference = found.GetSpatialRef()
        notes.insert(0, f"vectors: {data.GetDriver().LongName}")
        if not layer.parts:
            raise FileError(f"{path}: layer {found.GetName()} holds no geometry")
        if reference and reference.IsGeographic() and not are_angles(layer):
            # GDAL takes GeoJSON that names no system for degrees.
            notes.append(f"x,y are not angles, so it is not in {reference.GetName()}; see {option('crs')}")
            reference = None
        crs = reference.ExportToWkt() if reference else None
    progress(0.85)
    notes += layer.set_heights(columns, needs_z)
    progress(0.9)
    return layer, notes, crs


def read_flat_points(path, progress=no_progress):
    """((n, 2) points, and vertices of lines and polygons; the reference system or None): no z is needed."""
    layer, _, crs = read_layer(path, None, None, progress, needs_z=False)
    return numpy.concatenate([p[:-1, :2] if kind == "ring" else p[:, :2] for kind, p in layer.parts]), crs


def read_points(path, options):
    """Points, and the vertices of lines and polygons; attributes of numbers become point arrays,
    those of text Words.

    Takes about 20 seconds for a million features.
    """
    layer, notes, crs = read_layer(path, options.layer, options.columns, options.progress)
    parts = [points[:-1] if kind == "ring" else points for kind, points in layer.parts]
    coordinates = numpy.concatenate(parts)
    options.progress(0.95)
    if numpy.isnan(coordinates[:, 2]).all():
        names = ", ".join(layer.fields) or "none"
        raise FileError(
            f"{path}: the points are flat, and no attribute is named as an elevation; choose "
            f"one by {option('columns')} x,y,NAME; attributes: {names}"
        )
    kinds = {kind for kind, _ in layer.parts} - {"point"}
    if kinds:
        words = " and ".join({"line": "lines", "ring": "polygons"}[kind] for kind in sorted(kinds))
        notes.append(f"the vertices of {words} are taken as points")
    cloud = Cloud(make_points(coordinates), notes, crs=crs)
    cloud.z_name = layer.z_name
    repeat = numpy.repeat(layer.features, [len(points) for points in parts])
    for name, values in layer.fields.items():
        if any(isinstance(value, (int, float)) for value in values):
            numbers = layer.numbers(name)
            if numbers is not None:
                add_array(cloud.points, name, numbers[repeat])
        elif any(isinstance(value, str) for value in values):
            cloud.words[name] = words_of(values).some(repeat)
    for count, reason in ((layer.empty, Reason("feature", "without geometry")), (layer.labels, Reason("text"))):
        if count:
            cloud.left_out[reason] = count
    return cloud


def read_lines(path, singular, progress):
    """Lines and polygons with their holes, as vtkPolyData with lines and the field array CRS; attributes become
    cell arrays, those with a word of text."""
    layer, _, crs = read_layer(path, None, None, progress, as_lines=True, needs_z=singular != "a boundary")
    names, parts, features, count = [], [], [], collections.Counter()
    for feature, number, (kind, points) in zip(layer.ids, layer.features, layer.parts):
        if kind != "point":
            count[feature] += 1
            part = f", part {count[feature]}" if count[feature] > 1 else ""
            names.append(f"feature {feature}{part}")
            parts.append(points)
            features.append(number)
    if not parts:
        raise FileError(f"{path}: holds no line and no polygon that could be {singular}")
    data = make_lines(parts, names)
    for name, values in layer.fields.items():
        are_plain = all(value is None or isinstance(value, (int, float, str)) for value in values)
        if are_plain and name not in (LINE_NAMES, WITHOUT_Z):
            add_attribute(data, name, [values[number] for number in features])
    if crs:
        set_crs(data, crs)
    return data

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What reading rasters and reading vectors by GDAL share."""

import functools
import importlib.util
import math
import os

import numpy

from .messages import FileError
from .names import option

# Drivers that are not asked: text tables and ZMAP+ have readers of their own, and nothing is fetched.
NOT_ASKED = {"XYZ", "ZMap", "DERIVED", "HTTP", "WMS", "WCS", "WMTS", "OGCAPI", "PLMOSAIC", "EEDA", "EEDAI"}
NOT_ASKED |= {"DAAS", "STACTA", "STACIT", "PostGISRaster", "PDF", "Rasterlite", "KMLSUPEROVERLAY"}
# Those that are asked for points and lines.
VECTORS = (
    "GPKG,ESRI Shapefile,GeoJSON,GeoJSONSeq,ESRIJSON,TopoJSON,DXF,CAD,DGN,GML,LIBKML,KML,GPX,"
    "FlatGeobuf,OpenFileGDB,MapInfo File,OGR_GMT,SQLite,S57,OGR_VRT,AVCE00,JML"
).split(",")

SAME_PLACES = [
    "CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS",
    "IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES",
]


# What its Python raises: RuntimeError, or another where it cannot quote bytes of the file.
GDAL_ERRORS = (RuntimeError, SystemError, UnicodeDecodeError)


def one_line(error):
    """The words of an error of GDAL, for a message."""
    words = "" if isinstance(error, (SystemError, UnicodeDecodeError)) else str(error)
    return " ".join(words.split()) or "GDAL gives no reason that can be quoted"


def gdal_module():
    """GDAL, set to raise RuntimeError. Imported late: it takes a tenth of a second."""
    from osgeo import gdal, ogr, osr

    for part in (gdal, ogr, osr):
        part.UseExceptions()
    return gdal


class quiet:
    """A context in which GDAL prints nothing. Gives the list of its warnings."""

    def __enter__(self):
        gdal = gdal_module()
        warnings = []

        def note(kind=None, _number=0, message=""):  # of bytes that it cannot quote, GDAL passes nothing
            if kind == gdal.CE_Warning:
                warnings.append(" ".join(message.split()))

        gdal.PushErrorHandler(note)
        return warnings

    def __exit__(self, *_):
        gdal_module().PopErrorHandler()


@functools.lru_cache(maxsize=None)
def drivers(what):
    """Short names of the drivers that are asked for a "raster" or for "vectors"."""
    gdal = gdal_module()
    known = [gdal.GetDriver(i) for i in range(gdal.GetDriverCount())]
    if what == "vectors":
        return [driver.ShortName for driver in known if driver.ShortName in VECTORS]
    return [
        driver.ShortName
        for driver in known
        if driver.GetMetadataItem("DCAP_RASTER") and driver.ShortName not in NOT_ASKED
    ]


def kind_of(path, what):
    """The short name of the driver that knows the file's content, or None."""
    gdal = gdal_module()
    flags = gdal.OF_RASTER if what == "raster" else gdal.OF_VECTOR
    with quiet():
        try:
            driver = gdal.IdentifyDriverEx(path, flags, drivers(what))
        except GDAL_ERRORS as error:  # some drivers look further than at the beginning
            raise FileError(f"{path}: is cut off or damaged: {one_line(error)}") from None
        kind = driver.ShortName if driver else None
        if what == "vectors" and kind in ("GPKG", "SQLite"):
            # These hold rasters too.
            try:
                layers = gdal.OpenEx(path, flags).GetLayerCount()
                rasters = gdal.IdentifyDriverEx(path, gdal.OF_RASTER, ["GPKG"])
                kind = kind if layers or not rasters else None
            except RuntimeError:
                pass
    return kind


def choose_layer(path, wanted, names, what):
    """The wanted one of the names, the only one, or the only one that means elevations."""
    if wanted:
        if wanted not in names:
            raise FileError(f"{path}: has no layer {wanted}; {what}: {', '.join(names)}")
        return wanted
    if len(names) > 1:
        from .reading.column_names import meaning  # whose package imports this module

        named = [name for name in names if meaning(name).axis == "z"]
        names = named if len(named) == 1 else names
    if len(names) != 1:
        found = f"{what} {', '.join(names[:20])}: choose one by {option('layer')}" if names else f"no {what}"
        raise FileError(f"{path}: holds {found}")
    return names[0]


def write_through_memory(path, make):
    """Calls make(name) to write a file in memory, and copies it to path.

    GDAL overlooks a full disk with some formats, and prints about it with others. Raises OSError, and
    FileError with GDAL's reason.
    """
    gdal = gdal_module()
    name = f"/vsimem/{os.getpid()}/{os.path.basename(path)}"
    try:
        with quiet():
            make(name)
        source = gdal.VSIFOpenL(name, "rb")
        try:
            with open(path, "wb") as stream:
                while block := gdal.VSIFReadL(1, 1 << 24, source):
                    stream.write(block)
        finally:
            gdal.VSIFCloseL(source)
    except RuntimeError as error:
        raise FileError(one_line(error)) from None
    finally:
        gdal.Unlink(name)


def reference_of(crs):
    """The spatial reference of WKT, AUTHORITY:CODE or anything that GDAL knows; None for None.

    x is the first axis, whatever the authority says. Raises ValueError for what GDAL does not know.
    """
    if not crs:
        return None
    gdal_module()
    from osgeo import osr

    reference = osr.SpatialReference()
    try:
        with quiet():
            reference.SetFromUserInput(crs)
    except RuntimeError:
        raise ValueError(f"{crs} is not a coordinate reference system that GDAL knows") from None
    reference.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return reference


def name_of(crs):
    """"ETRS89 / UTM zone 32N (EPSG:25832)" of what reference_of() takes."""
    reference = reference_of(crs)
    name, code = reference.GetName() or "", reference.GetAuthorityCode(None)
    if name.lower() in ("", "unnamed", "unknown", "undefined"):
        kind = "degrees" if reference.IsGeographic() else reference.GetAttrValue("PROJECTION") or "local"
        name = f"a system without a name ({kind.replace('_', ' ')})"
    return f"{name} ({reference.GetAuthorityName(None)}:{code})" if code else name


def same_system(one, other):
    """Whether x and y of two systems mean the same; None where that cannot be decided.

    Each is what reference_of() takes. Heights and the order of axes do not count.
    """
    if not one or not other or one == other:
        return True if one and other else None
    try:
        pair = [reference_of(crs) for crs in (one, other)]
    except (ImportError, ValueError):
        return None
    if any(reference.IsLocal() for reference in pair):
        return None
    return bool(flat(pair[0]).IsSame(flat(pair[1]), SAME_PLACES))


def flat(reference):
    """A spatial reference, for x and y alone from here on."""
    if reference.IsCompound():
        reference.StripVertical()
    reference.DemoteTo2D()
    return reference


def moving(crs, other):
    """A function that moves (n, 2) places from one system to another by OGR; what is not finite stays so.

    Both raise RuntimeError where there is no way, or no place.
    """
    from osgeo import osr

    with quiet():
        change = osr.CoordinateTransformation(*(flat(reference_of(one)) for one in (crs, other)))

    def moved(places):
        places = numpy.array(places[:, :2], "f8")
        finite = numpy.isfinite(places).all(axis=1)
        with quiet():
            found = numpy.array(change.TransformPoints(places[finite].tolist())).reshape(-1, 3)[:, :2]
        if not numpy.isfinite(found).all():
            raise RuntimeError("some points have no place there")
        places[finite] = found
        return places

    return moved


NEAR = 5.0  # metres; between ETRS89 and WGS 84, which people mix, there is less than one


def is_near(one, other):
    """Whether two systems give a place the same x and y but for a few metres, as ETRS89 and WGS 84."""
    from osgeo import osr

    pair = [reference_of(crs) for crs in (one, other)]
    area = pair[0].GetAreaOfUse()
    if area is None or pair[0].IsGeographic() != pair[1].IsGeographic():
        return False
    longitude = 0.5 * (area.west_lon_degree + area.east_lon_degree)
    latitude = 0.5 * (area.south_lat_degree + area.north_lat_degree)
    try:
        with quiet():
            (x, y, _), (u, v, _) = (
                osr.CoordinateTransformation(reference_of("EPSG:4326"), reference).TransformPoint(
                    longitude, latitude
                )
                for reference in pair
            )
    except RuntimeError:
        return False
    metres = 111000.0 if pair[0].IsGeographic() else pair[0].GetLinearUnits()
    return math.hypot(x - u, y - v) * metres < NEAR


def check_system(path, crs, other_path, other):
    """Refuses a file whose system is not that of another file, to a few metres.

    Raises FileError. Returns notes.
    """
    same = same_system(crs, other)
    if same is None and crs and other:
        lacks = "" if importlib.util.find_spec("osgeo") else "; install python3-gdal to compare them"
        words = f"whether {path} has the coordinate reference system of {other_path} is not known"
        return [words + lacks]
    if same is False and is_near(crs, other):
        return [
            f"{path} is in {name_of(crs)}, {other_path} in {name_of(other)}: taken as the same, "
            f"which holds to less than {NEAR:g} m"
        ]
    if same is False:
        raise FileError(
            f"{path}: its coordinate reference system is {name_of(crs)}, that of {other_path} is "
            f"{name_of(other)}: reproject one of them first, by ogr2ogr, gdalwarp or QGIS"
        )
    return []

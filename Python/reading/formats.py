# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What kind of file a file is: by its content, and where that says nothing by its name."""

import dataclasses
import importlib
import itertools
import os
import re

from .column_names import known_names
from .tables import known
from .text_blocks import wide_encoding
from ..messages import FileError
from ..paths import is_geodatabase, suffix_of

HEAD, LONG_HEAD = 4096, 1 << 16


@dataclasses.dataclass(frozen=True)
class Format:
    """A kind of file, and the module of this package that reads it.

    is_it   decides from (first bytes, path) whether a file is of this kind
    module  the module that reads points, by read_points() if no other function is named
    lines   the module whose read_lines(path, singular) reads boundaries and faults, or ""
    slices  the class that reads points slice by slice, or ""
    """

    name: str
    suffixes: str
    is_it: object
    module: str
    lines: str = ""
    slices: str = ""

    def reader(self):
        module, _, function = self.module.partition(".")
        return self._load(module, function or "read_points")

    def line_reader(self):
        return self._load(self.lines, "read_lines")

    def slice_reader(self):
        return self._load(*self.slices.split("."))

    def _load(self, module, function):
        found = getattr(importlib.import_module("." + module, __package__), function)

        def read(path, *arguments):
            try:
                return found(path, *arguments)
            except ImportError as error:
                needed = "python3-gdal" if "osgeo" in str(error) else error.name
                raise FileError(f"{path}: {self.name}; install {needed} to read it") from None

        return read


def begins(pattern):
    """A test whether a file begins with the pattern."""
    compiled = re.compile(pattern, re.DOTALL)
    return lambda head, path: compiled.match(head) is not None


FORTRAN = re.compile(rb"([\d.])[dD]([-+]?\d)")
CONTROL = bytes(set(range(32)) - set(b"\t\n\v\f\r\x1a\x1b"))


def is_stl(head, path):
    if re.match(rb"\s*solid\b.*?\bfacet\s+normal\b", head, re.DOTALL | re.IGNORECASE):
        return True
    facets = int.from_bytes(head[80:84], "little")
    return facets > 0 and os.path.getsize(path) == 84 + 50 * facets


def count_numbers(line):
    """How many words of a line of bytes are numbers, in quotes or not, also 1.5D+03 of Fortran."""
    found = 0
    for word in re.split(rb"[\s,;]+", line.strip()):
        try:
            float(FORTRAN.sub(rb"\1e\2", word.strip(b"\"'")))
            found += 1
        except ValueError:
            pass
    return found


def first_lines(head):
    """The first lines of a text that are neither blank nor comments; the last may be cut."""
    marks = "".join(known().signs["comments"]).encode()
    return [line for line in re.split(rb"[\r\n]+", head) if line.strip() and line.lstrip()[0] not in marks]


def is_text(head):
    return b"\0" not in head


def is_plain_text(head):
    """Whether these bytes can be text that somebody wrote; NUL may fill the end."""
    head = head.rstrip(b"\0\x1a\r\n")
    return head != b"" and len(head.translate(None, CONTROL)) == len(head)


def is_table(head, path):
    """Text that begins with numbers, or names of columns and numbers. Asked early: so usual."""
    lines = first_lines(head)
    if not is_text(head) or not lines or len(lines[0]) > 1000 or lines[0].lstrip()[:1] in b"{[<":
        return False
    if len(lines) > 1 and len(re.split(rb"[,;\t]", lines[0])) > 2 and not count_numbers(lines[0]):
        del lines[0]  # names of columns
    return count_numbers(lines[0]) >= max(2, len(lines[0].split()) / 2)


def is_numbers(head, path):
    """Text with numbers in it."""
    return is_text(head) and any(count_numbers(line) > 1 for line in first_lines(head))


def is_table_with_geometry(head, path):
    """A table of text with a header line, and well-known text of geometries below it."""
    return GEOMETRY.match(head) is not None


def is_npz(head, path):
    return re.match(rb"PK\x03\x04.{26}[^\0]{1,99}?\.npy", head, re.DOTALL) is not None


def is_adcirc(head, path):
    """Text of a title, two counts, and nodes 1, 2, ... of four numbers."""
    lines = [line.split() for line in re.split(rb"\r?\n", head)[1:4]]
    try:
        elements, nodes = map(int, lines[0][:2])
        ids = [int(line[0]) for line in lines[1:]]
        places = [[float(word) for word in line[1:4]] for line in lines[1:]]
    except (ValueError, IndexError):
        return False
    return elements > 0 and nodes > 2 and ids == [1, 2] and all(len(place) == 3 for place in places)


def is_gxf(head, path):
    """Text with the word that a grid of GXF begins with; long comments may stand before."""
    if head.lstrip()[:1] not in (b"!", b"#"):
        return False
    with open(path, "rb") as stream:
        return re.search(rb"(?m)^#GRID[ \t]*\r?$", stream.read(LONG_HEAD)) is not None


def is_tekal(head, path):
    """Text of Delft3D: of each line a name, which names no columns, the counts of rows and columns, rows."""
    found = re.match(rb"(?:\*[^\n]*\n)*(?!DSAA|\s*[-+.\d])([^\n]{1,99})\n\s*([1-9]\d*)\s+([23])\s*\n", head)
    if not found or known_names(found[1].decode("latin-1").split()) > 2:  # as "x y"
        return False
    with open(path, "rb") as stream:
        stream.seek(found.end())
        rows, after = list(itertools.islice(stream, int(found[2]))), next(stream, b"")
    is_block = len(rows) > 0 and count_numbers(rows[-1]) == int(found[3])
    return is_block and (not after.strip() or count_numbers(after) < len(after.split()))


def is_segments(head, path):
    """Text of lines that are marked where they begin, or by the mark at the end of the last one."""
    if re.match(SEGMENTS, head, re.DOTALL) or is_tekal(head, path):
        return True
    if not count_numbers(head.partition(b"\n")[0]):
        return False
    with open(path, "rb") as stream:
        stream.seek(max(0, os.path.getsize(path) - 99))
        return re.search(SEGMENT_END + rb"\s*$", stream.read() + b"\n") is not None


def is_saga_header(head, path):
    return re.match(rb"NAME\s*=[^\n]*\nDESCRIPTION\s*=.*\nDATAFORMAT", head, re.DOTALL) is not None


def is_ugrid(head, path):
    """netCDF, as itself or in HDF5, that has a mesh."""
    if head[:3] != b"CDF" and head[:4] != b"\x89HDF":
        return False
    try:
        from .ugrid import is_ugrid as has_mesh

        return has_mesh(path)
    except ImportError:
        return False


def gdal_reads(what):
    def is_it(_head, path):
        try:
            from ..gdal_common import kind_of

            return kind_of(path, what) is not None
        except ImportError:
            return False

    return is_it


TEXT = ".csv .xyz .txt .dat .asc .pts .tsv"
XML = rb"(\xef\xbb\xbf)?\s*(<\?xml.*?\?>\s*)?(<!--.*?-->\s*)*<VTKFile\b"
OBJ = rb"(\s*(#|mtllib |o |g |s |usemtl |vn |vt )[^\n]*\n)*\s*v\s+[-+.\d]"

GEOMETRY = re.compile(
    rb"[^\n]*\n[^\n]*\b(MULTI)?(POINT|LINESTRING|POLYGON)\s*Z?M?\s*\(", re.IGNORECASE
)

EARTHVISION = rb"(#[^\n]*\n)*#\s*(Type:\s*scattered data|Field:\s*\d)"
# Comments may stand before.
IESX = rb"(\s*[#!][^\n]*\n)*PROFILE [^\n]*TYPE +\d"
LANDXML = rb"(\xef\xbb\xbf)?\s*(<\?xml.*?\?>\s*)?(<!--.*?-->\s*)*<LandXML\b"
PCD = rb"(#[^\n]*\n)*VERSION [.\d]+\s*\nFIELDS"
DHI = rb"(\d+ +\d+ +)?\d+ +[A-Za-z][^\n]*\n *1\s+([-+.\deE]+\s+){3}\d+\s*\n *2\s"
ZMAP = rb"(\s*![^\n]*\n)*\s*@[^\n]*,\s*"
PETREL = rb"(#[^\n]*\n)*\s*(VERSION \d+\s+)?(?i:BEGIN HEADER)\s"
# Lines begin with > or ->, or end with 999 999 999.
SEGMENT_END = rb"\n[ \t]*999(\.0*)?([ \t]+999(\.0*)?){2}[ \t]*\r?\n"
SEGMENTS = rb"(#(?! ?@VGMT)[^\n]*\n)*(-?>|FFASCI|[ \t]*999(\.0*)?([ \t]+999(\.0*)?){2}\s*\n|.*?" + SEGMENT_END + b")"

# In the order of asking.
FORMATS = (
    Format("VTK's XML", ".vtp .vtu .vts .vtr .vti", begins(XML), "vtk_files", "vtk_files"),
    Format("VTK's legacy format", ".vtk", begins(rb"# vtk DataFile"), "vtk_files", "vtk_files"),
    Format("a PLY file", ".ply", begins(rb"ply\s"), "ply", "ply"),
    Format("a LAS file", ".las .laz", begins(rb"LASF"), "las", slices="las.LasSlices"),
    Format("an STL file", ".stl", is_stl, "vtk_files", "vtk_files"),
    Format("an OBJ file", ".obj", begins(OBJ), "vtk_files", "vtk_files"),
    Format("a GOCAD file", ".ts .vs .pl", begins(rb"GOCAD\s"), "gocad", "gocad"),
    Format(
        "a numpy array", ".npy", begins(rb"\x93NUMPY"), "arrays.read_array", slices="arrays.ArraySlices",
    ),
    Format("arrays of numpy", ".npz", is_npz, "arrays.read_array"),
    Format("an IRAP grid", ".irap .gri", begins(rb"\s*-996\s"), "irap.read_grid"),
    Format("a binary IRAP grid", ".irap .gri", begins(rb"\0\0\0\x20\xff\xff\xfc\x1c"), "irap.read_binary_grid"),
    Format("an IESX horizon", "", begins(IESX), "iesx", "iesx"),
    Format("a LandXML file", ".landxml", begins(LANDXML), "landxml", "landxml"),
    Format("a PCD file", ".pcd", begins(PCD), "pcd"),
    Format("an ADCIRC mesh", ".14", is_adcirc, "adcirc"),
    Format("a DHI mesh", ".mesh", begins(DHI), "adcirc.read_dhi"),
    Format("a CPS-3 grid", ".cps .cps3", begins(rb"\s*FSASCI\b"), "horizons.read_cps3_grid"),
    Format("a GXF grid", ".gxf", is_gxf, "gxf.read_grid"),
    Format("a ZMAP+ grid", ".zmap .dat", begins(ZMAP + rb"GRID\s*,"), "horizons.read_zmap"),
    Format("ZMAP+ points", ".zmap .dat", begins(ZMAP + rb"DATA\s*,"), "horizons.read_zmap_points"),
    Format("EarthVision data", ".ev", begins(EARTHVISION), "horizons.read_earthvision"),
    Format("Petrel points", "", begins(PETREL), "horizons.read_petrel_points"),
    Format("lines in segments", ".gmt .pli .pliz .pol .ldb", is_segments, "horizons.read_segments", "horizons"),
    Format("a raster", ".sgrd .sdat", is_saga_header, "rasters"),
    Format("a vector file", ".csv", is_table_with_geometry, "vectors", "vectors"),
    Format("a vector file", ".gmt", begins(rb"# ?@VGMT"), "vectors", "vectors"),
    Format("a text table", TEXT, is_table, "text.read_text", slices="text.TextSlices"),
    Format(
        "a vector file",
        ".gpkg .shp .geojson .json .dxf .gml .kml .kmz .fgb .gpx .tab .mif .dgn .dwg .gdb",
        gdal_reads("vectors"),
        "vectors",
        "vectors",
    ),
    Format("a UGRID mesh", ".nc", is_ugrid, "ugrid"),
    Format(
        "a raster",
        ".tif .tiff .dem .asc .grd .nc .bag .vrt .img .hgt .flt .bil",
        gdal_reads("raster"),
        "rasters",
    ),
    Format("a text table", TEXT, is_numbers, "text.read_text", slices="text.TextSlices"),
)


# What people try that holds no points, or none that are read: (what it begins with, what to do).
FOREIGN = tuple(
    (re.compile(pattern, re.IGNORECASE), words)
    for pattern, words in (
        (rb"PK\x03\x04(?s:.{26}(mimetype|\[Content_Types\]|xl/|docProps/|_rels/|word/))",
         "is a spreadsheet or document of Office (.xlsx, .ods): save the table as .csv"),
        (rb"\xd0\xcf\x11\xe0", "is a spreadsheet or document of old Office (.xls): save the table as .csv"),
        (rb"7z\xbc\xaf|Rar!", "is an archive of 7-Zip or RAR: unpack it"),
        (rb"STORMGRID_BINARY", "is a Storm grid, which is not read: export it as IRAP, ZMAP+ or CPS-3"),
        (rb"MATLAB 5\.0|.{512}\x89HDF[^\n]*MATLAB", "is a MATLAB file: save x, y and z by writematrix() as .csv"),
        (rb"PAR1", "is a Parquet table: save it as .csv, in pandas by to_csv()"),
        (rb"\x80[\x02-\x05]", "is a pickle of Python: save the array by numpy.save()"),
        (rb"\$MeshFormat", "is a mesh of Gmsh: gmsh {path} -save -format vtk -o mesh.vtk makes one of it that is read"),
        (rb"MESH2D\b", "is a mesh of SMS (.2dm): save it as .vtu or .ply, in QGIS as points"),
        (rb"%PDF", "is a PDF document"),
        (rb"\s*<(!doctype )?html", "is a web page"),
        (rb"ASTM-E57", "is an E57 file, which is not read: convert it to .las or .ply"),
        (rb"\s*~V", "is a well log, not a LAS file of points"),
        (rb"C?OFF\s", "is an OFF file, which is not read: convert it to .ply"),
        (rb"glTF", "is a glTF file, which is not read: convert it to .ply or .obj"),
        (rb"[^\n]{0,60}\$[A-Z]{2}(GGA|GLL|RMC|GNS|DBT|DBS|DPT|VTG|GSA|GSV|ZDA|HDT),",
         "is a log of NMEA sentences: gpsbabel -i nmea -f {path} -o gpx -F track.gpx makes heights of it, which track.gpx "
         "gives; soundings need a program for surveys, which writes x, y and depth"),
        (rb"H\d{4}[A-Z][^\n]*\n([^\n]*\n)*?[A-Z]",
         "is a file of UKOOA P1/90: awk '/^[^H]/ {print substr($0,47,9), substr($0,56,9), substr($0,65,6)}' {path} > "
         "points.txt takes x, y and depth out of it"),
        (rb"G00,\d\d,[^\n]*\n([A-Z]\d\d,[^\n]*\n)*?A01,",
         "is a SIMA file, with y before x: awk -F, '$1 == \"A01\" {print $5, $4, $6}' {path} > points.txt takes x, y and z "
         "out of it"),
        (rb"[^,\n]*,\s*\d{1,2}-[a-z]{3}-\d{2}[^\n]*\n\s*0,\s*-?\d+\.\d+,",
         "is a Surpac string file, with y before x: awk -F, '$1 + 0 > 0 {print $3, $2, $4}' {path} > points.txt takes x, "
         "y and z out of it"),
        (rb"\s*\*?11\d{4}[+-]|CO,Nikon RAW|\s*\x02?\s*00[NT]MS|(--[^\n]*\s+)*(JB,NM[^\n]*\s+MO|SP,PN|OC,OP|LS,HI)|"
         rb"\x02_'|S[DS] {6}\d|\s*0001 +[A-Z.]+\s*\n\s*0002 |(\d\d?=[^\n]*\n){4}|\{\d+ [^\n{}]*\}",
         "is a raw file of a total station (Leica GSI, Nikon, Sokkia, Topcon, Trimble, Zeiss): export x, y and z as text "
         "from the instrument or its program"),
        (rb"(\xef\xbb\xbf)?\s*(<\?xml[^>]*>\s*)?<TrainingCenterDatabase",
         "is a track of Garmin: gpsbabel -i gtrnctr -f {path} -o gpx -F track.gpx makes one of it that is read"),
        (rb"A[A-Z]{3}[^\n]*\n(H[FOP]|I\d\d)[^\n]*\n",
         "is a track of a flight recorder: gpsbabel -i igc -f {path} -o gpx -F track.gpx makes one of it that is read"),
        (rb"\s*\d+\s*\n\s*\d+\s*\n(\s*\S+ +\S+ +\S+ *\r?\n){4}(\s*\S+ +\S+ +\S+ +\S+ *\r?\n){4}",
         "is a Leica PTX scan: convert it to .las or .ply, by CloudCompare -O {path} -C_EXPORT_FMT PLY -SAVE_CLOUDS"),
        (rb"FTP NEW \d|((VER|INF|FTP|TND|PRJ) [^\n]*\n)+(DEV|POS|EC1|ECH|MSG) ",
         "is a raw file of HYPACK, whose soundings have no places yet: edit it in HYPACK and save it as .xyz"),
    )
)


def recognise(path):
    """(Format, notes) of a file. Raises FileError for what is of no known kind."""
    if is_geodatabase(path):
        return next(kind for kind in FORMATS if ".gdb" in kind.suffixes), []
    with open(path, "rb") as stream:
        head = stream.read(HEAD)
    if encoding := wide_encoding(head):
        head = head.decode(encoding, "ignore").encode()
    for pattern, words in FOREIGN:
        if pattern.match(head):
            raise FileError(f"{path}: {words.replace('{path}', path)}")
    suffix = suffix_of(path)
    named = [kind for kind in FORMATS if suffix in kind.suffixes.split()]
    for kind in FORMATS:
        if kind.is_it(head, path):
            if named and kind.name not in [other.name for other in named]:
                return kind, [f"by its content this is {kind.name}, not {named[-1].name}"]
            return kind, []
    # The reader of text says best what is wrong with a text.
    is_plain = is_plain_text(head) and (not suffix or re.search(rb"\d", head))
    if suffix in TEXT.split() or is_plain and (not named or head.lstrip()[:1] in (b"[", b"{")):
        return FORMATS[-1], []
    if named:
        return named[0], []
    raise FileError(f"{path}: is of no kind that can be read: {all_suffixes()}")


def all_suffixes():
    """What can be read, as one line."""
    names = dict.fromkeys(suffix for kind in FORMATS for suffix in kind.suffixes.split())
    return " ".join(names)

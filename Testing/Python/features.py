# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of features and modes: what each property and input of the filters does in each mode.

TestFeaturesAndModes.py runs the rows, and compares what comes out with the cells. This script prints the
table as Markdown, as it stands in Documentation/Features.md.
"""

import ast
import re
import types

MODES = ("1 thread", "2 threads", "2 ranks", "4 ranks", "1 piece", "4 pieces", "2 ranks, 2 pieces each")
WORDS = {
    "s": "same", "g": "gathers", "r": "refused", "d": "differs", "-": "none",
}
CLASSES = {
    "Delaunay": "vtkGridDelaunay2D", "Trim": "vtkTrimOutwardTriangles", "Fill": "vtkFillElevationHoles",
}

# What a row is about | properties, of the row's filter or Filter.Property | the input: a function of
# modes.py, and what is changed of it | for each mode a letter of WORDS; with d the number of a remark in
# Documentation/Features.md, which explains the words.
TABLE = """
Delaunay
points                            |                            | points                       | s  s  s  s  s  s  s
points of floats                  |                            | points + float               | s  s  s  s  s  s  s
search by voxel traversal         | SearchStrategy=0           | points                       | s  s  s  s  s  s  s
search for compactness            | SearchStrategy=1           | points                       | s  s  s  s  s  s  s
lattice found                     | LatticeMode=0              | lattice                      | s  s  s  s  s  s  s
lattice given                     | Lattice=(600000.0, 6000000.0, 2.0, 1.5, -0.9, 1.2) | sparse lattice               | s  s  s  s  s  s  s
lattice off                       | LatticeMode=1              | lattice                      | s  s  s  s  s  s  s
lattice within a tolerance        | LatticeTolerance=0.1       | loose lattice                | s  s  s  s  s  s  s
edge limit                        | MaximumEdgeLength=2.0      | points                       | s  s  s  s  s  s  s
edge limit that leaves out most points| MaximumEdgeLength=0.3      | points                       | s  s  s  s  d1 d1 d1
elevation error                   | MaximumElevationError=0.03  | points                       | s  s  g  g  r  r  r
the same, data-dependent edges    | MaximumElevationError=0.03, DataDependentEdges=True | points                       | s  s  g  g  r  r  r
the same, with constraints        | MaximumElevationError=0.03  | straight line                | s  s  g  g  r  r  r
the same, constraints simplified  | MaximumElevationError=0.03, SimplifyConstraints=True | straight line                | s  s  g  g  r  r  r
number of points                  | MaximumNumberOfPoints=60    | points                       | s  s  g  g  r  r  r
the same, with constraints        | MaximumNumberOfPoints=60, SimplifyConstraints=True | straight line                | s  s  g  g  r  r  r
number of points before an elevation error | MaximumNumberOfPoints=60, MaximumElevationError=0.001 | points                       | s  s  g  g  r  r  r
constraints                       |                            | breaklines                   | s  s  s  s  s  s  s
constraints on one rank only      |                            | breaklines + on one          | s  s  s  s  s  s  s
constraints, values of points     |                            | breaklines + strings + integers | s  s  s  s  s  s  s
constraints draped                | DrapeConstraints=True      | breaklines                   | s  s  g  g  r  r  r
constraints, some points without z|                            | soft lines                   | s  s  g  g  r  r  r
duplicates, keep the first        | DuplicatePolicy=0          | duplicates                   | s  s  s  s  s  s  s
duplicates, keep the last         | DuplicatePolicy=1          | duplicates                   | s  s  s  s  s  s  s
duplicates, keep the lowest       | DuplicatePolicy=2          | duplicates                   | s  s  s  s  s  s  s
duplicates, keep the highest      | DuplicatePolicy=3          | duplicates                   | s  s  s  s  s  s  s
points that are not finite        |                            | not finite                   | s  s  s  s  s  s  s
two points                        |                            | two points                   | s  s  s  s  s  s  s
no points                         |                            | no points                    | s  s  s  s  s  s  s
points of another type of data set|                            | points + unstructured        | s  s  s  s  s  s  s
points in single precision        | OutputPointsPrecision=0    | breaklines                   | s  s  s  s  r  r  r
unused points removed             | RemoveUnusedPoints=True    | not finite + global ids      | s  s  s  s  r  r  r
point data: float                 |                            | points + float array         | s  s  s  s  s  s  s
point data: double                |                            | points + double array        | s  s  s  s  s  s  s
point data: integers of all sizes |                            | points + integers            | s  s  s  s  s  s  s
point data: strings               |                            | points + strings             | s  s  s  s  s  s  s
point data: vectors               |                            | points + vectors             | s  s  s  s  s  s  s
point data: normals               |                            | points + normals             | s  s  s  s  s  s  s
point data: pedigree ids          |                            | points + pedigree ids        | s  s  s  s  s  s  s
point data: global ids            |                            | points + global ids          | s  s  s  s  s  s  s
copies of points, marked as ghosts|                            | points + copies              | s  s  s  s  s  s  s
composite: multiblock             |                            | points + multiblock          | s  s  s  s  -  -  -
composite: collection             |                            | points + collection          | s  s  s  s  -  -  -
composite: partitions             |                            | points + partitions          | s  s  d3 d3 -  -  -

Trim
boundary given                    |                            | coast                        | s  s  s  s  s  s  s
boundary on one rank only         |                            | coast + on one               | s  s  s  s  s  s  s
boundary, some points without z   |                            | coast + no z                 | s  s  s  s  s  s  s
boundary with lakes and an island |                            | coast and lakes              | s  s  s  s  s  s  s
exact test                        | OutwardTest=0              | coast                        | s  s  s  s  s  s  s
inward-normal test                | OutwardTest=1              | coast                        | s  s  g  g  r  r  r
edges not recovered, none missing | RecoverBoundary=False      | coast along edges            | s  s  s  s  s  s  s
edges not recovered, some missing | RecoverBoundary=False      | coast                        | s  s  s  s  s  s  s
edges follow the surface, also of a lattice | BoundaryEdges=0        | lattice and lakes            | s  s  s  s  s  s  s
edges straight                    | BoundaryEdges=1            | coast                        | s  s  s  s  s  s  s
edges straight, own elevations    | BoundaryEdges=2            | coast                        | s  s  s  s  s  s  s
boundary found                    |                            | gaps                         | s  s  s  s  s  s  s
boundary found along tracks       |                            | tracks                       | s  s  s  s  s  s  s
boundary found, inward-normal test| OutwardTest=1              | gaps                         | s  s  g  g  r  r  r
gap tolerance                     | GapTolerance=2.5           | gaps                         | s  s  s  s  s  s  s
steps of a grid                   | GridSteps=(2.0, 1.5, -0.9, 1.2) | lattice                      | s  s  s  s  s  s  s
points in single precision        | OutputPointsPrecision=0    | coast                        | s  s  s  s  r  r  r
unused points removed             | RemoveUnusedPoints=True    | coast + global ids           | s  s  s  s  r  r  r
points of floats                  |                            | coast + float                | s  s  s  s  s  s  s
point data: float, double         |                            | coast + float array + double array | s  s  s  s  s  s  s
point data: integers, strings     |                            | coast + integers + strings   | s  s  s  s  s  s  s
point data: vectors               |                            | coast + vectors              | s  s  s  s  s  s  s
point data: normals               |                            | coast + normals              | s  s  s  s  s  s  s
point data: pedigree ids          |                            | coast + pedigree ids         | s  s  s  s  s  s  s
point data: global ids            |                            | coast + global ids           | s  s  s  s  s  s  s
composite: multiblock             |                            | coast + multiblock           | s  s  s  s  -  -  -
triangles from elsewhere, cell data|                            | surface and coast            | s  s  s  s  -  -  -
the same, clockwise               |                            | surface and coast + clockwise | s  s  g  g  -  -  -
the same, with vertices           |                            | surface and coast + vertices | s  s  s  s  -  -  -
the same, with marked copies      |                            | surface and coast + copies   | s  s  s  s  -  -  -
the same, boundary found          |                            | surface                      | s  s  s  s  -  -  -

Fill
interpolation: mean of neighbours | Interpolation=0            | coast and lakes              | s  s  s  s  s  s  s
interpolation: membrane           | Interpolation=1            | coast and lakes              | s  s  s  s  s  s  s
interpolation: thin plate         | Interpolation=2            | coast and lakes              | s  s  s  s  s  s  s
interpolation: adaptive           | Interpolation=3            | coast and lakes              | s  s  s  s  s  s  s
interpolation: cubic spline       | Interpolation=4            | coast and lakes              | s  s  s  s  s  s  s
interpolation: level              | Interpolation=5            | coast and lakes              | s  s  s  s  s  s  s
on the nodes of a lattice         |                            | lattice and lakes            | s  s  s  s  s  s  s
long triangles opened             | OpenEdgeLength=2.5         | coast and lakes              | s  s  s  s  s  s  s
largest hole                      | MaximumHoleSize=4.0        | coast and lakes              | s  s  s  s  s  s  s
most edges of a hole              | MaximumHoleEdges=13        | coast and lakes              | s  s  s  s  s  s  s
cut-outs of the boundary, open    |                            | coast and lakes              | s  s  s  s  s  s  s
cut-outs of the boundary, filled  | FillCutOuts=True           | coast and lakes              | s  s  s  s  s  s  s
only holes that touch areas filled | AreaMode=0                 | coast and lakes + areas      | s  s  s  s  s  s  s
holes that touch areas kept open  | AreaMode=1                 | coast and lakes + areas      | s  s  s  s  s  s  s
areas on one rank only            |                            | coast and lakes + areas + on one | s  s  s  s  s  s  s
areas, long triangles opened      | OpenEdgeLength=2.5         | coast and lakes + areas      | s  s  s  s  s  s  s
areas, points of floats           |                            | coast and lakes + areas + float | s  s  s  s  s  s  s
levels of areas                   | LevelArrayName="Water"     | coast and lakes + areas      | s  s  s  s  s  s  s
levels of areas, on one rank only | LevelArrayName="Water", Interpolation=5 | coast and lakes + areas + on one | s  s  s  s  s  s  s
most points inserted              | MaximumNumberOfInsertedPoints=50, Trim.BoundaryEdges=1 | coast and lakes              | s  s  s  s  s  s  s
most points expected              | MaximumNumberOfExpectedPoints=20 | coast and lakes              | s  s  s  s  s  s  s
spacing                           | Spacing=0.5                | coast and lakes              | s  s  s  s  s  s  s
as dense as the surface around    | MatchDensity=True, Delaunay.MaximumEdgeLength=2.2 | points                       | s  s  s  s  s  s  s
the same, long triangles opened   | MatchDensity=True, OpenEdgeLength=2.5 | coast and lakes              | s  s  s  s  s  s  s
a narrower interval               | ConfidenceLevel=0.7        | coast and lakes              | s  s  s  s  s  s  s
point data not interpolated       | InterpolatePointData=False | coast and lakes              | s  s  s  s  s  s  s
holes that an edge limit makes    | Delaunay.MaximumEdgeLength=2.2 | points                       | s  s  s  s  s  s  s
points in single precision        | OutputPointsPrecision=0    | coast and lakes              | s  s  s  s  r  r  r
points of floats, in double        | OutputPointsPrecision=1, Delaunay.MaximumEdgeLength=2.2 | points + float               | s  s  s  s  r  r  r
unused points removed, by all filters | RemoveUnusedPoints=True, Trim.RemoveUnusedPoints=True, Delaunay.RemoveUnusedPoints=True | coast and lakes + global ids | s  s  s  d2 r  r  r
points of floats                  |                            | coast and lakes + float      | s  s  s  s  s  s  s
point data: float, double         |                            | coast and lakes + float array + double array | s  s  s  s  s  s  s
point data: integers, strings     |                            | coast and lakes + integers + strings | s  s  s  s  s  s  s
point data: vectors               |                            | coast and lakes + vectors    | s  s  s  s  s  s  s
point data: normals               |                            | coast and lakes + normals    | s  s  s  s  s  s  s
point data: pedigree ids          |                            | coast and lakes + pedigree ids | s  s  s  s  s  s  s
point data: global ids            |                            | coast and lakes + global ids | s  s  s  d2 s  d2 d2
composite: multiblock             |                            | coast and lakes + multiblock | s  s  s  s  -  -  -
triangles from elsewhere, cell data|                            | surface                      | s  s  s  s  -  -  -
the same, clockwise               |                            | surface + clockwise          | s  s  s  s  -  -  -
the same, with vertices           |                            | surface + vertices           | s  s  g  g  -  -  -
the same, with marked copies      |                            | surface + copies             | s  s  g  g  -  -  -
the same, global ids              |                            | surface + global ids         | s  s  s  s  -  -  -
"""


def rows():
    """The rows: filter, feature, properties {name: value} and their text, input, cells {mode: word}."""
    found, of = [], None
    for line in TABLE.strip().splitlines():
        if "|" not in line:
            of = line or of
            continue
        feature, text, given, cells = (part.strip() for part in line.split("|"))
        call = ast.parse("f(%s)" % re.sub(r"\b(\w+)\.(\w+)=", r"\1__\2=", text), mode="eval").body
        values = {word.arg.replace("__", "."): ast.literal_eval(word.value) for word in call.keywords}
        words = [" ".join((WORDS[cell[0]], *cell[1:])) for cell in cells.split()]
        found.append(types.SimpleNamespace(
            filter=of, feature=feature, properties=values, text=text, input=given,
            cells=dict(zip(MODES, words, strict=True))))
    return found


def line_of(cells):
    return "| " + " | ".join(cells) + " |"


def markdown():
    """A table for each filter."""
    lines = []
    for name, filter_ in CLASSES.items():
        lines += ["### " + filter_, "", line_of(("feature", "set", *MODES)), "|---" * (len(MODES) + 2) + "|"]
        for row in rows():
            if row.filter == name:
                is_set = "`%s`" % row.text if row.text else ""
                lines.append(line_of((row.feature, is_set, *row.cells.values())))
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    print(markdown(), end="")

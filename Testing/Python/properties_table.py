# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of Documentation/Properties.md, made of Python/properties.ini.

`python3 Testing/Python/properties_table.py` prints it. It needs neither VTK nor a build.
"""

import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
from Python.description import DESCRIBED  # noqa: E402

TITLES = {
    "files": "Files",
    "read": "Reading",
    "faults": "Triangulation, vtkGridDelaunay2D",
    "pieces": "Surfaces larger than memory",
    "trim": "Trimming, vtkTrimOutwardTriangles",
    "fill": "Hole filling, vtkFillElevationHoles",
    "results": "Results",
}
SAME_TITLE = {"delaunay": "faults", "": "faults", "picture": "results"}
SECOND_INPUTS = {"faults": "SetSourceData", "boundary": "SetBoundaryData",
                 "fill_only": "SetAreasData", "keep_open": "SetAreasData"}


def row_of(one):
    names = ["`%s`" % option for option in one.options if "program" in one.places]
    setter = SECOND_INPUTS.get(one.name, one.setter)
    panels = [one.label_in(place) for place in ("chain", "reader") if place in one.places]
    takes = "on or off" if one.kind.value_type == "bool" else one.takes.replace("|", "/")
    takes += ", in %s" % one.kind.unit if one.kind.unit else ""
    remarks = [] if one.in_pieces else ["not in pieces"]
    for needs, others, _ in one.rules():
        listed = " or ".join("`%s`" % DESCRIBED[other].options[0] for other in others)
        remarks.append(("with " if needs else "without ") + listed)
    default = one.default_in("program" if names else "filter" if setter else one.places[0])
    cells = (" ".join(names), "`%s`" % setter if setter else "", (panels + [""])[0], takes, default,
             "; ".join([one.line, *remarks]))
    return "| " + " | ".join(cells) + " |"


def markdown():
    lines = []
    for step, title in TITLES.items():
        lines += ["## " + title, "", "| option | class | panel | takes | default | what it is |",
                  "|---|---|---|---|---|---|"]
        of_title = (one for one in DESCRIBED.values() if SAME_TITLE.get(one.step, one.step) == step)
        lines += [row_of(one) for one in of_title] + [""]
    return "\n".join(lines)


if __name__ == "__main__":
    print(markdown(), end="")

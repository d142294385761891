# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The --help of the program: help.txt, with its options as properties.ini describes them.

Needs neither VTK nor a build: in the folder of the repository, python3 -m Python.help prints it.
"""

import os
import textwrap

from .description import DESCRIBED, KINDS

GROUPS = {
    ("files",): "",
    ("read",): "reading",
    ("faults", "delaunay", ""): "triangulation (vtkGridDelaunay2D)",
    ("pieces",): "surfaces larger than memory",
    ("trim",): "trimming (vtkTrimOutwardTriangles)",
    ("fill",): "hole filling (vtkFillElevationHoles)",
    ("results", "picture"): "results",
}
COLUMN, WIDTH = 24, 104


def option_text(one):
    """The lines of an option: its names, what it takes, what it does, and its default."""
    is_off = "off" in one.words
    names = list(one.options)
    if one.kind is KINDS["switch"] and not is_off:
        names += [option.replace("--", "--no-", 1) for option in one.options]
    head = "  " + ", ".join(f"{name} {one.kind.metavar}".rstrip() for name in names)
    words = one.words["off"] if is_off else one.help_in("program")
    default = one.default_in("program")
    if default and not is_off and one.words["takes"] != "flag":
        words += f" (default: {default})"
    first = head.ljust(COLUMN) if len(head) <= COLUMN - 2 else head + "\n" + " " * COLUMN
    lines = textwrap.wrap(words, WIDTH - COLUMN, break_on_hyphens=False)
    return first + ("\n" + " " * COLUMN).join(lines)


def help_text():
    lines = []
    for steps, title in GROUPS.items():
        lines += ["", title + ":"] if title else []
        of_group = (one for one in DESCRIBED.values() if one.step in steps)
        lines += [option_text(one) for one in of_group if "program" in one.places]
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "help.txt")
    with open(path, encoding="utf-8") as stream:
        return stream.read().replace("@options@", "\n".join(lines))


if __name__ == "__main__":
    print(help_text(), end="")

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What VTK's readers do not notice by themselves.

They trust the counts of a file: what is missing stays as it was in memory, or the program ends. So
announced counts are compared with what is there, and a reader that may crash is tried in a process
of its own first.
"""

import math
import os
import re
import signal
import time
import warnings

from vtkmodules.vtkCommonCore import vtkSMPTools

from ..messages import FileError
from .horizons import numbers

TYPES = {"char": 1, "short": 2, "int": 4, "long": 8, "float": 4, "double": 8, "vtkidtype": 4}
TYPES.update({"vtktypeint64": 8, "vtktypeuint64": 8})
# The lines of a legacy file that announce numbers.
ANNOUNCED = re.compile(
    rb"^(?:(?P<tuples>POINT_DATA|CELL_DATA)|(?:POINTS|[XYZ]_COORDINATES)|CELL_TYPES"
    rb"|(?P<cells>CELLS|VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS)|(?P<ids>OFFSETS|CONNECTIVITY)"
    rb"|(?P<scalars>SCALARS)|(?P<vectors>VECTORS|NORMALS)|(?P<field>[A-Za-z_]\S*))"
    rb"[ \t]+(?P<words>[^\n]*\S)[ \t\r]*(?P<end>\n|\Z)(?:LOOKUP_TABLE[^\n]*\n)?",
    re.IGNORECASE | re.MULTILINE,
)
# What a text STL file consists of.
SOLID = re.compile(rb"\s*solid\b[^\n]*(?:\n|\Z)", re.IGNORECASE)
NUMBER = rb"\s+[-+]?(?:\d+\.?\d*(?:e[-+]?\d+)?|\.\d+(?:e[-+]?\d+)?|nan|inf)"
FACET = re.compile(
    rb"\s*(?:color\b[^\n]*\s+)*facet\b[^\n]*\s+outer\s*loop"
    rb"(?:\s+vertex" + 3 * NUMBER + rb"){3}\s+end\s*loop\s+end\s*facet(?!\S)",
    re.IGNORECASE,
)
END_OF_SOLID = re.compile(rb"\s*end\s*solid\b[^\n]*", re.IGNORECASE)
# Equal numbers can be packed to some thousandth of their size.
PACKED = 10000


def survives(work, waiting):
    """Whether work() comes to an end, tried in a child where there is fork.

    waiting()  is called while it works; what it raises ends the child
    """
    if not hasattr(os, "fork"):
        return True
    with warnings.catch_warnings():
        # VTK's threads wait, and the child uses none of them.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        try:
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            # The threads of the parent are not in the child.
            vtkSMPTools.SetBackend("Sequential")
            limit_memory()
            work()
        finally:
            os._exit(0)
    try:
        while not (done := os.waitpid(child, os.WNOHANG))[0]:
            waiting()
            time.sleep(0.001)
    except BaseException:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        raise
    return os.WIFEXITED(done[1])


def limit_memory():
    """A count beyond all memory becomes a crash of the child, not of the machine."""
    try:
        import resource

        memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    except (ImportError, ValueError, OSError):
        pass


def check(path, suffix, progress):
    """Raises FileError for a file that VTK's reader of this suffix would take for whole."""
    if suffix == ".stl":
        reason = why_no_stl(path)
    elif suffix == ".vtk":
        reason = why_no_legacy(path, lambda _: progress(0.0))
    elif suffix.startswith(".vt"):
        reason = why_no_xml(path)
    else:
        reason = None
    if reason:
        raise FileError(f"{path}: {reason}")


def why_no_stl(path):
    with open(path, "rb") as stream:
        head = stream.read(84)
    size, facets = os.path.getsize(path), int.from_bytes(head[80:84], "little")
    if head.lstrip()[:5].lower() == b"solid" and b"\0" not in head:
        return why_no_stl_text(path)
    if size != 84 + 50 * facets:
        return (
            f"is cut off, or not an STL file: {facets:,} facets are announced, "
            f"which take {84 + 50 * facets:,} bytes, not {size:,}"
        )
    return None


def why_no_stl_text(path):
    with open(path, "rb") as stream:
        data = stream.read().rstrip()
    at, facets = 0, 0
    while at < len(data) and (found := SOLID.match(data, at)):
        while found:
            at, facets = found.end(), facets + 1
            found = FACET.match(data, at)
        facets -= 1
        found = END_OF_SOLID.match(data, at)
        if not found:
            break
        at = found.end()
    if found and at == len(data):
        return None
    return (
        f"cannot be read: it is cut off or damaged after {facets:,} whole facets, "
        f"in line {data.count(bytes([10]), 0, at) + 1:,} or later"
    )


def why_no_xml(path):
    with open(path, "rb") as stream:
        head = stream.read(1 << 16)
        if b"WholeExtent" in head:
            head += stream.read()  # pieces may lie anywhere
        head = head.partition(b"<AppendedData")[0]
        size = stream.seek(0, os.SEEK_END)
        stream.seek(-min(size, 200), os.SEEK_END)
        if not stream.read().rstrip(b"\0\r\n\t ").endswith(b"</VTKFile>"):
            return "cannot be read: it is cut off, </VTKFile> is missing at its end"
    for what, count in re.findall(rb'\bNumberOf(Points|Verts|Lines|Polys|Cells)="(\d+)"', head):
        if int(count) > PACKED * size:
            return f"is damaged: it cannot hold {int(count):,} {what.decode().lower()}"
    # Nodes of grids that no piece covers stay as they were in memory.
    boxes = []
    for text in re.findall(rb"""\b(?:Whole)?Extent\s*=\s*["']([^"']*)["']""", head):
        box = [int(word) for word in text.split() if re.fullmatch(rb"[-+]?\d+", word)]
        if len(box) != 6 or any(a > b for a, b in zip(box[::2], box[1::2])):
            return f"is damaged: '{text.decode('latin-1')[:60]}' is not an extent of a grid"
        boxes.append(box)
    for box in boxes:
        whole = boxes[0]
        nodes = math.prod(b - a + 1 for a, b in zip(box[::2], box[1::2]))
        if nodes > PACKED * size:
            return f"is damaged: it cannot hold {nodes:,} nodes"
        if any(a < b for a, b in zip(box[::2], whole[::2])) or any(
            a > b for a, b in zip(box[1::2], whole[1::2])
        ):
            box, whole = (" ".join(map(str, extent)) for extent in (box, whole))
            return f"is damaged: a piece of extent {box} is not within the whole extent {whole}"
    cells = [math.prod(max(b - a, 1) for a, b in zip(box[::2], box[1::2])) for box in boxes]
    if cells and sum(cells[1:]) < cells[0]:
        return (
            f"is cut off or damaged: its whole extent {' '.join(map(str, boxes[0]))} has "
            f"{cells[0]:,} cells, its pieces only {sum(cells[1:]):,}"
        )
    return None


def why_no_legacy(path, progress):
    """Compares how many numbers a legacy file announces with how many follow."""
    with open(path, "rb") as stream:
        data = stream.read()
    is_text = data[:600].upper().split(b"\n")[2:3] == [b"ASCII"]
    tuples, cells, at = 0, [], 0
    while found := ANNOUNCED.search(data, at):
        at = found.end()
        if not found["end"] and not found["field"]:
            return "is cut off"
        words = found["words"].split()
        name = found.group().split()[0].decode("latin-1").upper()
        count, kind = 0, b"char"
        try:
            if found["tuples"]:
                tuples = int(words[0])
            elif found["cells"] and data[at : at + 7].upper() == b"OFFSETS":
                cells = [int(words[0]), int(words[1])]  # since 5.0; before, the numbers follow
            elif found["cells"]:
                count, kind = max(int(words[0]), int(words[1])), b"int"
            elif found["ids"]:
                count, kind = cells.pop(0), words[0]
            elif found["scalars"]:
                count, kind = tuples * int((words + [1])[2]), words[1]
            elif found["vectors"]:
                count, kind = 3 * tuples, words[1]
            elif found["field"]:
                count, kind = int(words[0]) * int(words[1]), words[2]
            elif name == "CELL_TYPES":
                count, kind = int(words[0]), b"int"
            else:
                count, kind = int(words[0]) * (3 if name == "POINTS" else 1), words[1]
            size = TYPES[re.sub(b"^(un)?signed_", b"", kind.lower()).decode("latin-1")]
        except (ValueError, IndexError, KeyError):
            continue  # VTK reports itself what this is
        there = (len(data) - at) // size
        if is_text:
            there = len(numbers(data[at:], progress)) if count else 0
        if not 0 <= count <= there:
            return f"is cut off or damaged: {count:,} {name} are announced, {there:,} found"
        at += 0 if is_text else count * size
    return None

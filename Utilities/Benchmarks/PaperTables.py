# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of reproduce-paper: Markdown between the marks of a document, and CSV."""

import csv
import math
import re

# Nguyen, Table I: points, faces and ms of CTC, of VTS, of Ball Pivoting; on one core of a Core2Duo.
PAPER = {
    15626: (29871, 14631, 29871, 13360, 29990, 18984),
    32402: (61073, 30911, 61073, 28984, 58030, 67871),
    60511: (115828, 68797, 115828, 63223, 110982, 225037),
    68956: (125463, 112117, 125463, 93246, 118273, 268276),
    98231: (181851, 194682, 181851, 162451, 174582, 859341),
    148317: (266187, 246435, 266187, 218713, 267842, 2017632),
    886639: (1618624, 1473188, 1618624, 1307466, 1601158, 11951403),
}
# Its accuracy after simplification: kB before and after, largest and mean distance.
PAPER_ACCURACY = ((232, 18, 0.020, 0.0006), (2629, 68, 0.018, 0.002))
NAMES = {
    "default": "vtkGridDelaunay2D",
    "voxel_traversal": "VoxelTraversal",
    "compactness": "Compactness",
    "cgal": "CGAL",
    "vtk": "vtkDelaunay2D",
    "meshlab": "MeshLab BP",
}
PAPER_NAMES = {"compactness": "paper CTC", "voxel_traversal": "paper VTS", "meshlab": "paper BP"}


def paper_figures(points, key):
    """(faces, ms) of Table I, or None."""
    if points not in PAPER or key not in PAPER_NAMES:
        return None
    place = 2 * list(PAPER_NAMES).index(key)
    return PAPER[points][place : place + 2]


def slope(pairs):
    """By how much log y rises for log x, by least squares; None for fewer than two x."""
    logs = [(math.log(x), math.log(y)) for x, y in pairs if y > 0]
    count = len(logs)
    if len({x for x, _ in logs}) < 2:
        return None
    middle_x, middle_y = (sum(column) / count for column in zip(*logs))
    above = sum((x - middle_x) * (y - middle_y) for x, y in logs)
    return above / sum((x - middle_x) ** 2 for x, _ in logs)


def series(measured, key, value):
    """[(points, value)] of a code, where it was run."""
    return [
        (cloud["points"], cloud["codes"][key][value])
        for cloud in measured["clouds"]
        if value in cloud["codes"].get(key, {})
    ]


def paper_series(measured, key):
    """The paper's seconds, of the sizes that were measured."""
    found = ((cloud["points"], paper_figures(cloud["points"], key)) for cloud in measured["clouds"])
    return [(points, 0.001 * figures[1]) for points, figures in found if figures]


# ---- Markdown -----------------------------------------------------------------------------------


def number(value, digits=3):
    """With so many digits that count, and commas."""
    if value is None:
        return ""
    if value == 0:
        return "0"
    places = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:,.{places}f}"


def exponent(pairs):
    """A slope as words."""
    found = slope(pairs)
    return "" if found is None else f"{found:.2f}"


def markdown(head, rows, words=1):
    """A table; the first columns are words."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * words + "---:|" * (len(head) - words)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def cell(codes, key, value, factor=1, digits=3):
    """A figure of a code, or why there is none."""
    one = codes.get(key, {"not_run": "not measured"})
    if "not_run" in one:
        return one["not_run"]
    if value not in one:
        return ""
    figure = factor * one[value]
    return f"{figure:,}" if isinstance(figure, int) else number(figure, digits)


def machine_table(measured):
    machine, options = measured["machine"], measured["options"]
    versions = {one.get("name", "") for c in measured["clouds"] for one in c["codes"].values()}
    peers = sorted(name for name in versions if name.startswith("CGAL"))
    shares = [one["seconds"] / one["processor_seconds"]
              for cloud in measured["clouds"] for key, one in cloud["codes"].items()
              if one.get("processor_seconds") and key != "meshlab"]
    rows = [
        ("processor", f"{machine['processor']}, {machine['cores']} cores"),
        ("system", machine["system"]),
        ("date", machine["date"]),
        *([("commit", machine["commit"])] if machine.get("commit") else []),
        ("versions", ", ".join(
            [f"VTK {machine['vtk']}", *peers]
            + ([f"MeshLab {machine['meshlab']}"] if machine["meshlab"] else []))),
        ("command", f"`{measured['command']}`"),
        ("runs", f"{options['repeats']} of each code, median; at most {options['time_limit']} s"),
    ]
    meshlab = [one["runs"] for cloud in measured["clouds"] for key, one in cloud["codes"].items()
               if key == "meshlab" and "runs" in one]
    if meshlab and min(meshlab) < options["repeats"]:
        rows[-1] = (rows[-1][0], f"{rows[-1][1]}; MeshLab at least {min(meshlab)}")
    if shares:
        rows.append(("clock / processor time", f"{min(shares):.2f} to {max(shares):.2f}, one thread"))
    return markdown(("", ""), rows, 2)


def cloud_table(measured):
    return markdown(("points", "cloud"), [
        (f"{cloud['points']:,}", cloud["cloud"]) for cloud in measured["clouds"]], 2)


def beside_paper(measured):
    """Milliseconds next to those of the paper, with slopes."""
    keys = ("compactness", "voxel_traversal", "meshlab")
    head = ["points"]
    for key in keys:
        head += [PAPER_NAMES[key], NAMES[key]]
    rows = []
    for cloud in measured["clouds"]:
        row = [f"{cloud['points']:,}"]
        for key in keys:
            paper = paper_figures(cloud["points"], key)
            row.append(f"{paper[1]:,}" if paper else "")
            row.append(cell(cloud["codes"], key, "processor_seconds", 1e3))
        rows.append([*row, cell(cloud["codes"], "default", "processor_seconds", 1e3)])
    last = ["slope"]
    for key in keys:
        last += [exponent(paper_series(measured, key)),
                 exponent(series(measured, key, "processor_seconds"))]
    last.append(exponent(series(measured, "default", "processor_seconds")))
    return markdown([*head, "vtkGridDelaunay2D"], [*rows, last])


def table_of(measured, value, factor, digits=3):
    rows = [
        [f"{cloud['points']:,}", *(cell(cloud["codes"], key, value, factor, digits) for key in NAMES)]
        for cloud in measured["clouds"]
    ]
    if value != "faces":
        rows.append(["slope", *(exponent(series(measured, key, value)) for key in NAMES)])
    return rows


def faces_table(measured):
    rows = []
    for cloud, row in zip(measured["clouds"], table_of(measured, "faces", 1)):
        papers = (paper_figures(cloud["points"], key) for key in ("voxel_traversal", "meshlab"))
        rows.append([*row, cell(cloud["codes"], "meshlab", "unused"),
                     *(f"{paper[0]:,}" if paper else "" for paper in papers)])
    return markdown(
        ["points", *NAMES.values(), "points in no face of BP", "paper CTC, VTS", "paper BP"], rows)


def check_table(measured):
    """What BenchmarkDelaunay found when it examined the results."""
    keys = [key for key in NAMES if key != "meshlab"]
    rows = []
    for cloud in measured["clouds"]:
        codes = cloud["codes"]
        rows.append([f"{cloud['points']:,}", *(words_cell(codes, key) for key in keys)])
    return markdown(["points", *(NAMES[key] for key in keys)], rows, 1 + len(keys))


def words_cell(codes, key):
    one = codes.get(key, {"not_run": "not measured"})
    return one.get("not_run") or one.get("remark", "")


def chain_table(measured):
    head = ("points", "triangles", "outward", "holes filled", "points inserted", "faces", "ms",
            "MB", "largest distance", "mean distance")
    rows = []
    for cloud in measured["clouds"]:
        chain = cloud["chain"]
        holes, distance = chain["holes"], chain["distance"]
        rows.append((
            f"{cloud['points']:,}", f"{chain['triangles']['delaunay']:,}", f"{chain['outward']:,}",
            f"{holes['filled']:,} of {holes['found']:,}", f"{holes['inserted_points']:,}",
            f"{chain['triangles']['filled']:,}", number(1e3 * chain["processor_seconds"]),
            number(1e-6 * chain["bytes"]), number(distance["maximum"]), number(distance["mean"])))
    return markdown(head, rows)


def threads_table(measured):
    rows = []
    for cloud in measured["clouds"]:
        threads = cloud["threads"]
        if threads:
            one, two, copies = (threads[name] for name in ("one", "two", "copies"))
            rows.append((
                f"{cloud['points']:,}", number(1e3 * one["seconds"]), number(1e3 * two["seconds"]),
                number(one["seconds"] / two["seconds"]),
                number(one["seconds"] / copies["seconds"]) if copies else "",
                number(two["processor_seconds"] / one["processor_seconds"])))
    return markdown(("points", "ms, one thread", "ms, two threads", "gain",
                     "gain of two copies at once", "processor time, two / one"), rows)


def accuracy_table(measured):
    head = ("surface", "points", "error allowed", "points kept", "kB before", "kB after", "smaller",
            "points outside", "largest", "mean", "largest, mean / relief", "largest, mean / diagonal")
    rows = [
        (f"paper's {place}", "", "", "", f"{before:,}", f"{after:,}", number(before / after), "",
         *(f"{distance:g}" for distance in distances), "", "")
        for place, (before, after, *distances) in zip(("first", "second"), PAPER_ACCURACY)
    ]
    for surface in measured["accuracy"]:
        for row in surface["rows"]:
            words = [surface["name"], f"{surface['points']:,}"]
            if "error" not in row:
                rows.append((*words, row["asked"] + ": never", *[""] * 9))
                continue
            distances = [row["largest"], row["mean"]]
            rows.append((
                *words, f"{number(row['error'])} ({row['asked']})", f"{row['kept']:,}",
                f"{0.001 * surface['bytes']:,.0f}", number(0.001 * row["bytes"]),
                number(surface["bytes"] / row["bytes"]), f"{row['outside']:,}",
                *map(number, distances),
                *(", ".join(number(distance / surface[unit], 2) for distance in distances)
                  for unit in ("relief", "diagonal"))))
    return markdown(head, rows)


TABLES = {
    "machine": machine_table,
    "clouds": cloud_table,
    "paper": beside_paper,
    "times": lambda m: markdown(("points", *NAMES.values()), table_of(m, "processor_seconds", 1e3)),
    "faces": faces_table,
    "check": check_table,
    "memory": lambda m: markdown(("points", *NAMES.values()), table_of(m, "bytes", 1e-6)),
    "threads": threads_table,
    "chain": chain_table,
    "accuracy": accuracy_table,
}


def with_tables(text, measured):
    """A document with what is between the marks of each table made anew; everything else stays.

    Marks are lines: <!-- table: NAME --> and <!-- end of table -->.
    """
    found = re.findall(r"^<!-- table: (\w+) -->$", text, re.MULTILINE)
    if sorted(found) != sorted(TABLES) or text.count("\n<!-- end of table -->\n") != len(TABLES):
        raise ValueError(f"the document must have each of these tables once: {', '.join(TABLES)}")

    def anew(match):
        return f"{match[1]}\n\n{TABLES[match[2]](measured)}\n\n{match[3]}"

    return re.sub(
        r"^(<!-- table: (\w+) -->)$.*?^(<!-- end of table -->)$", anew, text,
        flags=re.MULTILINE | re.DOTALL)


# ---- CSV ----------------------------------------------------------------------------------------


def write_times(path, measured):
    """A row for each code and cloud, those of the paper too."""
    with open(path, "w", newline="", encoding="utf-8") as stream:
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(("points", "cloud", "code", "faces", "processor_ms", "clock_ms", "MB", "remark"))

        def row(cloud, name, one):
            times = [f"{1e3 * one[key]:.4g}" if key in one else ""
                     for key in ("processor_seconds", "seconds")]
            rows.writerow((
                cloud["points"], cloud["cloud"], name, one.get("faces", ""), *times,
                f"{1e-6 * one['bytes']:.4g}" if "bytes" in one else "",
                one.get("not_run") or one.get("remark", "")))

        for cloud in measured["clouds"]:
            for key, name in NAMES.items():
                if key in cloud["codes"]:
                    row(cloud, name, cloud["codes"][key])
                paper = paper_figures(cloud["points"], key)
                if paper:
                    rows.writerow((cloud["points"], "of the paper", PAPER_NAMES[key], paper[0], "",
                                   paper[1], "", ""))
            chain = cloud["chain"]
            row(cloud, "whole chain", {**chain, "faces": chain["triangles"]["filled"]})
            for name, one in cloud["threads"].items():
                if one:
                    row(cloud, f"threads: {name}", one)


def write_accuracy(path, measured):
    columns = ("asked", "error", "kept", "faces", "bytes", "largest_elevation_error", "outside", "largest",
               "mean")
    with open(path, "w", newline="", encoding="utf-8") as stream:
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(("surface", "points", "relief", "diagonal", "bytes_before", *columns))
        for one in measured["accuracy"]:
            for row in one["rows"]:
                rows.writerow((one["name"], one["points"], one["relief"], one["diagonal"],
                               one["bytes"], *(row.get(name, "") for name in columns)))

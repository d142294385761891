# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The report on every point and hole, and on how far the points lie from the surface: for people
and as a dictionary."""

import time

import numpy
from .clouds import coordinates_of
from .distance import distance_to, limits_of
from .holes import hole_lines, holes_of
from .messages import counted, counted_reason
from .names import option
from .properties import LATTICE_MODES
from .ranks import all_values, total
from .spreading import (
    HIDDEN,
    IN_NO_TRIANGLE,
    NOT_FINITE,
    OUTSIDE_OUTLINE,
    SAME_PLACE,
    WITHIN_ERROR,
    ids_of,
    places_of,
)

OUTSIDE = "outside the boundary"
# Why a point is not used, by number.
REASONS = {
    SAME_PLACE: "same x,y as another point",
    NOT_FINITE: "not finite",
    WITHIN_ERROR: "within the elevation error",
    HIDDEN: "marked as hidden",
    OUTSIDE_OUTLINE: OUTSIDE,
    IN_NO_TRIANGLE: "in no triangle below the edge limit",
}
MOST_LISTED = 25_000  # unused points for each reason
FOUND = "found from the points"


def make_report(result):
    """Everything the user may want to know about a Reconstruction, as plain numbers and words. Where it is
    spread over ranks, all of them make it together."""
    delaunay, trim, ranks = result.delaunay, result.trim, result.ranks
    ids = ids_of(ranks, result.points)[: len(result.reasons)]
    reasons = reasons_unused(result)
    unused = list_unused(ranks, reasons, ids)
    notes, limits = result.decided + result.notes, limits_of(ranks, coordinates_of(result.complete), result.used)
    report = facts_of(result, result.number_of_points, notes, limits, unused)
    if delaunay.GetMaximumElevationError() or delaunay.GetMaximumNumberOfPoints():
        report["simplified"] = {
            "maximum_elevation_error": delaunay.GetMaximumElevationError(),
            "maximum_number_of_points": delaunay.GetMaximumNumberOfPoints(),
            "largest_elevation_error": delaunay.GetLargestElevationError(),
            "points_kept": int(numpy.count_nonzero(reasons == 0)),
            "points_redundant": int(numpy.count_nonzero(reasons == WITHIN_ERROR)),
        }
    if result.faults_name:
        with_faults = result.outlined[0] if result.outlined else delaunay
        without = with_faults.GetNumberOfPointsWithoutZ()
        report["faults"] = fault_report(result.faults_name, with_faults, without)
    if trim:
        report["trim"] = trimming_report(
            trim.GetNumberOfOutwardTriangles(),
            result.outlined[1] if result.outlined else trim,
            result.boundary_name,
            total(ranks, result.boundary.GetNumberOfLines()),
        )
    if result.fill:
        report["holes"] = holes_of(result)
    report["distance"] = distance_of(result, reasons, ids)
    return report


def facts_of(result, points, notes, limits, unused):
    """The part of the report that all surfaces have.

    result  with cloud, delaunay, lattice, triangles and several, as a Reconstruction
    points  how many there are
    notes   in addition to those of the cloud
    limits  the lowest x, y and z of the surface, and the highest
    unused  {reason: (how many points are not used, the first MOST_LISTED of them)}
    """
    cloud = result.cloud
    counts = {reason: count for reason, (count, _) in unused.items() if count}
    listed = [(i, reason) for reason, (_, ids) in unused.items() for i in ids.tolist()]
    listed = [{"point": point, "reason": reason} for point, reason in sorted(listed)]
    for one in listed if cloud.lines is not None else ():
        one["line"] = int(cloud.lines[one["point"]])
    report = {
        "notes": cloud.notes + notes,
        "left_out": cloud.left_out,
        "bounds": {axis: list(pair) for axis, *pair in zip("xyz", *limits)},
        "crs": cloud.crs,
        "points": points,
        "points_unused": sum(counts.values()),
        "unused_reasons": counts,
        "unused": listed,
        "unused_listed": len(listed),
        "lattice": result.lattice,
        "lattice_mode": LATTICE_MODES[result.delaunay.GetLatticeMode()],
        "triangles": result.triangles,
    }
    if result.several:
        report["several_heights"] = result.several
    return report


def fault_report(name, delaunay, points_without_z=0):
    """The part of the report on faults. None are without z in pieces."""
    return {
        "file": name,
        "added_points": delaunay.GetNumberOfAddedPoints(),
        "points_without_z": points_without_z,
        "crossings": delaunay.GetNumberOfConstraintCrossings(),
    }


def trimming_report(outward, trim, boundary_name, rings):
    """The part of the report on trimming.

    outward        how many triangles were outside
    trim           the filter that has found or been given the boundary
    boundary_name  where a given one is from
    rings          how many it has
    """
    report = {
        "outward_triangles": outward,
        "recovered_edges": trim.GetNumberOfRecoveredEdges(),
        "inserted_points": trim.GetNumberOfInsertedPoints(),
        "boundary": boundary_name or FOUND,
        "boundary_rings": rings,
    }
    if not boundary_name:
        report["effective_gap_tolerance"] = trim.GetEffectiveGapTolerance()
        report["points_left_out"] = trim.GetNumberOfPointsLeftOut()
    return report


def distance_of(result, reasons, ids):
    """The distance of all points that the user wants in the surface, used or not."""
    coordinates = result.coordinates
    measured = numpy.isfinite(coordinates).all(axis=1) & (reasons != HIDDEN)
    if result.boundary_name:
        measured &= reasons != OUTSIDE_OUTLINE
    began = time.perf_counter()
    distance = distance_to(
        result.complete, result.used, coordinates, measured, result.measuring, result.ranks, ids
    )
    result.times["measure"] = time.perf_counter() - began
    return distance


def reasons_unused(result):
    """(n,) numbers of REASONS, or 0, for the points that Reconstruction.reasons are of."""
    used = result.used[: len(result.reasons)]
    return numpy.where((result.reasons == 0) & ~used, OUTSIDE_OUTLINE, result.reasons)


def list_unused(ranks, reasons, ids):
    """{reason: (how many points are not used, the places of the first MOST_LISTED of them)}.

    ids  of the points of this rank
    """
    found = {}
    for number, words in REASONS.items():
        places = numpy.sort(ids[reasons == number])
        count = total(ranks, len(places))
        if count:
            places = numpy.sort(all_values(ranks, places[:MOST_LISTED]))[:MOST_LISTED]
            places = places_of(ranks, places, ids)
        found[words] = (count, places)
    return found


def crs_name(crs):
    """A short name of a coordinate reference system."""
    try:
        from .gdal_common import name_of

        return name_of(crs)
    except (ImportError, ValueError):
        return crs[:60]


def print_report(report):
    """The report for people."""
    print(report["file"])
    for name, text in report_lines(report):
        print(f"  {name:<10} {text}")


def report_lines(report):
    """[(name, text)] of the report for people; a line that goes on has no name.

    Long lists are cut here, never in the JSON.
    """
    result = []

    def line(name, text):
        result.append((name, text))

    point_lines(report, line)
    triangle_lines(report, line)
    if "holes" in report:
        hole_lines(report["holes"], line)
    line("surface", counted(list(report["triangles"].values())[-1], "triangle"))
    if "pieces" in report:
        line("", f"in {counted(report['pieces'], 'piece')}")
    if "distance" in report:
        distance_lines(report, line)
    if "written" in report and report["unused_listed"] < report["points_unused"]:
        line("", f"{option('report')} lists the first {MOST_LISTED:,} unused points for each reason")
    if "elevations_at" in report:
        at = report["elevations_at"]
        line("elevations", f"at {counted(at['places'], 'place')} of {at['file']}, {at['outside']:,} outside")
    if "volume" in report:
        volume_lines(report["volume"], line)
    if "times" in report:
        times = report["times"].items()
        line("time", ", ".join(f"{name} {seconds:.2f} s" for name, seconds in times))
    for path in report.get("written", ()):
        line("written", path)
    return result


def point_lines(report, line):
    """The lines of notes and points."""
    for note in report["notes"]:
        line("note", note)
    if report["crs"]:
        line("crs", crs_name(report["crs"]))
    text = f"{report['points']:,} read"
    for reason, count in report["left_out"].items():
        text += f"; {counted_reason(count, reason)} left out"
    line("points", text)
    if report["points_unused"] == 0:
        line("unused", "none")
    if "simplified" in report:
        few = report["simplified"]
        line(
            "simplified",
            f"{few['points_kept']:,} of {counted(report['points'], 'point')} kept; others of the "
            f"surface are at most {few['largest_elevation_error']:.4g} above or below it",
        )
    for reason, count in report["unused_reasons"].items():
        some = [u for u in report["unused"] if u["reason"] == reason][:5]
        if "line" in some[0]:
            where = "line " + ", ".join(str(u["line"]) for u in some)
        else:
            where = "point " + ", ".join(str(u["point"]) for u in some)
        line("unused", f"{count:,} {reason}: {where}{', ...' if count > len(some) else ''}")


def triangle_lines(report, line):
    """The lines on how triangles were made, and which were removed."""
    if report["lattice"]:
        steps = [
            f"{length:.7g} towards {round(direction, 3) + 0.0:.4g} degrees"
            for length, direction in zip(
                report["lattice"]["lengths"], report["lattice"]["directions"]
            )
        ]
        where = " in the plane" if len(report["lattice"]["origin"]) > 2 else ""
        line("lattice", f"steps of {' and '.join(steps)}{where}")
    elif "faults" in report:
        line("lattice", "not looked for, because of the faults")
    elif report["lattice_mode"] == "automatic":
        line("lattice", "none: the points are not on the nodes of a grid")
    line("triangles", f"{report['triangles']['delaunay']:,} in the triangulation")
    if "faults" in report:
        faults = report["faults"]
        line(
            "faults",
            f"{faults['file']}: {counted(faults['added_points'], 'point')} added, "
            f"{counted(faults['crossings'], 'crossing')}",
        )
        if faults["points_without_z"]:
            line("", f"{counted(faults['points_without_z'], 'point')} without z, on the surface of the points")
    if "trim" in report:
        trim = report["trim"]
        rings = trim["boundary_rings"]
        line(
            "trimmed",
            f"{counted(trim['outward_triangles'], 'outward triangle')}; "
            f"boundary {trim['boundary']}, {counted(rings, 'ring')}",
        )
        if "effective_gap_tolerance" in trim:
            line("", f"gap tolerance {trim['effective_gap_tolerance']:.4g} spacings")
        if trim.get("points_left_out"):
            line("", f"{counted(trim['points_left_out'], 'point')} outside the boundary")
        if trim["recovered_edges"]:
            line("", f"{counted(trim['recovered_edges'], 'boundary edge')} recovered")
        if trim["inserted_points"]:
            line("", f"{counted(trim['inserted_points'], 'boundary point')} inserted")


def distance_lines(report, line):
    """The lines on how far the points are from the surface."""
    d = report["distance"]
    boundary_given = report.get("trim", {}).get("boundary", FOUND) != FOUND
    beyond = ""
    if report["unused_reasons"].get(OUTSIDE):
        beyond = ", those outside left out" if boundary_given else ", those outside too"
    line(
        "distance",
        f"of {counted(d['points'], 'point')}{beyond} from the surface: max {d['maximum']:.3g}, "
        f"mean {d['mean']:.3g}, RMS {d['rms']:.3g}",
    )
    if d["measured"] < d["points_not_corners"]:
        line(
            "",
            f"from a sample: every corner, and {d['measured']:,} of the "
            f"{d['points_not_corners']:,} other points",
        )


def volume_lines(volume, line):
    """The lines on the volume between the surface and another one, or a level."""
    error = "" if volume["error"] is None else f" +- {volume['error']:.3g} by filled elevations"
    line("volume", f"{volume['net']:.7g} over {volume['over']}{error}: {volume['above']:.7g} above, {volume['below']:.7g} below")
    left_out = f"area {volume['area']:.7g}; {volume['left_out']:.4g} of the surface left out"
    if not volume["is_level"]:
        left_out += f", {volume['other_left_out']:.4g} of the other"
    line("", left_out)


def main_counts(result):
    """The main figures: how many points, triangles and holes, as a list of words."""
    parts = [
        counted(result.number_of_points, "point"),
        counted(list(result.triangles.values())[-1], "triangle"),
    ]
    found, filled = result.hole_counts
    if filled < found:
        parts.append(f"{filled:,} of {found:,} holes filled")
    elif found:
        parts.append(f"{counted(found, 'hole')} filled")
    return parts


def picture_subtitle(result):
    """The counts under a picture's title."""
    return "   \u00b7   ".join(main_counts(result))

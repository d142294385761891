# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures reconstruct() for reproduce-paper, which starts it as a process of its own. Prints JSON.

    PaperChain.py chain POINTS.f64 REPEATS    the whole chain on one thread
    PaperChain.py accuracy NAME               a surface of PaperClouds before and after simplification
"""

import json
import os
import statistics
import sys
import tempfile
import time

import numpy
from vtkelevationsurface import reconstruct
from vtkelevationsurface.distance import distance_to
from vtkelevationsurface.report import reasons_unused
from vtkelevationsurface.spreading import OUTSIDE_OUTLINE

from PaperClouds import make_horizon, points_of
from ProcessMemory import forget_most, memory_of

ERRORS = (0.5, 1.0, 3.0)  # percent of the relief
# The paper's two files became so many times smaller.
FACTORS = (232 / 18, 2629 / 68)
NEAR = 0.02  # so close to a factor is close enough
MOST_TRIALS = 20


def chain(path, repeats):
    points = numpy.fromfile(path, "<f8").reshape(-1, 3)
    reconstruct(make_horizon(1000), threads=1)  # so that its program code is in memory
    clock, processor, most = [], [], 0
    for _ in range(int(repeats)):
        result = None  # the last one's memory goes first
        forget_most()
        before = memory_of("VmRSS")
        began, worked = time.perf_counter(), time.process_time()
        result = reconstruct(points, threads=1)
        processor.append(time.process_time() - worked)
        clock.append(time.perf_counter() - began)
        most = max(most, memory_of("VmHWM") - before)
    report = result.report
    return {
        "seconds": statistics.median(clock),
        "processor_seconds": statistics.median(processor),
        "bytes": most,
        "triangles": report["triangles"],
        "outward": report["trim"]["outward_triangles"],
        "rings": report["trim"]["boundary_rings"],
        "holes": {name: report["holes"][name] for name in ("found", "filled", "inserted_points")},
        "opened": result.fill.GetOpenEdgeLength(),
        "distance": report["distance"],
    }


class Surface:
    """The surface of all points, and what it becomes with fewer."""

    def __init__(self, name, folder):
        self.points = points_of(name)
        self.path = os.path.join(folder, "surface.ply")
        self.relief = float(numpy.ptp(self.points[:, 2]))
        self.diagonal = float(numpy.linalg.norm(numpy.ptp(self.points, axis=0)))
        self.bytes = self.size_of(reconstruct(self.points))

    def size_of(self, result):
        """Bytes of its file."""
        result.write(self.path)
        return os.path.getsize(self.path)

    def row(self, error, asked):
        """What is reported of one surface. asked: words"""
        result = reconstruct(self.points, maximum_elevation_error=error)
        report = result.report
        # Points outside the outline that was found are not points of the surface.
        inside = reasons_unused(result) != OUTSIDE_OUTLINE
        distance = distance_to(result.complete, result.used, self.points, inside)
        return {
            "asked": asked,
            "error": error,
            "kept": report["simplified"]["points_kept"],
            "faces": list(report["triangles"].values())[-1],
            "bytes": self.size_of(result),
            "largest_elevation_error": report["simplified"]["largest_elevation_error"],
            "largest": distance["maximum"],
            "mean": distance["mean"],
            "outside": int(numpy.count_nonzero(~inside)),
        }

    def error_for(self, factor):
        """The error with which the file gets so many times smaller; None where none does."""
        low, high = 0.0, self.relief
        for trial in range(MOST_TRIALS):
            error = high if trial == 0 else 0.5 * (low + high)
            got = self.bytes / self.size_of(reconstruct(self.points, maximum_elevation_error=error))
            if abs(got / factor - 1.0) < NEAR:
                return error
            if got > factor:
                high = error
            elif trial == 0:
                return None
            else:
                low = error
        return None


def accuracy(name):
    with tempfile.TemporaryDirectory() as folder:
        surface = Surface(name, folder)
        rows = [surface.row(0.01 * part * surface.relief, f"{part:g} %") for part in ERRORS]
        for factor in FACTORS:
            error = surface.error_for(factor)
            asked = f"{factor:.1f} times smaller"
            rows.append(surface.row(error, asked) if error else {"asked": asked})
    return {
        "name": name,
        "points": len(surface.points),
        "relief": surface.relief,
        "diagonal": surface.diagonal,
        "bytes": surface.bytes,
        "rows": rows,
    }


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in ("chain", "accuracy"):
        sys.exit(__doc__)
    print(json.dumps({"chain": chain, "accuracy": accuracy}[sys.argv[1]](*sys.argv[2:])))

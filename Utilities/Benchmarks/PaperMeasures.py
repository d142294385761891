# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What reproduce-paper measures: each code on each cloud, as plain dictionaries."""

import datetime
import json
import os
import platform
import shutil
import statistics
import subprocess
import sys

import PaperClouds
import ThisMachine

HERE = os.path.dirname(os.path.abspath(__file__))
# The codes of BenchmarkDelaunay by the beginnings of their names.
CODES = {
    "vtkGridDelaunay2D": "default",
    "- VoxelTraversal": "voxel_traversal",
    "- Compactness": "compactness",
    "CGAL": "cgal",
    "vtkDelaunay2D": "vtk",
    "- one thread": "one_thread",
    "- 2 copies": "copies",
}
BALL_PIVOTING = """<!DOCTYPE FilterScript>
<FilterScript>
 <filter name="Surface Reconstruction: Ball Pivoting">
  <Param type="RichAbsPerc" value="0" min="0" max="100" name="BallRadius"/>
  <Param type="RichFloat" value="20" name="Clustering"/>
  <Param type="RichFloat" value="90" name="CreaseThr"/>
  <Param type="RichBool" value="false" name="DeleteFaces"/>
 </filter>
</FilterScript>
"""
NOTHING = "<!DOCTYPE FilterScript>\n<FilterScript/>\n"
MOST_SECONDS = 60.0  # of one code on one cloud: then it is not repeated any more


class Failed(RuntimeError):
    """A program that should work did not."""


def called(command, environment=None):
    """The JSON that a Python program of this folder prints."""
    done = subprocess.run(
        [sys.executable, "-W", "ignore", *command], stdout=subprocess.PIPE, check=False,
        env={**os.environ, **(environment or {})},
    )
    if done.returncode:
        raise Failed(f"{' '.join(command)}: code {done.returncode}")
    return json.loads(done.stdout)


# ---- BenchmarkDelaunay --------------------------------------------------------------------------


def figures_of(one):
    """A code of BenchmarkDelaunay's file, for a cloud of so many points, in seconds and bytes."""

    def figures(points):
        if "not_run" in one:
            return {"not_run": one["not_run"]}
        result = {
            "seconds": 1e-9 * one["ns_per_point"]["median"] * points,
            "processor_seconds": 1e-9 * one["processor_ns_per_point"] * points,
            "runs": len(one["ns_per_point"]["runs"]),
        }
        if "bytes_per_point_above_input_and_output" in one:
            each = one["bytes_per_point_above_input_and_output"] + one["output_bytes_per_point"]
            result["bytes"] = each * points
        if "triangles" in one:
            result.update(faces=one["triangles"], right=one["right"], remark=one["result"])
        return result

    return figures


def codes_of(measured):
    """{key: figures} of the only set of BenchmarkDelaunay's file, as a dictionary."""
    [cloud] = measured["sets"]
    result = {}
    for one in cloud["codes"]:
        key = next(key for name, key in CODES.items() if one["code"].startswith(name))
        result[key] = figures_of(one)(cloud["points"])
        result[key]["name"] = one["code"]
    return result


def triangulations(benchmark, cloud, folder, options):
    """All codes of BenchmarkDelaunay on a file, and ours with two threads."""

    def measured(*arguments):
        path = os.path.join(folder, "benchmark.json")
        done = subprocess.run(
            [benchmark, "--file", cloud, "--repeats", str(options.repeats),
             "--time-limit", str(options.time_limit), "--json", path, *arguments],
            stdout=subprocess.DEVNULL, check=False,
        )
        if done.returncode not in (0, 1):  # 1: a result of ours is wrong, as the file says
            raise Failed(f"{benchmark}: code {done.returncode}")
        with open(path, encoding="utf-8") as stream:
            return json.load(stream)

    one = measured("--searches", "--vtk", "--no-delaunay32")
    two = measured("--threads", "2", "--no-check", "--no-cgal", "--no-delaunay32", "--no-vtk")
    threads = codes_of(two)
    return codes_of(one), {
        "one": threads["one_thread"], "two": threads["default"], "copies": threads.get("copies")
    }


# ---- MeshLab ------------------------------------------------------------------------------------


class MeshLab:
    """Ball Pivoting with the defaults of MeshLab, by meshlabserver, in a process of its own."""

    def __init__(self, folder, options):
        self.folder, self.options = folder, options
        self.program = shutil.which("meshlabserver")
        self.paths = {name: os.path.join(folder, name) for name in ("in.ply", "out.ply")}
        for name, text in (("pivot.mlx", BALL_PIVOTING), ("nothing.mlx", NOTHING)):
            self.paths[name] = os.path.join(folder, name)
            with open(self.paths[name], "w", encoding="ascii") as stream:
                stream.write(text)

    def run(self, script):
        return called([
            os.path.join(HERE, "RunLimited.py"), str(self.options.time_limit), self.program,
            "-i", self.paths["in.ply"], "-o", self.paths["out.ply"], "-s", self.paths[script],
        ])

    def measure(self, points):
        """Time and memory above those of a run that only reads and writes the points."""
        if not self.program:
            return {"not_run": "meshlabserver was not found"}
        PaperClouds.write_ply(self.paths["in.ply"], points)
        runs, nothing = [], []
        for _ in range(self.options.repeats):
            nothing.append(self.run("nothing.mlx"))
            if os.path.exists(self.paths["out.ply"]):
                os.remove(self.paths["out.ply"])
            runs.append(self.run("pivot.mlx"))
            if runs[-1]["out_of_time"]:
                return {"not_run": f"more than {self.options.time_limit} s"}
            if runs[-1]["code"] != 0 or not os.path.exists(self.paths["out.ply"]):
                return {"not_run": f"ended with code {runs[-1]['code']}"}
            if sum(run["seconds"] for run in runs) > MOST_SECONDS:
                break
        faces, used = PaperClouds.ply_used_points(self.paths["out.ply"])
        result = {"faces": faces, "unused": len(points) - used, "runs": len(runs)}
        for name, key in (("seconds",) * 2, ("processor_seconds",) * 2, ("peak_bytes", "bytes")):
            middle = [statistics.median(run[name] for run in some) for some in (runs, nothing)]
            result[key] = max(0.0, middle[0] - middle[1])
        return result


# ---- all ----------------------------------------------------------------------------------------


def package_version(name):
    """What Debian says, or nothing."""
    if not shutil.which("dpkg-query"):
        return ""
    done = subprocess.run(
        ["dpkg-query", "-W", "-f", "${Version}", name], stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL, text=True, check=False,
    )
    return done.stdout if done.returncode == 0 else ""


def machine():
    from vtkmodules.vtkCommonCore import vtkVersion

    return {
        "processor": ThisMachine.processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "vtk": vtkVersion.GetVTKVersion(),
        "meshlab": package_version("meshlab"),
        "date": datetime.date.today().isoformat(),
        "commit": ThisMachine.commit(),
    }


def measure_cloud(count, folder, options, benchmark, meshlab):
    points, what = PaperClouds.cloud_of(count)
    path = os.path.join(folder, f"cloud{count}.f64")
    PaperClouds.write_doubles(path, points)
    row = {"points": count, "cloud": what, "codes": {}, "threads": {}}
    load = os.getloadavg()[0]
    if benchmark:
        row["codes"], row["threads"] = triangulations(benchmark, path, folder, options)
    row["codes"]["meshlab"] = meshlab.measure(points)
    row["chain"] = called([os.path.join(HERE, "PaperChain.py"), "chain", path, str(options.repeats)])
    row["load_before"] = load
    os.remove(path)
    return row


def measure_all(folder, options, benchmark, save):
    """save(measured) is called after each step, so that little is lost when it is stopped."""
    from vtkelevationsurface.picture.display import screen

    chosen = {"repeats": options.repeats, "time_limit": options.time_limit}
    measured = {"machine": machine(), "options": chosen, "clouds": [], "accuracy": []}
    with screen() as reason:  # meshlabserver does not start without one
        if reason:
            print(f"no display for MeshLab: {reason}", file=sys.stderr)
        meshlab = MeshLab(folder, options)
        for count in options.sizes:
            print(f"{count:,} points", file=sys.stderr)
            measured["clouds"].append(measure_cloud(count, folder, options, benchmark, meshlab))
            save(measured)
    for name in options.surfaces:
        if PaperClouds.points_of(name) is None:
            print(f"{name}: skipped, it is not there", file=sys.stderr)
            continue
        print(name, file=sys.stderr)
        measured["accuracy"].append(called([os.path.join(HERE, "PaperChain.py"), "accuracy", name]))
        save(measured)
    return measured

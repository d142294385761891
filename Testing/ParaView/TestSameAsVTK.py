# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin's filters, on ParaView's VTK, put out the same as those of a build against VTK, bit by
bit: points, cells, arrays, counts, messages, on the data sets and on meshes with arrays of all kinds.

    TestSameAsVTK.py --python <for VTK> --package <the folder vtkelevationsurface of that build>
                     --plugin <the built plugin> -D <Data> -T <folder>

Utilities/checksums says what each puts out. The environment is the one that ParaView needs.
"""
import argparse
import os
import subprocess
import sys

CHECKSUMS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Utilities", "checksums")
CASES = r"(aegean_sea|b9_ground|horizon_synthetic|jacksboro_fault|olinda_land|_rich).*/default/t3"
VERSION = "from vtkmodules.vtkCommonCore import vtkVersion; print(vtkVersion.GetVTKVersion())"


def put_out(python, environment):
    """The version of VTK, and what checksums prints: by case, the rest of its line."""
    def output(*arguments):
        return subprocess.run([python, *arguments], env=environment, stdout=subprocess.PIPE,
                              universal_newlines=True, check=True).stdout
    lines = output(CHECKSUMS, "--only", CASES).splitlines()
    return output("-c", VERSION).strip(), dict(line.split(" ", 1) for line in lines)


def main():
    parser = argparse.ArgumentParser()
    for option in ("--python", "--package", "--plugin", "-D", "-T"):
        parser.add_argument(option, required=True)
    options = parser.parse_args()

    environment = dict(os.environ, PYTHONPATH=os.path.dirname(options.package))
    environment.pop("LD_LIBRARY_PATH", None)  # of ParaView
    vtk, expected = put_out(options.python, environment)
    folders = [os.path.dirname(options.plugin), os.environ.get("PYTHONPATH", "")]
    paraviews, found = put_out(sys.executable, dict(os.environ, PYTHONPATH=os.pathsep.join(folders)))

    different = [name for name in expected.keys() | found if expected.get(name) != found.get(name)]
    for name in sorted(different):
        print("FAILED: %s: %s instead of %s" % (name, found.get(name), expected.get(name)))
    print("VTK %s and ParaView's %s: %d cases, %d differ" % (vtk, paraviews, len(expected), len(different)))
    return 1 if different or len(expected) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())

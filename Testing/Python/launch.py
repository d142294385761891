# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a test script as vtkpython would.

    launch.py <folder of the package> <script> [arguments]
"""
import faulthandler
import os
import runpy
import sys
import unittest


def name_skipped(result, test, reason, add=unittest.TextTestResult.addSkip):
    """What Utilities/test lists at its end."""
    print(f"\nSKIPPED {test.id()}: {reason}", flush=True)  # on a line of its own: dots come before
    add(result, test, reason)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    faulthandler.enable()
    package_folder, *arguments = sys.argv[1:]
    script = arguments[0]
    # As if the script had been started directly: its own folder first, then the package. Programs that
    # the script starts find the package too.
    sys.path[:1] = [os.path.dirname(os.path.abspath(script)), package_folder]
    paths = [package_folder, os.environ.get("PYTHONPATH")]
    os.environ["PYTHONPATH"] = os.pathsep.join(path for path in paths if path)
    sys.argv = arguments
    unittest.TextTestResult.addSkip = name_skipped
    runpy.run_path(script, run_name="__main__")


main()

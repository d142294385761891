# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The switch of the faults in Python; see Faults.h."""

import atexit
import os

_ON = int(os.environ.get("ES_FAULT", 0))
_REACHED = set()


def on(number):
    _REACHED.add(number)
    return _ON == number


@atexit.register
def _tell():
    name = os.environ.get("ES_FAULTS_REACHED")
    if name and _REACHED:
        with open(name, "a") as file:
            file.writelines(f"{number}\n" for number in sorted(_REACHED))

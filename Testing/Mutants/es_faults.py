# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The switch of the faults in Python; see Faults.h."""

import contextlib
import os

_ON = int(os.environ.get("ES_FAULT", 0))
_REACHED = set()


def on(number):
    if number not in _REACHED:
        _REACHED.add(number)
        name = os.environ.get("ES_FAULTS_REACHED")
        if name:
            # A test may have limited the size of files, and is not to meet that here.
            with contextlib.suppress(OSError), open(name, "a") as file:
                file.write(f"{number}\n")
    return _ON == number

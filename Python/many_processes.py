# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program as several processes that mpirun has started: mpirun -n 4 python3 -m vtkelevationsurface.

The first of them (rank 0) speaks for all. A process that crashes or is killed ends the others by mpirun.
"""

import os
import sys

from .messages import ElevationSurfaceError
from .ranks import is_on_all_ranks, start_ranks, together
from .supervisor import held_back, hold_stops, rank_and_size


def run_together(main):
    """The exit code of main(ranks=controller), which all processes call and which is the same in all."""
    if rank_and_size()[0] > 0:
        sys.stdout = sys.stderr = open(os.devnull, "w", encoding="utf-8")
    try:
        controller = start_ranks()
        code = main(ranks=controller)
    except ElevationSurfaceError as error:
        print(f"reconstruct: error: {error}", file=sys.stderr)
        return 1
    except SystemExit as end:
        code = end.code or 0
    except Exception as error:
        if not is_on_all_ranks(error):
            sys.stderr = sys.__stderr__  # nobody else can report it
        raise
    # mpirun stops the others when one ends with an error. They have come to the same end.
    hold_stops()
    if not held_back:  # else the others are gone
        code = max(together(controller, lambda: [code]))
        controller.Finalize()
    return code

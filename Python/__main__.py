# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m vtkelevationsurface FILE, also of several processes that mpirun starts"""

import sys

from .supervisor import rank_and_size, supervised


def program():
    from .command import main

    if rank_and_size()[1] > 1:
        from .many_processes import run_together

        return run_together(main)
    return main()


sys.exit(supervised(program))

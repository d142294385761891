# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m vtkelevationsurface FILE"""

import sys

from .supervisor import supervised


def program():
    from .command import main

    return main()


sys.exit(supervised(program))

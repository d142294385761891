# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m vtkelevationsurface FILE"""

import sys

from .command import main

sys.exit(main())

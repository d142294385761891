# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""How a surface is shown at first, in pictures and in ParaView: colours, and where the eye is.

It needs Python alone: the build of the plugin reads it too.
"""

# All maps rise evenly in lightness, so that they keep their order in grey and for colour-blind
# eyes. Colours are mixed in CIE Lab between the stops.
LAND = ("#1f4e5f", "#2f7a72", "#6fa06a", "#c3b56b", "#e6cf9c", "#faf3e3")
SEA = ("#13203c", "#1b456e", "#2a729b", "#559fb4", "#8cc4c4", "#cfe9dc")
ERROR = ("#f1efe9", "#f0c987", "#dc7a4a", "#a62f3f", "#4a1030")

FILLED, OPEN = "#b8124d", "#f2730d"
# Of outlines of holes, by StatusName of vtkFillElevationHoles.
STATUS = {
    "filled": FILLED,
    "too large": OPEN,
    "too many edges": "#f7c331",
    "failed": "#111111",
    "replaced": "#e07ba6",
    "cut out": "#5b8fd0",
}

# Of the eye, in degrees. From the south, so that the north is at the back, as on a map.
BEARING, HEIGHT = 200.0, 42.0

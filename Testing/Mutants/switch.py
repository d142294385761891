# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""How a fault and what it replaces stand next to each other in the code."""


def switched(path, number, right, wrong):
    """The code of both, of which the number of the fault decides."""
    if path.endswith(".py"):
        if not wrong:
            return f"if not es_faults.on({number}): {right}"
        return f"(({wrong}) if es_faults.on({number}) else ({right}))"
    if not wrong:
        return f"if (!esFault({number})) {{ {right} }}"
    return f"(esFault({number}) ? ({wrong}) : ({right}))"

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""How messages name an option: as it is written where the user has set it.

That is maximum_edge_length in Python, --maximum-edge-length in the program, and Maximum Edge Length in
a panel. The program and the algorithms of panels say so by written_for(); a message is made with the
right names at once, so that nobody has to look for names in sentences.
"""

import contextlib
import contextvars

PYTHON, PROGRAM, PANEL = "Python", "program", "panel"
_place = contextvars.ContextVar("place", default=PYTHON)


@contextlib.contextmanager
def written_for(place):
    """Messages that are made in this context are for PYTHON, the PROGRAM or a PANEL."""
    before = _place.set(place)
    try:
        yield
    finally:
        _place.reset(before)


def are_for(place):
    """Whether messages are made for this place now."""
    return _place.get() == place


def option(name):
    """--no-data, or No Data in a panel, of no_data."""
    return name.replace("_", " ").title() if are_for(PANEL) else "--" + name.replace("_", "-")


def argument(name):
    """no_data in Python, elsewhere as option()."""
    return name if are_for(PYTHON) else option(name)

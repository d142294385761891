# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a short example, as reconstruct.py draws it; with or without a screen."""

import contextlib
import os
import sys

import surface_picture
from virtual_display import VirtualDisplay


@contextlib.contextmanager
def screen_for(path):
    """A screen to draw a picture on, or ends the program with the reason why there is none."""
    display = VirtualDisplay()
    try:
        reason = None if os.environ.get("DISPLAY") else display.open()
        reason = reason or surface_picture.why_no_picture()
        if reason:
            sys.exit(f"{path}: cannot be drawn: {reason}")
        yield
    finally:
        display.close()


def draw(surface, path, title, subtitle, **options):
    """Draws a surface into a PNG file, or ends the program with the reason why it cannot."""
    with screen_for(path):
        surface_picture.draw(surface, path, title, subtitle, **options)

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Memory of this process, as Linux reports it."""


def memory_of(name):
    """Bytes of this process: VmRSS now, VmHWM at most since forget_most()."""
    with open("/proc/self/status", encoding="ascii") as stream:
        return 1024 * int(stream.read().split(name + ":")[1].split()[0])


def forget_most():
    with open("/proc/self/clear_refs", "w", encoding="ascii") as stream:
        stream.write("5")

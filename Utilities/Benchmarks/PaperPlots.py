# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The plots of reproduce-paper."""

import os

import matplotlib

matplotlib.use("Agg")  # needs no screen
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402

from PaperTables import NAMES, PAPER_NAMES, paper_series, series, slope  # noqa: E402

# Colours that colour-blind eyes can distinguish; each code has a marker of its own too.
LOOKS = {
    "default": ("#d55e00", "o"),
    "voxel_traversal": ("#0072b2", "s"),
    "compactness": ("#56b4e9", "D"),
    "cgal": ("#009e73", "^"),
    "vtk": ("#7f7f7f", "v"),
    "meshlab": ("#cc79a7", "P"),
}
SIZE = (8.2, 5.6)
DPI = 100


def named(name, pairs):
    found = slope(pairs)
    return name if found is None else f"{name}: slope {found:.2f}"


def lines(axes, measured, value, factor, with_paper):
    for key, (colour, marker) in LOOKS.items():
        pairs = series(measured, key, value)
        if pairs:
            x, y = zip(*pairs)
            # Both searches need the same memory: the wider line is seen under the other.
            is_wide = value == "bytes" and key == "voxel_traversal"
            axes.plot(x, [factor * v for v in y], color=colour, marker=marker,
                      linewidth=3.6 if is_wide else 1.6, markersize=10 if is_wide else 6,
                      label=named(NAMES[key], pairs))
        papers = paper_series(measured, key) if with_paper else []
        if papers:
            x, y = zip(*papers)
            axes.plot(x, [factor * v for v in y], color=colour, marker=marker, linewidth=1.2,
                      linestyle="--", markerfacecolor="white", label=named(PAPER_NAMES[key], papers))


# 20,000, but 1.5
PLAIN = FuncFormatter(lambda value, _: f"{value:,.0f}" if value >= 10 else f"{value:g}")


def plain_ticks(axis, *, steps=(1.0, 2.0, 5.0)):
    """Of an axis with less than two powers of ten: 20,000, 50,000, ..."""
    axis.set_major_locator(LogLocator(10, steps))
    axis.set_major_formatter(PLAIN)
    axis.set_minor_formatter(NullFormatter())


def dress(axes, what, title):
    axes.set_xscale("log")
    plain_ticks(axes.xaxis)
    axes.set_xlabel("points")
    axes.set_ylabel(what)
    axes.set_title(title, loc="left", fontsize=12)
    axes.grid(True, which="major", color="#d0d0d0", linewidth=0.8)
    axes.grid(True, which="minor", color="#ececec", linewidth=0.5)
    axes.set_axisbelow(True)


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(os.path.join(folder, name), dpi=DPI, metadata={"Software": None})
    plt.close(figure)


def times(measured, folder):
    figure, axes = plt.subplots(figsize=(SIZE[0] + 2.4, SIZE[1]))
    lines(axes, measured, "processor_seconds", 1e3, True)
    dress(axes, "milliseconds", "Triangulation: time against points")
    axes.set_yscale("log")
    axes.set_ylim(bottom=1.0)
    axes.yaxis.set_major_formatter(PLAIN)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize=9.5,
                title="solid: here, one thread\ndashed: the paper, Core2Duo", alignment="left")
    save(figure, folder, "paper_times.png")


def memory(measured, folder):
    figure, axes = plt.subplots(figsize=SIZE)
    lines(axes, measured, "bytes", 1e-6, False)
    dress(axes, "MB above the input, with the output", "Triangulation: peak memory against points")
    axes.set_yscale("log")
    plain_ticks(axes.yaxis)
    axes.legend(loc="upper left", frameon=True, framealpha=0.9, fontsize=9.5)
    save(figure, folder, "paper_memory.png")


def threads(measured, folder):
    clouds = [cloud for cloud in measured["clouds"] if cloud["threads"]]
    if not clouds:
        return
    figure, (left, right) = plt.subplots(1, 2, figsize=(SIZE[0] + 3.4, SIZE[1] - 1.2))
    x = [cloud["points"] for cloud in clouds]
    runs = {name: [1e3 * cloud["threads"][name]["seconds"] for cloud in clouds]
            for name in ("one", "two")}
    for name, words, colour, marker in (
        ("one", "one thread", "#0072b2", "s"), ("two", "two threads", "#d55e00", "o")
    ):
        left.plot(x, runs[name], color=colour, marker=marker, label=words)
    dress(left, "milliseconds on the clock", "vtkGridDelaunay2D on threads")
    left.set_yscale("log")
    plain_ticks(left.yaxis, steps=(1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0))
    left.legend(frameon=False)
    for axes in (left, right):
        axes.tick_params(axis="x", labelsize=9)
    gain = [one / two for one, two in zip(runs["one"], runs["two"])]
    right.plot(x, gain, color="#d55e00", marker="o", label="two threads")
    copies = [cloud["threads"]["copies"] for cloud in clouds]
    if all(copies):
        most = [1e-3 * one / copy["seconds"] for one, copy in zip(runs["one"], copies)]
        right.plot(x, most, color="#7f7f7f", marker="v", linestyle="--",
                   label="two copies at once: what the machine gives")
    dress(right, "times as fast as one thread", "Gain")
    right.axhline(1.0, color="#404040", linewidth=0.8)
    right.set_ylim(0.0, max(2.2, 1.1 * max(gain)))
    right.legend(frameon=False, loc="lower right")
    save(figure, folder, "paper_threads.png")


def draw_all(measured, folder):
    times(measured, folder)
    memory(measured, folder)
    threads(measured, folder)

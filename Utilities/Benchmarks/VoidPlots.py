# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The figures of void-bench."""

import os

import matplotlib

matplotlib.use("Agg")  # needs no screen
import matplotlib.pyplot as plt  # noqa: E402
import numpy  # noqa: E402
from matplotlib.ticker import FixedLocator, FuncFormatter, MultipleLocator, NullLocator  # noqa: E402

from VoidDraw import KINDS  # noqa: E402
from VoidMethods import CANDIDATES  # noqa: E402
from VoidTables import best_candidate, has_candidates  # noqa: E402

# Colours that colour-blind eyes can distinguish; each method has a marker of its own too.
LOOKS = {
    "Adaptive": ("#d55e00", "o", 2.6),
    "ThinPlate": ("#0072b2", "s", 1.4),
    "CubicSpline": ("#56b4e9", "D", 1.4),
    "Membrane": ("#009e73", "^", 1.4),
    "kriging": ("#cc79a7", "P", 1.4),
    "GMT": ("#8c6d00", "v", 1.4),
    "GMT tension": ("#e0b000", "<", 1.4),
    "GRASS": ("#5e3c99", "X", 1.4),
    "GDAL": ("#7f7f7f", "d", 1.2),
    "vtkFillHoles": ("#b0b0b0", "x", 1.2),
}
OTHERS = (("#000000", "*"), ("#444444", "h"), ("#888888", "p"))  # methods that others add
NOT_DRAWN = ("NeighborMean", "linear", "hindsight")
DPI = 100


def looks_of(results):
    """Of the methods that are drawn, ours last, so that it lies on top."""
    names = [name for name in results.names() if name != results.base and name not in NOT_DRAWN]
    added = [name for name in names if name not in LOOKS]
    looks = {name: (*OTHERS[added.index(name) % 3], 2.0) if name in added else LOOKS[name]
             for name in names}
    return dict(sorted(looks.items(), key=lambda entry: entry[0] == "Adaptive"))


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(os.path.join(folder, name), dpi=DPI, metadata={"Software": None})
    plt.close(figure)


def log_ratios(axis, least, most):
    ticks = [tick for tick in (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.3, 1.5, 2, 3, 4, 5) if
             0.97 * least <= tick <= 1.03 * most]
    axis.set_major_locator(FixedLocator(ticks))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def ratios_by_size(results, folder):
    figure, axes = plt.subplots(figsize=(9.4, 5.2))
    drawn = []
    for name, (colour, marker, width) in looks_of(results).items():
        pairs = [(size, results.ratio(name, results.base, results.of(size=size)))
                 for size in results.sizes()]
        pairs = [pair for pair in pairs if pair[1] is not None]
        if pairs:
            axes.plot(*zip(*pairs), color=colour, marker=marker, linewidth=width,
                      markersize=8 if name == "Adaptive" else 5.5, label=name)
            drawn += [ratio for _, ratio in pairs]
    if not drawn:
        plt.close(figure)
        return
    axes.axhline(1.0, color="black", linewidth=1.2, label=results.base)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_locator(FixedLocator(results.sizes()))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    axes.xaxis.set_minor_locator(NullLocator())
    log_ratios(axes.yaxis, min(drawn), max(drawn))
    axes.set_xlabel("lost nodes of a void")
    axes.set_ylabel(f"RMSE in parts of that of {results.base}")
    axes.set_title("Error by size of the void; lower is better", loc="left", fontsize=12)
    axes.grid(True, color="#dddddd", linewidth=0.8)
    axes.set_axisbelow(True)
    order = axes.get_legend_handles_labels()
    axes.legend(order[0][::-1], order[1][::-1], loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
    save(figure, folder, "void_bench_sizes.png")


def ratios_by_kind(results, folder):
    figure, axes = plt.subplots(figsize=(9.4, 4.8))
    drawn = []
    looks = looks_of(results)
    for number, (name, (colour, marker, _)) in enumerate(looks.items()):
        shift = 0.6 * ((number + 0.5) / len(looks) - 0.5)
        for row, kind in enumerate(KINDS):
            ratio = results.ratio(name, results.base, results.of(kind=kind))
            if ratio is not None:
                axes.plot(ratio, row + shift, color=colour, marker=marker, linestyle="",
                          markersize=9 if name == "Adaptive" else 6.5,
                          label=name if row == 0 else None)
                drawn.append(ratio)
    if not drawn:
        plt.close(figure)
        return
    axes.axvline(1.0, color="black", linewidth=1.2, label=results.base)
    axes.set_xscale("log")
    log_ratios(axes.xaxis, min(drawn), max(drawn))
    for row in range(1, len(KINDS)):
        axes.axhline(row - 0.5, color="#cccccc", linewidth=0.8)
    axes.set_yticks(range(len(KINDS)), KINDS)
    axes.set_ylim(len(KINDS) - 0.5, -0.5)
    axes.set_xlabel(f"RMSE in parts of that of {results.base}")
    axes.set_title("Error by kind of terrain; further left is better", loc="left", fontsize=12)
    axes.grid(True, axis="x", color="#dddddd", linewidth=0.8)
    axes.set_axisbelow(True)
    order = axes.get_legend_handles_labels()
    axes.legend(order[0][::-1], order[1][::-1], loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
    save(figure, folder, "void_bench_kinds.png")


def intervals(results, folder):
    names = [name for name in results.names() if results.coverage(name) is not None
             and name not in (*NOT_DRAWN, *CANDIDATES)]
    if not names:
        return
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.2, 4.4), sharey=True)
    looks = looks_of(results)
    for name in names:
        colour, marker, width = looks.get(name, (*OTHERS[0], 1.4))
        for axes, key, values in ((left, "size", results.sizes()), (right, "kind", KINDS)):
            shares = [results.coverage(name, results.of(**{key: value})) for value in values]
            places = [place for place, share in enumerate(shares) if share is not None]
            axes.plot(places, [100 * shares[place] for place in places], color=colour, marker=marker,
                      linewidth=width, label=name, linestyle="-" if key == "size" else "",
                      markersize=8)
    for axes in (left, right):
        axes.axhspan(87, 93, color="#dff0d8", zorder=0)
        axes.grid(True, color="#dddddd", linewidth=0.8)
        axes.set_axisbelow(True)
        axes.set_ylim(min(80, axes.get_ylim()[0]), 101)
        axes.yaxis.set_major_locator(MultipleLocator(5))
    left.set_xticks(range(len(results.sizes())), [f"{size:,}" for size in results.sizes()])
    left.set_xlabel("lost nodes of a void")
    left.set_ylabel("true heights inside the interval, %")
    left.set_title("Intervals; green: 87 to 93 %", loc="left", fontsize=12)
    right.set_xticks(range(len(KINDS)), [kind.replace(" ", "\n") for kind in KINDS])
    left.legend(loc="lower left", frameon=False)
    save(figure, folder, "void_bench_intervals.png")


def candidates(results, folder):
    """How far Adaptive is from the best candidate of each kind and size, and which that is."""
    if not has_candidates(results):
        return
    sizes = results.sizes()
    values = numpy.full((len(KINDS), len(sizes)), numpy.nan)
    figure, axes = plt.subplots(figsize=(9.4, 4.2))
    for row, kind in enumerate(KINDS):
        for column, size in enumerate(sizes):
            best = best_candidate(results, results.of(kind=kind, size=size), True)
            if best:
                values[row, column] = best[1]
                axes.text(column, row, f"{best[1]:.2f}\n{best[0]}", ha="center", va="center", fontsize=8)
    image = axes.imshow(values, cmap="PuOr_r", vmin=0.5, vmax=1.5, aspect="auto")
    figure.colorbar(image, ax=axes, pad=0.02)
    axes.set_xticks(range(len(sizes)), [f"{size:,}" for size in sizes])
    axes.set_yticks(range(len(KINDS)), KINDS)
    axes.set_xlabel("lost nodes of a void (empty: fewer than ten voids)")
    axes.set_title("RMSE of Adaptive in parts of that of its best candidate, which is named", loc="left",
                   fontsize=12)
    save(figure, folder, "void_bench_candidates.png")


def shaded(heights, steps):
    """Light from the upper left; slopes are made comparable between surfaces."""
    rise = numpy.gradient(heights, *steps[::-1])
    usual = numpy.sqrt(numpy.nanmean(rise[0] ** 2 + rise[1] ** 2)) or 1.0
    y, x = (0.9 * part / usual for part in rise)
    return (1.0 + 0.6 * (x - y)) / numpy.sqrt(1.0 + x**2 + y**2)


def examples(results, folder):
    """A void of each kind, with the terrain around it and what was lost."""
    figure, all_axes = plt.subplots(2, 3, figsize=(9.4, 6.6))
    for axes, kind in zip(all_axes.T.ravel(), KINDS):
        axes.set_xticks([])
        axes.set_yticks([])
        voids = [void for void in results.voids if void.kind == kind and void.lost.size >= 900]
        if not voids:
            axes.set_title(f"{kind}: none", fontsize=10)
            continue
        void = min(voids, key=lambda one: (
            abs(one.size - 220), one.has_island != kind.startswith("rough"),
            numpy.isnan(one.heights).sum()))
        width, height = (side * step for side, step in zip(void.lost.shape[::-1], void.steps))
        place = dict(origin="lower", extent=(0, width, 0, height))
        axes.imshow(shaded(void.heights, void.steps), cmap="gray", vmin=0, vmax=1.5, **place)
        axes.contour(void.lost.astype(float), [0.5], colors="#d55e00", linewidths=1.8,
                     origin="lower", extent=(0, width, 0, height))
        axes.set_title(f"{kind}: {void.surface},\n{void.lost.sum()} nodes", fontsize=9.5)
    figure.suptitle("Voids (orange): what is inside is hidden from the methods. White: no heights",
                    x=0.02, ha="left", fontsize=12)
    save(figure, folder, "void_bench_voids.png")


def draw_all(results, folder):
    for draw in (examples, ratios_by_size, ratios_by_kind, intervals, candidates):
        draw(results, folder)

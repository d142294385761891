# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of void-bench: Markdown between the marks of a document, and CSV."""

import csv
import re
from collections import Counter

import numpy

from VoidDraw import KINDS
from VoidMethods import CANDIDATES, Measured

HINDSIGHT = "hindsight"  # for each void, whichever candidate happens to be best
LEAST = 10  # voids that a figure needs
NONE = ""


class Results:
    """All that was measured on one draw."""

    def __init__(self, voids, measured, missing, about):
        self.voids, self.missing, self.about = voids, missing, about
        self.measured = dict(measured)
        counts = numpy.array([void.lost.sum() for void in voids])
        self.counts = counts
        self.owner = numpy.repeat(numpy.arange(len(voids)), counts)  # of each lost node
        self.scale = numpy.array([void.relief() for void in voids])
        self.base = next((name for name in ("CGAL", "linear") if name in measured), next(iter(measured)))
        if all(name in self.measured for name in CANDIDATES):
            self.measured[HINDSIGHT] = self.hindsight()

    def hindsight(self):
        squares = numpy.array([self.per_void(numpy.square(self.measured[name].errors))
                               for name in CANDIDATES])
        best = numpy.argmin(squares, axis=0)
        errors = numpy.choose(best[self.owner], [self.measured[name].errors for name in CANDIDATES])
        nothing = numpy.full(errors.shape, numpy.nan)
        return Measured(errors, nothing, numpy.full(len(self.voids), numpy.nan), [""] * len(self.voids))

    def per_void(self, values):
        """Sums; nodes without a value count as nothing."""
        return numpy.bincount(self.owner, numpy.nan_to_num(values), len(self.voids))

    def names(self):
        return list(self.measured)

    def of(self, **wanted):
        """Which voids have these properties."""
        return numpy.array([all(getattr(void, key) == value for key, value in wanted.items())
                            for void in self.voids])

    def relative(self, name):
        """Errors in parts of the relief around the void."""
        return self.measured[name].errors / self.scale[self.owner]

    def ratio(self, name, to, chosen=None, relative=True):
        """Root mean square error in parts of another method's, at nodes that both have filled."""
        pair = [self.relative(one) if relative else self.measured[one].errors for one in (name, to)]
        both = ~numpy.isnan(pair[0]) & ~numpy.isnan(pair[1])
        if chosen is not None:
            both &= chosen[self.owner]
        if len(numpy.unique(self.owner[both])) < LEAST:
            return None
        squares = [numpy.square(one[both]).sum() for one in pair]
        return float(numpy.sqrt(squares[0] / squares[1])) if squares[1] > 0 else None

    def void_ratios(self, name, to):
        """The same for each void alone; NaN where either left nodes open."""
        squares = []
        for one in (name, to):
            errors = self.measured[one].errors
            complete = self.per_void(~numpy.isnan(errors)) == self.counts
            squares.append(numpy.where(complete, self.per_void(numpy.square(errors)), numpy.nan))
        with numpy.errstate(divide="ignore", invalid="ignore"):
            return numpy.sqrt(squares[0] / squares[1])

    def surfaces(self):
        return list(dict.fromkeys(sorted(void.surface for void in self.voids)))

    def by_surface(self, name, to):
        """{surface: ratio}, of those with enough voids."""
        found = {surface: self.ratio(name, to, self.of(surface=surface), False)
                 for surface in self.surfaces()}
        return {surface: ratio for surface, ratio in found.items() if ratio is not None}

    def coverage(self, name, chosen=None):
        """The share of truths inside the interval; None without intervals."""
        inside = self.measured[name].inside
        known = ~numpy.isnan(inside)
        if chosen is not None:
            known &= chosen[self.owner]
        return float(inside[known].mean()) if known.any() else None

    def sizes(self):
        return sorted({void.size for void in self.voids})


# ---- Markdown -----------------------------------------------------------------------------------


def markdown(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def shown(value, form=".2f"):
    return NONE if value is None or not numpy.isfinite(value) else format(value, form)


def percent(value, form=".0f"):
    return NONE if value is None else f"{100 * value:{form}} %"


def method_table(results):
    rows = []
    for name in results.names():
        measured = results.measured[name]
        sizes = numpy.abs(results.relative(name))
        known = sizes[~numpy.isnan(sizes)]
        if not len(known):
            rows.append((name, *[NONE] * 8))
            continue
        ratios = results.by_surface(name, results.base)
        worst = max(ratios, key=ratios.get) if ratios else None
        each = results.void_ratios(name, results.base)
        filled = ~numpy.isnan(measured.seconds)
        microseconds = 1e6 * measured.seconds[filled].sum() / max(1, results.counts[filled].sum())
        rows.append((
            name, percent(numpy.sqrt((known**2).mean()), ".1f"), percent(known.mean(), ".1f"),
            percent(numpy.percentile(known, 90), ".1f"),
            shown(numpy.mean(list(ratios.values())) if ratios else None, ".3f"),
            f"{ratios[worst]:.2f} {worst}" if worst else NONE,
            shown(numpy.nanmedian(each) if numpy.isfinite(each).any() else None),
            percent(results.coverage(name)),
            NONE if name == HINDSIGHT else f"{microseconds:.3g}"))
    base = results.base
    return markdown(("method", "RMSE", "mean", "90th percentile", f"to {base}", "worst surface",
                     "median void", "in interval", "µs a node"), rows)


def failure_table(results):
    rows = []
    for name, measured in results.measured.items():
        if name == HINDSIGHT:
            continue
        late = sum(bool(re.match(r"failed more than .* s$", note)) for note in measured.notes)
        failed = sum(bool(note) for note in measured.notes) - late
        left = numpy.isnan(measured.errors)
        open_voids = results.per_void(left) > 0
        partly = int((open_voids & numpy.array([not note for note in measured.notes])).sum())
        words = Counter(note for note in measured.notes if note).most_common(1)
        reason = words[0][0].removeprefix("failed ").replace("|", " ")[:90] if words else NONE
        rows.append((name, str(failed), str(late), str(partly), percent(left.mean(), ".1f"), reason))
    return markdown(("method", "failed", "too long", "left open in part", "nodes left open",
                     "most frequent reason"), rows)


def missing_table(results):
    if not results.missing:
        return "None is missing."
    return "\n".join(f"- {name}: {reason}" for name, reason in results.missing.items())


def group_table(results, key, values):
    names = [name for name in results.names() if name != results.base]
    rows = []
    for value in values:
        chosen = results.of(**{key: value})
        rows.append((str(value), *[shown(results.ratio(name, results.base, chosen)) for name in names]))
    return markdown((key, *names), rows)


def surface_table(results):
    names = [name for name in results.names() if name != results.base]
    found = {name: results.by_surface(name, results.base) for name in names}
    rows = [(surface, *[shown(found[name].get(surface)) for name in names])
            for surface in results.surfaces() if any(surface in found[name] for name in names)]
    for what, function in (("mean", numpy.mean), ("most", max)):
        rows.append((what, *[shown(function(list(found[name].values())) if found[name] else None, ".3f")
                             for name in names]))
    return markdown(("surface", *names), rows)


def interval_table(results):
    names = [name for name in results.names() if results.coverage(name) is not None]
    rows = [(str(value), *[percent(results.coverage(name, results.of(**{key: value}))) for name in names])
            for key, values in (("kind", KINDS), ("size", results.sizes()), ("surface", results.surfaces()))
            for value in values if results.of(**{key: value}).any()]
    return markdown(("voids", *names), rows)


def best_candidate(results, chosen, relative):
    """(name, ratio of Adaptive to it): the one of the three that is best on all these voids."""
    found = [(results.ratio("Adaptive", name, chosen, relative), name) for name in CANDIDATES]
    if any(ratio is None for ratio, _ in found):
        return None
    ratio, name = max(found)
    return name, ratio


def has_candidates(results):
    return all(name in results.measured for name in ("Adaptive", *CANDIDATES))


def candidate_table(results):
    if not has_candidates(results):
        return "Adaptive and what it chooses from were not measured."
    rows = []
    for key, values in (("surface", results.surfaces()), ("kind", KINDS), ("size", results.sizes())):
        for value in values:
            chosen = results.of(**{key: value})
            best = best_candidate(results, chosen, key != "surface")
            if best:
                rows.append((str(value), best[0], shown(best[1]),
                             shown(results.ratio("Adaptive", HINDSIGHT, chosen, key != "surface"))))
    return markdown(("voids", "best candidate", "Adaptive to it", "Adaptive to hindsight"), rows)


def cell_table(results):
    if not has_candidates(results):
        return "Adaptive and what it chooses from were not measured."
    rows = []
    for kind in KINDS:
        row = [kind]
        for size in results.sizes():
            best = best_candidate(results, results.of(kind=kind, size=size), True)
            row.append(f"{best[1]:.2f} {best[0][0]}" if best else NONE)
        rows.append(row)
    return markdown(("kind", *map(str, results.sizes())), rows)


def count_table(results):
    counts = Counter((void.kind, void.size) for void in results.voids)
    sizes = results.sizes()
    rows = [(kind, *[str(counts[kind, size]) for size in sizes]) for kind in KINDS]
    rows.append(("all", *[str(sum(counts[kind, size] for kind in KINDS)) for size in sizes]))
    return markdown(("kind", *map(str, sizes)), rows)


def source_table(results):
    voids = Counter(void.surface for void in results.voids)
    rows = [(raster.name, f"{raster.heights.shape[1]} x {raster.heights.shape[0]}",
             f"{raster.steps[0]:.4g} x {raster.steps[1]:.4g}", raster.origin, str(voids[raster.name]))
            for raster in results.about["rasters"]]
    return markdown(("surface", "nodes", "steps", "from", "voids"), rows)


def draw_table(results):
    about = results.about
    islands = sum(void.has_island for void in results.voids)
    return "\n".join((
        f"- command: `{about['command']}`", f"- date, version: {about['date']}, {about['commit']}",
        f"- machine: {about['machine']}",
        f"- draw: {about['fingerprint']}, seed {about['seed']}; {len(results.voids):,} voids of "
        f"{results.counts.sum():,} lost nodes, {islands} of them with an island",
        f"- limit: {about['limit']:g} s on the clock for each void"))


TABLES = {
    "run": draw_table,
    "missing": missing_table,
    "sources": source_table,
    "counts": count_table,
    "methods": method_table,
    "failures": failure_table,
    "kinds": lambda results: group_table(results, "kind", KINDS),
    "sizes": lambda results: group_table(results, "size", results.sizes()),
    "surfaces": surface_table,
    "intervals": interval_table,
    "candidates": candidate_table,
    "cells": cell_table,
}
STORED_RUN = re.compile(r"^<!-- of the stored run -->$.*?^<!-- end -->$\n*", re.MULTILINE | re.DOTALL)


def with_tables(text, results, *, is_stored_run):
    """A document with its tables made anew; what is said of the stored run goes with that run alone."""
    found = re.findall(r"^<!-- table: (\w+) -->$", text, re.MULTILINE)
    if sorted(found) != sorted(TABLES):
        raise ValueError(f"the document must have each of these tables once: {', '.join(TABLES)}")

    def anew(match):
        return f"{match[1]}\n\n{TABLES[match[2]](results)}\n\n{match[3]}"

    text = re.sub(r"^(<!-- table: (\w+) -->)$.*?^(<!-- end of table -->)$", anew, text,
                  flags=re.MULTILINE | re.DOTALL)
    return text if is_stored_run else STORED_RUN.sub("", text)


# ---- CSV ----------------------------------------------------------------------------------------


def write_voids(path, results):
    """A row for each void and method; errors in units of the heights."""
    with open(path, "w", newline="", encoding="utf-8") as stream:
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(("void", "surface", "kind", "size", "row", "column", "lost", "island", "relief",
                       "method", "filled", "rmse", "mean", "percentile90", "greatest", "inside",
                       "seconds", "note"))
        starts = numpy.concatenate(([0], results.counts.cumsum()))
        for name, measured in results.measured.items():
            for number, void in enumerate(results.voids):
                part = slice(starts[number], starts[number + 1])
                sizes = numpy.abs(measured.errors[part])
                sizes = sizes[~numpy.isnan(sizes)]
                inside = measured.inside[part]
                inside = inside[~numpy.isnan(inside)]
                figures = [numpy.sqrt((sizes**2).mean()), sizes.mean(), numpy.percentile(sizes, 90),
                           sizes.max()] if len(sizes) else []
                rows.writerow((
                    number, void.surface, void.kind, void.size, *void.corner, results.counts[number],
                    int(void.has_island), f"{results.scale[number]:.6g}", name, len(sizes),
                    *([f"{figure:.6g}" for figure in figures] or [""] * 4),
                    f"{inside.mean():.4f}" if len(inside) else "",
                    shown(measured.seconds[number], ".6f"), measured.notes[number]))


def write_summary(path, results):
    """A row for each kind, size and method; errors in parts of the relief."""
    with open(path, "w", newline="", encoding="utf-8") as stream:
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(("kind", "size", "method", "voids", "nodes", "rmse", "mean", "percentile90",
                       "inside", "microseconds_a_node"))
        for kind in KINDS:
            for size in results.sizes():
                chosen = results.of(kind=kind, size=size)
                for name, measured in results.measured.items():
                    errors = numpy.abs(results.relative(name)[chosen[results.owner]])
                    errors = errors[~numpy.isnan(errors)]
                    if not len(errors):
                        continue
                    filled = chosen & ~numpy.isnan(measured.seconds)
                    nodes = results.counts[filled].sum()
                    time = 1e6 * measured.seconds[filled].sum() / nodes if nodes else numpy.nan
                    rows.writerow((
                        kind, size, name, int(chosen.sum()), len(errors),
                        f"{numpy.sqrt((errors**2).mean()):.5f}", f"{errors.mean():.5f}",
                        f"{numpy.percentile(errors, 90):.5f}",
                        shown(results.coverage(name, chosen), ".4f"), shown(time, ".4g")))

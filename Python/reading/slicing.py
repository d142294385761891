# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads points slice by slice, where files hold more than memory does.

Several ranks read at the same time. The bytes of all files, one behind the other, are cut into as many
shares, so that the points are in the order of the files, rank after rank. A rank reads a part of the
rows of an array or a LAS file, or of the blocks of a text. What is not cut, such as a packed file, is
read by the rank in whose share it begins. What is reported about a file is found in all its parts: each
rank gives what it has found, as plain values, and the one with the beginning adds them up.
"""

import dataclasses
import os

import numpy

from ..clouds import WHOLE, Cloud, Part, ReadOptions, system_of
from ..messages import FileError, Reason
from ..paths import check_readable
from ..progress import share
from ..ranks import agreed, rank_and_count, together, total
from ..selecting import NothingChosen, Selection, as_option, none_chosen
from . import NAMES_IN_COLUMNS, check_use
from .formats import FORMATS, recognise
from .nulls import ALL_WITHOUT_DATA, nulls_in
from .tables import known
from .unpacking import STANDARD_INPUT, is_plain, named, unpacked
from .upwards import notes_on_range

MOST_SEEN = 20_000  # points of earlier slices that are kept, to recognise nulls in later ones


def check_sliced(path, kind):
    """Refuses a kind of file that is only read as a whole."""
    if not kind.slices:
        names = sorted({other.name for other in FORMATS if other.slices})
        raise FileError(
            f"{path}: {kind.name} cannot be read in pieces; {', '.join(names)} can"
        )


class SlicedFile:
    """A file, or a part of it, that is read slice by slice.

    Iterate to get arrays of x, y and z in the order of read(), without point arrays. In between comes
    None where points look like null values, and others read parts of this file, too: give it what
    these have seen as `others`, and check() before you go on. At last the one with the beginning has
    to finish(). Options are ReadOptions.
    """

    def __init__(self, path, options, part=WHOLE):
        self.path, self.local, self.options, self.part = path, path, options, part
        self.cloud, self.reader, self.facts, self.unused = Cloud(None), None, None, None
        self.seen = self.others = self.doubtful = numpy.empty((0, 3))

    def __iter__(self):
        options, chosen, count, low, high = self.options, 0, 0, numpy.inf, -numpy.inf
        with unpacked(self.path, options.progress) as (self.local, begun):
            reading = dataclasses.replace(options, progress=share(options.progress, begun, 1.0))
            kind, self.cloud.notes = recognise(self.local)
            check_use(self.local, kind, options)
            check_sliced(self.local, kind)
            if options.layer and kind.module in NAMES_IN_COLUMNS:
                raise FileError(
                    f"{self.local}: --layer of {kind.name} needs all points in memory: in pieces, "
                    f"{as_option('COLUMN', options.layer)} takes those of a name"
                )
            self.reader = kind.slice_reader()(self.local, reading, self.part)
            self.selection = Selection(self.local, options.where or ())
            for points, columns in self.reader:
                if options.where:
                    points = points[self.selection.keep(columns)]
                chosen += len(points)
                if options.no_data is not None:
                    points = points[points[:, 2] != options.no_data]
                if len(points) and not options.keep_nulls:
                    yield from self.look_for_nulls(points)
                z = points[numpy.isfinite(points[:, 2]), 2]
                low, high = float(z.min(initial=low)), float(z.max(initial=high))
                count += len(points)
                yield points * (1.0, 1.0, -1.0) if options.depth else points
            self.facts = {
                "chosen": chosen,
                "count": count,
                "low": [low],
                "high": [high],
                "reader": self.reader.facts(),
                "selection": self.selection.facts(),
            }

    def look_for_nulls(self, points):
        """Refuses nulls in a slice; of a part of a file not before others were asked."""
        self.doubtful = points
        try:
            self.check()
        except FileError:
            if self.part.is_whole():
                raise
            yield None
        self.seen = numpy.concatenate((self.seen, points[:: max(1, len(points) // 100)]))
        self.seen = self.seen[:: 1 + len(self.seen) // MOST_SEEN]

    def check(self):
        """Refuses nulls in the last slice."""
        check_nulls(self.local, numpy.concatenate((self.others, self.seen, self.doubtful)))

    def check_rest(self):
        """Refuses nulls that fill a part of a file, in which there are no other values."""
        z = self.seen[:, 2]
        are_nulls = numpy.isin(z[numpy.isfinite(z)], known().nulls["values"]).all()
        if len(self.seen) and (are_nulls or not self.seen.any()):
            self.check()

    def finish(self, facts):
        """Makes the cloud of what has been found in all parts. Raises FileError."""
        cloud, noun = self.cloud, getattr(self.reader, "noun", "point")
        with named(self.local, self.path):
            self.reader.finish(facts["reader"], cloud)
            self.selection.take(facts["selection"])
            cloud.notes += self.selection.check(facts["chosen"])
            self.selection.add_to(cloud.left_out)
            if not facts["count"]:
                raise FileError(f"{self.local}: {getattr(self.reader, 'without_data', ALL_WITHOUT_DATA)}")
        if facts["chosen"] > facts["count"]:
            cloud.left_out[Reason(noun, "without data")] = facts["chosen"] - facts["count"]
        low, high = min(facts["low"]), max(facts["high"])
        if low <= high:
            cloud.notes += notes_on_range(cloud, self.options.depth, low, high, self.path)
        if self.options.depth:
            cloud.notes.append("z is turned over, as --depth says")

    def attempt_to_finish(self, facts):
        """finish(), and where no point is chosen of this file, others may have some."""
        try:
            self.finish(facts)
        except NothingChosen as error:
            self.unused = str(error)
            self.cloud.notes.append(none_chosen())


@numpy.errstate(all="ignore")
def check_nulls(path, points):
    """Refuses points of which some have a usual null value that stands apart from the others.

    points  of a slice, with some of those before it: a slice may have nothing but nulls
    """
    for name, value, _ in nulls_in(*numpy.ascontiguousarray(points.T)):
        what = f"{name} = {value:.9g}, far from other values, looks like a null value: "
        if not name:
            what = f"points {value:g} {value:g} {value:g} apart from all others look like null values: "
        advice = f"--no-data {value:.9g} leaves such points out, " if name == "z" else ""
        raise FileError(f"{path}: {what}{advice}--keep-nulls keeps them")


def file_parts(paths, rank, ranks):
    """{number of a file: the Part of it} that a rank reads of all files."""
    for path in paths:
        if path != "-":
            check_readable(path)
    if ranks > 1 and "-" in paths[1:]:
        raise FileError(f"{STANDARD_INPUT} is of the first process alone: name - before other files")
    sizes = [os.path.getsize(path) if path != "-" else 0 for path in paths]
    begin, end = (sum(sizes) * number // ranks for number in (rank, rank + 1))
    parts, at = {}, 0
    for number, (path, size) in enumerate(zip(paths, sizes)):
        if path == "-" and rank == 0 or not is_plain(path) and begin <= at < end:
            parts[number] = WHOLE
        elif is_plain(path) and max(begin, at) < min(end, at + size):
            parts[number] = Part(max(begin - at, 0), min(end - at, size), size)
        at += size
    return parts


def summed(parts):
    """Plain values of several parts as one: numbers are added, lists are put one behind the other,
    dictionaries are taken value by value."""
    if isinstance(parts[0], dict):
        names = dict.fromkeys(name for part in parts for name in part)
        return {name: summed([part[name] for part in parts if name in part]) for name in names}
    return sum(parts[1:], parts[0])


def read_files(paths, cloud, take, ranks=None, **options):
    """Calls take(x y z) for each slice of files, one after another, of the share of this rank.

    The cloud gets notes, what is left out and the reference system of all points, on all ranks.
    Options as of read(). Usual null values that stand apart are an error, as whether they are null
    shows in all points together: a rank on which some look so stops until all have read, and looks
    at them again among points that others have seen. Raises FileError, also where coordinate
    reference systems differ.
    """
    rank, count = rank_and_count(ranks)
    parts = agreed(ranks, lambda: file_parts(paths, rank, count))
    options, files = ReadOptions(**options), {}
    for i, (number, part) in enumerate(parts.items()):
        of_file = share(options.progress, i / len(parts), (i + 1) / len(parts))
        of_file = dataclasses.replace(options, progress=of_file)
        files[number] = SlicedFile(paths[number], of_file, part)
    cut = {number: file for number, file in files.items() if not file.part.is_whole()}

    def reading():
        """Goes on at the next file or suspicion."""
        for file in files.values():
            for points in file:
                if points is None:
                    yield file
                else:
                    take(points)

    steps, is_stopped = reading(), True
    while is_stopped:
        try:
            stop = next(steps, None)
        except Exception as error:  # pylint: disable=broad-except
            stop = error  # raised once all have come here
        seen = together(ranks, lambda: [[rank, i, file.seen.tolist()] for i, file in cut.items()])
        for i, file in cut.items():
            others = [points for other, number, points in seen if number == i and other != rank]
            file.others = numpy.array(sum(others, []), dtype="f8").reshape(-1, 3)
        agreed(ranks, lambda: settle(stop))
        is_stopped = total(ranks, stop is not None)
    facts = together(ranks, lambda: [[i, file.facts] for i, file in files.items()])
    begun = {i: file for i, file in files.items() if file.part.first == 0}

    def finish():
        for i, file in files.items():
            file.check_rest()
            if i in begun:
                file.attempt_to_finish(summed([found for number, found in facts if number == i]))

    agreed(ranks, finish)
    clouds, unused = [], []
    for notes, left_out, crs, why in together(ranks, lambda: [plain(file) for file in begun.values()]):
        left_out = {Reason(*parts): count for parts, count in left_out}
        clouds.append(Cloud(None, notes, left_out, crs=crs))
        unused += [why] if why else []
    if len(unused) == len(paths):
        raise NothingChosen(unused[0])
    for path, own in zip(paths, clouds):
        cloud.notes += [f"{path}: {note}" for note in own.notes] if len(paths) > 1 else own.notes
        for reason, count in own.left_out.items():
            cloud.left_out[reason] = cloud.left_out.get(reason, 0) + count
    cloud.crs, notes = system_of(paths, clouds)
    cloud.notes += notes


def settle(stop):
    """Raises why reading has stopped, if it is a reason: an exception, or nulls of a file."""
    if isinstance(stop, Exception):
        raise stop
    if stop:
        stop.check()


def plain(file):
    """What came of a file, as plain values."""
    left_out = [[reason.parts, count] for reason, count in file.cloud.left_out.items()]
    return [file.cloud.notes, left_out, file.cloud.crs, file.unused]

# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ranks that read a share each have the points of one process, in their order, and its words."""

import ast
import gzip
import io
import random
import struct
import threading
import unittest
from unittest import mock

import numpy
from in_folder import InFolder
from vtkelevationsurface.clouds import Cloud
from vtkelevationsurface.messages import ElevationSurfaceError
from vtkelevationsurface.reading import text_blocks
from vtkelevationsurface.reading.slicing import read_files
from vtkmodules.util.numpy_support import vtk_to_numpy

SHARES = (1, 2, 3, 7)


class Rank:
    """What a controller does, for threads that each are a rank."""

    def __init__(self, number, everybody):
        self.number, (self.barrier, self.values) = number, everybody

    def GetLocalProcessId(self):
        return self.number

    def GetNumberOfProcesses(self):
        return len(self.values)

    def AllGather(self, own, everywhere):
        self.values[self.number] = vtk_to_numpy(own)
        self.barrier.wait()
        vtk_to_numpy(everywhere)[:] = numpy.concatenate(self.values)
        self.barrier.wait()


PARSE, PARSING = ast.parse, threading.Lock()


def parse_alone(*arguments, **options):
    """ast.parse(), which numpy reads headers by; Python 3.11 fails where two threads are in it
    (python/cpython 106905)."""
    with PARSING:
        return PARSE(*arguments, **options)


@mock.patch("ast.parse", parse_alone)
def on_ranks(count, work):
    """[work(Rank)] of so many threads."""
    everybody, results = (threading.Barrier(count), [None] * count), [None] * count

    def call(number):
        try:
            results[number] = work(Rank(number, everybody))
        except BaseException as error:  # pylint: disable=broad-except
            everybody[0].abort()
            results[number] = error

    threads = [threading.Thread(target=call, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in results:
        if isinstance(result, BaseException) and not isinstance(result, threading.BrokenBarrierError):
            raise result
    return results


def read(paths, ranks, **options):
    """(points, notes and counts of a Cloud) or the words of an error; the words are those of all ranks."""

    def of_rank(rank):
        cloud, taken = Cloud(None), [numpy.empty((0, 3))]
        try:
            read_files(paths, cloud, taken.append, rank, **options)
        except ElevationSurfaceError as error:
            return None, str(error)
        return numpy.concatenate(taken), (cloud.notes, cloud.left_out, cloud.crs)

    results = on_ranks(ranks, of_rank) if ranks else [of_rank(None)]
    words = results[0][1]
    if any(other != words for _, other in results):
        raise AssertionError(f"ranks have different words: {results}")
    if isinstance(words, str):
        return words
    return numpy.concatenate([points for points, _ in results]), words


def text_of(chance):
    """A small text file, of whatever may be in one."""
    separator, end = chance.choice((" ", ",", ";", "\t")), chance.choice(("\n", "\r\n", "\r"))
    width, count = chance.randint(3, 6), chance.randint(1, 300)
    lines = ["# made by hand " + "long " * chance.randint(0, 30)] * chance.randint(0, 2)
    if chance.random() < 0.5:
        lines.append(separator.join(("x", "y", "z", "v", "w", "u")[:width]))
    for i in range(count):
        row = [f"{chance.uniform(0, 99):.{chance.randint(1, 6)}f}" for _ in range(width)]
        if chance.random() < 0.02:
            row[2] = chance.choice(("nan", "NaN", "-9999", "999"))
        if width > 3 and chance.random() < 0.02:
            row[3] = "none"
        lines.append(separator.join(row))
        if chance.random() < 0.03:
            lines.append(chance.choice(("", "# a comment", lines[-1] + separator + "7", "  ")))
        if chance.random() < 0.003:
            lines.append(chance.choice(("1", "a b c", separator.join(["1", "2", "high", "3", "4", "5"][:width]))))
    words = end.join(lines) + chance.choice(("", end, end + end, "\x1a", "\0\0"))
    code = chance.choice(("utf-8", "utf-8", "utf-8-sig", "utf-16"))
    return words.encode(code)


def las_of(chance):
    """A LAS file with some points of several classes."""
    count = chance.randint(1, 300)
    head = b"LASF" + bytes(20) + bytes((1, 2)) + bytes(68)
    head += struct.pack("<HIIBH", 227, 227, 0, 0, 20) + struct.pack("<I5I", count, *[0] * 5)
    head += struct.pack("<6d", 0.01, 0.01, 0.001, 5e5, 6e6, 0.0) + bytes(48)
    return head + b"".join(
        struct.pack("<iiiHBBbBH", *(chance.randint(-9999, 9999) for _ in range(3)), 7, 1,
                    chance.choice((1, 1, 2, 130)), 0, 0, 0)
        for _ in range(count))


def options_of(chance, kind):
    options = {}
    if chance.random() < 0.3:
        options["depth"] = True
    if chance.random() < 0.5:
        options["no_data"] = chance.choice((-9999.0, 999.0))
    if chance.random() < 0.5:
        options["keep_nulls"] = True
    if kind == "txt" and chance.random() < 0.4:
        options["columns"] = chance.choice(((2, 1, 3), (1, 2, 4), (3, 2, 1)))
    if kind == "txt" and chance.random() < 0.4:
        options["skip_bad_lines"] = True
    if kind == "las" and chance.random() < 0.5:
        options["classes"] = chance.choice(((1,), (2,), (1, 2), (5,)))
    if chance.random() < 0.3:
        name = {"txt": "v", "las": "Classification", "npy": "column 4"}[kind]
        options["where"] = {name: chance.sample(range(6), 3)}
    return options


class Shares(InFolder):
    def assert_alike(self, paths, shares=SHARES, **options):
        """What is read is alike, whatever the number of ranks. Returns what one process has."""
        expected = read(paths, None, **options)
        for count in shares:
            found = read(paths, count, **options)
            if isinstance(expected, str):
                self.assertEqual(found, expected)
            else:
                numpy.testing.assert_array_equal(found[0], expected[0])
                self.assertEqual(found[1], expected[1])
        return expected

    def npy_of(self, chance, path):
        numbers = numpy.random.default_rng(chance.randint(0, 10**9))
        rows = numbers.integers(0, 40, (chance.randint(1, 300), chance.randint(3, 5))) * 0.5
        rows[numbers.random(len(rows)) < 0.01, 2] = -9999.0
        numpy.save(path, chance.choice((numpy.asfortranarray, numpy.ascontiguousarray))(rows))

    def test_random_files_of_each_kind(self):
        read_well = 0
        for seed in range(20):
            chance = random.Random(seed)
            kind, paths = chance.choice(("txt", "txt", "las", "npy")), []
            for number in range(chance.randint(1, 3)):
                paths.append(self.path(f"{seed}-{number}.{kind}"))
                if kind == "npy":
                    self.npy_of(chance, paths[-1])
                else:
                    self.file(paths[-1], text_of(chance) if kind == "txt" else las_of(chance))
            options = options_of(chance, kind)
            with self.subTest(seed=seed, options=options), \
                    mock.patch.object(text_blocks, "BLOCK", chance.choice((40, 300, 2000))), \
                    mock.patch("vtkelevationsurface.clouds.AT_ONCE", chance.choice((7, 50, 1000))):
                read_well += not isinstance(self.assert_alike(paths, **options), str)
        self.assertGreater(read_well, 7)

    def test_more_shares_than_points(self):
        numpy.save(self.path("a.npy"), numpy.arange(15.0).reshape(5, 3))
        paths = [self.file("a.txt", "1 2 3\n4 5 6\n7 7 7"), self.path("a.npy"),
                 self.file("a.las", las_of(random.Random(1)))]
        with mock.patch.object(text_blocks, "BLOCK", 6):
            self.assertGreater(len(self.assert_alike(paths, (5, 40))[0]), 8)
            self.assertIn("no point of class 9", self.assert_alike([paths[2]], (40,), classes=(9,)))

    def test_shares_are_even(self):
        rows = numpy.random.default_rng(1).random((1000, 3))
        for name in "ab":
            numpy.save(self.path(f"{name}.npy"), rows)
        self.file("c.txt", "".join("%.5f %.5f %.5f\n" % tuple(row) for row in rows))

        def of_rank(rank):
            taken = []
            read_files([self.path(name) for name in ("a.npy", "b.npy", "c.txt")], Cloud(None),
                       taken.append, rank)
            return sum(map(len, taken))

        with mock.patch.object(text_blocks, "BLOCK", 500):
            counts = on_ranks(4, of_rank)
        self.assertEqual(sum(counts), 3000)
        self.assertLess(max(counts), 900)

    def test_numbers_of_lines_are_those_of_the_file(self):
        rows = ["X,Y,Z,v", *(f"{i % 70},{i // 70},{i % 11},{i}" for i in range(2000))]
        rows[100] = rows[1700] = "# a comment"
        rows[1200] = "5,6,7,much"
        rows[1400] = "5,6,7,8,9"
        rows[1990] = "Total,,5,"
        path = self.file("a.csv", "\r\n".join(rows))
        with mock.patch.object(text_blocks, "BLOCK", 1000):
            notes = self.assert_alike([path])[1][0]
            self.assertTrue(any("line 1,201: much" in note for note in notes))
            self.assertTrue(any("line 1,401 has 5 columns" in note for note in notes))
            self.assertTrue(any("left out: line 1,991 (Total)" in note for note in notes))
            self.assertTrue(any("2 comment lines" in note for note in notes))
            rows[1900] = "5,6,high,7"
            path = self.file("a.csv", "\r\n".join(rows))
            self.assertIn("a.csv, line 1901: 'high'", self.assert_alike([path]))

    def test_nulls_are_judged_by_the_points_of_all_ranks(self):
        rows = numpy.random.default_rng(5).random((3000, 3)) * (100.0, 100.0, 3000.0)
        path = self.path("a.npy")
        for part in (slice(0, 1500), slice(1500, 3000), slice(1200, 1203), slice(2999, 3000)):
            nulls = rows.copy()
            nulls[part, 2] = -9999.0
            numpy.save(path, nulls)
            with self.subTest(part=part):
                self.assertIn("z = -9999, far from other", self.assert_alike([path], (2, 3)))
        trench = rows.copy()
        trench[:1000, 2] -= 11000.0
        trench[2500, 2] = -9999.0  # alone in the last share, near others in the first
        numpy.save(path, trench)
        self.assertEqual(len(self.assert_alike([path], (2, 3))[0]), 3000)

    def test_a_file_that_is_not_cut_is_of_one_rank(self):
        content = "".join(f"{i} {i * i % 97} {i % 7}\n" for i in range(900)).encode()
        paths = [self.file("a.xyz", content), self.file("b.xyz.gz", gzip.compress(content)),
                 self.file("c.xyz", content)]
        with mock.patch.object(text_blocks, "BLOCK", 1000):
            points, (notes, *_) = self.assert_alike(paths)
            self.assertEqual(len(points), 2700)
            self.assertTrue(all("/tmp" not in note.split(":", 1)[1] for note in notes))
            self.file("b.xyz.gz", gzip.compress(content + b"1 2 high\n"))
            self.assertIn("b.xyz.gz, line 901: 'high'", self.assert_alike(paths))
        with self.assertRaisesRegex(AssertionError, "name - before other files"):
            raise AssertionError(read([paths[0], "-"], 2))

    def test_standard_input_is_of_the_first_rank(self):
        rows = numpy.random.default_rng(2).random((40, 3))
        numpy.save(self.path("a.npy"), rows)
        row_text = "".join("%r %r %r\n" % tuple(row) for row in rows.tolist()).encode()
        for others in ([], [self.path("a.npy")]):
            for ranks in SHARES:
                with mock.patch("sys.stdin", mock.Mock(buffer=io.BytesIO(row_text))):
                    points = read(["-", *others], ranks)[0]
                numpy.testing.assert_array_equal(points, numpy.tile(rows, (1 + len(others), 1)))

    def test_a_missing_file_is_an_error_of_all_ranks(self):
        self.assertIn("no such file", self.assert_alike([self.path("a.npy")]))


if __name__ == "__main__":
    unittest.main(argv=["TestReadShares"])

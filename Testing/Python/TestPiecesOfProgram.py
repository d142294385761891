# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program with --pieces and --memory: its surface and its report are those of one run."""

import os
import re
import signal
import subprocess
import sys
import unittest

import numpy
from in_folder import Program
from in_pieces import all_triangles, clouds, coast_and_lakes, star
from meshes import by_places, sorted_rows, sorted_triangles, triangles_of
from vtkelevationsurface import pieces
from vtkmodules.vtkIOXML import vtkXMLPartitionedDataSetReader, vtkXMLPolyDataReader

TRIANGULATION_ONLY = ("--no-trim", "--no-fill")


class Command(Program):
    """The program with --pieces and --memory."""

    def npy(self, name, points):
        numpy.save(self.path(name), points)
        return name

    def parts(self, name):
        """The pieces of a .vtpd file, each read by itself as its global ids are known then."""
        reader = vtkXMLPartitionedDataSetReader()
        reader.SetFileName(self.path(name))
        reader.Update()
        found = [reader.GetOutput().GetPartition(i)
                 for i in range(reader.GetOutput().GetNumberOfPartitions())]
        self.assertTrue(all(part.GetPointData().GetGlobalIds() for part in found))
        return found

    def test_the_pieces_have_the_surface_and_the_report_of_one_run(self):
        for kind in ("random", "lattice"):
            name = self.npy(f"{kind}.npy", clouds()[kind])
            options = (*TRIANGULATION_ONLY, "--report", "--duplicates", "keep-highest")
            all_points = "--no-remove-unused-points"  # pieces have them
            self.assertEqual(self.call(name, "--no-picture", all_points, *options).returncode, 0)
            whole = self.json(f"{kind}_surface.json")
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(self.path(f"{kind}_surface.vtp"))
            reader.Update()
            done = self.call(name, "--pieces", "5", *options)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("in 5 pieces", done.stdout)
            numpy.testing.assert_array_equal(
                all_triangles(self.parts(f"{kind}_surface.vtpd")),
                sorted_triangles(triangles_of(reader.GetOutput())),
            )
            report = self.json(f"{kind}_surface.json")
            for key in ("points", "unused_reasons", "unused", "lattice", "triangles", "left_out",
                        "bounds", "crs", "lattice_mode", "points_unused"):
                self.assertEqual(report[key], whole[key], key)

    def test_the_report_of_trimmed_pieces_is_that_of_one_run(self):
        name = self.npy("a.npy", clouds()["random"])
        ring = star((400500.0, 400500.0), 380.0)
        self.file("coast.txt", "".join(f"{x!r} {y!r}\n" for x, y, _ in ring.tolist()))
        options = ("--boundary", "coast.txt", "--no-fill", "--report", "--no-picture")
        self.assertEqual(self.call(name, *options).returncode, 0)
        whole = self.json("a_surface.json")
        done = self.call(name, "--pieces", "4", *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        report = self.json("a_surface.json")
        for key in ("points", "unused_reasons", "unused", "points_unused", "triangles", "trim",
                    "bounds"):
            self.assertEqual(report[key], whole[key], key)
        self.assertGreater(report["unused_reasons"]["outside the boundary"], 100)
        self.file("open.txt", "1 1\n2 2\n3 1\n4 4\n")
        done = self.call(name, "--pieces", "4", "--boundary", "open.txt", "--no-fill")
        self.assertIn("open.txt: the part from line 1 to 4 is not closed", done.stderr)
        self.file("nulls.xyz", "".join(f"{i % 40} {i // 40} {-9999 if i > 700 else i % 7}\n" for i in range(1000)))
        done = self.call("nulls.xyz", "--pieces", "4", "--boundary", "open.txt")  # read first
        self.assertIn("open.txt: the part from line 1", done.stderr)
        self.file("far.txt", "1 1\n2 2\n3 1\n1 1\n")
        done = self.call(name, "--pieces", "4", "--boundary", "far.txt", "--no-fill")
        self.assertIn("far.txt: trimming: The boundary", done.stderr)

    def test_the_outline_that_is_found_is_that_of_one_run(self):
        points = clouds()["random"]
        places = points[:, :2] - (400600.0, 400500.0)
        name = self.npy("a.npy", points[~(numpy.hypot(*places.T) < 150.0)])
        for ways in (("--no-fill",), ("--open-edge-length", "0"), ("--no-fill", "--gap-tolerance", "3")):
            reported = []
            for way in (("--no-picture",), ("--pieces", "4")):
                done = self.call(name, *ways, *way, "--report")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                report = self.json("a_surface.json")
                reported.append([line for line in done.stdout.splitlines()
                             if not re.match("  (time|distance|written)|  +in 4 pieces", line)])
                reported.append({key: report[key] for key in ("unused_reasons", "unused", "triangles", "trim", "bounds")})
            self.assertEqual(reported[:2], reported[2:])
            self.assertEqual(reported[1]["trim"]["boundary"], "found from the points")
            self.assertGreater(reported[1]["trim"]["outward_triangles"], 20)
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(self.path("a_surface.vtp"))
            reader.Update()
            numpy.testing.assert_array_equal(
                sorted_rows(numpy.concatenate([by_places(part) for part in self.parts("a_surface.vtpd")])),
                by_places(reader.GetOutput()),
            )

    def test_faults_are_edges_and_reported_as_by_one_run(self):
        points = clouds()["random"]
        points[:, 2] += 100.0
        name = self.npy("a.npy", points)
        lines = [points[[5, 900]] + (3.0, 0.0, 1.0), points[[7, 60]] + (0.0, 4.0, 2.0)]
        rows = ["".join("%r %r %r\n" % tuple(place) for place in line.tolist()) for line in lines]
        self.file("f.txt", "\n".join(rows))
        self.file("bare.txt", "\n".join(re.sub(" [^ ]*\n", "\n", text) for text in rows))
        self.file("zero.txt", "\n".join(re.sub(" [^ ]*\n", " 0\n", text) for text in rows))
        self.file("high.txt", "\n".join(re.sub(" [^ ]*\n", " 9000\n", text) for text in rows))
        for faults in ("f.txt", "high.txt"):
            options = ("--faults", faults, *TRIANGULATION_ONLY, "--report")
            self.assertEqual(self.call(name, *options, "--no-picture").returncode, 0)
            whole = self.json("a_surface.json")
            done = self.call(name, "--pieces", "4", *options)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            report = self.json("a_surface.json")
            for key in ("points", "unused", "triangles", "bounds", "faults"):
                self.assertEqual(report[key], whole[key], key)
            self.assertEqual([note for note in report["notes"] if "faults" in note],
                             [note for note in whole["notes"] if "faults" in note])
            self.assertGreater(report["faults"]["added_points"], 0)
        for options, words in (
            (("--faults", "bare.txt"), "bare.txt: 2 of 2 lines without z (first: "),
            (("--faults", "zero.txt"), "zero.txt: z of its lines is 0 everywhere"),
            (("--faults", "f.txt", "--faults-z", "drape"), "f.txt: z of its lines is left aside"),
        ):
            done = self.call(name, "--pieces", "4", *TRIANGULATION_ONLY, *options)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
            self.assertIn(words, done.stderr)
            self.assertIn("takes the whole surface in memory", done.stderr)
        done = self.call(name, "--pieces", "4", *TRIANGULATION_ONLY, "--faults", "zero.txt", "--faults-z", "given")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.file("far.txt", "1 1 1\n2 2 2\n")
        done = self.call(name, "--memory", "2G", *TRIANGULATION_ONLY, "--faults", "far.txt")
        self.assertIn("far.txt: triangulating: The constraints", done.stderr)

    def cloud_with_lakes(self, count):
        """The name of a file of points; a coast and so many lakes are in lakes.txt."""
        points = clouds()["random"]
        rings = coast_and_lakes(points)[: 1 + count]
        text_of = ["".join(f"{x!r} {y!r}\n" for x, y, _ in ring.tolist()) for ring in rings]
        self.file("lakes.txt", "\n".join(text_of))
        return self.npy("a.npy", points)

    def test_the_report_of_filled_pieces_is_that_of_one_run(self):
        name = self.cloud_with_lakes(5)
        options = ("--boundary", "lakes.txt", "--fill-cut-outs", "--maximum-hole-size", "150", "--report")
        done = self.call(name, *options, "--no-picture")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        whole = self.json("a_surface.json")
        done = self.call(name, "--pieces", "4", *options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("5 found, 2 filled with", done.stdout)
        report = self.json("a_surface.json")
        for one in (report, whole):
            for hole in one["holes"]["list"]:
                del hole["hole"]  # in the order of triangles
            one["holes"]["list"].sort(key=lambda hole: hole["centre"])
        for key in ("points", "unused_reasons", "unused", "points_unused", "triangles", "trim",
                    "bounds", "holes"):
            self.assertEqual(report[key], whole[key], key)

    def test_triangles_above_a_given_length_are_filled_as_by_one_run(self):
        points = clouds()["random"]
        places = points[:, :2] - (400600.0, 400500.0)
        name = self.npy("a.npy", points[numpy.abs(numpy.hypot(*places.T) - 160.0) > 30.0])
        for options in (("--open-edge-length", "45"), ("--open-edge-length", "45", "--maximum-hole-size", "100")):
            options += ("--maximum-expected-points", "9000", "--no-trim", "--report")
            found = []
            for way in (("--no-picture",), ("--pieces", "4")):
                done = self.call(name, *options, *way)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                bridged = [line.split("  ", 2)[2] for line in done.stdout.splitlines() if "void" in line or "bridge" in line]
                report = self.json("a_surface.json")
                for hole in report["holes"]["list"]:
                    del hole["hole"]  # in the order of triangles
                report["holes"]["list"].sort(key=lambda hole: hole["centre"])
                found.append({key: report[key] for key in ("unused_reasons", "triangles", "bounds", "holes")})
                found[-1]["bridged"] = [re.sub("void .*", "", line) for line in bridged]
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(self.path("a_surface.vtp"))
            reader.Update()
            self.assertEqual(*found)
            self.assertEqual(found[0]["holes"]["open_edge_length_is"], "as given")
            self.assertGreater(found[0]["holes"]["by_status"]["replaced"], 5)
            self.assertEqual(found[0]["holes"]["bridged_left"] > 0, "--maximum-hole-size" in options)
            numpy.testing.assert_array_equal(
                sorted_rows(numpy.concatenate([by_places(part) for part in self.parts("a_surface.vtpd")])),
                by_places(reader.GetOutput()),
            )

    def test_messages_on_a_boundary_are_those_of_one_run(self):
        points = clouds()["random"]
        name = self.npy("a.npy", points)
        chosen = points[numpy.isfinite(points).all(axis=1)][[700, 800, 900, 700], :2].tolist()
        self.file("chosen.txt", "".join(f"{x!r} {y!r}\n" for x, y in chosen))
        corners = "400100 400100\n400900 400150\n400700 400800\n400100 400100\n"
        self.file("twice.txt", f"{corners}\n400500 400250\n400600 400300\n400600 400200\n400500 400250\n\n{corners}")
        self.file("thin.txt", "400100.001 400100\n400100.002 400900\n400100.003 400100\n400100.001 400100\n")
        for options, words in (
            (("--boundary", "twice.txt"), r"note +trimming: Rings .* \(1 more, the first of them the part from line "
             r"11 to 14\) count once"),
            (("--boundary", "chosen.txt", "--no-recover-boundary"), r"chosen.txt: trimming: The boundary's edge from "
             r"point \d+ .* is not an edge of the mesh"),
            (("--boundary", "thin.txt"), "boundary thin.txt, 1 ring"),
        ):
            said = []
            for way in ("--no-picture", "--pieces=4"):
                done = self.call(name, "--no-fill", *options, way)
                lines = [line for line in done.stdout.splitlines() if re.match("  (note|triangles|trimmed)", line)]
                said.append((done.returncode, done.stderr, lines))
            self.assertEqual(*said)
            self.assertRegex("\n".join([done.stderr, *lines]), words)

    def test_holes_that_fail_are_reported_as_by_one_run(self):
        name = self.cloud_with_lakes(2)
        options = (
            "--boundary", "lakes.txt", "--fill-cut-outs", "--spacing", "0.001",
            "--open-edge-length", "0",
        )
        refused = [self.call(name, *options, way).stderr for way in ("--no-picture", "--pieces=4")]
        self.assertRegex(refused[0], r"a.npy: filling holes: .* A --spacing of 0\.\d+ would do")
        self.assertEqual(*refused)
        # With as many as may be inserted, holes fail one by one.
        options += ("--maximum-expected-points", "100000000")
        reported = []
        for way in ("--no-picture", "--pieces=4"):
            done = self.call(name, *options, way, "--report")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            report = self.json("a_surface.json")
            reported.append(sorted(re.sub("Hole [01]", "Hole", note) for note in report["notes"]))
            reported.append(report["holes"]["open_edge_length_is"])
            strict = self.call(name, *options, way, "--strict")
            self.assertEqual((strict.returncode, len(strict.stderr.splitlines())), (1, 1))
            self.assertIn("a.npy: filling holes: Hole 0 (", strict.stderr)
        self.assertEqual(reported[:2], reported[2:])
        self.assertEqual(len(reported[0]), 5)  # two holes that fail, places with several heights, two on the boundary
        said = []
        for way in ("--no-picture", "--pieces=4"):
            done = self.call(name, "--boundary", "lakes.txt", "--fill-cut-outs", "--spacing", "1e-10", way)
            said.append((done.returncode, done.stderr))
        self.assertEqual(*said)
        self.assertIn("--spacing: 1e-10 is too small: x and y of the points are in steps of", said[0][1])

    def test_a_hole_may_not_take_more_than_the_memory(self):
        name = self.cloud_with_lakes(2)
        options = (
            "--boundary", "lakes.txt", "--fill-cut-outs", "--memory", "450M",
            "--maximum-expected-points", "99999999",
        )
        done = self.call(name, *options, "--spacing", "0.2")
        self.assertEqual(done.returncode, 1)
        found = re.search(r"more than the memory for it, 0.2 GB. A --spacing of (\S+) would do", done.stderr)
        self.assertTrue(found, done.stderr)
        self.assertGreater(float(found.group(1)), 0.2)

    def test_points_in_no_triangle_below_the_limit_are_reported(self):
        points = clouds()["random"]
        name = self.npy("a.npy", points)
        ring = star((400500.0, 400500.0), 380.0)
        self.file("coast.txt", "".join(f"{x!r} {y!r}\n" for x, y, _ in ring.tolist()))
        limit = ("--maximum-edge-length", "25", "--report")
        for options, words in (
            (("--no-trim", "--no-fill"), "in no triangle below the edge limit"),
            (("--boundary", "coast.txt"), "outside the boundary, or in no triangle below the edge limit"),
        ):
            self.assertEqual(self.call(name, *limit, *options, "--no-picture").returncode, 0)
            whole = self.json("a_surface.json")
            done = self.call(name, "--pieces", "4", *limit, *options)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            report = self.json("a_surface.json")
            for key in ("points_unused", "triangles", "bounds"):
                self.assertEqual(report[key], whole[key], key)
            self.assertGreater(report["unused_reasons"][words], 50)
            self.assertEqual([u["point"] for u in report["unused"]],
                             [u["point"] for u in whole["unused"]])

    def test_several_files_are_one_cloud(self):
        points = clouds()["random"]
        names = [self.npy("a.npy", points[:1000]), self.npy("b.npy", points[1000:])]
        for extra in (("--memory", "2G"), ("--pieces", "3", "-o", "c.vtpd")):
            done = self.call(*names, *extra, *TRIANGULATION_ONLY, "--crs", "EPSG:25832")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        one, several = self.parts("a_surface.vtpd"), self.parts("c.vtpd")
        self.assertEqual((len(one), len(several)), (1, 3))
        numpy.testing.assert_array_equal(all_triangles(one), all_triangles(several))
        crs = several[0].GetFieldData().GetAbstractArray("CRS").GetValue(0)
        self.assertEqual(crs, "EPSG:25832")

    def test_pieces_of_an_earlier_run_go(self):
        name = self.npy("a.npy", clouds()["random"])
        for count in ("5", "2"):
            done = self.call(name, "--pieces", count, *TRIANGULATION_ONLY, "-o", "c.vtpd")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.file("c/c_note.vtp", "not a piece")
        self.assertEqual(sorted(os.listdir(self.path("c"))), ["c_0.vtp", "c_1.vtp", "c_note.vtp"])

    def test_memory_sets_the_number_of_pieces(self):
        self.assertEqual(pieces.memory_size("1.5g"), 1.5e9)
        self.assertEqual(pieces.memory_size("800MB"), 8e8)
        self.assertEqual(pieces.memory_size("2GiB"), 2e9)
        self.assertEqual(pieces.pieces_within(2e9, 1000), 1)
        self.assertEqual(pieces.pieces_within(2e9, 200_000_000), 30)
        self.assertEqual(pieces.pieces_within(2e9, 200_000_000, fill=True), 42)
        self.assertEqual(pieces.pieces_within(2e9, 1000, processes=4), 4)
        self.assertEqual(pieces.pieces_within(2e9, 200_000_000, processes=4), 32)
        for wrong in ("", "2X", "10", "-2G", "100M", "nan", "1e9"):
            done = self.call("a.npy", f"--memory={wrong}", *TRIANGULATION_ONLY)
            words = f"--memory takes a size of at least 450M, such as 2G, not '{wrong}'"
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)

    def test_what_does_not_go_with_pieces_is_refused_before_any_work(self):
        name = self.npy("a.npy", clouds()["few"])
        self.file("b.stl", "solid a\n facet normal 0 0 1\n")
        self.file("taken", "a file")
        for options, words in (
            (("--pieces", "2", "--no-trim"), "add --open-edge-length, 0 for none"),
            (("--pieces", "0"), "--pieces takes a whole number from 1, not '0'"),
            (("--pieces", "2", "--memory", "2G", *TRIANGULATION_ONLY), "leave one out"),
            (("--pieces", "2", "--grid", "5", *TRIANGULATION_ONLY), "--grid needs the whole"),
            (("--pieces", "2", "--boundary", "a.npy", "--outward-test", "inward-normal"), "--outward-test needs"),
            (("--pieces", "2", "--view", "top", *TRIANGULATION_ONLY), "--view needs the whole"),
            (("--pieces", "2", "-o", "a.vtp", *TRIANGULATION_ONLY), ".vtp cannot be written in"),
            (("b.stl", "--pieces", "2", *TRIANGULATION_ONLY), "an STL file cannot be read in pieces"),
            (("--pieces", "2", "-o", "taken.vtpd", *TRIANGULATION_ONLY), "has this name"),
            (("-o", "a.vtpd"), ".vtpd cannot be written; use one of .vtp"),
        ):
            done = self.call(name, *options)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)
            self.assertIn(words, done.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.npy", "b.stl", "taken"])

    def test_no_triangle_is_an_error_that_leaves_nothing(self):
        name = self.npy("a.npy", numpy.arange(30.0).reshape(10, 3))
        done = self.call(name, "--pieces", "3", *TRIANGULATION_ONLY)
        self.assertEqual(done.returncode, 1)
        self.assertIn("no surface", done.stderr)
        self.assertEqual(os.listdir(self.folder), ["a.npy"])

    def test_a_full_disk_is_one_message_and_leaves_nothing(self):
        name = self.npy("a.npy", clouds()["random"])
        for most in (20_000, 100_000):  # bytes of a file: of all points, of a piece
            done = self.call(name, "--pieces", "1", *TRIANGULATION_ONLY, largest_file=most)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
            self.assertIn("cannot be written: File too large", done.stderr)
            self.assertEqual(os.listdir(self.folder), ["a.npy"])

    def test_a_stop_leaves_nothing(self):
        name = self.npy("a.npy", clouds()["random"])
        for when in ("read", "update", "write_vtpd"):
            script = (
                "import os, signal, sys, time\n"
                "from vtkelevationsurface import command, pieces, supervisor\n"
                "def stopped(*_):\n"
                "    os.kill(os.getppid(), signal.SIGTERM)\n"
                "    time.sleep(300)\n"
                "    open('went-on', 'w').close()\n"
                f"home = pieces if hasattr(pieces, {when!r}) else pieces.Pieces\n"
                f"setattr(home, {when!r}, stopped)\n"
                f"options = [{name!r}, '--pieces', '3', '--no-trim', '--no-fill']\n"
                "work = lambda: command.main(options)\n"
                "sys.exit(supervisor.supervised(work))\n"
            )
            done = subprocess.run(
                [sys.executable, "-c", script], cwd=self.folder, text=True, capture_output=True,
                timeout=300, check=False,
            )
            words = "reconstruct: stopped; nothing is written\n"
            self.assertEqual((done.returncode, done.stderr), (130, words))
            self.assertEqual(os.listdir(self.folder), ["a.npy"])


if __name__ == "__main__":
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    unittest.main(argv=sys.argv[:1])

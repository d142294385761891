# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Places with several heights, and meshes that fold: what is noted, refused, and the ways out."""

import json
import math
import os
import sys
import unittest
import warnings

import numpy
from in_folder import InFolder, Program, coordinates
from vtkelevationsurface import reading, reconstruct, writing
from vtkelevationsurface.clouds import Cloud, add_array, cells_of, make_points
from vtkelevationsurface.several_heights import check_heights, several_heights
from vtkelevationsurface.messages import ElevationSurfaceError, ElevationSurfaceWarning, FileError
from vtkelevationsurface.reading.facing import notes_on_faces
from vtkelevationsurface.selecting import words_of
from vtkmodules.vtkCommonCore import vtkStringArray

SIDE = 24
NODES = numpy.stack(numpy.meshgrid(*[25.0 * numpy.arange(SIDE)] * 2), -1).reshape(-1, 2)


def with_z(xy, z):
    return numpy.column_stack((xy, numpy.broadcast_to(z, len(xy))))


def waves(xy):
    return 8.0 * numpy.sin(xy[:, 0] / 150.0) + 0.02 * xy[:, 1]


def horizons(*depths):
    """Horizons below each other at the same nodes, and the number of each point's horizon."""
    parts = [with_z(NODES, waves(NODES) - depth) for depth in depths]
    return numpy.concatenate(parts), numpy.repeat(numpy.arange(len(depths)), len(NODES))


def reverse_fault():
    """A horizon that dips to the east; a strip of its nodes is there twice, 73.6 apart."""
    lower = NODES[NODES[:, 0] <= 350]
    upper = NODES[NODES[:, 0] >= 275]
    return numpy.concatenate(
        (with_z(lower, -1000.0 - 0.2 * lower[:, 0]), with_z(upper, -926.4 - 0.2 * upper[:, 0]))
    )


def wells(random, count=15, each=20):
    """On even ground, and not of one depth."""
    xy = random.random((count, 2)) * 5000
    step = 20.0 + 40.0 * random.random((count, 1))
    depth = step * numpy.arange(each) + random.random((count, each))
    return with_z(numpy.repeat(xy, each, axis=0), -depth.ravel())


def cloud_of(points, **columns):
    cloud = Cloud(make_points(points))
    for name, values in columns.items():
        if isinstance(values[0], str):
            cloud.words[name] = words_of(values)
        else:
            add_array(cloud.points, name, numpy.asarray(values))
    return cloud


class Heights(unittest.TestCase):
    def setUp(self):
        self.random = numpy.random.default_rng(11)

    def refused(self, points, **columns):
        """The error's words."""
        with self.assertRaises(ElevationSurfaceError) as caught:
            check_heights(cloud_of(points, **columns))
        self.assertEqual(check_heights(cloud_of(points, **columns), 3)[1]["of"] > 0, True)
        return str(caught.exception)

    def note_and_facts(self, points, **columns):
        return check_heights(cloud_of(points, **columns))

    def test_counts_and_largest_difference_are_those_of_a_plain_search(self):
        for _ in range(50):
            count = int(self.random.integers(1, 60))
            points = self.random.integers(-2, 3, (count, 3)) * (1.0, 1e-3, 0.5)
            points[self.random.random(count) < 0.3] *= -0.0  # -0 and 0 are the same place
            points[self.random.random(count) < 0.1, self.random.integers(3)] = numpy.nan
            places = {}
            for x, y, z in points[numpy.isfinite(points).all(axis=1)].tolist():
                places.setdefault((x, y), set()).add(z)
            spans = [max(z) - min(z) for z in places.values() if len(z) > 1]
            found = several_heights(points)
            if not spans:
                self.assertIsNone(found)
                continue
            self.assertEqual(found.count(), len(spans))
            self.assertEqual(found.largest(), max(spans))
            self.assertEqual(found.places, len(places))
            self.assertEqual(sorted(found.spans.tolist()), sorted(spans))

    def test_equal_points_are_plain_duplicates(self):
        points = with_z(NODES, waves(NODES))
        self.assertEqual(self.note_and_facts(numpy.concatenate((points, points))), (None, None))

    def test_a_few_are_a_note_with_numbers(self):
        points = with_z(NODES, 0.0)
        more = [(25.0, 50.0, 98.25), (25.0, 50.0, -1.5), (75.0, 0.0, 3.0)]
        note, facts = self.note_and_facts(numpy.concatenate((points, more)))
        self.assertEqual(
            note,
            "2 places have several heights, up to 99.75 apart: the first is taken "
            "(see --duplicates)",
        )
        self.assertEqual(facts, {"places": 2, "of": len(NODES), "largest": 99.75})

    def test_horizons_in_one_cloud_are_refused_in_any_order(self):
        points, _ = horizons(0, 410, 900, 1720)
        for some in (points, self.random.permutation(points)):
            words = self.refused(some)
            self.assertIn("576 of 576 places have several heights, up to 1720 apart", words)
            self.assertIn("no column separates them", words)

    def test_a_reverse_fault_is_refused(self):
        self.assertIn("96 of 576 places have several heights, up to 73.6 apart",
                      self.refused(reverse_fault()))

    def test_wells_with_many_depths_at_a_place_are_refused(self):
        self.assertIn("15 of 15 places", self.refused(wells(self.random)))

    def test_units_do_not_matter(self):
        for scale in ((1, 1, 1000), (1, 1, 0.001), (1e-5, 1e-5, 1), (1000, 1000, 1)):
            self.refused(reverse_fault() * scale)
            noisy = self.noise(5000, 40) * scale
            self.assertIsNotNone(self.note_and_facts(noisy)[0])

    def noise(self, count, side):
        xy = self.random.integers(0, side, (count, 2)).astype(float)
        return with_z(xy, self.random.normal(0, 0.1, count))

    def test_noise_at_rounded_places_is_a_note(self):
        for count, side in ((2000, 200), (5000, 100), (5000, 40), (5000, 20)):
            self.assertIsNotNone(self.note_and_facts(self.noise(count, side))[0])

    def test_steep_ground_at_rounded_places_is_a_note(self):
        xy = self.random.random((20000, 2)) * 1000
        z = 300 * numpy.sin(xy[:, 0] / 90) + 200 * numpy.cos(xy[:, 1] / 70)
        for step in (2.0, 7.0, 14.0):
            note, facts = self.note_and_facts(with_z(numpy.round(xy / step) * step, z))
            self.assertIsNotNone(note)
        self.assertGreater(facts["places"], 0.9 * facts["of"])

    def test_double_returns_below_one_in_a_hundred_places_are_a_note(self):
        ground = with_z(self.random.random((9000, 2)) * 300, 0.0)
        ground[:, 2] = waves(ground)
        for share, is_refused in ((0.008, False), (0.03, True)):
            trees = ground[: int(share * len(ground))] + (0, 0, 20)
            points = numpy.concatenate((ground, trees))
            first = numpy.repeat([1, 2], (len(ground), len(trees)))
            if is_refused:
                self.assertIn("column ReturnNumber separates them: 1 (9,000), 2 (270)",
                              self.refused(points, ReturnNumber=first))
            else:
                self.assertIsNotNone(self.note_and_facts(points, ReturnNumber=first)[0])

    def test_lines_that_cross_are_a_note_whatever_column_names_them(self):
        along = numpy.arange(0.0, 1000.0, 10.0)
        lines, names = [], []
        for i in range(8):
            flat = numpy.full(len(along), 125.0 * i // 10 * 10)
            for name, xy in ((f"E{i}", (along, flat)), (f"N{i}", (flat, along))):
                z = waves(numpy.column_stack(xy)) + self.random.normal(0, 3.0, len(along))
                lines.append(numpy.column_stack((*xy, z)))
                names += [name] * len(along)
        note, facts = self.note_and_facts(numpy.concatenate(lines), line=names)
        self.assertGreater(facts["places"], 50)
        self.assertIn("have several heights", note)

    def test_a_column_that_separates_heights_is_shown_with_its_values(self):
        points, number = horizons(0, 410, 900, 1720)
        order = self.random.permutation(len(points))
        names = numpy.array(["Top", "Chalk", "Base, lower", "Salt"])
        words = self.refused(points[order], Name=names[number[order]].tolist(),
                             measured=self.random.random(len(points)))
        self.assertIn("column Name separates them: Base, lower (576), Chalk (576), Salt", words)
        self.assertIn("--each-value Name makes a surface of each value", words)
        self.assertIn("--where 'Name=Base, lower' one of this", words)
        words = self.refused(points[order], **{"Horizon no": number[order] + 1})
        self.assertIn("column Horizon no separates them: 1 (576), 2 (576), 3 (576)", words)
        self.assertIn("--each-value 'Horizon no' makes", words)

    def test_columns_that_name_no_surfaces_are_not_shown(self):
        points = wells(self.random)
        count = len(points)
        of_well = numpy.repeat([f"W{i}" for i in range(15)], 20).tolist()
        for columns in (
            {"well": of_well},
            {"id": numpy.arange(count)},
            {"measured_depth": -points[:, 2] + self.random.random(count)},
            {"empty": numpy.full(count, numpy.nan)},
            {"same": numpy.ones(count)},
        ):
            self.assertIn("no column separates them", self.refused(points, **columns), columns)
        marker = numpy.tile(numpy.arange(20), 15)
        words = self.refused(points, well=of_well, marker=marker, id=numpy.arange(count))
        self.assertIn("column marker separates them: 0 (15), 1 (15)", words)
        self.assertIn(", and 10 more", words)

    def test_text_that_names_surfaces_is_enough_at_few_places(self):
        top, number = horizons(0, 300)
        far = with_z(NODES + (7.0, 11.0), waves(NODES) - 300.0)  # the second has other nodes
        points = numpy.concatenate((top[number == 0], far, top[number == 1][:4]))
        names = ["Top"] * len(NODES) + ["Base"] * (len(NODES) + 4)
        self.assertIn("4 of 1,152 places", self.refused(points, name=names))
        self.assertIsNotNone(self.note_and_facts(points)[0])
        self.assertIsNotNone(self.note_and_facts(points, number=[1.0 * (name == "Top") for name in names])[0])

    def test_values_that_lack_at_some_places_do_not_hide_the_column(self):
        points, number = horizons(0, 500)
        number = number.astype(float)
        number[::100] = numpy.nan
        self.assertIn("column n separates them: 0 (", self.refused(points, n=number))
        number[: len(NODES) : 3] = numpy.nan
        self.assertIn("no column separates", self.refused(points, n=number))


class InPython(unittest.TestCase):
    def test_surfaces_are_refused_and_a_policy_is_a_decision(self):
        points, _ = horizons(0, 500)
        words = "576 of 576 places.*--duplicates keep-highest"
        with self.assertRaisesRegex(ElevationSurfaceError, words):
            reconstruct(points)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result = reconstruct(points, duplicates="keep-highest")
        self.assertEqual(
            result.report["several_heights"], {"places": 576, "of": 576, "largest": 500.0}
        )
        self.assertIn("576 places have several heights, up to 500 apart: the highest is taken "
                      "(see --duplicates)", result.report["notes"])
        self.assertEqual(result.report["unused_reasons"], {"same x,y as another point": 576})

    def test_a_few_places_are_warned_of(self):
        points = numpy.vstack((with_z(NODES, 0.0), (0.0, 0.0, 5.0)))
        words = "1 place has several heights, up to 5 apart"
        with self.assertWarnsRegex(ElevationSurfaceWarning, words):
            result = reconstruct(points)
        self.assertNotIn("several_heights", reconstruct(points[:-1]).report)
        self.assertEqual(result.report["several_heights"]["places"], 1)

    def test_arrays_of_words_of_a_point_set_are_columns(self):
        points, number = horizons(0, 500)
        data = make_points(points)
        words = vtkStringArray()
        words.SetName("Horizon")
        for i in number:
            words.InsertNextValue(("Top", "Base")[i])
        data.GetPointData().AddArray(words)
        words = r"column Horizon .*: Base \(576\), Top \(576\)"
        with self.assertRaisesRegex(ElevationSurfaceError, words):
            reconstruct(data)


TABLE = 'Horizon name,X,Y,Z,line,amp\n' + "".join(
    f'"{name}",{x},{y},{z + x / 10:.2f},{line},{amp}\n'
    for name, z, line, amp in (
        ("Top, upper", 0, 1, "0.5"), ("Base", -500, 2, "nan"), ("", -900, 3, "1.5"),
    )
    for x in range(6) for y in range(5)
)


class Where(InFolder):
    def heights(self, content=TABLE, name="a.csv", **options):
        return sorted(set(numpy.round(coordinates(self.read(content, name, **options))[:, 2], 2)))

    def test_values_of_text_and_numbers_choose_points(self):
        top = [round(0.1 * x, 2) for x in range(6)]
        base = sorted(round(z - 500, 2) for z in top)
        for where in ("Horizon name=Top, upper", "horizon NAME = Top, upper", "line=1", "line=1.0",
                      {"line": 1}, {"Horizon name": "Top, upper"}, ["line=1", "amp=0.5"],
                      "amp=5e-1"):
            self.assertEqual(self.heights(where=where), top, where)
        for where in ("Horizon name=Base", "amp=", {"amp": [""]}):
            self.assertEqual(self.heights(where=where), base, where)
        self.assertEqual(self.heights(where={"line": [1, 2]}), base + top)
        self.assertEqual(len(self.heights(where="Horizon name=")), 6)
        cloud = self.read(TABLE, "a.csv", where="line=2")
        self.assertEqual(cloud.left_out, {"points of other values": 60})
        self.assertEqual(cloud.lines.tolist(), list(range(32, 62)))
        self.assertEqual(len(cloud.words["Horizon name"].codes), 30)

    def test_what_chooses_nothing_is_an_error_that_shows_the_values(self):
        for where, words in (
            ("Horizon name=Bas", "no point has Horizon name = Bas; did you mean Base?; values: "
                                 "Base (30), Top, upper (30)"),
            ("line=7", "no point has line = 7; values: 1 (30), 2 (30), 3 (30)"),
            ("line=one", "column line holds numbers, and 'one' is none; values: 1 (30)"),
            ("line=", "no point has line = nothing; values"),
            ("horizon=Top", "there is no column horizon besides x, y and z; did you mean "
                            "Horizon name?; columns: Horizon name, line, amp"),
            ("X=3", "there is no column X besides x, y and z"),
            (["line=1", "Horizon name=Base"], "no point is left by --where 'Horizon name=Base' and "
                                              "--where line=1 together"),
        ):
            self.assert_refused(words, TABLE, "a.csv", where=where)
        rows = "1 2 3\n4 5 6\n7 8 1\n"
        self.assert_refused("besides x, y and z; columns: none", rows, where="a=1")
        for wrong in ("line", "=3", ["line=1", "two"]):
            with self.assertRaisesRegex(ValueError, "where takes COLUMN=VALUE, as horizon=Top, n"):
                self.read(TABLE, "a.csv", where=wrong)

    def test_a_missing_value_among_others_is_a_note(self):
        cloud = self.read(TABLE, "a.csv", where={"line": [1, 9]})
        self.assertEqual(cloud.points.GetNumberOfPoints(), 30)
        self.assertIn("no point has line = 9; values: 1 (30), 2 (30), 3 (30)", cloud.notes)

    def test_columns_without_names_go_by_number(self):
        rows = "".join(f"{x} {y} {z} {name}\n" for name, z in (("Top", 5), ("Base", 9))
                       for x in range(5) for y in range(5))
        self.assertEqual(self.heights(rows, "a.txt", where="4=Top"), [5.0])
        self.assertEqual(self.heights(rows, "a.txt", where="column 4=Base"), [9.0])

    def test_more_words_than_surfaces_can_have_are_found_all_the_same(self):
        rows = "x,y,z,name\n" + "".join(f"{i % 50},{i // 50},{i},P{i}\n" for i in range(2500))
        self.assertEqual(self.heights(rows, where="name=P2222"), [2222.0])
        self.assertEqual(self.read(rows, "a.csv").words, {})

    def test_a_layer_of_text_is_the_name_in_a_column(self):
        self.assertEqual(len(self.heights(layer="Base")), 6)
        left_out = self.read(TABLE, "a.csv", layer="Base").left_out
        self.assertEqual(left_out, {"points of other layers": 60})
        words = "no column of text holds base; did you mean Base?; Horizon name: Base (30), Top, upper"
        self.assert_refused(words, TABLE, "a.csv", layer="base")
        self.assert_refused("there is no column of text", "1 2 3\n4 5 6\n7 8 1\n", layer="Top")
        rows = [f"A,{a},{b},{a * b},A" for a in range(4) for b in range(4)]
        two = "\n".join(["of,x,y,z,in", *rows])
        self.assert_refused("several columns hold A; choose --where of=A or --where in=A",
                            two, "b.csv", layer="A")

    def test_objects_of_gocad_have_names(self):
        objects = "".join(
            f"GOCAD VSet 1\nHEADER {{\n{head}\n}}\n"
            + "".join(f"VRTX {i} {i} {i * i} {z}\n" for i in range(1, 5)) + "END\n"
            for head, z in (("name: Top Chalk", 1), ('name:"Base"', 2))
        )
        self.assertEqual(self.heights(objects, "a.vs", where="name=Top Chalk"), [1.0])
        self.assertEqual(self.heights(objects, "a.vs", layer="Base"), [2.0])
        one_line = objects.replace("HEADER {\n", "HEADER {").replace("\n}\n", "}\n")
        self.assertEqual(self.heights(one_line, "a.vs", layer="Top Chalk"), [1.0])

    def test_attributes_of_vector_files_are_columns(self):
        features = [
            {"type": "Feature", "properties": {"horizon": name, "no": number},
             "geometry": {"type": "Point", "coordinates": [x, y, z]}}
            for name, number, z in (("Top", 1, 10.0), ("Base", 2, 20.0), (None, 3, 30.0))
            for x in range(3) for y in range(3)
        ]
        content = json.dumps({"type": "FeatureCollection", "features": features})
        for where, z in (("horizon=Top", 10.0), ("no=2", 20.0), ("horizon=", 30.0)):
            self.assertEqual(self.heights(content, "a.geojson", where=where), [z])

    def test_depth_and_nulls_are_of_the_points_that_are_chosen(self):
        rows = "x,y,z,n\n" + "".join(
            f"{x},{y},{-9999 if n == 1 and x == y == 3 else 10 * n},{n}\n"
            for n in (1, 2) for x in range(8) for y in range(8)
        )
        cloud = self.read(rows, "a.csv", where="n=1", depth=True)
        nulls = "null values (z = -9999)"
        self.assertEqual(cloud.left_out, {"points of other values": 64, nulls: 1})
        self.assertEqual(set(coordinates(cloud)[:, 2]), {-10.0})


class HeightsInProgram(Program):
    """Runs the program."""

    def run_of(self, *arguments, code=0):
        done = self.call(*arguments, "--no-picture")
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout if code == 0 else done.stderr

    def surface(self, name):
        with open(self.path(name), "rb") as stream:
            return stream.read()

    def table(self, name="h.csv"):
        points, number = horizons(0, 410, 900, 1720)
        names = ("Top, upper", "Chalk", "Base", "Salt")
        rows = "".join(
            f'{i},"{names[k]}",{x},{y},{z:.6f},{k}\n'
            for i, ((x, y, z), k) in enumerate(zip(points, number))
        )
        return self.file(name, "id,Horizon name,X,Y,Z,code\n" + rows)

    def test_each_value_makes_what_where_makes(self):
        name = self.table()
        error = self.run_of(name, code=1)
        self.assertIn("h.csv: 576 of 576 places have several heights, up to 1720 apart", error)
        self.assertIn("--each-value 'Horizon name' makes a surface of each value", error)
        self.assertEqual(os.listdir(self.folder), [name])
        shown = self.run_of(name, "--each-value", "horizon NAME", "--report")
        self.assertIn("h.csv, Horizon name = Top, upper\n", shown)
        files = {value: f"h_{value}" for value in ("Chalk", "Base", "Salt")}
        files["Top, upper"] = "h_Top_upper"
        expected = [f"{stem}_surface.{end}" for stem in files.values() for end in ("vtp", "json")]
        self.assertEqual(set(os.listdir(self.folder)), {name, *expected})
        for value, stem in files.items():
            self.run_of(name, "--where", f"Horizon name={value}", "-o", "one.vtp")
            self.assertEqual(self.surface("one.vtp"), self.surface(f"{stem}_surface.vtp"))
            report = self.json(f"{stem}_surface.json")
            self.assertEqual(report["options"]["where"], [["Horizon name", value]])
            self.assertNotIn("several_heights", report)

    def test_standard_input_is_read_once_for_all_values(self):
        program = f"{sys.executable} -m vtkelevationsurface - --each-value code --no-picture"
        done = self.execute("sh", "-c", f"{program} <{self.table()}")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(sorted(os.listdir(self.folder))[1:],
                         [f"points_{code}_surface.vtp" for code in range(4)])

    def test_points_without_a_value_are_noted_and_in_no_surface(self):
        rows = "".join(f"{x},{y},{n},{n if x < 5 else ''}\n" for n in (1, 2) for x in range(6)
                       for y in range(6))
        shown = self.run_of(self.file("a.csv", "x,y,z,n\n" + rows), "--each-value", "n")
        self.assertEqual(shown.count("12 points have no n: of no surface"), 2)
        self.assertIn("30 read; 42 points of other values left out", shown)

    def test_values_that_make_no_surfaces_are_refused_before_any_is_made(self):
        many = "x,y,z,d\n" + "".join(f"{i % 40},{i // 40},{i % 7},{i + 0.5}\n" for i in range(1600))
        many = self.file("many.csv", many)
        words = "".join(f"{i % 9},{i // 9},1,{('a_b', 'a b')[i % 2]}\n" for i in range(81))
        words = self.file("words.csv", "x,y,z,w\n" + words)
        for code, expected, arguments in (
            (1, "many.csv: column d has 1,600 values, and --each-value makes a surface of each, at "
                "most 1,000", (many, "--each-value", "d")),
            (1, "many.csv: there is no column depth besides x, y and z; columns: d",
             (many, "--each-value", "depth")),
            (2, "--each-value would write words_a_b_surface.vtp twice; 'a b' is one of the values",
             (words, "--each-value", "w")),
            (2, "--each-value names the results of each value itself: leave out the names of "
                "results", (many, "--each-value", "d", "-o", "a.vtp")),
            (2, "--each-value takes a column", (many, "--each-value")),
            (2, "--each-value needs all points in memory: in pieces, --where COLUMN=VALUE takes one "
                "value", (many, "--each-value", "d", "--pieces", "2", "--no-trim", "--no-fill")),
            (2, "--where takes COLUMN=VALUE, as horizon=Top, not 'Top'", (many, "--where", "Top")),
            (1, "many.csv: no point has d = 7; values: 0.5 (1), 1.5 (1)", (many, "--where", "d=7")),
        ):
            with self.subTest(arguments=arguments):
                error = self.run_of(*arguments, code=code)
                self.assertIn(expected, error)
                self.assertEqual(len(error.splitlines()), 1)
        self.assertEqual(sorted(os.listdir(self.folder)), [many, words])

    def test_a_value_without_a_surface_does_not_stop_the_others(self):
        rows = "".join(f"{x},{y},1,1\n" for x in range(5) for y in range(5))
        name = self.file("a.csv", f"x,y,z,n\n{rows}9,9,9,2\n")
        error = self.run_of(name, "--each-value", "n", code=1)
        self.assertIn("a.csv, n = 2: no surface: there is only one point", error)
        self.assertIn("a_1_surface.vtp", os.listdir(self.folder))

    def test_files_that_are_each_a_surface_are_reported(self):
        names = [
            self.file(f"{name}.xyz", "".join(f"{x} {y} {-depth}\n" for x, y in NODES))
            for name, depth in (("top", 0), ("base", 500))
        ]
        error = self.run_of(*names, code=1)
        self.assertIn("top.xyz + base.xyz: 576 of 576 places", error)
        self.assertIn("the files separate them: --each makes a surface of each", error)
        self.run_of(*names, "--each")

    def test_files_without_the_value_are_noted(self):
        for name, value in (("a.csv", "Top"), ("b.csv", "Base")):
            rows = "".join(f"{x},{y},1,{value}\n" for x in range(5) for y in range(5))
            self.file(name, "x,y,z,name\n" + rows)
        shown = self.run_of("a.csv", "b.csv", "--where", "name=Top", "-o", "s.vtp")
        self.assertIn("b.csv: --where leaves no point", shown)
        self.assertIn("25 read", shown)
        self.assertIn("a.csv: no point has name = Salt",
                      self.run_of("a.csv", "b.csv", "--where", "name=Salt", code=1))

    def test_a_policy_makes_one_surface_with_a_note(self):
        shown = self.run_of(self.table(), "--duplicates", "keep-highest", "--report", "r.json")
        self.assertIn("note       576 places have several heights, up to 1720 apart: the highest is "
                      "taken (see --duplicates)", shown)
        report = self.json("r.json")
        self.assertEqual(report["several_heights"]["places"], 576)
        self.assertLess(abs(report["several_heights"]["largest"] - 1720), 1e-5)

    def test_in_pieces_heights_are_counted_as_in_memory(self):
        random = numpy.random.default_rng(7)
        points = random.random((4000, 3)) * (100, 80, 30)
        points[:, 2] += points[:, 0]
        some = points[random.integers(0, 4000, 30)]
        more = (some + (0, 0, 9), some[:9], some[:5] - (0, 0, 4))
        points = random.permutation(numpy.concatenate((points, *more)))
        numpy.save(self.path("a.npy"), points)
        ways, found = ("--no-trim", "--no-fill", "--report", "r.json"), []
        for way in ((), ("--pieces", "1"), ("--pieces", "7")):
            shown = self.run_of("a.npy", *ways, *way)
            found.append(self.json("r.json")["several_heights"])
            self.assertIn("places have several heights, up to 13 apart: the first is taken", shown)
        self.assertEqual(found, 3 * found[:1])
        self.assertEqual(found[0]["of"], 4000)

    def test_in_pieces_surfaces_are_refused_and_one_is_chosen(self):
        name = self.table()
        ways = ("--no-trim", "--no-fill", "--pieces", "3")
        error = self.run_of(name, *ways, code=1)
        self.assertIn("576 of 576 places have several heights, up to 1720 apart", error)
        self.assertIn("a run in pieces looks at no columns", error)
        self.assertEqual(os.listdir(self.folder), [name])
        self.assertIn("576 read; 1,728 points of other values left out",
                      self.run_of(name, *ways, "--where", "Horizon name=Base"))
        error = self.run_of(name, *ways, "--where", "code=9", code=1)
        self.assertIn("no point has code = 9", error)
        error = self.run_of(name, *ways, "--layer", "Base", code=1)
        self.assertIn("h.csv: --layer of a text table needs all points in memory: in pieces, "
                      "--where COLUMN=Base takes", error)
        self.run_of(name, *ways, "--duplicates", "keep-last")


# ---- meshes -------------------------------------------------------------------------------------


def sheet(shape, side=30):
    """(points, triangles) of shape(u, v), two numbers from 0 to 1."""
    v, u = numpy.meshgrid(*[numpy.linspace(0.0, 1.0, side)] * 2, indexing="ij")
    ids = numpy.arange(side * side).reshape(side, side)
    a, b, c, d = (
        ids[row : row + side - 1, column : column + side - 1].ravel()
        for row, column in ((0, 0), (0, 1), (1, 1), (1, 0))
    )
    triangles = numpy.concatenate((numpy.stack((a, b, c), 1), numpy.stack((a, c, d), 1)))
    return numpy.stack([axis.ravel() for axis in shape(u, v)], -1), triangles


FLAT = sheet(lambda u, v: (100 * u, 100 * v, 9 * numpy.cos(9 * u)))
FOLD = sheet(lambda u, v: (100 * (u + 0.4 * numpy.sin(9 * u)), 100 * v, 30 * numpy.cos(9 * u)))
BALL = sheet(lambda u, v: (
    50 * numpy.cos(2 * math.pi * u) * numpy.sin(math.pi * v),
    50 * numpy.sin(2 * math.pi * u) * numpy.sin(math.pi * v), 50 * numpy.cos(math.pi * v)))
WALL = sheet(lambda u, v: (100 * u, 0 * v, 100 * v))


def mesh_of(points, triangles):
    data = make_points(points)
    data.SetPolys(cells_of(triangles))
    return data


class Meshes(InFolder):
    def shares(self, points, triangles):
        """The numbers in the note or error."""
        try:
            return notes_on_faces(mesh_of(points, triangles))
        except ElevationSurfaceError as error:
            return str(error)

    def test_the_share_is_that_of_the_faces_that_face_down(self):
        points, triangles = FOLD
        # As x = 100 (u + 0.4 sin 9u): a column of faces faces down where x falls.
        x = points[:30, 0]
        down = 2 * 29 * int(numpy.count_nonzero(numpy.diff(x) < 0))
        words = self.shares(points, triangles)
        self.assertIn(f"is not an elevation surface: of 1,682 faces, {down:,} face down where others "
                      f"face up ({100 * down / 1682:.0f} %)", words)
        flipped = triangles.copy()
        some = numpy.random.default_rng(3).random(len(triangles)) < 0.5
        flipped[some] = flipped[some][:, ::-1]
        soup = points[flipped].reshape(-1, 3), numpy.arange(flipped.size).reshape(-1, 3)
        for other in ((points, triangles[:, ::-1]), (points, flipped), soup):
            self.assertEqual(self.shares(*other), words)

    def test_the_order_of_corners_does_not_matter(self):
        points, triangles = FLAT
        some = numpy.random.default_rng(3).random(len(triangles)) < 0.3
        mixed = triangles.copy()
        mixed[some] = mixed[some][:, ::-1]
        two = numpy.concatenate((triangles, triangles[:, ::-1] + len(points)))
        for case in ((points, triangles), (points, triangles[:, ::-1]), (points, mixed),
                     (numpy.concatenate((points, points + (200, 0, 0))), two)):
            self.assertEqual(self.shares(*case), [])

    def test_closed_and_vertical_meshes_are_refused(self):
        for case in (BALL, WALL):
            words = "so it is closed, or folds; split it into parts that do not"
            self.assertIn(words, self.shares(*case))
        self.assertIn("1,682 are vertical (100 %)", self.shares(*WALL))

    def test_a_few_faces_are_a_note(self):
        points, triangles = FLAT
        points = points.copy()
        points[15 * 30 + 15, 0] += 5.0
        (note,) = self.shares(points, triangles)
        words = "^of 1,682 faces, [2-6] face down where others face up: the mesh folds there"
        self.assertRegex(note, words)

    def written(self, name, case):
        path = self.path(name)
        writing.write_surface(mesh_of(*case), path)
        return path

    def test_every_format_of_meshes_is_looked_at(self):
        for suffix in (".vtp", ".vtu", ".ply", ".stl", ".obj", ".ts"):
            with self.subTest(suffix=suffix):
                good = self.written("flat" + suffix, FLAT)
                self.assertFalse([note for note in reading.read(good).notes if "face" in note])
                bad = self.written("ball" + suffix, FOLD)
                with self.assertRaises(FileError) as caught:
                    reading.read(bad)
                words = r"^\S+: is not an elevation surface: of 1,682 faces, .* or --points-only takes its "
                self.assertRegex(str(caught.exception), words + "points as they are$")
                cloud = reading.read(bad, points_only=True)
                self.assertEqual(cloud.points.GetNumberOfPoints(), len(FOLD[0]))

    def test_objects_of_gocad_are_looked_at_one_by_one(self):
        texts = []
        for name, case in (("Fold", FOLD), ("Flat", FLAT)):
            with open(self.written(name + ".ts", case), encoding="utf-8") as stream:
                texts.append(stream.read())
        words = "a.ts, Fold: is not an elevation surface: of 1,682 faces"
        self.assert_refused(words, "".join(texts), "a.ts")
        for options in ({"where": "name=Flat"}, {"layer": "Flat"}):
            cloud = self.read("".join(texts), "a.ts", **options)
            self.assertEqual(cloud.points.GetNumberOfPoints(), len(FLAT[0]))
        self.assert_refused("a.ts, Fold: is no", "".join(texts), "a.ts", layer="Fold")

    def test_texts_of_large_coordinates_are_looked_at_as_they_are(self):
        points, triangles = FLAT
        x, y, z = 0.05 * points.T  # a float in the north is in steps of 0.5
        points = numpy.column_stack((0.8 * x - 0.6 * y + 5e5, 0.6 * x + 0.8 * y + 6e6, z))
        stl = "solid a\n" + "".join(
            "facet normal 0 0 1\nouter loop\n"
            + "".join(f"vertex {x:.4f} {y:.4f} {z:.4f}\n" for x, y, z in points[corners])
            + "endloop\nendfacet\n" for corners in triangles
        ) + "endsolid a\n"
        obj = "".join(f"v {x:.4f} {y:.4f} {z:.4f}\n" for x, y, z in points)
        obj += "".join(f"f {a} {b} {c}\n" for a, b, c in triangles + 1)
        for name, content in (("a.stl", stl), ("a.obj", obj)):
            notes = self.read(content, name).notes
            self.assertFalse([note for note in notes if "vertical" in note or "face down" in note])

    def test_faces_of_faults_and_boundaries_may_stand_upright(self):
        for suffix in (".ply", ".ts", ".vtp"):
            path = self.written("wall" + suffix, WALL)
            self.assertEqual(reading.read_faults(path).GetNumberOfPolys(), 1682)

    def test_reconstruct_looks_at_the_faces_of_a_mesh(self):
        words = "points: the mesh is not an elevation surface: of 1,682 faces.* or give its points alone"
        with self.assertRaisesRegex(ElevationSurfaceError, words):
            reconstruct(mesh_of(*FOLD))
        self.assertEqual(reconstruct(mesh_of(*FLAT)).surface.GetNumberOfPolys(), 1682)


class MeshesInProgram(Program):
    def test_a_folded_mesh_is_refused_and_its_points_can_be_taken(self):
        writing.write_surface(mesh_of(*FOLD), self.path("a.ts"))
        done = self.call("a.ts", "--no-picture")
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1))
        self.assertIn("a.ts: is not an elevation surface", done.stderr)
        done = self.call("a.ts", "--no-picture", "--points-only")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("only the points are used", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

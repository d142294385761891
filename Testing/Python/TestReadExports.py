# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The text exports that people have: names in nine languages, and tables without names."""

import configparser
import os
import re
import subprocess
import sys
import unittest
from unittest import mock

from text_tables import COUNT, Tables, columns_of
from vtkelevationsurface.reading import tables
from vtkelevationsurface.reading.column_names import meaning, plain

# Program, head of the file, separator, what the columns hold, words of the notes.
EXPORTS = (
    ("Petrel, lines", "# Type: scattered data\n# Field: 1 x\n# Field: 2 y\n# Field: 3 z meters\n"
     "# Field: 4 column\n# Field: 5 row\n# End:\n", " ", "gx gy down xl il", "x = 1 (x)"),
    ("OpendTect, one line", '#"Inline"\t"Crossline"\t"X"\t"Y"\t"Z (ms)"\n', "\t",
     "il xl gx gy time", "z = 5"),
    ("OpendTect, many lines",
     "# 1: Inline\n# 2: Crossline\n# 3: X\n# 4: Y\n# 5: Z(ms)\n# - - - - - -\n", "\t",
     "il xl gx gy time", "z = 5"),
    ("Kingdom", "Line Trace X Y Time\n", " ", "line trace x y time", "upside down"),
    ("Kingdom, 3D", "Inline,Xline,X Coord,Y Coord,TWT (ms)\n", ",", "il xl gx gy time", "times"),
    ("GeoFrame", "! CDP_X CDP_Y SHOTPOINT LINE TWT\n", " ", "x y trace line time", "TWT"),
    ("DecisionSpace", "X_UTM,Y_UTM,Z_TWT,Amplitude\n", ",", "x y time amp", "z = 3 (Z_TWT)"),
    ("well tops", "Well;Surface;X [m];Y [m];TVDSS [m]\n", ";", "code code x y down", "z = 5"),
    ("total station, Leica", "Point Id,Easting,Northing,Ortho. Height,Code\n", ",",
     "id x y z code", "x = 2 (Easting)"),
    ("total station, Trimble", "Point,Northing,Easting,Elevation,Code\n", ",", "id y x z code",
     "y = 2 (Northing)"),
    ("Topcon", "Name\tN\tE\tH\tCode\n", "\t", "id y x z code", "x = 3 (E)"),
    ("Carlson", "P,N,E,Z,D\n", ",", "id y x z code", "z = 4"),
    ("GNSS, degrees", "Name,Latitude,Longitude,Ellipsoidal height\n", ",", "id lat lon z",
     "look like degrees"),
    ("GNSS, with time", "date,gps_time,lat,lon,alt,hdop\n", ",", "date gps lat lon z sd", "alt"),
    ("German", "Punktnr;Rechtswert;Hochwert;Hoehe\n", ";", "id x y z", "Rechtswert"),
    ("German, new names", "PunktNr;Ostwert [m];Nordwert [m];Höhe über NHN [m];Bemerkung\n", ";",
     "id x y z code", "Ostwert"),
    ("German, degrees", "Nr;Breite;Länge;Tiefe\n", ";", "id lat lon depth", "depths"),
    ("German, Gauss-Krueger", "Pkt Y X H\n", " ", "id y x z", "Y stands before X"),
    ("French", "id;abscisse;ordonnee;altitude\n", ";", "id x y z", "abscisse"),
    ("French, accents", "Matricule;Coordonnée X;Coordonnée Y;Altitude NGF\n", ";", "id x y z",
     "NGF"),
    ("French, soundings", "Latitude;Longitude;Profondeur (m)\n", ";", "lat lon depth", "depths"),
    ("Spanish", "Punto,Este,Norte,Cota\n", ",", "id x y z", "Este"),
    ("Spanish, accents", "Nombre;Norte;Este;Elevación;Descripción\n", ";", "id y x z code",
     "Norte"),
    ("Portuguese", "Ponto;Leste;Norte;Cota\n", ";", "id x y z", "Leste"),
    ("Portuguese, accents", "Nº;Coordenada E;Coordenada N;Elevação;Código\n", ";", "id x y z code",
     "Coordenada"),
    ("Norwegian", "Punkt;Nord;Øst;Høyde\n", ";", "id y x z", "Nord"),
    ("Norwegian, without letters", "Punktnummer Oest Nord Hoeyde Kode\n", " ", "id x y z code",
     "Oest"),
    ("Norwegian, axes", "Nr;X (Nord);Y (Øst);Z\n", ";", "id y x z", "x = 3"),
    ("Norwegian, soundings", "Dato;Breddegrad;Lengdegrad;Dybde\n", ";", "date lat lon depth",
     "Dybde"),
    ("Italian", "Punto;Est;Nord;Quota\n", ";", "id x y z", "Quota"),
    ("Italian, soundings", "Latitudine;Longitudine;Profondità\n", ";", "lat lon depth", "depths"),
    ("Dutch", "Puntnummer;X-coördinaat;Y-coördinaat;Hoogte (m NAP)\n", ";", "id x y z", "Hoogte"),
    ("Dutch, soundings", "Noord;Oost;Diepte\n", ";", "y x depth", "Diepte"),
    ("Polish", "Numer;Współrzędna X;Współrzędna Y;Wysokość\n", ";", "id x y z", "Wysoko"),
    ("Polish, degrees", "Nazwa;Szerokość geograficzna;Długość geograficzna;Głębokość\n", ";",
     "id lat lon depth", "depths"),
    ("Finnish", "Piste;P;I;Korkeus\n", ";", "id y x z", "y = 2 (P)"),
    ("Czech", "č.b.;Y;X;výška\n", ";", "id y x z", "z = 4 (výška)"),
    ("CloudCompare", "//X Y Z R G B Scalar_field\n", " ", "x y z r g b amp", "z = 3"),
    ("CloudCompare, with a count", f"{COUNT}\n", " ", "x y z r g b", "first 3 of 6"),
    ("Leica .pts", f"{COUNT}\n", " ", "x y z int r g b", "first 3 of 7"),
    ("LAStools", "X,Y,Z,intensity,return_number,classification,gps_time\n", ",",
     "x y z int class class gps", "z = 3"),
    ("PDAL", '"X","Y","Z","Intensity","Red","Green","Blue"\n', ",", "x y z int r g b", "z = 3"),
    ("QGIS", "fid,X,Y,ELEV_M,layer\n", ",", "id x y z code", "ELEV_M"),
    ("ArcGIS", "OBJECTID,POINT_X,POINT_Y,POINT_Z\n", ",", "id x y z", "POINT_X"),
    ("ArcGIS, with degrees", "OID,Lat,Lon,UTM_E,UTM_N,Elevation_ft\n", ",", "id lat lon x y z",
     "UTM_E"),
    ("R", '"x" "y" "z"\n', " ", "id x y z", "x = 2"),
    ("pandas", ",easting,northing,height\n", ",", "id x y z", "easting"),
    ("Qimera", "Easting (m) Northing (m) Depth (m) StdDev\n", " ", "x y depth sd", "depths"),
    ("Hypack", "X,Y,Raw Depth,Corrected depth,Date\n", ",", "", "may all be z"),
    ("GMT", "# lon lat z\n> segment\n", "\t", "lon lat z", "degrees"),
)
# The same without any names.
BARE = (
    ("x y z", " ", "x y z", ""),
    ("id x y z", " ", "id x y z", "column 1 is an id"),
    ("id x y z, local", ",", "id nx ny z", "column 1 is an id"),
    ("P,N,E,Z,code of UTM", ",", "id y x z code", "column 2 is taken as northing"),
    ("P,E,N,Z,code of UTM", ",", "id x y z code", "x = 2, y = 3, z = 4"),
    ("inline crossline x y z", " ", "il xl gx gy time", "line, trace or place in a grid"),
    ("line trace x y time", " ", "line trace x y time", "x = 3, y = 4, z = 5"),
    ("x y z inline crossline", " ", "gx gy time il xl", "first 3 of 5"),
    ("x y z class", " ", "x y z class", "first 3 of 4"),
    ("class x y z", " ", "class x y z", "column 1 is a class"),
    ("x y z intensity", " ", "x y z int", "first 3 of 4"),
    ("x y z r g b", " ", "x y z r g b", "first 3 of 6"),
    ("time x y z", " ", "gps x y z", "x = 2, y = 3, z = 4"),
    ("x y z amplitude", " ", "x y z amp", "first 3 of 4"),
    ("code x y z", ",", "code x y z", "x = 2"),
)
# Names of columns, apart by bars, and what they mean.
NAMES = (
    ("x", "X|X_UTM|UTM_X|utmx|XCoord|xcoordinate|X-Koordinate|Coord.X|POINT_X|X (m)|x_m|CDP_X|"
     "Eastings|E|E_UTM32|UTM32 E|Ostwert|RW|Est|Este|Leste|\u00d8st|Koordinat_\u00d8|Oost|Lon|LON_DD|"
     "longitude_deg|L\u00e4nge|Lengdegrad|Lengtegraad|X (East)|Y (\u00d8st)|Y (Rechtswert)|X L93|"
     "Coordenada Este|Grid East|Longitude_E|Wsp\u00f3\u0142rz\u0119dna X"),
    ("y", "Y|Northing|NORTHING_FT|N|N_UTM|Hochwert|Nord|Norte|Noord|Ordonn\u00e9e|Lat|Breite|"
     "Breddegrad|Szeroko\u015b\u0107|X (Nord)|X (Hochwert)|Latitude_N"),
    ("z", "Z|Z_TWT|Elevation|Elev.|Elev_ft|H\u00f6he|Hoehe|H_NN2000|H\u00f8yde|Hoogte|Altitude (m)|"
     "Altura|Cota|Cote|Quota s.l.m.|Wysoko\u015b\u0107|Rz\u0119dna|DEPTH_M|Tiefe|Dybde|TVDSS|TWT (ms)|"
     "Ellip_Height|Ortho. Height|Reduced Level|WaterDepth|Seabed_Z|NAP|Meeresh\u00f6he"),
    ("", "nx|NormalX|dx|StdDev_Z|sigma_h|error_z|z_error|rms_xy|Number|Zone|Layer|Note|Vx|East_Vel|"
     "Elevation_error|GPSTime|UTC_time|Date|Temp|Amplitude|Class|Return_Number|PointSourceID|Red|"
     "Intensity|Well|Line_Name|Trace_Number|CDP|SP|Inline|XL|Offset|Slope|PDOP|N_geoid|Rod Height|"
     "Antenna_height|Horizon|UserData|ScanAngleRank|Sample (Height)"),
)

# Sections of tables.ini whose entries are not asked for by name.
TAKEN_AS_THEY_ARE = ("axes", "roles", "units of length", "letters", "x is north", "separators", "not tables",
                      "not numbers")


class Names(unittest.TestCase):
    def test_names_mean_what_they_mean_in_their_language(self):
        for axis, names in NAMES:
            for name in names.split("|"):
                for written in (name, name.upper(), name.lower()):
                    if written == name or axis and not re.search("[a-z][A-Z]", name):
                        with self.subTest(written):
                            self.assertEqual(meaning(written).axis, axis)


class Exports(Tables):
    def check(self, what, head, separator, kinds, words):
        if not kinds:
            text = head + "".join("1,2,3,4,5\n4,5,7,8,9\n8,8,8,8,8\n")
            self.assertIn(words, self.refusal(text))
            return
        rows, expected = columns_of(kinds)
        if what == "R":
            rows = [[f'"{row[0]}"', *row[1:]] for row in rows]
        text = head + "".join(separator.join(row) + "\n" for row in rows)
        encodings = ["utf-8"] + ["latin-1"] * all(ord(letter) < 256 for letter in text)
        for encoding in encodings:
            cloud = self.read(text.encode(encoding))
            self.assert_rows(cloud, expected)
            self.assertIn(words, " | ".join(cloud.notes))
        if separator == ";":
            cloud = self.read(head + text[len(head):].replace(".", ","))
            self.assert_rows(cloud, expected)

    def test_real_exports_of_nine_languages_are_read_as_they_are_meant(self):
        for what, *case in EXPORTS:
            with self.subTest(what):
                self.check(what, *case)

    def test_columns_without_names_are_recognised_by_their_values(self):
        for what, *case in BARE:
            with self.subTest(what):
                self.check(what, "", *case)

    def test_names_that_say_nothing_leave_it_to_the_values(self):
        for what, separator, kinds, words in BARE[1:4]:
            with self.subTest(what):
                width = len(kinds.split())
                head = separator.join(f"f{i}" for i in "abcdefg"[:width]) + "\n"
                self.check(what, head, separator, kinds, words.split(" is ")[0])

    def test_every_kind_is_found_without_a_header_in_few_rows(self):
        text = "1,5000.25,7000.5,12.1\n2,5003.75,7001.25,12.4\n3,5001.5,7004.75,12.9\n"
        self.assert_rows(
            self.read(text),
            [(5000.25, 7000.5, 12.1), (5003.75, 7001.25, 12.4), (5001.5, 7004.75, 12.9)],
        )


class Known(Tables):
    """tables.ini."""

    def test_a_word_has_one_meaning_and_is_written_as_names_are_compared(self):
        parser = configparser.ConfigParser(interpolation=None, delimiters="=")
        parser.optionxform = str
        path = os.path.join(os.path.dirname(tables.__file__), "tables.ini")
        parser.read(path, encoding="utf-8")
        for section in ("axes", "roles", "colours", "units of length"):
            words = " ".join(parser[section].values()).split()
            self.assertEqual(sorted(set(words)), sorted(words), section)
            self.assertEqual([word for word in words if "".join(plain(word)) != word], [], section)

    def test_names_in_lines_of_their_own_are_those_of_gslib(self):
        notes = self.read("x y grade\n3\na\nb\nc\n1.5 2.5 3.5\n4.5 5.5 6.5\n").notes
        self.assertIn("x = 1 (a), y = 2 (b), z = 3 (c)", " ".join(notes))

    def test_it_is_not_read_before_a_table_is(self):
        code = ("import vtkelevationsurface.command, vtkelevationsurface.reading.tables as tables;"
                "print(tables.known.cache_info().currsize)")
        self.assertEqual(subprocess.check_output([sys.executable, "-c", code]).split(), [b"0"])

    def refusal_with(self, content):
        """The error where content, or nothing, stands in place of the file."""
        path = self.file("tables.ini", content) if content is not None else self.path("tables.ini")
        self.addCleanup(tables.known.cache_clear)
        tables.known.cache_clear()
        with mock.patch.object(tables, "TABLES", path):
            error = self.refusal("x y z\n1 2 3\n")
        self.assertTrue(error.startswith(path) and error.endswith("; install the package again"), error)
        return error

    def test_where_it_lacks_or_is_damaged_an_error_names_it(self):
        with open(tables.TABLES, encoding="utf-8") as stream:
            text = stream.read()
        for damaged, words in (
            (None, "No such file"), ("", "it has no 'other words'"), (b"\xff\xfe", "can't decode"),
            (text[: text.index("[nulls]")], "it has no 'nulls'"), (text.replace("[nulls]", "[nulls"), "parsing errors"),
            (text.replace("\ndate = ", "\ndate = ("), "missing )"), (text.replace("-9999", "nine", 1), "'nine'"),
        ):
            self.assertIn(words, self.refusal_with(damaged))
        for entry, other, words in (
            ("encodings = latin-1 ", "encodings = latin-9000 ", "unknown encoding"),
            ("figures = 6378137 ", "figures = ", "[earth] figures needs 4"),
            ("month = 1 12 ", "month = 1 ", "[parts of time] month needs 3"),
            ("    hour, minute, second", "    hour, tick", "it has no 'tick'"),
            ("figures = 6378137 6356752.3 0.003 1e4", "figures =", "[earth] figures is empty"),
            ("red = red r rot rouge", "red =", "[colours] red is empty"),
            ("numbered name = (?i)(?:field|column|col)?\\W*(", "numbered name = (?:", "numbered name needs 2 groups"),
        ):
            self.assertIn(entry, text)
            self.assertIn(words, self.refusal_with(text.replace(entry, other, 1)))

    def test_an_entry_that_is_asked_for_by_name_and_lacks_is_named_with_its_section(self):
        with open(tables.TABLES, encoding="utf-8") as stream:
            lines = stream.read().split("\n")
        section, count = "", 0
        for at, line in enumerate(lines):
            section = line.strip("[]") if line.startswith("[") else section
            if section in TAKEN_AS_THEY_ARE or not re.match(r"[^;\[\s]", line):
                continue
            behind = at + 1
            while lines[behind].startswith(" "):
                behind += 1
            error = self.refusal_with("\n".join(lines[:at] + lines[behind:]))
            self.assertIn(f"[{section}] has no {line.partition(' =')[0]};", error)
            count += 1
        self.assertGreater(count, 50)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

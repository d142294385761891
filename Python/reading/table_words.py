# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What is known of tables: the words and signs by which columns, nulls and layouts are
recognised, and what speaks for a reading of columns. Nothing here does anything."""

import re


def _words(text):
    return frozenset(text.split())


# Names of English, German, French, Spanish, Portuguese, Norwegian, Italian, Dutch and Polish, some
# of Finnish, Czech, Croatian, Hungarian, Turkish, Indonesian, Russian, Ukrainian, Chinese, Japanese
# and Korean, as plain() writes them: (axis, rank, direction, names). A lower rank is the better name.
AXES = (
    ("x", 0, "", _words("x х")),  # the second letters of x, y and h are Cyrillic
    ("y", 0, "", _words("y у")),
    ("z", 0, "", _words("z")),
    ("x", 1, "", _words(
        "easting eastings east rechtswert rechts rw ostwert ost oest este leste est abscisse "
        "abscissa abscisa absis oost oosting ostkoordinate wschod wschodnia ostkoordinat "
        "oestkoordinat ostverdi eastcoordinate coordeste oosten rechtsw oestverdi "
        "ita itakoordinaatti восток восточная 東 东 東座標 东坐标 東坐標 横坐标 橫坐標 동"
    )),
    ("y", 1, "", _words(
        "northing northings north nrth hochwert hoch hw nordwert nord norte ordonnee ordenada ordinata "
        "ordinate noord noording nordkoordinate polnoc polnocna nordkoordinat nordverdi noorden "
        "hochw pohjoinen pohjoiskoordinaatti север северная 北 北座標 北坐标 北坐標 纵坐标 縱坐標 북"
    )),
    ("z", 1, "", _words(
        "elevation elevations elev elevacion elevacao elevazione height heights hgt ht hoehe hohe "
        "gelaendehoehe gelandehohe altitude alt altitud altura altezza cota cote quota kote hoyde "
        "hoeyde hoogte wysokosc rzedna topography level niveau rl orthoheight ellipheight "
        "gelaende gelande terrenghoyde terrenghoeyde moh maaiveld maaiveldhoogte bodemhoogte "
        "hoogteligging wys rzednaterenu pnm quotaslm altimetria altimetrie topo grundhoehe "
        "bodenhoehe bodenhohe gok gokhoehe meereshohe meereshoehe hojde hoejde hoeydekote hae msl "
        "nap nhn amsl korkeus vyska visina magassag yukseklik kot rakim ketinggian elevasi высота высоты "
        "отметка висота відмітка 標高 標高値 高さ 地盤高 楕円体高 海抜 标高 高程 高度 海拔 海拔高度 海拔高 大地高 正常高 "
        "표고 고도 높이 해발고도 지반고"
    )),
    ("x", 2, "", _words("e oe")),
    ("y", 2, "", _words("n")),
    ("z", 2, "", _words("h н")),
    ("z", 2, "depth", _words(
        "depth depths tiefe profondeur prof profundidad profundidade profondita dybde diepte "
        "glebokosc tvd tvdss sounding soundings sonde bathymetry bathymetrie tvdm wassertiefe "
        "meerestiefe wasserstiefe bunndybde havdybde vanndybde waterdiepte bodemdiepte profund "
        "waterdepth seabeddepth dubina syvyys melyseg derinlik kedalaman глубина глибина 水深 深度 深さ 수심"
    )),
    ("z", 2, "time", _words("twt owt twtt laufzeit")),
    ("x", 3, "", _words(
        "lon long longitude lng laenge lange laengengrad langengrad longitud lengdegrad lengde "
        "lengtegraad longitudine dlugosc lonx longitudeddeg laengde duzina boylam bujur hosszusag "
        "pituusaste долгота довгота 経度 经度 經度 경도"
    )),
    ("y", 3, "", _words(
        "lat latitude breite breitengrad latitud breddegrad bredde breedtegraad latitudine "
        "szerokosc laty sirina enlem lintang szelesseg leveysaste широта 緯度 纬度 위도"
    )),
    ("z", 4, "time", _words("time zeit temps tiempo tempo tid tijd czas")),
)
AXIS_NAMES = {name: (axis, rank, direction) for axis, rank, direction, names in AXES for name in names}
# Words that may stand next to the name of an axis.
NEXT_TO_AXES = _words(
    "utm coord coords coordinate coordinates koordinate koordinaten koordinat koordinaat "
    "coordinaat coordenada coordenadas coordonnee coordonnees coordinata wspolrzedna wsp point pt "
    "p map world gps wgs etrs epsg local grid proj projected geo m ft feet meter meters metre "
    "metres us deg degree degrees degr dd decimal ms s km mm cm cdp bin center centre centroid "
    "mid midpoint source receiver shot sp ellipsoid ellipsoidal ell ellip ellipsoidische ortho "
    "orthometric orthometrique msl above sea surface top base gk rd lambert ngf nap nhn nn dhhn "
    "ground terrain water bed value val pos position posisjon wgs84 total station survey surveyed "
    "zone geografica geograficzna geographique geographische decimale z in du de la le den der "
    "gridded slm snm nmm gnss rtk true average mbsl amsl asl navd ngvd odn lv rt sirgas ed psad "
    "utme utmn magna irenet osgb bng cs crs srs seabed seafloor bottom dtm dem dgm dsm mdt bunn fond fondo "
    "bodem grund uber ueber sobre sur over reduced boven l ii iii iv sjobunn nadmorska координата координаты м абс "
    "абсолютная над уровнем моря 座標 座標値 坐标 坐標 坐标值 좌표"
)
# What a column with such a name is, when it is not a coordinate. A name that holds one of the words of
# "measure" is not a coordinate whatever else it holds.
ROLES = (
    ("an id", _words(
        "id fid oid objectid nr no num nummer number numero point pt pkt punkt punktnr "
        "punktnummer ptnr punto ponto punti punt puntnr puntnummer pnr pno name matricule station "
        "index row pid ptid ident uid gid serial nome nombre nom nazwa numer naam pointid "
        "pointnumber pointno pointname p idx piste pistenumero pistenro bod cislo cislobodu номер точка имя название "
        "скважина пункт 点名 点号 点番号 番号 測点 測点名 名称 编号 序号 点番 점번호 번호"
    )),
    ("a line, trace or place in a grid", _words(
        "line inline il iline xline crossline xl trace tr cdp cmp sp shotpoint shot bin ffid "
        "linje linie linea ligne linha profil profile track col column swath lijn traza spur "
        "traco"
    )),
    ("a date or a time", _words(
        "date datum fecha data dato hour gpstime timestamp utc epoch datetime second seconds tow "
        "utctime heure hora uhrzeit year month day hours minute minutes min hh mm yyyy doy sec jahr monat "
        "tag stunde annee mois jour minuto segundo ano mes dia hr дата время 日付 日期 時刻 时间 時間"
    )),
    ("a colour", _words("red green blue r g b rot gruen grun blau rouge vert bleu alpha rgb")),
    ("a code", _words(
        "code kod kode codigo codice class classification klasse classe return returns user flag "
        "description desc remark comment bemerkung beschreibung descripcion descricao opis "
        "bemerking код описание 備考 备注 代码 编码 コード"
    )),
    ("a measure", _words(
        "intensity amplitude quality std stddev sigma sd rms error err uncertainty accuracy "
        "precision velocity speed heading pitch roll nx ny nz normal confidence hdop pdop vdop "
        "tide draft angle slope aspect undulation geoid dev deviation residual delta dx dy dz "
        "thickness offset snr weight fold scan beam ping mean stdev count density tpu tvu thu fom course bearing satellites "
        "sats nsat count cnt population pop age "
        "antenna ant target instrument prism rod pole vel vx vy vz dist distance distanz distancia distanza afstand "
        "avstand abstand"
    )),
)
COLOURS = {
    "red": _words("red r rot rouge"),
    "green": _words("green g gruen grun vert"),
    "blue": _words("blue b blau bleu"),
}
UNITS = {
    "metres": _words("m meter meters metre metres mtr м"),
    "feet": _words("ft feet foot usft ftus sft"),
    "kilometres": _words("km kilometer kilometers kilometre kilometres"),
    "centimetres": _words("cm centimeter centimeters centimetre centimetres"),
    "millimetres": _words("mm millimeter millimeters millimetre millimetres"),
}
UNITS_OF_TIME = _words("s sec secs second seconds ms msec msecs millisecond milliseconds us")
HORIZONS = _words("horizon horizons horizont horizonte horisont orizzonte horyzont hor tvdss")
SEISMIC = _words("inline il iline xline crossline xl trace tr cdp cmp")
LETTERS_OF_AXES = _words("e oe n h х у н")
LETTERS = str.maketrans({"ø": "oe", "æ": "ae", "ß": "ss", "ł": "l", "Ø": "Oe", "Ł": "L", "ı": "i", "đ": "d"})
# What shows that a table is in a language in which X is often north, and Y east.
X_IS_NORTH = {
    "Cyrillic": "[а-яё]", "Japanese": "[ぁ-ヿ]|[点番]名|座標|標高", "Korean": "[가-힣]", "Chinese": "[一-鿿]",
    "Polish": r"\b(wysoko[sś][cć]|rz[eę]dna|numer|nazwa)\b", "Czech": r"\b(v[yý][sš]ka|č\. ?b|[cč][ií]slo)\b",
    "Croatian": r"\b(visina|to[cč]ka)\b", "Turkish": r"\b(y[uü]kseklik|rak[iı]m|nokta)\b",
}
ENCODINGS = ("latin-1", "cp1250", "cp1251", "cp932", "gb18030", "euc-kr")  # of text that is not Unicode

# ---- lines and words ----------------------------------------------------------------------------

COMMENT_MARKS = ("#", "%", "/", "!", "*", ">")
MISSING = set(
    "na n/a #n/a n.a. null none nil nodata no-data missing void - -- ? * -nan nan(ind)".split()
) | {""}
SEPARATORS = {";": "semicolons", "\t": "tabs", ",": "commas", "|": "bars", None: "blanks"}
NUMBERED_NAME = re.compile(r"(?:field|column|col)?\W*(\d{1,4})(?!\d)\s*[:=.)]?\s*(\S.*)", re.I)  # "3: X" in a header
# How files begin that are not tables, and what an error says of them.
_EXPORT = "numbers with {} cannot be read; export plain decimals"
THOUSANDS = _EXPORT.format("marks between thousands")
SEXAGESIMALS = _EXPORT.format("degrees, minutes and seconds")
GRIDS = "is an ESRI ASCII grid, not a table of points", "is a Surfer grid, not a table of points"  # which GDAL reads
NO_TABLES = (
    (r"ncols\b", GRIDS[0]),
    (r"dsaa\b", GRIDS[1]),
    (r"<[?!a-z]", "is XML or HTML, not a table of points"),
    (r"[{\[]\s*[\"{\[]",
     "is JSON, of which GDAL reads GeoJSON: of a list of records python3 -c \"import csv, json, sys; rows = json.load(open('{path}')); "
     "out = csv.DictWriter(sys.stdout, rows[0]); out.writeheader(); out.writerows(rows)\" > points.csv makes a table"),
    (r"(var|let|const)\s+\w+\s*=\s*[{\[]",
     "is JavaScript: sed '1s/^[^{]*//' {path} > points.geojson leaves its GeoJSON"),
    (r"(?s).*\w ?\(d'", SEXAGESIMALS),  # "latitude(d'")"
)
# Numbers of fixed width without a blank between, and what looks like them.
TOUCHING = r"[-+]?\d+\.\d+([-+]\d*\.\d+|\.\d+)+"
DATE = r"\d{1,2}\.\d{1,2}\.\d{2,4}|\d+(\.\d+){3}"
# What keeps words from being numbers: (pattern, share of lines in which it may be where numbers are found, what an
# error says of it). Blanks in thousands stand between other signs, or all numbers have decimals.
COMMAS_TWICE = (
    "commas stand for decimals and between columns; export it with semicolons between columns, or with decimal points"
)
_BLANKS = r"\s*[-+]?\d{1,3}( \d{3})*([.,]\d*)?\s*"
_LETTER = _EXPORT.format("a letter for north, south, east or west")
NO_NUMBERS = (
    (r"\d[\u00a0\u202f]\d{3}", 0.0, THOUSANDS),
    (rf"^(?=.*\d \d{{3}}){_BLANKS}(?P<sign>[\t;|]){_BLANKS}((?P=sign){_BLANKS})*$", 0.5, THOUSANDS),
    (r"^(?=.*\b\d{1,3}( \d{3}){2}[.,]\d)\s*([-+]?\d{1,3}( \d{3})*[.,]\d+\s*){3,}$", 0.9, THOUSANDS),
    (
        r"(?<!\w)(?<!\w-)\d{1,3}(?P<sign>[,.' ])\d{3}(?P=sign)\d{3}|(?<![\d.,])(?<!\w-)\d{1,3},\d{3}\.\d|"
        r"(?<![\d.,])\d{1,3}\.\d{3},\d+(?![\d.])",
        1.0, THOUSANDS,
    ),
    (r"\d\s*(\u00b0|\u00ba|d)\s*\d+\s*'", 1.0, SEXAGESIMALS),
    (r"\b[NS]\d{1,2} \d{1,2}\.\d.*\b[EW]\d{1,3} \d{1,2}\.\d|\.\d+[\u00b0\u00ba]?[NS]\b.*\.\d+[\u00b0\u00ba]?[EW]\b",
     0.5, _LETTER),
    (r"\d\s?[NSEW]\b", 1.0, _LETTER),
    (r"\"\s*[-+]?\d+,\d+\s*\"\s*,", 1.0, COMMAS_TWICE),  # "1,5","2,5"
)
GROUPED = r"[-+]?[1-9]\d{0,2}[.,]\d{3}"  # a number with a mark between thousands, or with three decimals
# Rows, their words between blanks: whole numbers two by two; degrees, minutes, seconds twice, and a value.
PAIRS = r"[-+]?\d+ [-+]?\d+( [-+]?\d+ [-+]?\d+)+"
SEXAGESIMAL = r"([-+]?(0?\d{1,2}|1[0-7]\d|180) [0-5]?\d [0-5]?\d([.,]\d*)? ){2}.*"
WITH_DECIMALS = r"\S+ \S+ \S*[.,]\S* \S+ \S+ \S*[.,]"

# How a line begins that holds totals of the others, in the languages of the names of columns.
SUMMARY = re.compile(
    r"[\s;,|\"]*((?:grand\s+)?(?:total|subtotal|sum|mean|average|avg|max|min|maximum|minimum|"
    r"median|range|rms|std|stdev|stddev|sd|mittel|mittelwert|summe|gesamt|moyenne|"
    r"somme|standardabweichung|[eé]cart[ -]type|m[eé]dia|suma|soma|somma|totale|totaal|"
    r"gemiddelde|m[ií]nimo|m[aá]ximo|minimo|massimo|srednia|\u015brednia|keskiarvo|summa)"
    r"(?:[ .]*dev\w*\.?| value)?)[\"\s:=.]*(?:[;,\t|]|\s[-+\d.])",
    re.I,
)

# ---- nulls --------------------------------------------------------------------------------------

FLOAT_MAX = 3.4028234663852886e38
NULLS = (
    (-9999.0, -999.25, -999.0, -9999.25, -99999.0, -999999.0, -9999999.0, -99999.99, -9999.99)
    + (9999.0, 99999.0, 999999.0, 9999900.0, 9999999.0, 999.25, 99999.99)
    + (-32768.0, -32767.0, 32767.0, -2147483648.0, 2147483647.0)
    + (1e30, -1e30, 1e31, 1e20, -1e20, 1e35, 1.70141e38, FLOAT_MAX, -FLOAT_MAX, 3.4e38, -3.4e38)
)
# Of rows that have it in x and y, and mostly in z; 999 is IRAP's mark at the end of a line.
NULL_ROWS = (0.0, 999.0)

# ---- readings of columns ------------------------------------------------------------------------

LINES_AS_AXES = {"x": _words("inline il iline"), "y": _words("crossline xline xl")}
MOST_STEP_OF_LINES = 4  # between their numbers
FINNISH = {"p": "y", "i": "x"}  # pohjoinen, itä
HIGHEST = 1e5  # no place is as high
GEOCENTRIC = (6378137.0, 6356752.3, 0.003, 1e4)  # the axes of the earth, by how much a place may miss it, least z
MOST_FEET = 4e6  # of many state planes of the USA, which look like metres of UTM near the equator
# What speaks for a reading of columns as x, y and z by their values, and against it. Some differences of
# sums are those of cases: "stands first" outweighs a fault of all but the weightiest.
WEIGHTS = {
    "one pair": 10,  # of names
    "as many decimals": 16,  # x and y
    "as wide as high": 6,  # to a factor of 30
    "z spans less": 16,  # than ten times what x and y do
    "z is higher than any place": -16,
    "stands first": 10,
    "x rises": -7,  # in all rows, as a time does
    "x is a line": -10,
    "a column is left out": -4,  # before x, behind the first, for no reason
    "x and y are of UTM": 16,
    "x and y count": -11,  # as line and trace do
    "z is flat or rises along lines": -10,  # as numbers of lines do
    "z behind lines": -8,
}
# A reading is certain if the next is this much worse; more, where the reading itself is not a good one.
GOOD, CLEAR, CLEAR_OF_POOR = 33, 4, 6
# The parts of a time: least, most, and how many seconds they are.
PARTS_OF_TIME = {
    "year": (1900, 2100, 366 * 86400.0), "month": (1, 12, 31 * 86400.0), "day": (1, 31, 86400.0),
    "day of year": (1, 366, 86400.0), "hour": (0, 24, 3600.0), "minute": (0, 59, 60.0),
    "second": (0, 61, 1.0),
}
TIMES = tuple(
    tuple(parts.split(", "))
    for parts in (
        "year, month, day, hour, minute, second", "day, month, year, hour, minute, second",
        "month, day, year, hour, minute, second", "year, day of year, hour, minute, second",
        "year, month, day, hour, minute", "year, day of year, hour, minute", "year, month, day",
        "day, month, year", "month, day, year", "hour, minute, second",
    )
)

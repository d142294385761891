# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the name of a column means: an axis, or something else, in nine languages and some more."""

import dataclasses
import re
import unicodedata


def _words(text):
    return frozenset(text.split())


# Names of English, German, French, Spanish, Portuguese, Norwegian, Italian, Dutch and Polish, some
# of Finnish and Czech, as plain() writes them: (axis, rank, direction, names). A lower rank is the
# better name.
AXES = (
    ("x", 0, "", _words("x")),
    ("y", 0, "", _words("y")),
    ("z", 0, "", _words("z")),
    ("x", 1, "", _words(
        "easting eastings east rechtswert rechts rw ostwert ost oest este leste est abscisse "
        "abscissa abscisa absis oost oosting ostkoordinate wschod wschodnia ostkoordinat "
        "oestkoordinat ostverdi eastcoordinate coordeste oosten rechtsw oestverdi "
        "ita itakoordinaatti"
    )),
    ("y", 1, "", _words(
        "northing northings north hochwert hoch hw nordwert nord norte ordonnee ordenada ordinata "
        "ordinate noord noording nordkoordinate polnoc polnocna nordkoordinat nordverdi noorden "
        "hochw pohjoinen pohjoiskoordinaatti"
    )),
    ("z", 1, "", _words(
        "elevation elevations elev elevacion elevacao elevazione height heights hgt ht hoehe hohe "
        "gelaendehoehe gelandehohe altitude alt altitud altura altezza cota cote quota kote hoyde "
        "hoeyde hoogte wysokosc rzedna topography level niveau rl orthoheight ellipheight "
        "gelaende gelande terrenghoyde terrenghoeyde moh maaiveld maaiveldhoogte bodemhoogte "
        "hoogteligging wys rzednaterenu pnm quotaslm altimetria altimetrie topo grundhoehe "
        "bodenhoehe bodenhohe gok gokhoehe meereshohe meereshoehe hojde hoejde hoeydekote hae msl "
        "nap nhn amsl korkeus vyska"
    )),
    ("x", 2, "", _words("e oe")),
    ("y", 2, "", _words("n")),
    ("z", 2, "", _words("h")),
    ("z", 2, "depth", _words(
        "depth depths tiefe profondeur prof profundidad profundidade profondita dybde diepte "
        "glebokosc tvd tvdss sounding soundings sonde bathymetry bathymetrie tvdm wassertiefe "
        "meerestiefe wasserstiefe bunndybde havdybde vanndybde waterdiepte bodemdiepte profund "
        "waterdepth seabeddepth"
    )),
    ("z", 2, "time", _words("twt owt twtt laufzeit")),
    ("x", 3, "", _words(
        "lon long longitude lng laenge lange laengengrad langengrad longitud lengdegrad lengde "
        "lengtegraad longitudine dlugosc lonx longitudeddeg laengde"
    )),
    ("y", 3, "", _words(
        "lat latitude breite breitengrad latitud breddegrad bredde breedtegraad latitudine "
        "szerokosc laty"
    )),
    ("z", 4, "time", _words("time zeit temps tiempo tempo tid tijd czas")),
)
# Words that may stand beside the name of an axis.
BESIDE = _words(
    "utm coord coords coordinate coordinates koordinate koordinaten koordinat koordinaat "
    "coordinaat coordenada coordenadas coordonnee coordonnees coordinata wspolrzedna wsp point pt "
    "p map world gps wgs etrs epsg local grid proj projected geo m ft feet meter meters metre "
    "metres us deg degree degrees degr dd decimal ms s km mm cm cdp bin center centre centroid "
    "mid midpoint source receiver shot sp ellipsoid ellipsoidal ell ellip ellipsoidische ortho "
    "orthometric orthometrique msl above sea surface top base gk rd lambert ngf nap nhn nn dhhn "
    "ground terrain water bed value val pos position posisjon wgs84 total station survey surveyed "
    "zone geografica geograficzna geographique geographische decimale z in du de la le den der "
    "gridded slm snm nmm gnss rtk true average mbsl amsl asl navd ngvd odn lv rt sirgas ed psad "
    "magna irenet osgb bng cs crs srs seabed seafloor bottom dtm dem dgm dsm mdt bunn fond fondo "
    "bodem grund uber ueber sobre sur over reduced boven l ii iii iv sjobunn"
)
# What a column with such a name is, when it is no coordinate. A name that holds one of the words of
# "measure" is no coordinate whatever else it holds.
ROLES = (
    ("an id", _words(
        "id fid oid objectid nr no num nummer number numero point pt pkt punkt punktnr "
        "punktnummer ptnr punto ponto punti punt puntnr puntnummer pnr pno name matricule station "
        "index row pid ptid ident uid gid serial nome nombre nom nazwa numer naam pointid "
        "pointnumber pointno pointname p idx piste pistenumero pistenro bod cislo cislobodu cb eb"
    )),
    ("a line, trace or place in a grid", _words(
        "line inline il iline xline crossline xl trace tr cdp cmp sp shotpoint shot bin ffid "
        "linje linie linea ligne linha profil profile track col column swath lijn traza spur "
        "traco"
    )),
    ("a date or a time", _words(
        "date datum fecha data dato hour gpstime timestamp utc epoch datetime second seconds tow "
        "utctime heure hora uhrzeit"
    )),
    ("a colour", _words("red green blue r g b rot gruen grun blau rouge vert bleu alpha rgb")),
    ("a code", _words(
        "code kod kode codigo codice class classification klasse classe return returns user flag "
        "description desc remark comment bemerkung beschreibung descripcion descricao opis "
        "bemerking"
    )),
    ("a measure", _words(
        "intensity amplitude quality std stddev sigma sd rms error err uncertainty accuracy "
        "precision velocity speed heading pitch roll nx ny nz normal confidence hdop pdop vdop "
        "tide draft angle slope aspect undulation geoid dev deviation residual delta dx dy dz "
        "thickness offset snr weight fold scan beam ping mean stdev count density tpu tvu thu fom "
        "antenna ant target instrument prism rod pole vel vx vy vz"
    )),
)
ABBREVIATED = _words("cb eb")  # "č.b.", also as read from another code page
COLOURS = {
    "red": _words("red r rot rouge"),
    "green": _words("green g gruen grun vert"),
    "blue": _words("blue b blau bleu"),
}
UNITS = {
    "metres": _words("m meter meters metre metres mtr"),
    "feet": _words("ft feet foot usft ftus sft"),
    "kilometres": _words("km kilometer kilometers kilometre kilometres"),
    "centimetres": _words("cm centimeter centimeters centimetre centimetres"),
    "millimetres": _words("mm millimeter millimeters millimetre millimetres"),
}
UNITS_OF_TIME = _words("s sec secs second seconds ms msec msecs millisecond milliseconds us")
HORIZONS = _words("horizon horizons horizont horizonte horisont orizzonte horyzont hor tvdss")
SEISMIC = _words("inline il iline xline crossline xl trace tr cdp cmp")
LETTERS_OF_AXES = _words("e oe n h")
LETTERS = str.maketrans({"ø": "oe", "æ": "ae", "ß": "ss", "ł": "l", "Ø": "Oe", "Ł": "L"})


def plain(text):
    """Without accents, apart at capitals and signs: "Höhe_NN (m)" -> ["hohe", "nn", "m"]."""
    text = re.sub("Ø(?=[A-Z])", "OE", text)
    text = unicodedata.normalize("NFKD", text.translate(LETTERS))
    text = "".join(letter for letter in text if not unicodedata.combining(letter))
    text = re.sub(r"([a-z])([A-Z])|([A-Z])([A-Z][a-z])", r"\1\3 \2\4", text)
    beside = r"(utm|p|pos|coord\w*|koord\w*)?"
    text = re.sub(rf"\b{beside}([xyz]){beside}\b", r"\1 \2 \3", text.lower())
    return [word for word in re.split(r"[^a-z]+", text) if word]


def in_brackets(name):
    """("X (Nord)") -> ("X ", " Nord")."""
    return re.sub(r"[(\[{<].*", "", name), " ".join(re.findall(r"[(\[{<]([^)\]}>]*)", name))


@dataclasses.dataclass(frozen=True)
class Meaning:
    """What a name tells: an axis with rank and direction, or the role of something else."""

    axis: str = ""
    rank: int = 0
    direction: str = ""
    role: str = ""
    beside: tuple = ()  # the words beside the name of the axis


def meaning(name):
    """The Meaning of a column's name; empty where it is not known."""
    outside, inside = in_brackets(name)
    words = plain(outside) or plain(inside)
    joined = "".join(words)
    for role, names in ROLES:
        whole = joined in names and (len(words) == 1 or len(joined) > 3)  # "X L" is no "xl"
        whole |= joined in names & ABBREVIATED
        if whole or role == "a measure" and any(word in names for word in words):
            return Meaning(role=role)
    extra = [w for w in plain(inside) if any(w in names and r == 1 for _, r, _, names in AXES)]
    axis = _axis_of(words, joined, extra)
    if axis:
        return axis
    for role, names in ROLES:
        if words and any(word in names for word in words) and not any(len(w) == 1 for w in words):
            return Meaning(role=role)
    return Meaning()


def _axis_of(words, joined, extra):
    whole = [(a, r, d) for a, r, d, names in AXES if joined in names]
    found = [(a, r, d, w) for a, r, d, names in AXES for w in words if w in names]
    # "Longitude_E": the word tells more than the letter.
    found = [one for one in found if one[3] not in LETTERS_OF_AXES] or found
    found = whole or [one[:3] for one in found]
    found += [(a, r, d) for a, r, d, names in AXES for w in extra if w in names]
    if not found:
        return None
    if len({axis for axis, _, _ in found}) > 1:
        # "X (Nord)": the word tells more than the letter.
        found = [(a, r, d) for a, r, d in found if r == 1 and a != "z"]
        if len({axis for axis, _, _ in found}) != 1:
            return None
    axis, rank, direction = min(found)
    direction = max(d for _, _, d in found)
    known = frozenset().union(*(names for _, _, _, names in AXES))
    beside = tuple(w for w in words if w not in known) if not whole else ()
    strange = [word for word in beside if word not in BESIDE]
    if axis == "z" and "alt" in words and len(words) > 1 and any(
        w != "alt" and w in names for a, _, _, names in AXES if a == "z" for w in words
    ):
        strange.append("alt")  # "Höhe_alt": the old one
    if strange:
        if max(len(word) for word in words if word in known) < 2 or rank == 4:
            return None  # a single letter among words that tell something else
        rank += 5
    return Meaning(axis, rank, direction, "", tuple(sorted(beside)))


def unit_of(name):
    """The unit of length that a column's name tells, as "feet" for "Z (ft)" and "elev_ft", or ""."""
    outside, inside = in_brackets(name)
    words = plain(inside) or plain(outside)[1:]
    return next((unit for unit, names in UNITS.items() if words and words[-1] in names), "")


def direction_of(name):
    """"depth" or "time" where a name, or its unit in brackets, says that z counts downwards, or ""."""
    is_time = "".join(plain(in_brackets(name)[1])) in UNITS_OF_TIME
    return meaning(name).direction or ("time" if is_time else "")


def says_up(name):
    """Whether a name says that z counts upwards, as "Elevation" does and "Z" does not."""
    found = meaning(name)
    return found.axis == "z" and found.rank == 1 and not direction_of(name)


def is_of_horizon(name):
    """Whether the name of a file says that it holds a horizon, or depths."""
    return any(
        word in HORIZONS or len(word) > 4 and meaning(word).direction == "depth"
        for word in plain(name)
    )


def is_seismic(name):
    """Whether a name is that of a line or trace of a seismic survey."""
    return "".join(plain(name)) in SEISMIC


def is_beside(name):
    """Whether a word may stand beside the name of an axis, as "coordinate" does."""
    return all(word in BESIDE for word in plain(name))


def known_names(names):
    """How many of some names mean something, those of axes most."""
    found = [meaning(name) for name in names]
    return sum(3 if m.axis and m.rank < 5 else 1 for m in found if m.axis or m.role)

"""Words by which people call a column's numbers: of museums and laboratories, in English, German, Italian and French.

Headings of tables of objects, and suggestions for misspelt arguments, keys and options, read this one list. Case,
accents, separators, order of words and British or American spelling do not count. A word that may mean several numbers
is in `AMBIGUOUS`: it is never read, and a message lists its meanings.
"""

import re
import unicodedata
from collections.abc import Iterable, Mapping
from functools import cache

_LISTED = {
    # Numbers of an inventory last: a table with both has its names in the other column.
    "name": (
        "object, item, title, object name, designation, Objekt, Bezeichnung, Titel, oggetto, nome, titolo, objet, nom, "
        "titre, inventory number, inv no, accession number, catalogue number, object number, object id, id, "
        "Inventarnummer, Inventar Nr, numero inventario, numéro d'inventaire"
    ),
    "radius": (
        "foot radius, base radius, bottom radius, r foot, r base, "
        "Fußradius, Standradius, raggio, raggio base, rayon, rayon base, rayon pied"
    ),
    "diameter": (
        "Ø, foot diameter, base diameter, bottom diameter, foot Ø, base Ø, diam, dia, foot diam, base diam, "
        "Durchmesser, Durchmesser Fuß, Fußdurchmesser, Standdurchmesser, diametro, diametro base, diametro piede, "
        "diamètre, diamètre base, diamètre pied"
    ),
    "height": "total height, overall height, object height, Höhe, Gesamthöhe, altezza, altezza totale, hauteur, "
    "hauteur totale",
    "mass": "weight, total mass, total weight, Gewicht, Masse, Gesamtgewicht, peso, massa, poids",
    "density": "ρ, rho, mass density, Dichte, densità, densité, masse volumique",
    "mass_height": (
        "centre of mass, height of the centre of mass, CoM, CoM height, CoM h, "
        "centre of gravity, height of the centre of gravity, CoG, CoG height, "
        "centroid, centroid height, Schwerpunkt, Schwerpunkthöhe, Höhe Schwerpunkt, baricentro, altezza baricentro, "
        "centre de gravité, hauteur du centre de gravité"
    ),
    "inner_radius": "inside radius, internal radius, bore radius, Innenradius",
    "inner_diameter": "inside diameter, internal diameter, inner Ø, Innendurchmesser",
    "top_radius": "upper radius",
    "top_diameter": "upper diameter, top Ø",
    "max_radius": "maximum radius, largest radius, greatest radius, größter Radius, raggio massimo, rayon maximal",
    "max_diameter": (
        "max Ø, maximum diameter, maximum Ø, max diam, largest diameter, largest Ø, greatest diameter, "
        "größter Durchmesser, Durchmesser max, diametro massimo, diamètre maximal, diamètre max"
    ),
    "friction_coefficient": (
        "friction, friction factor, µ, mu, CoF, "
        "Reibung, Reibungskoeffizient, Reibbeiwert, Reibungszahl, attrito, coefficiente di attrito, frottement, "
        "coefficient de frottement"
    ),
    "damping": "η, eta, damping parameter, Dämpfung, smorzamento, amortissement",
    "site": "",
    "shape": "",
    "profile": "",
}
_AMBIGUOUS = {
    ("radius", "diameter"): (
        "foot, base, width, breadth, depth, size, dimension, dimensions, length, Fuß, Breite, Tiefe, Größe, piede, "
        "larghezza, profondità, pied, largeur, profondeur"
    ),
    ("height", "mass_height"): "h, z",
    ("diameter",): "d",
    ("radius",): "r",
    ("mass",): "m, w",
    ("transverse_inertia", "axial_inertia"): "inertia, moment of inertia",
}
_EMPTY_WORDS = frozenset(["of", "the", "at", "de", "du", "des", "di", "del", "della", "der"])
_SPELLINGS = {"centre": "center", "catalogue": "catalog", "coeff": "coefficient", "nr": "no", "number": "no"}
_DIAMETER_SIGNS = str.maketrans({"⌀": "ø", "∅": "ø"})
_INITIALS = re.compile(r"\b(\w)\.")
_JOINED = re.compile(r"(?<=[a-z])(?=[A-Z][a-z])")
_WORD = re.compile(r"[^\W_]+|±")
# Shorter words are like too many others.
_LONG_ENOUGH = 4


def words_of(text: str) -> tuple[str, ...]:
    """Return the words of a text in small letters, without accents, in American spelling.

    >>> words_of("Centre_of-Mass"), words_of("c.o.g."), words_of("FootRadius")
    (('center', 'of', 'mass'), ('cog',), ('foot', 'radius'))
    """
    spaced = _JOINED.sub(" ", _INITIALS.sub(r"\1", text.translate(_DIAMETER_SIGNS)))
    letters = unicodedata.normalize("NFKD", spaced.casefold())
    plain = "".join(one for one in letters if not unicodedata.combining(one))
    return tuple(_SPELLINGS.get(word, word) for word in _WORD.findall(plain))


def _key(words: Iterable[str]) -> frozenset[str]:
    return frozenset(word for word in words if word not in _EMPTY_WORDS)


def _keys(listed: str) -> dict[frozenset[str], tuple[str, ...]]:
    return {_key(words): words for words in (words_of(one) for one in listed.split(",")) if words}


ALIASES: Mapping[str, tuple[str, ...]] = {
    name: tuple(" ".join(one.split()) for one in listed.split(",") if one.strip()) for name, listed in _LISTED.items()
}
"""Aliases of each name, without the name itself."""

AMBIGUOUS: Mapping[str, tuple[str, ...]] = {
    word.strip(): names for names, listed in _AMBIGUOUS.items() for word in listed.split(",")
}
"""The names that an ambiguous word may mean."""

_BY_KEY = {key: name for name, listed in _LISTED.items() for key in (*_keys(listed), _key(words_of(name)))}
_UNSURE = {_key(words_of(word)): names for word, names in AMBIGUOUS.items()}


def meant_by(text: str) -> str | None:
    """Return the name that a text is or is an alias of; None for other texts.

    >>> meant_by("Total Height"), meant_by("Ø"), meant_by("coefficient of friction"), meant_by("width")
    ('height', 'diameter', 'friction_coefficient', None)
    """
    return _BY_KEY.get(_key(words_of(text)))


def order_of(text: str) -> int:
    """Return the place of a text among the aliases of its name; 0 for the name itself.

    >>> order_of("name"), order_of("Object"), order_of("object, name of the")
    (0, 1, 4)
    """
    name = meant_by(text)
    same = [_key(words_of(one)) for one in (name, *ALIASES[name])] if name else []
    return same.index(_key(words_of(text))) if name else 0


def may_mean(text: str) -> tuple[str, ...]:
    """Return the names that a text that is no alias may mean: by an ambiguous word, or by an alias in longer words.

    >>> may_mean("width"), may_mean("max. foot diameter"), may_mean("Bodendurchmesser"), may_mean("remarks")
    (('radius', 'diameter'), ('diameter',), ('diameter',), ())
    """
    words = words_of(text)
    key = _key(words)
    if key in _UNSURE:
        return _UNSURE[key]
    numbers = {one: name for one, name in _BY_KEY.items() if name in _NUMBERS}
    within = {one: name for one, name in numbers.items() if one < key and _is_long(one)}
    if not within:
        within = {
            one: name
            for one, name in numbers.items()
            if len(one) == 1 and any(len(part) > _LONG_ENOUGH and part in word for part in one for word in key)
        }
    most = max(map(_length, within), default=0)
    return tuple(dict.fromkeys(name for one, name in within.items() if _length(one) == most))


_NUMBERS = frozenset(_LISTED) - {"name", "site", "shape", "profile"}


def _is_long(key: frozenset[str]) -> bool:
    return "ø" in key or any(len(word) >= _LONG_ENOUGH for word in key)


def _length(key: frozenset[str]) -> int:
    return sum(map(len, key))


@cache
def spellings_of(name: str) -> tuple[str, ...]:
    """Return the name and its longer aliases, for a comparison with misspelt ones."""
    long = (one.lower() for one in ALIASES.get(name, ()) if len(one) > _LONG_ENOUGH)
    return (name, *long)

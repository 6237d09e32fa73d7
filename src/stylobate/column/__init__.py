"""The column: its numbers, its named constructors, and the shapes by which files describe it."""

from stylobate.column.column import Column as Column
from stylobate.column.numbers import STANDARD_GRAVITY as STANDARD_GRAVITY
from stylobate.column.numbers import Density as Density
from stylobate.column.numbers import Height as Height
from stylobate.column.numbers import MassHeight as MassHeight
from stylobate.column.numbers import Radius as Radius
from stylobate.column.numbers import Slenderness as Slenderness
from stylobate.column.numbers import TopRadius as TopRadius
from stylobate.column.profiles import PROFILES as PROFILES
from stylobate.column.profiles import Profile as Profile
from stylobate.column.shapes import SHAPES as SHAPES
from stylobate.column.shapes import SHAPES_IN_FILES as SHAPES_IN_FILES
from stylobate.column.shapes import SHAPES_OF_PROFILES as SHAPES_OF_PROFILES
from stylobate.column.shapes import SHAPES_WITH_OPTIONS as SHAPES_WITH_OPTIONS

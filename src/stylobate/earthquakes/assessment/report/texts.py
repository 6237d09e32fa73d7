"""Fixed texts of the report: assumptions, subjects not covered, classes of verdicts, planar column, references."""

ASSUMPTIONS: tuple[tuple[str, str], ...] = (
    ("body", "a rigid body of revolution in one piece, symmetric about its axis, on a flat circular base"),
    ("ground", "rigid, level and flat; the base acceleration acts on the whole footprint at once"),
    ("start", "upright and at rest, without cracks or wear of the rim"),
    (
        "contact",
        "the base does not slip, pivot freely or lift off; the section Contact demand lists the friction needed: "
        "compare it with the friction that the joint provides",
    ),
    ("dissipation", "as stated by the author of the study, at low, central and high levels; not measured or checked"),
    ("after the record", "the base stands still; the run continues for the stated free-vibration time"),
    ("scaled records", "one factor multiplies all components; the time axis does not change"),
    ("direction", "a round column on level ground has no weak direction: rotating the record only rotates the motion"),
)

NOT_COVERED: tuple[tuple[str, str], ...] = (
    ("several drums or blocks", "joints open and slide; the column is taken as one piece"),
    ("flexible soil and foundation", "rocking and uplift of the footing, amplification of the ground motion"),
    ("flexible superstructure", "a floor, pedestal or shaking building changes the record before it reaches the base"),
    ("sloshing liquid", "the liquid in a tank moves against its wall"),
    ("anchors, dowels, clamps", "they restrain the column until they break"),
    ("bases that are not circular", "square plinths, broken rims, feet"),
    ("contact that yields", "crushing of the edge, wear, mortar and lead beds"),
    ("neighbours", "impact against walls, other columns, an architrave on top"),
    ("other ground motions", "only the records listed were run; whether they represent the site is not judged here"),
)

SLIP_AND_FLIGHT: dict[bool, tuple[str, str]] = {
    False: ("slip and flight", "the sliding model (kind sliding) was not run: sliding = false"),
    True: (
        "slip and flight",
        "the sliding model (kind sliding) was run only for columns that slide before they rock, at the central "
        "dissipation; all other runs assume that the base neither slips nor lifts off",
    ),
}
"""Remark on slip and flight, by the option `sliding`."""

VERDICT_CLASSES: tuple[tuple[str, str], ...] = (
    (
        "NOT shown safe",
        "at least one record overturned the column at some stated dissipation, with the given or the other contact law",
    ),
    (
        "Survival NOT robust",
        "no record overturned it at any stated dissipation and contact law, but the vertical component, another scale "
        "within 10 % or below, a small variation, an undecided run or too little friction (with the "
        "given contact law) leaves the verdict open",
    ),
    (
        "Survived every run",
        "no record overturned it at any stated dissipation and contact law, at any scale tried within 10 %, or in any "
        "small variation; all runs were decided, and the stated friction suffices with the given contact law; a run "
        "whose outcome rounding could alter counts only if small variations do not settle the case",
    ),
    (
        "Not described by these runs",
        "the column slides before it rocks, because the stated friction is less than r/h, or no run was decided",
    ),
)

PLANAR = (
    "The usual calculation applies each horizontal component alone to a planar block, which loses energy at impacts "
    "by the formula of Housner (1963). It is shown for comparison; no verdict depends on it.",
    "The two calculations differ for this reason: a planar block hits the ground with its whole base in every half "
    "cycle, and each impact takes a fixed fraction of its energy. A round column under two components rolls on its rim "
    "and seldom passes through the vertical, so it has hardly any impacts. It loses energy only by the stated damping, "
    "a different mechanism from restitution. It can therefore reach several times the tilt of the planar block under "
    "the same record; for cylinders in three dimensions see Vassiliou et al. (2017). The comparison depends on the "
    "stated damping.",
    "A positive mean logarithm means that the column tilts more in three dimensions. The mean covers the records under "
    "which both columns rock by more than 0.001 α_c and neither overturns. The last columns of the table count the "
    "records under which only one of them overturns.",
)

REFERENCES: tuple[tuple[str, str], ...] = (
    (
        "rocking, planar block",
        "G. W. Housner, The behavior of inverted pendulum structures during earthquakes, Bull. Seismol. Soc. Am. 53, "
        "403–417, 1963",
    ),
    (
        "cylinders in three dimensions",
        "M. F. Vassiliou, S. Burger, M. Egger, J. A. Bachmann, M. Broccardo, B. Stojadinović, The three-dimensional "
        "behavior of inverted pendulum cylindrical structures during earthquakes, Earthquake Engng Struct. Dyn. 46, "
        "2261–2280, 2017",
    ),
    (
        "displacements of rocking bodies",
        "N. Reggiani Manzo, M. F. Vassiliou, Displacement-based analysis and design of rocking structures, Earthquake "
        "Engng Struct. Dyn. 48, 2019, doi 10.1002/eqe.3217",
    ),
    (
        "RotD50",
        "D. M. Boore, Orientation-independent, nongeometric-mean measures of seismic intensity from two horizontal "
        "components of motion, Bull. Seismol. Soc. Am. 100, 1830–1835, 2010",
    ),
    (
        "scaled records",
        "D. Vamvatsikos, C. A. Cornell, Incremental dynamic analysis, Earthquake Engng Struct. Dyn. 31, 491–514, 2002",
    ),
    (
        "equations of motion",
        "documentation of stylobate, pages Models and Equations: a rigid body whose rim rolls without slip, with "
        "viscous damping of the tilt",
    ),
    (
        "damping",
        "no published value is used: the author of the study stated the levels",
    ),
)

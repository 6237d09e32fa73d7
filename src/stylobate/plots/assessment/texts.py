"""What an assessment assumes, and what it does not cover."""

ASSUMPTIONS: tuple[tuple[str, str], ...] = (
    ("body", "a rigid body of revolution in one piece, symmetric about its axis, on a flat circular base"),
    ("ground", "rigid, level and flat; the base acceleration acts on the whole footprint at once"),
    ("start", "upright and at rest, nothing leaning, no crack or wear of the rim"),
    (
        "contact",
        "the base does not slip, pivot freely or lift off; what it would have to bear for that is told above and is to "
        "be compared with what the joint can bear",
    ),
    ("dissipation", "the stated one: three levels, none of them measured by this program"),
    ("after the record", "the base stands still and the column is followed on for the stated time"),
    ("scaled records", "all components times one factor, the time axis unchanged"),
    ("direction", "a round column on level ground has no weak direction: a turned record turns the motion and no more"),
)

NOT_COVERED: tuple[tuple[str, str], ...] = (
    ("several drums or blocks", "joints open and slide; the column is taken as one piece"),
    ("flexible soil and foundation", "rocking of the footing, uplift of the soil, amplification on the way up"),
    ("flexible superstructure", "a floor, pedestal or shaking building changes the record before it reaches the base"),
    ("sloshing liquid", "a tank's content moves against it"),
    ("anchors, dowels, clamps", "and what happens when they break"),
    ("bases that are not circular", "square plinths, broken rims, feet"),
    ("contact that gives way", "crushing of the edge, wear, mortar and lead beds"),
    ("slip and flight", "a model that slides exists (kind sliding) and is not part of this assessment"),
    ("neighbours", "impact against walls, other columns, an architrave on top"),
    ("other ground motions", "only the records listed were run; whether they represent the site is not judged here"),
)

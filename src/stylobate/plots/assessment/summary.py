"""The text that a reader sees first: a paragraph on each column."""

import math

import xarray as xr

from stylobate.plots.assessment.wording import CENTRAL, number, records
from stylobate.results.assessment import Assessment


def summary_paragraphs(assessment: Assessment) -> list[str]:
    """Return a paragraph on each column, and one that says how to read them."""
    return [*(column_paragraph(assessment, name) for name in _columns(assessment)), _reading(assessment)]


def column_paragraph(assessment: Assessment, name: str) -> str:
    """Return what became of one column, in words that promise nothing."""
    own = assessment.data["summary"].sel(column=name)
    total = assessment.data["records"].sizes["record"]
    told = [f"{name}:", *(_at(own.sel(scale=scale), float(scale), total) for scale in own["scale"].to_numpy())]
    told += [_margin(assessment, own), _contact(assessment, name, own)]
    return " ".join(part for part in told if part)


def _columns(assessment: Assessment) -> list[str]:
    return [str(name) for name in assessment.data["columns"]["column"].to_numpy()]


def _at(own: xr.Dataset, scale: float, total: int) -> str:
    """Return what happened at one scale: the verdicts, then what makes them doubtful."""
    said = [_verdicts(own, "As recorded (scale 1)" if scale == 1.0 else f"At scale {scale:g}", total)]
    fallen, some = int(own["overturned"]), int(own["overturned_in_some"])
    if some > fallen:
        more = f" under {records(some, total)}" if total > 1 else ""
        said.append(f"at some stated dissipation, or without the vertical component, it overturned{more}")
    if "not_robust" in own and int(own["undecided"]) < total:
        shaky = int(own["not_robust"])
        if shaky:
            under = f" under {records(shaky, total)}" if total > 1 else ""
            said.append(f"the verdict{under} flips under a small change and is not repeatable")
        else:
            said.append("no small change that was tried flipped a verdict")
    return "; ".join(said) + "."


def _verdicts(own: xr.Dataset, where: str, total: int) -> str:
    fallen, unknown = int(own["overturned"]), int(own["undecided"])
    all_of_them = f"any of the {total} records" if total > 1 else "the one record"
    every = f"every one of the {total} records" if total > 1 else "the one record"
    if unknown == total:
        return f"{where} no run decided"
    if fallen == total:
        return f"{where} it overturned under {every}"
    undecided = f", and {records(unknown, total)} did not decide" if unknown else ""
    if fallen == 0 and not unknown:
        largest = number(float(own["largest_tilt_ratio"]))
        moved = f"largest tilt {largest} α" if float(own["largest_tilt_ratio"]) > 0.0 else "it never moved"
        return f"{where} it did not overturn in these runs under {all_of_them}, {moved}"
    return f"{where} it overturned under {records(fallen, total)}{undecided}"


def _margin(assessment: Assessment, own: xr.Dataset) -> str:
    low, high, _ = assessment.setting["margin_scales"]
    governing = str(own["governing"].item())
    least, least_of_all = float(own["least_overturning"]), float(own["least_of_all"])
    if math.isnan(least):
        said = (
            f"No scale factor from {number(low)} to {number(high)} that was run overturned it at the central "
            f"dissipation; the largest tilt was under {governing}."
        )
    else:
        said = f"The least scale factor of those run that overturned it is {number(least, 4)}, under {governing}"
        said += f"{_lasting(assessment, str(own['column'].item()), governing)}."
    if not math.isnan(least_of_all) and least_of_all != least:
        said += f" Over all stated dissipations, and without the vertical component, it is {number(least_of_all, 4)}."
    again = int(own["stands_again"])
    if again:
        under = records(again, assessment.data["records"].sizes["record"])
        said += f" Some larger scales did not overturn it again, under {under}: more shaking is not always worse."
    return said


def _lasting(assessment: Assessment, column: str, record: str) -> str:
    """Return what is to be said of a least scale that stands alone, its neighbours on both sides having stood."""
    margins = assessment.data["margins"].sel(column=column, record=record, case=CENTRAL)
    least, lasting = float(margins["least_overturning"]), float(margins["least_lasting"])
    if lasting == least:
        return ""
    alone = ", in a band so narrow that another scan might miss it: scales just above and below did not"
    return (
        alone
        if math.isnan(lasting)
        else f"{alone}; the least from which a wider band was found is {number(lasting, 4)}"
    )


def _contact(assessment: Assessment, name: str, own: xr.Dataset) -> str:
    need = float(own["friction_demand"].max())
    if math.isnan(need):
        return ""
    stated = float(assessment.setting["friction_coefficient"][name])
    if need <= stated:
        at_stated = (
            f"The largest friction that any run at {_stated_scales(assessment)} needed is {number(need)}; the stated "
            f"coefficient is {number(stated)}."
        )
    else:
        at_stated = (
            f"Some run needed a friction of {number(need)}, above the stated coefficient {number(stated)}: "
            "there the base would slip, which these runs do not follow."
        )
    return f"{at_stated} {_contact_to_margin(own)}"


def _contact_to_margin(own: xr.Dataset) -> str:
    """Return what the contact must bear up to the margin, and from which scale on that is more than is stated."""
    need, slipping = (float(own[name]) for name in ("friction_to_margin", "least_slipping"))
    if math.isnan(need) and math.isnan(slipping):
        return "What other scales need was not looked at."
    if math.isnan(slipping):
        return "No scale factor that was run for the margin needed more than that."
    said = f"The least scale run that needs more is {number(slipping, 4)}"
    if int(own["slips_first"]):
        return (
            f"{said}, in some case below the least that overturned it: there the base would slip first, and the margin "
            "is not told by these runs."
        )
    return f"{said}, above the least that overturned it: beyond it the base would slip."


def _stated_scales(assessment: Assessment) -> str:
    scales = assessment.setting["scales"]
    return f"scale {scales[0]:g}" if len(scales) == 1 else "the stated scales"


def _reading(assessment: Assessment) -> str:
    repeated = (
        "so every verdict was repeated under small changes, and one that flips should be taken as open."
        if assessment.setting["changes"]
        else "no verdict was repeated under small changes here, so none is known to be repeatable."
    )
    return (
        "How to read this: a verdict is what happened in the runs that were made, of a rigid column under these "
        "records only. “Did not overturn” is no proof that it cannot. A single rocking run is barely repeatable near "
        "the limit; " + repeated
    )

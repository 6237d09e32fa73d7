"""Description of an inventory: the table of objects, the sites with their records and hazard, and the study."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from stylobate.config.axis import Scales
from stylobate.config.description import Config, Seconds, built
from stylobate.config.parts import DEFAULT_MODEL
from stylobate.config.record_collection import RecordsConfig
from stylobate.earthquakes.config.assess import as_source, hazard_as_stated
from stylobate.earthquakes.config.hazard import Hazard
from stylobate.earthquakes.inventories.objects import InventoryObject, InventorySite
from stylobate.earthquakes.inventories.table import read_inventory
from stylobate.errors import ConfigError, FileError
from stylobate.run_arguments import Accuracy, numbers_of


class SiteConfig(Config):
    """A site of an inventory.

    Parameters
    ----------
    records
        Records: a folder, a pattern or a list of files; or a table.
    hazard
        Hazard curve, for annual rates: a table as for a fragility.
    """

    records: Annotated[RecordsConfig, BeforeValidator(as_source)]
    hazard: Hazard | None = None

    def build(self) -> InventorySite:
        """Read the records, and build the hazard curve.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        problems: list[str] = []
        hazard = None
        try:
            hazard = None if self.hazard is None else built("hazard", partial(hazard_as_stated, self.hazard), problems)
        except FileError as error:
            problems.append(f"hazard: {error}")
        try:
            records = self.records.build()
        except ConfigError as error:
            raise ConfigError([*problems, *error.problems]) from None
        if problems:
            raise ConfigError(problems)
        return InventorySite(records=records, hazard=hazard)


@dataclass(frozen=True, slots=True)
class InventorySetup:
    """Objects, sites and other arguments of `earthquakes.inventory`, read from a file."""

    objects: tuple[InventoryObject, ...]
    sites: dict[str, InventorySite]
    options: dict[str, Any]


class InventoryConfig(Config):
    """An inventory of objects, ranked by how probably they overturn.

    Parameters
    ----------
    objects
        Table of the objects: a CSV file, a workbook or a GeoPackage.
    carry
        Headings of columns of the table to carry through although they are or resemble a known name.
    defaults
        Values for empty cells and missing columns of the table, by name.
    model
        Kind of the model of all objects.
    records
        Records of the one site: a folder, a pattern or a list of files; or a table.
    hazard
        Hazard curve of the one site.
    sites
        Sites by name, in place of `records` and `hazard`: tables with these two keys.
    samples
        Number of samples of the uncertain numbers for each record.
    scales
        Factors of the records: numbers, or a table as for a fragility.
    limit_state
        Limit state of the ranking, such as "tilt 0.5 α".
    tail
        Free-vibration time after a record [s]; 20/`column.frequency_parameter` by default.
    seed
        Seed of samples and resamples.
    confidence
        Confidence level of intervals.
    resamples
        Number of bootstrap samples of the records for intervals of annual rates.
    rtol
        Relative tolerance.
    rest_energy
        Energy below which a column can come to rest, in c².
    max_steps
        Maximum number of integration steps.
    """

    objects: str
    carry: tuple[str, ...] = ()
    defaults: dict[str, float | str] = Field(default_factory=dict)
    model: str = DEFAULT_MODEL
    records: Annotated[RecordsConfig | None, BeforeValidator(as_source)] = None
    hazard: Hazard | None = None
    sites: dict[str, SiteConfig] = Field(default_factory=dict)
    samples: int = 20
    scales: tuple[float, ...] | Scales = (1.0,)
    limit_state: str = "overturning"
    tail: Seconds | None = None
    seed: int = 0
    confidence: float = 0.95
    resamples: int = 1000
    rtol: float = 1e-8
    rest_energy: float | None = None
    max_steps: int = 200_000

    def build(self) -> InventorySetup:
        """Read the table and the records, and build the arguments of `stylobate.earthquakes.inventory`.

        Raises
        ------
        ConfigError
            With one line for each invalid row or part.
        FileError
            If the table cannot be read.
        """
        problems: list[str] = []
        scales = self.scales if isinstance(self.scales, tuple) else built("scales", self.scales.build, problems)
        objects: tuple[InventoryObject, ...] = ()
        try:
            objects = read_inventory(Path(self.objects), model=self.model, defaults=self.defaults, carry=self.carry)
        except ConfigError as error:
            problems += error.problems
        sites: dict[str, InventorySite] = {}
        for name, site in self._sites(problems).items():
            try:
                sites[name] = site.build()
            except ConfigError as error:
                problems += [f"sites.{name}: {line}" if name else line for line in error.problems]
        if problems:
            raise ConfigError(problems)
        own = ("model", "samples", "limit_state", "tail", "seed", "confidence", "resamples")
        accuracy = [name for name in numbers_of(Accuracy) if name in type(self).model_fields]
        options = {name: getattr(self, name) for name in (*own, *accuracy)}
        return InventorySetup(objects, sites, {**options, "scales": scales})

    def _sites(self, problems: list[str]) -> Mapping[str, SiteConfig]:
        """Return the sites by name; the one site has the name ""."""
        one = self.records is not None or self.hazard is not None
        if one and self.sites:
            problems.append("records and sites: only one of them is allowed. Move the records into a site.")
        elif self.records is None and not self.sites:
            problems.append(
                'records: missing. Name a folder, such as records = "quakes", or give [sites.NAME] records.'
            )
        if self.records is None:
            return self.sites
        return {"": SiteConfig(records=self.records, hazard=self.hazard)}

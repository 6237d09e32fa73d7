from .basin import BasinConfig
from .hierarchy import HierarchyConfig
from .map import MapConfig
from .record_collection import EventConfig, RecordsConfig
from .record_files import relocated
from .records import RecordMotion
from .response import ResponseConfig
from .simulation import Setup, SimulationConfig, config_of, read_config
from .snippets import as_python, as_toml

__all__ = [
    "BasinConfig",
    "EventConfig",
    "HierarchyConfig",
    "MapConfig",
    "RecordMotion",
    "RecordsConfig",
    "ResponseConfig",
    "Setup",
    "SimulationConfig",
    "as_python",
    "as_toml",
    "config_of",
    "read_config",
    "relocated",
]

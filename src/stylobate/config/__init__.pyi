from .record_collection import EventConfig, RecordsConfig
from .records import RecordMotion, relocated
from .simulation import Setup, SimulationConfig, config_of, read_config
from .snippets import as_python, as_toml
from .study_config import study_config

__all__ = [
    "EventConfig",
    "RecordMotion",
    "RecordsConfig",
    "Setup",
    "SimulationConfig",
    "as_python",
    "as_toml",
    "config_of",
    "read_config",
    "relocated",
    "study_config",
]

from .record_collection import RecordsConfig
from .records import RecordMotion
from .simulation import SimulationConfig, config_of, read_config
from .study_config import study_config

__all__ = [
    "RecordMotion",
    "RecordsConfig",
    "SimulationConfig",
    "config_of",
    "read_config",
    "study_config",
]

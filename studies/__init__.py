"""Studies: stiffness over poses and parameters, and comparisons with published numbers."""

from strutwork.studies.azulay_dynamic import (
    AzulayDynamics,
    azulay_table_5,
    published_dynamic_ranking,
)
from strutwork.studies.budget_map import budget_map
from strutwork.studies.check_points import CheckPoints, area_weights, hemisphere
from strutwork.studies.comparison import (
    MODELS,
    AzulayComparison,
    compare_azulay,
    published_ranking,
    published_rows,
    variant,
)
from strutwork.studies.dataset_files import (
    read_netcdf,
    to_json,
    write_csv,
    write_json,
    write_long_csv,
    write_netcdf,
)
from strutwork.studies.dynamic import dynamic_stiffness, frequency_responses
from strutwork.studies.dynamic_map import Vibration, dynamic_map
from strutwork.studies.dynamic_sensitivity import (
    closed_form_stiffness,
    dynamic_link_lengths,
    mass_sensitivity,
    offset_sensitivity,
)
from strutwork.studies.executor import Executor, Threads, default_executor
from strutwork.studies.filters import AS_IN_AZULAY, Filters, PoseStatus
from strutwork.studies.link_lengths import LINK_LENGTHS, link_lengths
from strutwork.studies.plane_map import Fall, on_plane, plane_map, stiffness_falls
from strutwork.studies.progress import Lines, Progress
from strutwork.studies.published_table import PublishedRow, file_name, write_published
from strutwork.studies.removal_rate import RemovalExponents, removal_exponents
from strutwork.studies.scale import PowerLaw, ScaleStudy, power_law, scale_study
from strutwork.studies.similarity import ROLLERS, SIMILAR, UNSCALED, JointScaling, scaled
from strutwork.studies.statistics import (
    QUANTILES,
    AxisSummary,
    PoseValue,
    Statistics,
    Summary,
    statistics,
    summary,
)
from strutwork.studies.stiffness_map import stiffness_map
from strutwork.studies.sweep import sweep
from strutwork.studies.synthetic_measurement import SyntheticMeasurement, synthetic_measurement
from strutwork.studies.tolerance_result import ToleranceStudy
from strutwork.studies.tolerance_study import StudyOptions, tolerance_study
from strutwork.studies.toleranced_machines import TolerancedMachine, toleranced_machine

__all__ = [
    "AS_IN_AZULAY",
    "LINK_LENGTHS",
    "MODELS",
    "QUANTILES",
    "ROLLERS",
    "SIMILAR",
    "UNSCALED",
    "AxisSummary",
    "AzulayComparison",
    "AzulayDynamics",
    "CheckPoints",
    "Executor",
    "Fall",
    "Filters",
    "JointScaling",
    "Lines",
    "PoseStatus",
    "PoseValue",
    "PowerLaw",
    "Progress",
    "PublishedRow",
    "RemovalExponents",
    "ScaleStudy",
    "Statistics",
    "StudyOptions",
    "Summary",
    "SyntheticMeasurement",
    "Threads",
    "ToleranceStudy",
    "TolerancedMachine",
    "Vibration",
    "area_weights",
    "azulay_table_5",
    "budget_map",
    "closed_form_stiffness",
    "compare_azulay",
    "default_executor",
    "dynamic_link_lengths",
    "dynamic_map",
    "dynamic_stiffness",
    "file_name",
    "frequency_responses",
    "hemisphere",
    "link_lengths",
    "mass_sensitivity",
    "offset_sensitivity",
    "on_plane",
    "plane_map",
    "power_law",
    "published_dynamic_ranking",
    "published_ranking",
    "published_rows",
    "read_netcdf",
    "removal_exponents",
    "scale_study",
    "scaled",
    "statistics",
    "stiffness_falls",
    "stiffness_map",
    "summary",
    "sweep",
    "synthetic_measurement",
    "to_json",
    "tolerance_study",
    "toleranced_machine",
    "variant",
    "write_csv",
    "write_json",
    "write_long_csv",
    "write_netcdf",
    "write_published",
]

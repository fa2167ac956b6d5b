"""Studies: stiffness over poses and parameters, and comparisons with published numbers."""

from studies.budget_map import budget_map
from studies.check_points import CheckPoints, area_weights, hemisphere
from studies.comparison import (
    MODELS,
    AzulayComparison,
    compare_azulay,
    published_ranking,
    published_rows,
    variant,
)
from studies.dataset_files import read_netcdf, to_json, write_csv, write_json, write_netcdf
from studies.executor import Executor, Threads, default_executor
from studies.filters import AS_IN_AZULAY, Filters, PoseStatus
from studies.link_lengths import LINK_LENGTHS, link_lengths
from studies.progress import Lines, Progress
from studies.published_table import PublishedRow, file_name, write_published
from studies.statistics import (
    QUANTILES,
    AxisSummary,
    PoseValue,
    Statistics,
    Summary,
    statistics,
    summary,
)
from studies.stiffness_map import stiffness_map
from studies.sweep import sweep

__all__ = [
    "AS_IN_AZULAY",
    "LINK_LENGTHS",
    "MODELS",
    "QUANTILES",
    "AxisSummary",
    "AzulayComparison",
    "CheckPoints",
    "Executor",
    "Filters",
    "Lines",
    "PoseStatus",
    "PoseValue",
    "Progress",
    "PublishedRow",
    "Statistics",
    "Summary",
    "Threads",
    "area_weights",
    "budget_map",
    "compare_azulay",
    "default_executor",
    "file_name",
    "hemisphere",
    "link_lengths",
    "published_ranking",
    "published_rows",
    "read_netcdf",
    "statistics",
    "stiffness_map",
    "summary",
    "sweep",
    "to_json",
    "variant",
    "write_csv",
    "write_json",
    "write_netcdf",
    "write_published",
]

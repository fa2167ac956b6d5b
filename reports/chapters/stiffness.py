"""Stiffness over the hemisphere: maps, distributions, extreme and dropped poses."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from strutwork.reports.content import Column, Figure, Table
from strutwork.reports.data_files import DataFile
from strutwork.reports.figures.maps import hemisphere_map
from strutwork.reports.numbers import count, micro, share, significant
from strutwork.studies import QUANTILES, PoseStatus, PoseValue, Summary, write_csv, write_netcdf

AXES = ("x", "y", "z")

VIEW = (
    "The hemisphere is seen from above, with one cell for each check point: the middle of a disc "
    "is the pole, and its rim is the equator, where the platform stands upright. Each disc has "
    "its own scale; ▽ marks the worst point, ▲ the best."
)


def map_figure(
    dataset: xr.Dataset,
    axis: str,
    key: str,
    label: str,
    data: str,
    limits: tuple[float, float] | None = None,
    small: bool = False,
    ring: tuple[float, float] | None = None,
) -> Figure:
    """The blocked stiffness along one axis over the check points, N/µm; a ring as in the map."""
    values = axis_values(dataset, axis)
    position, normal = dataset["position"].to_numpy(), dataset["normal"].to_numpy()
    roll = np.degrees(dataset["roll"].to_numpy())
    middle = [float(v) for v in 1e3 * position.mean(axis=0)[:2]]
    hover = [
        f"K{axis * 2} {value:.3f} N/µm<br>x {1e3 * p[0]:.1f}, y {1e3 * p[1]:.1f}, "
        f"z {1e3 * p[2]:.1f} mm<br>tilt {tilt(n):.0f}°, roll {r:.0f}°"
        if np.isfinite(value)
        else f"K{axis * 2} infinite: the tool cannot move this way<br>x {1e3 * p[0]:.1f}, y "
        f"{1e3 * p[1]:.1f} mm"
        if np.isinf(value)
        else f"no valid pose<br>x {1e3 * p[0]:.1f}, y {1e3 * p[1]:.1f} mm"
        for value, p, n, r in zip(values, position, normal, roll, strict=True)
    ]
    shown = values[np.isfinite(values)]
    low, high = (float(shown.min()), float(shown.max())) if shown.size else (np.inf, np.inf)
    values = np.where(np.isfinite(values), values, np.nan)
    return Figure(
        key,
        f"K{axis * 2}, {label}: {significant(low)} to {significant(high)} N/µm.",
        hemisphere_map(position, values, f"K{axis * 2} (N/µm)", hover, limits, small, ring),
        f"Disc seen from above of K{axis * 2} over {len(values)} check points about "
        f"x {middle[0]:.0f}, y {middle[1]:.0f} mm, from {low:.2f} to {high:.2f} N/µm; {label}.",
        data,
        height=0,
    )


def map_files(dataset: xr.Dataset, name: str, what: str) -> tuple[DataFile, DataFile]:
    """A map as NetCDF and as CSV."""
    return (
        DataFile(f"{name}.nc", f"{what}: everything, NetCDF", lambda p: write_netcdf(p, dataset)),
        DataFile(
            f"{name}.csv", f"{what}: one line per check point", lambda p: write_csv(p, dataset)
        ),
    )


def axis_values(dataset: xr.Dataset, axis: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Blocked stiffness along an axis, N/µm, (n,); NaN where no pose counts, may be infinite."""
    values = dataset["stiffness_blocked"].sel(direction=axis).to_numpy() / 1e6
    return np.where(dataset["status"].to_numpy() == PoseStatus.GOOD, values, np.nan)


def statistics_table(title: str, summaries: Mapping[str, Summary]) -> Table:
    """Mean, variance, quantiles and extremes for each axis."""
    columns = [Column("axis", "", False), Column("model", "", False), Column("mean", "N/µm")]
    columns += [Column("variance", "N²/µm²"), Column("minimum", "N/µm")]
    columns += [Column(f"{100 * q:.0f} %", "N/µm") for q in QUANTILES]
    columns += [Column("maximum", "N/µm"), Column("points", "")]
    rows = []
    for axis in AXES:
        for label, found in summaries.items():
            entry = found.axis(axis)
            s = entry.statistics
            rows.append(
                [
                    f"K{axis * 2}",
                    label,
                    micro(s.mean, 4),
                    significant(s.variance / 1e12),
                    micro(entry.worst.value),
                    *(micro(q) for q in s.quantiles),
                    micro(entry.best.value),
                    str(s.count),
                ]
            )
    return Table(title, columns, rows, "report.json")


def pose_columns(first: str) -> list[Column]:
    """Columns of `pose_rows`."""
    return [
        Column(first, "", False),
        Column("axis", "", False),
        Column("", "", False),
        Column("stiffness", "N/µm"),
        Column("x", "mm"),
        Column("y", "mm"),
        Column("z", "mm"),
        Column("tilt", "deg"),
        Column("roll", "deg"),
    ]


def pose_rows(label: str, dataset: xr.Dataset, found: Summary) -> list[list[str]]:
    """Worst and best pose for each axis."""
    normal = dataset["normal"].to_numpy()

    def row(axis: str, word: str, pose: PoseValue) -> list[str]:
        places = [f"{1e3 * v:.2f}".replace("-", "−") for v in pose.position]
        roll = "" if pose.roll is None else f"{np.degrees(pose.roll):.0f}"
        return [
            label,
            f"K{axis * 2}",
            word,
            micro(pose.value),
            *places,
            f"{tilt(normal[pose.index]):.0f}",
            roll,
        ]

    return [
        row(axis, word, pose)
        for axis in AXES
        for word, pose in (("worst", found.axis(axis).worst), ("best", found.axis(axis).best))
    ]


def dropped_table(maps: Mapping[str, xr.Dataset], first: str) -> Table:
    """Candidates kept and dropped, by reason."""
    rows = []
    for label, dataset in maps.items():
        total = int(dataset.attrs["candidates"])
        rows.append([label, "kept", *of_total(int(dataset.attrs["candidates_kept"]), total)])
        for reason, number in json.loads(dataset.attrs["dropped_by_reason"]).items():
            rows.append([label, f"dropped: {reason}", *of_total(int(number), total)])
        lost = dataset.sizes["point"] - int(dataset.attrs["points_kept"])
        if lost:
            rows.append([label, f"{count(lost, 'check point')} without a valid candidate", "", ""])
    columns = (
        Column(first, "", False),
        Column("", "", False),
        Column("candidates"),
        Column("share"),
    )
    return Table("Candidate poses, kept and dropped", columns, rows, "report.json")


def of_total(number: int, total: int) -> list[str]:
    """A number and its share, as two cells."""
    return [str(number), share(number / total)]


def tilt(normal: Any) -> float:
    """Angle of a unit vector from the vertical, deg."""
    return float(np.degrees(np.arccos(np.clip(normal[2], -1.0, 1.0))))

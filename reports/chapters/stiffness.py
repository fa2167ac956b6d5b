"""Stiffness over the hemisphere: maps, distributions, extreme and dropped poses."""

from __future__ import annotations

import json
from collections.abc import Mapping

import numpy as np
import xarray as xr

from strutwork.reports.chapters.machine import AXES, tilt
from strutwork.reports.content import Block, Chapter, Column, Figure, Row, Table, Text
from strutwork.reports.data_files import DataFile
from strutwork.reports.figures.charts import distributions
from strutwork.reports.figures.maps import hemisphere_map
from strutwork.reports.machine_study import MODEL_NAMES, MachineStudy
from strutwork.reports.numbers import count, micro, share, significant
from strutwork.studies import QUANTILES, PoseStatus, PoseValue, Summary, write_csv, write_netcdf

VIEW = (
    "Seen from above, one cell for each check point: the middle of a disc is the pole, its rim the "
    "equator of the hemisphere, where the platform stands upright. Each disc has its own scale; "
    "▽ marks the worst point, ▲ the best."
)


def map_chapter(study: MachineStudy) -> Chapter:
    """A disc for each axis and joint model."""
    blocks: list[Block] = [Text(VIEW)]
    files: list[DataFile] = []
    for model, label in MODEL_NAMES.items():
        name = f"stiffness-map-{model}"
        blocks.append(
            Row(
                tuple(
                    map_figure(study.maps[model], axis, f"map-{model}-{axis}", label, f"{name}.csv")
                    for axis in AXES
                )
            )
        )
        files += map_files(study.maps[model], name, f"stiffness map, {label}")
    return Chapter("maps", "Stiffness over the hemisphere", tuple(blocks), tuple(files))


def map_figure(
    dataset: xr.Dataset,
    axis: str,
    key: str,
    label: str,
    data: str,
    limits: tuple[float, float] | None = None,
    small: bool = False,
) -> Figure:
    """The blocked stiffness along one axis over the check points, N/µm."""
    values = axis_values(dataset, axis)
    position, normal = dataset["position"].to_numpy(), dataset["normal"].to_numpy()
    roll = np.degrees(dataset["roll"].to_numpy())
    middle = [float(v) for v in 1e3 * position.mean(axis=0)[:2]]
    hover = [
        f"K{axis * 2} {value:.3f} N/µm<br>x {1e3 * p[0]:.1f}, y {1e3 * p[1]:.1f}, "
        f"z {1e3 * p[2]:.1f} mm<br>tilt {tilt(n):.0f}°, roll {r:.0f}°"
        if np.isfinite(value)
        else f"K{axis * 2} infinite: the tool cannot move so<br>x {1e3 * p[0]:.1f}, "
        f"y {1e3 * p[1]:.1f} mm"
        if np.isinf(value)
        else f"no pose counts<br>x {1e3 * p[0]:.1f}, y {1e3 * p[1]:.1f} mm"
        for value, p, n, r in zip(values, position, normal, roll, strict=True)
    ]
    shown = values[np.isfinite(values)]
    low, high = (float(shown.min()), float(shown.max())) if shown.size else (np.inf, np.inf)
    values = np.where(np.isfinite(values), values, np.nan)
    return Figure(
        key,
        f"K{axis * 2}, {label}: {significant(low)} to {significant(high)} N/µm.",
        hemisphere_map(position, values, f"K{axis * 2} (N/µm)", hover, limits, small),
        f"Disc seen from above of K{axis * 2} over {len(values)} check points about "
        f"x {middle[0]:.0f}, y {middle[1]:.0f} mm, from {low:.2f} to {high:.2f} N/µm; {label}.",
        data,
        height=0,
    )


def map_files(dataset: xr.Dataset, name: str, what: str) -> tuple[DataFile, DataFile]:
    """A map as NetCDF and as CSV."""
    return (
        DataFile(f"{name}.nc", f"{what}: everything, NetCDF", lambda p: write_netcdf(p, dataset)),
        DataFile(f"{name}.csv", f"{what}: one line a check point", lambda p: write_csv(p, dataset)),
    )


def axis_values(dataset: xr.Dataset, axis: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Blocked stiffness along an axis, N/µm, (n,); NaN where no pose counts, may be infinite."""
    values = dataset["stiffness_blocked"].sel(direction=axis).to_numpy() / 1e6
    return np.where(dataset["status"].to_numpy() == PoseStatus.GOOD, values, np.nan)


def distribution_chapter(study: MachineStudy) -> Chapter:
    """Boxes and statistics of both joint models, and both meanings of stiffness."""
    every = np.concatenate([axis_values(d, a) for d in study.maps.values() for a in AXES])
    top = float(every[np.isfinite(every)].max(initial=0.0)) or 1.0
    figures = []
    for model, label in MODEL_NAMES.items():
        values = {f"K{a * 2}": axis_values(study.maps[model], a) for a in AXES}
        spec = distributions(
            {k: v[np.isfinite(v)] for k, v in values.items()}, "stiffness (N/µm)", top=1.05 * top
        )
        figures.append(
            Figure(
                f"distribution-{model}",
                f"{label[0].upper()}{label[1:]}: every check point; box at the quartiles, "
                "line at the median, dashed at the mean, whiskers to 1.5 times the box's height.",
                spec,
                f"Boxes of Kxx, Kyy and Kzz over the check points, {label}.",
                f"stiffness-map-{model}.csv",
                height=380,
            )
        )
    blocks: list[Block] = [
        Text("(C⁻¹)_ii, other directions blocked; every check point counts once."),
        Row(tuple(figures), 340),
        statistics_table(
            "Other directions blocked, (C⁻¹)_ii",
            {label: study.summaries[m] for m, label in MODEL_NAMES.items()},
        ),
        statistics_table(
            "Other directions free to follow, 1/C_ii: the softer meaning, at the same poses",
            {label: study.free[m] for m, label in MODEL_NAMES.items()},
        ),
    ]
    return Chapter("distributions", "Distributions", tuple(blocks))


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


def poses_chapter(study: MachineStudy) -> Chapter:
    """The extreme poses of each axis, and what was dropped."""
    rows = [
        row
        for model, label in MODEL_NAMES.items()
        for row in pose_rows(label, study.maps[model], study.summaries[model])
    ]
    table = Table("Worst and best poses", pose_columns("model"), rows, "report.json")
    dropped = dropped_table({label: study.maps[m] for m, label in MODEL_NAMES.items()}, "model")
    return Chapter(
        "poses",
        "Worst poses and dropped poses",
        (
            table,
            Text(
                "At every check point each roll is a candidate; those out of reach, out of the "
                "joint ranges kept or near a singularity are dropped. A point is lost only when no "
                "candidate is left."
            ),
            dropped,
            ranges_table(study),
        ),
    )


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
        rows.append([label, "kept", *_of(int(dataset.attrs["candidates_kept"]), total)])
        for reason, number in json.loads(dataset.attrs["dropped_by_reason"]).items():
            rows.append([label, f"dropped: {reason}", *_of(int(number), total)])
        lost = dataset.sizes["point"] - int(dataset.attrs["points_kept"])
        if lost:
            rows.append([label, f"{count(lost, 'check point')} without any candidate left", "", ""])
    columns = (
        Column(first, "", False),
        Column("", "", False),
        Column("candidates"),
        Column("share"),
    )
    return Table("Candidate poses, by what became of them", columns, rows, "report.json")


def ranges_table(study: MachineStudy) -> Table:
    """How many candidates each kind of joint range would drop, kept or not."""
    rows = []
    for model, label in MODEL_NAMES.items():
        dataset = study.maps[model]
        total = int(dataset.attrs["candidates"])
        kept = json.loads(dataset.attrs["joint_ranges_kept"])
        for kind, number in zip(
            dataset["joint_kind"].to_numpy(),
            dataset["outside_range"].to_numpy().sum(axis=0),
            strict=True,
        ):
            word = "kept" if kept == "all" or kind in kept else "not kept"
            rows.append([label, f"{kind} joints", word, *_of(int(number), total)])
    columns = (
        Column("model", "", False),
        Column("ranges of the", "", False),
        Column("", "", False),
        Column("candidates outside"),
        Column("share"),
    )
    return Table("Candidates outside the joint ranges of Table 3", columns, rows, "report.json")


def _of(number: int, total: int) -> list[str]:
    return [str(number), share(number / total)]

"""How far the joints move over the workspace."""

from __future__ import annotations

from math import degrees

import numpy as np

from strutwork.reports.content import Block, Chapter, Note, Text
from strutwork.reports.joint_ranges import JointRange, range_blocks, range_file
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import grid_text

KEY = "motion"
TITLE = "How far do its joints move?"
FILE = "joint-ranges.csv"

#: A support whose free direction moves by less, mm or deg, is left out.
STILL = 1e-6


def missing(subject: Subject) -> str:
    """Why there is nothing to say; empty where there is."""
    return subject.unmoved


def write(subject: Subject) -> Chapter:
    """Range of every joint coordinate over the workspace beside its limits."""
    found, model = subject.stiffness_survey, subject.model
    names = model.motion.joints.names
    values = found["joint_coordinate"].to_numpy().reshape(-1, len(names))
    home = model.motion.home_values
    driven = set(model.structure.linkage.driven)
    limits = {(limit.joint, limit.coordinate): limit for limit in model.limits}
    held = set(model.supports.values())
    ranges = []
    for k, (joint, direction) in enumerate(names):
        turns = direction.startswith("r")
        factor = degrees(1.0) if turns else 1e3
        span = factor * values[:, k]
        low, high = float(np.nanmin(span)), float(np.nanmax(span))
        if joint in held and high - low <= STILL:
            # a support that leaves a direction free is no joint that a reader looks for
            continue
        limit = limits.get((joint, direction))
        ranges.append(
            JointRange(
                joint,
                direction,
                (joint, direction) in driven,
                factor * float(home[k]),
                low,
                high,
                None if limit is None else (factor * limit.low, factor * limit.high),
            )
        )
    blocks: list[Block] = [
        Text(
            f"The ranges cover the reachable ones of {grid_text(subject.grid)}. They follow from "
            "the joints alone, without a formula of the machine. Rotations are counted "
            "continuously from home; the three of a spherical joint are the components of its "
            "rotation vector."
        ),
        *range_blocks(ranges, FILE),
    ]
    free = found.attrs["poses"] - found.attrs["poses_kept"]
    if free:
        blocks.append(
            Note(
                f"{free} of {found.attrs['poses']} poses are excluded; the chapter on stiffness "
                "over the workspace says why. Those that are only outside a joint's limits are "
                "in the ranges above."
            )
        )
    return Chapter(KEY, TITLE, tuple(blocks), (range_file(ranges, FILE),))

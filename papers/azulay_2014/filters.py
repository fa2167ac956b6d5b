"""Which poses count for the paper's tables."""

from __future__ import annotations

from strutwork.studies.filters import Filters

#: What comes closest to the tables of Azulay et al. 2014: of the joint ranges only the revolute
#: joints' (5° to 70°). With the others the published means are out of reach.
AS_IN_AZULAY = Filters(joint_kinds=("revolute",))

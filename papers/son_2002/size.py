"""The MIT-SS-1 larger and smaller: stiffness, frequencies, removal rate (Son 2002, chapter 3)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from strutwork.machines.model_file import parse_model
from strutwork.machines.model_templates import template
from strutwork.papers.son_2002.calibrated import calibrated_machine
from strutwork.studies.scale import FACTORS, LAWS, ScaleStudy, scale_study
from strutwork.studies.similarity import ROLLERS, SIMILAR, JointScaling

#: Frequencies: with the granite the first six are those of the mounts.
MODES, MODES_WHOLE = 4, 10

#: The two kinds of machine in Fig. 9, as templates of model files: dimensions of assumed.
FIGURE_9 = {"hexapod": "6-UPS", "serial machine": "gantry"}

#: Sizes and laws at which they are compared; the first law is section 3.3's.
SIZES, COMPARED = (0.5, 1.0, 2.0), (SIMILAR, ROLLERS)


def figure_9_scale(machine: str) -> ScaleStudy:
    """Scale study of a hexapod or a serial machine at home, joints similar and on rollers.

    Parameters
    ----------
    machine : str
        A key of `FIGURE_9`.

    Returns
    -------
    ScaleStudy
        Of the lowest two frequencies.
    """
    model = parse_model(template(FIGURE_9[machine]))
    return scale_study(model.placed, SIZES, COMPARED, 2)


def mit_ss1_scale(
    factors: Sequence[float] = FACTORS,
    laws: Sequence[JointScaling] = LAWS,
    *,
    granite: bool = False,
    folder: Path | None = None,
) -> ScaleStudy:
    """Scale study of the MIT-SS-1 at home.

    The machine is the one calibrated to the thesis's finite element model. Its bearings, and with
    the granite its mounts, follow the laws; struts and granite are similar.

    Parameters
    ----------
    factors : sequence of float
        Sizes beside the machine's own.
    laws : sequence of JointScaling
    granite : bool
        With the granite, a solid, on its mounts; without it the rails stand still.
    folder : Path, optional
        Of stored superelements.

    Returns
    -------
    ScaleStudy
    """
    whole = calibrated_machine(folder=folder)
    if granite:
        placed = whole.structure.at(whole.place(whole.home()))
        return scale_study(placed, factors, laws, MODES_WHOLE)
    moving = whole.machine
    return scale_study(moving.structure.at(moving.place(moving.home())), factors, laws, MODES)

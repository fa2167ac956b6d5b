"""Which designs have gradients, and why others have none."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.studies.design_quantities import COST, MEAN, OF_JOINTS, REACH, Quantity
from strutwork.studies.design_terms import EVOLUTION, GRADIENT, Objective, Search
from strutwork.studies.parameter import Varied
from strutwork.studies.variables import AXES

#: What to do instead.
_REMEDY = f'Choose method = "{EVOLUTION}", which needs no gradients.'

_LOCKED = "it is a sum of sizes, whose slope jumps where a force changes its sign"
_MOTION = "what a parameter does to the Jacobian is not differentiated"

#: Why quantities have no gradient.
_WHY: Mapping[str, str] = {
    "reach": "it counts poses, and changes in steps",
    "locked_in_force": _LOCKED,
    "locked_in_moment": _LOCKED,
    "condition": _MOTION,
    "least_amplification": _MOTION,
    "largest_amplification": _MOTION,
}

#: Quantities of vibration, with those of `strutwork.studies.gradient_quantities` that they are.
_VIBRATION: Mapping[str, tuple[str, ...]] = {
    "first_frequency": ("frequency_1",),
    "lowest_frequency": ("frequency_1",),
    "least_dynamic_stiffness": tuple(f"least_dynamic_stiffness_{a}" for a in AXES),
    **{f"least_dynamic_stiffness_{a}": (f"least_dynamic_stiffness_{a}",) for a in AXES},
}

#: Quantities that no pose changes: they are taken at home.
AT_HOME = ("mass", "first_frequency", COST)


def smooth_names(quantity: Quantity) -> tuple[str, ...]:
    """The quantities with gradients that a quantity of a design is the least or the mean of.

    Parameters
    ----------
    quantity : Quantity
        One that has a gradient.

    Returns
    -------
    tuple of str
        As `strutwork.studies.gradient_quantities.read_quantity` takes them.
    """
    if quantity.name == COST:
        return ("mass",)
    name = quantity.name.removeprefix(f"{MEAN}_")
    return _VIBRATION.get(name, (name,))


def require_smooth(
    search: Search,
    objectives: Sequence[Objective],
    quantities: Sequence[Quantity],
    varied: Sequence[Varied],
    model: Model,
) -> None:
    """Refuse a search along gradients of what has none.

    Parameters
    ----------
    search : Search
    objectives : sequence of Objective
    quantities : sequence of Quantity
        Of objectives and constraints.
    varied : sequence of Varied
    model : Model
        As stated.

    Raises
    ------
    ModelError
        A quantity without gradient (the message says why), several objectives, or parameters that
        have lists of values.
    """
    if search.method == EVOLUTION:
        return
    if search.method == GRADIENT and len(objectives) > 1:
        raise ModelError(
            "search",
            f"follows the gradient of one objective, and there are {len(objectives)}.",
            'State the others as constraints, or choose method = "both" for a front.',
        )
    lists = [p.name for p in varied if p.values]
    if lists and (search.method == GRADIENT or len(lists) == len(varied)):
        raise ModelError(
            f"parameter {lists[0]}",
            "has a list of values, between which there is no gradient.",
            f"Give it a range. {_REMEDY}",
        )
    for quantity in quantities:
        why = _WHY.get(quantity.name.removeprefix(f"{MEAN}_"), "")
        if quantity.name.startswith(f"{REACH}_"):
            why = _WHY[REACH]
        if quantity.reduction in OF_JOINTS:
            why = "what a parameter does to the coordinates of joints is not differentiated"
        if not why and quantity.name in _VIBRATION and model.preload is not None:
            why = (
                f'the machine vibrates under "{model.preload}", and what a parameter does to the '
                "forces of this case is not differentiated"
            )
        if why:
            raise ModelError(
                f"quantity {quantity.name.replace('_', ' ')}", f"has no gradient: {why}.", _REMEDY
            )

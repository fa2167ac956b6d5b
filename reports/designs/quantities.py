"""What two machines are asked, question by question."""

from __future__ import annotations

from dataclasses import dataclass

from strutwork.kinematics import DIRECTIONS
from strutwork.reports.designs.row import Quantity

AXES = DIRECTIONS[:3]

#: Frequencies that are compared.
LISTED = 3


@dataclass(frozen=True)
class Question:
    """Several quantities with what is better of them.

    Parameters
    ----------
    key : str
    title : str
        Of its table; `{where}` stands for where the machines stand.
    asks : str
        The same as a question.
    criterion : str
        Which of two answers is better, a sentence.
    """

    key: str
    title: str
    asks: str
    criterion: str


QUESTIONS: tuple[Question, ...] = (
    Question(
        "home",
        "Stiffness at the tool {where}",
        "How stiff are they {where}?",
        "The stiffer machine is better.",
    ),
    Question(
        "worst",
        "Least stiffness at the tool over the workspace",
        "How stiff are they at worst?",
        "The machine that is stiffer at its worst pose is better.",
    ),
    Question(
        "vibration",
        "Vibration {where}",
        "How do they vibrate?",
        "The higher frequency and the larger dynamic stiffness are better.",
    ),
    Question("mass", "Mass {where}", "How heavy are they?", "The lighter machine is better."),
    Question(
        "mobility",
        "Mobility and redundancy {where}",
        "How do they move, and what is redundant?",
        "Less mobility with the drives held, fewer redundant constraints and fewer surplus drives "
        "are better, because redundancy locks forces in. Of the other numbers neither is better.",
    ),
    Question(
        "forces",
        "Largest assembly forces {where}",
        "Which forces do their tolerances lock in?",
        "The smaller force, deviation and share of a limit are better.",
    ),
    Question(
        "reach",
        "Workspace",
        "How much of the workspace do they reach?",
        "The machine that reaches more of its poses is better.",
    ),
    Question(
        "counts",
        "What they are made of",
        "What are they made of?",
        "None of these numbers is better than another.",
    ),
)


def _stiffness(question: str, lead: str) -> list[Quantity]:
    made = []
    for meaning in ("free", "blocked"):
        for d in DIRECTIONS:
            turns = d.startswith("r")
            made.append(
                Quantity(
                    f"{question}_stiffness_{meaning}_{d}",
                    question,
                    f"{lead}{'about' if turns else 'along'} {d[-1]}, others {meaning}",
                    "N*m/rad" if turns else "N/m",
                    "more",
                )
            )
    return made


QUANTITIES: tuple[Quantity, ...] = (
    *_stiffness("home", ""),
    *_stiffness("worst", ""),
    *(
        Quantity(f"frequency_{k}", "vibration", f"natural frequency {k}", "Hz", "more")
        for k in range(1, LISTED + 1)
    ),
    *(
        Quantity(
            f"least_dynamic_stiffness_{d}",
            "vibration",
            f"least dynamic stiffness along {d}",
            "N/m",
            "more",
        )
        for d in AXES
    ),
    Quantity("mass", "mass", "mass", "kg", "less"),
    Quantity("mobility", "mobility", "mobility, drives free", "1"),
    Quantity("tool_freedoms", "mobility", "degrees of freedom of the tool", ""),
    Quantity("mobility_locked", "mobility", "mobility, drives held", "1", "less"),
    Quantity("drives", "mobility", "drives", "1"),
    Quantity("surplus_drives", "mobility", "surplus drives", "1", "less"),
    Quantity("redundant_constraints", "mobility", "redundant constraints", "1", "less"),
    Quantity("locked_force", "forces", "force in a joint", "N", "less"),
    Quantity("locked_moment", "forces", "moment in a joint", "N*m", "less"),
    Quantity("limit_used", "forces", "share of a limit", "%", "less"),
    Quantity("tool_deviation", "forces", "deviation of the tool", "m", "less"),
    Quantity("poses_taken", "reach", "poses reached, of those requested", "%", "more"),
    Quantity("poses", "reach", "poses requested", "1"),
    Quantity("bodies", "counts", "bodies", "1"),
    Quantity("joints", "counts", "joints", "1"),
    Quantity("nodes", "counts", "nodes", "1"),
    Quantity("beams", "counts", "beams", "1"),
    Quantity("springs", "counts", "springs", "1"),
    Quantity("solids", "counts", "solids", "1"),
    Quantity("tolerances", "counts", "tolerances", "1"),
    Quantity("degrees_of_freedom", "counts", "degrees of freedom of the flexible model", "1"),
)


def of_question(key: str) -> tuple[Quantity, ...]:
    """The quantities of a question.

    Parameters
    ----------
    key : str
    """
    return tuple(q for q in QUANTITIES if q.question == key)

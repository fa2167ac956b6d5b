"""The documents that the machines come from."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Paper:
    """A document.

    Parameters
    ----------
    key : str
        Short name, used in the names of tables.
    citation : str
    page : str
        What writes a page about the document itself, as `MODULE:FUNCTION` of `papers`, see
        `strutwork.machines.paper_reference.resolve`; empty where there is none.
    """

    key: str
    citation: str
    page: str = ""


AZULAY_2014 = Paper(
    "azulay-2014",
    "H. Azulay, M. Mahmoodi, R. Zhao, J. K. Mills, B. Benhabib: Comparative analysis of a new "
    "3xPPRS parallel kinematic mechanism. Robotics and Computer-Integrated Manufacturing 30 "
    "(2014).",
    "strutwork.papers.azulay_2014.comparison_page:comparison_chapters",
)

SON_2002 = Paper(
    "son-2002",
    "S.-K. Son: A hybrid type small 5-axis CNC milling machine. PhD thesis, Massachusetts "
    "Institute of Technology (2002).",
    "strutwork.papers.son_2002.document_page:document_chapters",
)

KIM_2001 = Paper(
    "kim-2001",
    "J. Kim, F. C. Park, S. J. Ryu, J. Kim, J. C. Hwang, C. Park, C. C. Iurascu: Design and "
    "analysis of a redundantly actuated parallel mechanism for rapid machining. IEEE Transactions "
    "on Robotics and Automation 17 (2001).",
    "strutwork.papers.kim_2001.pages:paper_chapters",
)

CORBEL_2008 = Paper(
    "corbel-2008",
    "D. Corbel, O. Company, F. Pierrot: Optimal design of a 6-dof parallel measurement mechanism "
    "integrated in a 3-dof parallel machine-tool. IEEE/RSJ International Conference on Intelligent "
    "Robots and Systems (2008).",
    "strutwork.papers.corbel_2008.pages:paper_chapters",
)

CHABLAT_2003 = Paper(
    "chablat-2003",
    "D. Chablat, P. Wenger, F. Majou: The optimal design of three degree-of-freedom parallel "
    "mechanisms for machining applications. International Conference on Advanced Robotics (2003).",
    "strutwork.papers.chablat_2003.pages:paper_chapters",
)

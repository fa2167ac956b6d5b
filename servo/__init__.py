"""Controllers of drives around a structure: poles, margins, stiffness with them in the loop."""

from strutwork.machines.servos import Servo
from strutwork.servo.closed_loop import ClosedLoop, DriveMargins, UnstableLoopError, closed_loop
from strutwork.servo.least import LeastStiffness, least_stiffness
from strutwork.servo.loop_poles import LoopPole, loop_poles
from strutwork.servo.margins import Margins, loop_margins

__all__ = [
    "ClosedLoop",
    "DriveMargins",
    "LeastStiffness",
    "LoopPole",
    "Margins",
    "Servo",
    "UnstableLoopError",
    "closed_loop",
    "least_stiffness",
    "loop_margins",
    "loop_poles",
]

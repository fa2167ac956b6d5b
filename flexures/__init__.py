"""Flexures: notch hinges, leaf springs and cross-spring pivots as joints with a 6 x 6 stiffness."""

from strutwork.flexures.cross_spring import CrossSpring
from strutwork.flexures.flexure import Flexure
from strutwork.flexures.leaf import Leaf
from strutwork.flexures.notch import CircularNotch, EllipticNotch

__all__ = ["CircularNotch", "CrossSpring", "EllipticNotch", "Flexure", "Leaf"]

"""The MIT-SS-1 half and twice as large: what its bearings make of similarity.

A study in Python: stiffness, frequencies and the deflection at constant removal rate against the
size of a machine, under three laws for its bearings and one user-defined law.

$ python examples/07_scale_mit_ss1.py
> similar joints
> roller bearings
> unscaled joints
> half a power
"""

from strutwork.kinematics import DIRECTIONS
from strutwork.papers.son_2002.size import mit_ss1_scale
from strutwork.studies.removal_rate import removal_exponents
from strutwork.studies.scale import LAWS
from strutwork.studies.similarity import JointScaling

# bearings chosen one size smaller than similarity would: a law of one's own beside the thesis's
laws = (*LAWS, JointScaling(0.5, name="half a power"))
study = mit_ss1_scale((0.5, 0.7, 1.0, 1.4, 2.0), laws)

print("exponents of the size      x      y      z     f 1     f 2")
for i, law in enumerate(laws):
    stiffness = study.stiffness_law(i).exponent[:3]
    frequency = study.frequency_law(i).exponent[:2]
    numbers = "".join(f"{v:7.3f}" for v in stiffness) + "".join(f"{v:8.3f}" for v in frequency)
    print(f"{law!s:20}{numbers}")

print()
print("bearings' share in the deflection:")
for axis, share in zip(DIRECTIONS[:3], study.joint_share, strict=False):
    print(f"  {axis}: {100 * share:.1f} %")

print()
print("deflection at constant removal rate, drives' force ~ L^n, similar machine:")
for n in (1.0, 3.0, 3.5):
    print(f"  n = {n:g}: L^{removal_exponents(n).deflection:g}")

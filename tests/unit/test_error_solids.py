"""Temperatures in solids of a machine, against closed forms."""

import pickle
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError, StrutworkError
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.meshes import block, joined, write_mesh
from strutwork.meshes import moved as shifted
from strutwork.studies.error_causes import error_sheet
from strutwork.studies.error_file import parse_errors
from strutwork.studies.error_solid_heat import HeatFlow, SolidField, solid_heat

E, ALPHA = 200e9, 12e-6
LENGTH, WIDTH, DEPTH = 0.4, 0.04, 0.06

#: A block along x, held at one end and free at the other.
BLOCK = f"""
[materials.steel]
youngs_modulus = {E}
poissons_ratio = 0.3
density = 7800
[nodes]
A = [0, 0, 0]
B = [{LENGTH}, 0, 0]
[[solids]]
name = "bar"
shape = "block"
size = [{LENGTH}, {WIDTH}, {DEPTH}]
position = [0, {-WIDTH / 2}, {-DEPTH / 2}]
material = "steel"
cell = "30 mm"
modes = 6
[[solids.interfaces]]
node = "A"
patch = "-x"
[[solids.interfaces]]
node = "B"
patch = "+x"
[[supports]]
node = "A"
fixed = "all"
[tool]
tcp = "B"
"""
RIGID = BLOCK.replace('"-x"', '"-x"\nkind = "rigid"').replace('"+x"', '"+x"\nkind = "rigid"')
STEEL = f"expansion = {{ steel = {ALPHA} }}\n"


def moved(model: Model, text: str) -> np.ndarray:
    return error_sheet(model, parse_errors(STEEL + text, "test", model)).mean


@pytest.mark.parametrize("text", [BLOCK, RIGID], ids=["average", "rigid"])
def test_a_free_block_grows_without_bending(text: str) -> None:
    """Pure expansion α ΔT L, uniform and by a profile that is constant."""
    model = parse_model(text)
    expected = [ALPHA * 10 * LENGTH, 0, 0, 0, 0, 0]
    for entry in (
        'change = "10 K"',
        'profile = { axis = [1, 0, 0], places = [0, 0.3], changes = ["10 K", "10 K"] }',
    ):
        found = moved(model, f'[[temperatures]]\npart = "bar"\n{entry}')
        np.testing.assert_allclose(found, expected, atol=1e-12)


@pytest.mark.parametrize("text", [BLOCK, RIGID], ids=["average", "rigid"])
def test_a_gradient_across_a_block_bends_it(text: str) -> None:
    """κ = α g: the hot top bends the block down by κ L² / 2, its end turns by κ L."""
    model = parse_model(text)
    curvature = ALPHA * 50.0
    expected = [0, 0, -curvature * LENGTH**2 / 2, 0, curvature * LENGTH, 0]
    # the mean of the field that is exact, and the same as a profile, which the mesh carries
    for entry in (
        "gradient = [0, 0, 50]",
        'profile = { axis = [0, 0, 2], places = [-0.05, 0.05], changes = ["-2.5 K", "2.5 K"] }',
    ):
        found = moved(model, f'[[temperatures]]\npart = "bar"\n{entry}')
        np.testing.assert_allclose(found, expected, atol=1e-11)


def test_a_gradient_along_a_block_stretches_it_by_its_mean() -> None:
    """The mean of α (T₀ + g (x − x₀)) over the length."""
    model = parse_model(BLOCK)
    entry = '[[temperatures]]\npart = "bar"\nchange = "3 K"\ngradient = [10, 0, 0]\nat = [0, 0, 0]'
    np.testing.assert_allclose(
        moved(model, entry)[0], ALPHA * (3 + 10 * LENGTH / 2) * LENGTH, rtol=1e-8
    )


def test_a_solid_that_stands_askew_grows_along_its_own_axis() -> None:
    """The same block along the global y axis, the gradient given in global axes."""
    text = BLOCK.replace(f"B = [{LENGTH}, 0, 0]", f"B = [0, {LENGTH}, 0]")
    text = text.replace(
        f"position = [0, {-WIDTH / 2}, {-DEPTH / 2}]",
        f"position = [{WIDTH / 2}, 0, {-DEPTH / 2}]\naxis = [0, 0, 1]\nsecond_axis = [0, 1, 0]",
    )
    entry = '[[temperatures]]\npart = "bar"\nchange = "10 K"\ngradient = [0, 0, 50]'
    curvature = ALPHA * 50.0
    down = -curvature * LENGTH**2 / 2
    expected = [0, ALPHA * 10 * LENGTH, down, -curvature * LENGTH, 0, 0]
    np.testing.assert_allclose(moved(parse_model(text), entry), expected, atol=1e-11)


def test_a_clamped_bar_pushes_by_its_stiffness() -> None:
    """E A α ΔT, less the share E A / (k L) by which a stiff spring yields."""
    own = E * WIDTH * DEPTH / LENGTH
    stiff = 1e4 * own
    text = BLOCK + f'[[springs]]\nname = "wall"\nnode = "B"\nstiffness = {{ x = {stiff} }}\n'
    found = moved(parse_model(text), '[[temperatures]]\npart = "bar"\nchange = "10 K"')
    force = E * WIDTH * DEPTH * ALPHA * 10
    np.testing.assert_allclose(stiff * found[0], force / (1 + own / stiff), rtol=1e-6)
    np.testing.assert_allclose(found[1:], 0.0, atol=1e-12)


def test_linear_cells_bend_as_far() -> None:
    """The linear part of a conducted temperature does not depend on the mesh."""
    model = parse_model(BLOCK.replace('cell = "30 mm"', 'cell = "30 mm"\norder = 1'))
    text = 'conductivity = { steel = 50 }\n[[temperatures]]\npart = "bar"\nsurfaces = ['
    text += '{ patch = "+z", change = 3 }, { patch = "-z", change = -3 }]'
    np.testing.assert_allclose(moved(model, text)[4], ALPHA * 6 / DEPTH * LENGTH, rtol=1e-7)


def test_a_solid_between_two_surfaces_bends_by_what_it_conducts() -> None:
    """Faces at 3 K and −3 K: κ = α ΔT / h; the sheet says how warm it is."""
    model = parse_model(BLOCK)
    text = f"""{STEEL}
conductivity = {{ steel = "50 W/m/K" }}
[[temperatures]]
part = "bar"
surfaces = [
  {{ patch = "+z", change = "3 K" }},
  {{ box = [[0, 0, 0], [{LENGTH}, {WIDTH}, 0]], change = "-3 K" }},
]
"""
    sheet = error_sheet(model, parse_errors(text, "test", model))
    np.testing.assert_allclose(sheet.mean[4], ALPHA * 6 / DEPTH * LENGTH, rtol=1e-7)
    assert sheet.notes == ("Steady conduction changes the temperature of bar by -3 to 3 K.",)


def test_a_spread_of_a_solid_is_an_interval() -> None:
    model = parse_model(BLOCK)
    text = STEEL + '[[temperatures]]\npart = "bar"\ngradient = [0, 0, 50]\nspread = "2 K"'
    sheet = error_sheet(model, parse_errors(text, "test", model))
    np.testing.assert_allclose(sheet.half_range[0], ALPHA * 2 * LENGTH, rtol=1e-8)
    np.testing.assert_allclose(sheet.mean[0], 0.0, atol=1e-12)


def test_a_solid_twice_as_large_has_its_source_with_it() -> None:
    """What is kept of the mesh survives pickling, which workers need, and scaling."""
    element = pickle.loads(pickle.dumps(parse_model(BLOCK).solids[0].scaled(2.0)))  # noqa: S301
    found = solid_heat(element, SolidField(0.0, (0.0, 0.0, 50.0)), {"steel": ALPHA})
    free = np.linalg.solve(element.reduced.local_stiffness[6:, 6:], found.load[6:])
    np.testing.assert_allclose(free[4], ALPHA * 50 * 2 * LENGTH, rtol=1e-8)
    flows = (HeatFlow(node="A", change=1.0), HeatFlow(patch="+x", film=5.0))
    conducted = solid_heat(
        element, SolidField(flows=flows, conductivities={"steel": 50.0}), {"steel": ALPHA}
    )
    # q = 1 K / (L / k + 1 / h) leaves the end at q / h
    end = 1 / (2 * LENGTH / 50 + 1 / 5) / 5
    np.testing.assert_allclose([conducted.lowest, conducted.highest], [end, 1.0], rtol=1e-8)


@pytest.mark.parametrize(
    ("entry", "problem"),
    [
        ('surfaces = [{ patch = "+x", change = "1 K" }]', "steel has no conductivity"),
        ('surfaces = [{ patch = "+w", change = "1 K" }]', r'unknown patch "\+w"'),
        ('surfaces = [{ node = "C", change = "1 K" }]', '"C", which the solid does not have'),
        ("surfaces = [{ change = 1 }]", "names no place, or several"),
        ('change = "1 K"\nsurfaces = [{ node = "A", change = 1 }]', "beside surfaces"),
        ("profile = { axis = [0, 0, 1], places = [1, 0], changes = [1, 2] }", "do not rise"),
        ("profile = { axis = [0, 0, 0], places = [0, 1], changes = [1, 2] }", "no length"),
        ('gradient_y = "3 K/m"', "it is a solid"),
        ('gradient = [0, 0, 3]\nexpansion = "1e-6 m/K"', "not a coefficient of expansion"),
    ],
)
def test_what_does_not_fit_a_solid_is_named(entry: str, problem: str) -> None:
    model = parse_model(BLOCK)
    with pytest.raises(StrutworkError, match=problem):
        parse_errors(f'{STEEL}[[temperatures]]\npart = "bar"\n{entry}', "test", model)


def test_a_solid_without_a_coefficient_is_named() -> None:
    model = parse_model(BLOCK)
    with pytest.raises(ModelError, match="its material steel has no coefficient of expansion"):
        parse_errors('[[temperatures]]\npart = "bar"\nchange = "1 K"', "test", model)


def test_a_solid_of_two_materials_grows_by_both(tmp_path: Path) -> None:
    """Two halves in line: the growths add, and each needs its own coefficient."""
    half = (LENGTH / 2, WIDTH, DEPTH)
    ends = [
        block(half, (6, 2, 2), region="stone"),
        shifted(block(half, (6, 2, 2), region="cap"), None, (LENGTH / 2, 0, 0)),
    ]
    write_mesh(joined(*ends), tmp_path / "part.msh")
    text = BLOCK.replace('material = "steel"', 'materials = { stone = "soft", cap = "steel" }')
    text = text.replace('shape = "block"', 'mesh = "part.msh"').replace('cell = "30 mm"', "")
    text = text.replace(f"size = [{LENGTH}, {WIDTH}, {DEPTH}]", "")
    text = text.replace('patch = "-x"', f"box = [[0, 0, 0], [0, {WIDTH}, {DEPTH}]]")
    text = text.replace('patch = "+x"', f"box = [[{LENGTH}, 0, 0], [{LENGTH}, {WIDTH}, {DEPTH}]]")
    text += "[materials.soft]\nyoungs_modulus = 50e9\npoissons_ratio = 0\ndensity = 2000\n"
    # without Poisson's ratios nothing is strained across the bar
    text = text.replace("poissons_ratio = 0.3", "poissons_ratio = 0")
    model = parse_model(text, folder=tmp_path)
    entry = '[[temperatures]]\npart = "bar"\nchange = "10 K"'
    inputs = parse_errors(f"expansion = {{ steel = {ALPHA}, soft = 2e-6 }}\n{entry}", "t", model)
    grown = error_sheet(model, inputs).mean
    np.testing.assert_allclose(grown[0], 10 * (ALPHA + 2e-6) * LENGTH / 2, rtol=1e-8)
    with pytest.raises(ModelError, match="its material soft has no coefficient of expansion"):
        moved(model, entry)
    with pytest.raises(ModelError, match="steel, of which bar is made only in part"):
        moved(model, '[[temperatures]]\nmaterial = "steel"\nchange = "10 K"')

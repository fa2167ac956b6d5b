"""Writing universal files through pyuff, whole or not at all."""

from __future__ import annotations

import re
import tempfile
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pyuff
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.uff import FUNCTION_NAMES, FrfRecord, ModeRecord, UniversalFile
from strutwork.fea.uff_names import with_fitted_names
from strutwork.fea.uff_read import read_universal
from strutwork.files import write_whole
from strutwork.kinematics import DIRECTIONS

Array = NDArray[Any]

#: Type of specific data in data set 58.
SPECIFIC = {"displacement": 8, "velocity": 11, "acceleration": 12, "force": 13, "frequency": 18}

_UNITS = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s^2"}
_TURN_UNITS = {"displacement": "rad", "velocity": "rad/s", "acceleration": "rad/s^2"}

#: What rounding leaves is written as zero: an exponent of three digits would not fit its column.
_NEGLIGIBLE = 1e-30


def write_universal(
    path: str | Path,
    content: UniversalFile,
    *,
    text: bool = False,
    shapes_in: Literal[55, 2414] = 55,
) -> Path:
    """Write a universal file, read it back and compare before it is put in place.

    Functions are written as complex double with their frequencies: binary (58b) and exact, or
    as text with the 12 digits for values and 6 for frequencies that the format has. Modes have
    6 digits; complex ones only their translations, which is what pyuff carries. Nodes are
    numbered; their names stand in groups of one node (2467), longer ones than its 40 characters
    as `strutwork.fea.uff_names.fitted_names` says.

    Parameters
    ----------
    path : str or Path
    content : UniversalFile
    text : bool
        Functions as text.
    shapes_in : 55 or 2414
        Data set of the modes.

    Returns
    -------
    Path

    Raises
    ------
    ModelError
        Nothing to write, or a folder that cannot be written.
    NumericalError
        What was written does not read back.
    """
    if not content.functions and not content.modes:
        raise ModelError(str(path), "would be empty.", "Give functions or modes.")
    content = with_fitted_names(content)
    numbers = node_numbers(content)
    sets = [_units(), *_geometry(content, numbers)]
    sets += [_function(f, numbers, binary=not text) for f in content.functions]
    make = _mode_55 if shapes_in == 55 else _mode_2414
    sets += [make(m, i, numbers) for i, m in enumerate(content.modes, 1)]

    def write(temporary: Path) -> None:
        temporary.write_bytes(_bytes(sets))
        _check_reads_back(temporary, content, text)

    return write_whole(Path(path), write)


def node_numbers(content: UniversalFile) -> dict[str, int]:
    """Number of every node: its name where all names are numbers, else counted from one.

    Parameters
    ----------
    content : UniversalFile
    """
    names = content.nodes
    if all(re.fullmatch(r"[1-9][0-9]{0,8}", name) for name in names):
        return {name: int(name) for name in names}
    return {name: i for i, name in enumerate(names, 1)}


def _bytes(sets: list[dict[Any, Any]]) -> bytes:
    parts: list[bytes] = []
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        # pyuff leaves the closing of a file it writes in binary to the interpreter
        warnings.simplefilter("ignore", ResourceWarning)
        for i, one in enumerate(sets):
            scratch = Path(folder) / f"{i}.uff"
            # in its mode "overwrite" pyuff loses the header of a binary set
            pyuff.UFF(str(scratch)).write_sets([one], mode="add")
            written = scratch.read_bytes()
            if one.get("binary"):
                # pyuff counts the bytes of real values without frequencies
                counted = f"{24 * len(one['data']):12d}".encode()
                written = re.sub(rb"(58b.{24}).{12}", rb"\g<1>" + counted, written, count=1)
            parts.append(written)
            scratch.unlink()
    return b"".join(parts)


def _units() -> dict[Any, Any]:
    return {
        "type": 164,
        "units_code": 1,
        "units_description": "SI: m, N",
        "temp_mode": 1,
        "length": 1.0,
        "force": 1.0,
        "temp": 1.0,
        "temp_offset": 273.15,
    }


def _geometry(content: UniversalFile, numbers: Mapping[str, int]) -> list[dict[Any, Any]]:
    sets: list[dict[Any, Any]] = []
    if content.positions:
        known = [numbers[n] for n in content.positions]
        x, y, z = np.array(list(content.positions.values())).T
        same = [0] * len(known)
        sets.append(
            {
                "type": 2411,
                "node_nums": known,
                "def_cs": same,
                "disp_cs": same,
                "color": [1] * len(known),
                "x": x,
                "y": y,
                "z": z,
            }
        )
    if content.lines:
        # 11 is the one element of lines that pyuff writes as it reads it
        rods = [
            {
                "element_nums": i,
                "fe_descriptor": 11,
                "phys_table": 1,
                "mat_table": 1,
                "color": 1,
                "num_nodes": 2,
                "beam_orientation": 0,
                "beam_foreend_cross": 0,
                "beam_aftend_cross": 0,
                "nodes_nums": [numbers[a], numbers[b]],
            }
            for i, (a, b) in enumerate(content.lines, 1)
        ]
        sets.append({"type": 2412, 11: rods})
    if any(name != str(number) for name, number in numbers.items()):
        none = dict.fromkeys(
            (
                "active_constraint_set_no_for_group",
                "active_restraint_set_no_for_group",
                "active_load_set_no_for_group",
                "active_dof_set_no_for_group",
                "active_temperature_set_no_for_group",
                "active_contact_set_no_for_group",
            ),
            0,
        )
        groups = [
            {
                "group_number": number,
                "group_name": name,
                "entity_type_code": [7],
                "entity_tag": [number],
                "entity_node_leaf_id": [0],
                "entity_component_id": [0],
                **none,
            }
            for name, number in numbers.items()
        ]
        sets.append({"type": 2467, "groups": groups})
    return sets


def _function(record: FrfRecord, numbers: Mapping[str, int], *, binary: bool) -> dict[Any, Any]:
    f = record.frequencies
    step = (f[-1] - f[0]) / (len(f) - 1)
    # a text file has six digits for a frequency: even steps keep more where start and step fit
    rounded = float(f"{f[0]:.5e}") + np.arange(len(f)) * float(f"{step:.5e}")
    even = not binary and bool(np.allclose(rounded, f, rtol=1e-12, atol=1e-12 * f[-1]))
    turns = record.output[1].startswith("r")
    twists = record.input[1].startswith("r")
    title = f"{FUNCTION_NAMES[record.motion]} {record.name}"
    return {
        "type": 58,
        "binary": int(binary),
        "id1": title[:80],
        "id2": "computed or converted by Strutwork, SI units",
        "id4": f"response {':'.join(record.output)}"[:80],
        "id5": f"reference {':'.join(record.input)}"[:80],
        "func_type": 4,
        "rsp_node": numbers[record.output[0]],
        "rsp_dir": DIRECTIONS.index(record.output[1]) + 1,
        "ref_node": numbers[record.input[0]],
        "ref_dir": DIRECTIONS.index(record.input[1]) + 1,
        "abscissa_spacing": int(even),
        "abscissa_spec_data_type": SPECIFIC["frequency"],
        "abscissa_axis_lab": "frequency",
        "abscissa_axis_units_lab": "Hz",
        "ordinate_spec_data_type": SPECIFIC[record.motion],
        "ordinate_axis_lab": record.motion,
        "ordinate_axis_units_lab": (_TURN_UNITS if turns else _UNITS)[record.motion],
        "orddenom_spec_data_type": SPECIFIC["force"],
        "orddenom_axis_lab": "moment" if twists else "force",
        "orddenom_axis_units_lab": "N*m" if twists else "N",
        "x": f,
        "data": record.values,
    }


def _clean(shape: Array) -> Array:
    return np.where(np.abs(shape) > _NEGLIGIBLE * np.abs(shape).max(initial=1e-300), shape, 0.0)


def _mode_55(mode: ModeRecord, number: int, numbers: Mapping[str, int]) -> dict[Any, Any]:
    shape = _clean(mode.shape)
    complex_shape = np.iscomplexobj(shape)
    made: dict[Any, Any] = {
        "type": 55,
        "id1": f"mode {number}, {mode.frequency:.6g} Hz",
        "id2": "translations" if complex_shape else "translations and rotations",
        "model_type": 1,
        "analysis_type": 3 if complex_shape else 2,
        "data_ch": 2 if complex_shape else 3,
        "spec_data_type": 8,
        "load_case": 0,
        "mode_n": number,
        "node_nums": [numbers[n] for n in mode.nodes],
        **{f"r{k + 1}": shape[:, k] for k in range(3 if complex_shape else 6)},
    }
    if complex_shape:
        ratio = mode.damping_ratio or 0.0
        turn = np.sqrt(max(1.0 - ratio**2, 0.0))
        made["eig"] = 2.0 * np.pi * mode.frequency * (-ratio + 1j * turn)
    else:
        made |= {"freq": mode.frequency, "modal_m": 1.0}
        made["modal_damp_vis"] = mode.damping_ratio or 0.0
    return made


def _mode_2414(mode: ModeRecord, number: int, numbers: Mapping[str, int]) -> dict[Any, Any]:
    shape = _clean(mode.shape)
    complex_shape = np.iscomplexobj(shape)
    if complex_shape:
        shape = np.stack([shape[:, :3].real, shape[:, :3].imag], axis=-1).reshape(-1, 6)
    title = f"mode {number}, {mode.frequency:.6g} Hz"
    return {
        "type": 2414,
        "analysis_dataset_label": number,
        "analysis_dataset_name": title,
        "dataset_location": 1,
        **{f"id{k}": title if k == 1 else "NONE" for k in range(1, 6)},
        "model_type": 1,
        "analysis_type": 2,
        "data_characteristic": 2 if complex_shape else 3,
        "result_type": 8,
        "data_type": 5 if complex_shape else 2,
        "number_of_data_values_for_the_data_component": 3 if complex_shape else 6,
        "record10_field6": number,
        "record12_field2": mode.frequency,
        "record12_field4": 1.0,
        "record12_field5": mode.damping_ratio or 0.0,
        "node_nums": np.array([numbers[n] for n in mode.nodes]),
        "data_at_node": list(shape),
    }


def _check_reads_back(path: Path, content: UniversalFile, text: bool) -> None:
    back = read_universal(path)
    same: Any = len(back.functions) == len(content.functions) and len(back.modes) == len(
        content.modes
    )
    for got, put in zip(back.functions, content.functions, strict=False):
        near, digits = (1e-5, 1e-10) if text else (0.0, 0.0)
        same = same and (got.output, got.input, got.motion) == (put.output, put.input, put.motion)
        same = same and np.allclose(got.frequencies, put.frequencies, rtol=near, atol=0.0)
        same = same and np.allclose(got.values, put.values, rtol=digits, atol=0.0)
    for mode, wanted in zip(back.modes, content.modes, strict=False):
        k = 3 if np.iscomplexobj(wanted.shape) else 6
        size = np.abs(wanted.shape).max(initial=0.0)
        same = same and mode.nodes == wanted.nodes
        same = same and np.isclose(mode.frequency, wanted.frequency, rtol=2e-5, atol=1e-30)
        same = same and np.allclose(
            mode.shape[:, :k], wanted.shape[:, :k], rtol=2e-5, atol=1e-20 * size
        )
    if not same:
        raise NumericalError(
            str(path.name), "does not read back as it was written.", "Please report the file."
        )

"""The elimination program of a topology: which joint coordinate meets which, in what order.

Made once per structure and free of coordinates: the compiled kernel (`strutwork.msa.kernel`) runs
it on many poses at a time. Joint coordinates of the spanning forest are the unknowns, without those
that closed loops make follow from others; those that move the tool come last, so that eliminating
the others condenses each leg to the tool.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Ints = NDArray[np.int64]


class LoopProgram(NamedTuple):
    """How dependent coordinates follow from the others, as the kernel reads it.

    Loops that share no dependent coordinate are solved each by itself. `entries` are the shares
    of independent in dependent coordinates: of loop after loop, by dependent coordinate.

    Parameters
    ----------
    nodes : (m, 2)
        Mesh nodes of the closing joints, in the order of their loops.
    joint : (m,)
    row_start : (m + 1,)
        Range of each joint's rows.
    row_direction : (r,)
        Locked direction 0-5 of every row.
    row_scale : (r,)
        1 of a translation, length of a rotation, m.
    touch_start : (m + 1,)
    touch_coordinate, touch_column : (t,)
        Coordinates that move the joint's sides, and their columns in the loop's rows: dependent
        coordinates first.
    touch_ends : (t, 2)
        1 where the coordinate moves the first, the second side.
    loop_joint : (b + 1,)
        Range of each loop's joints.
    dependent_start : (b + 1,)
    dependent : (d,)
        Coordinates of the loops that follow, loop after loop.
    independent_start : (b + 1,)
    independent : (i,)
        Coordinates of the loops that they follow, loop after loop.
    store_start, entry_start : (b + 1,)
        Range of each loop's rows, and of its entries.
    scale : (c,)
        Coordinate per scaled coordinate: 1 of a translation, 1/length of a rotation, 1/m.
    most_rows, most_columns : int
    """

    nodes: Ints
    joint: Ints
    row_start: Ints
    row_direction: Ints
    row_scale: Array
    touch_start: Ints
    touch_coordinate: Ints
    touch_column: Ints
    touch_ends: Ints
    loop_joint: Ints
    dependent_start: Ints
    dependent: Ints
    independent_start: Ints
    independent: Ints
    store_start: Ints
    entry_start: Ints
    scale: Array
    most_rows: int
    most_columns: int


class SpreadProgram(NamedTuple):
    """Where the parts that dependent coordinates move go, as the kernel reads it.

    Parameters
    ----------
    plain : (e + l,)
        1 where an item's touches are independent coordinates only.
    width : (e + l,)
        Independent coordinates of every item.
    own : (t,)
        Place of a touch's coordinate among the item's independent ones, −1 if dependent.
    start : (t + 1,)
    target, entry : (s,)
        Of a dependent touch: places among the item's independent coordinates, and loop entries.
    outer_slot, outer_first, outer_second, outer_coordinate, outer_value : (o,)
        Elastic dependent coordinates and their stiffness, N/m or N·m/rad: K[slot] += value ·
        first · second entry.
    tool_from, tool_to, tool_entry : (g,)
        Dependent coordinate that moves the tool, independent one, loop entry.
    """

    plain: Ints
    width: Ints
    own: Ints
    start: Ints
    target: Ints
    entry: Ints
    outer_slot: Ints
    outer_first: Ints
    outer_second: Ints
    outer_coordinate: Ints
    outer_value: Array
    tool_from: Ints
    tool_to: Ints
    tool_entry: Ints


class Program(NamedTuple):
    """Integer arrays and constants of one topology, as the kernel reads them.

    Of c coordinates, the first n are independent and are solved for; the others follow from them
    through the loops.

    Parameters
    ----------
    axis_joint, axis_direction : (c,)
        Joint and axis 0-2 of every coordinate; joint −1 means a global axis.
    axis_sign : (c,)
        1 or −1, no unit.
    turns : (c,)
        1 where the coordinate is a rotation.
    pivot_node : (c,)
        Mesh node about which it rotates.
    item_nodes : (e, 2)
        Mesh nodes of the beam elements.
    item_beam : (e,)
    item_offsets : (e, 2, 3)
        From the nodes to the element's ends, m.
    properties : (b, 6)
        As `Beam.properties`, in their units.
    turn_frame : (b,)
        Frame of the beam's body, in whose axes its vectors are; −1 for global axes.
    orientation : (b, 3)
        Direction of local z, no unit; NaN for the default.
    orientation_joint : (b,)
        Joint whose z axis is taken, or −1.
    link_nodes : (l, 2)
        Mesh nodes of the springs and elastic joints that carry nothing, −1 for ground.
    link_joint : (l,)
        Frame in whose axes the stiffness is given, or −1 for global axes.
    link_stiffness : (l, 6, 6)
        N/m, N, N·m/rad.
    touch_start : (e + l + 1,)
        Range of each element's touches, dependent coordinates included, beams before links.
    touch_coordinate : (t,)
    touch_ends : (t, 2)
        1 where the coordinate moves the first, the second end.
    pair_start : (e + l + 1,)
    pair_slot : (q,)
        Slot of K for each pair i ≥ j of an element's independent coordinates, row by row.
    spring_slot, spring_coordinate, spring_value : (s,)
        Slot in K of elastic independent coordinates, which they are, and their stiffness, N/m or
        N·m/rad.
    diagonal : (n,)
        Slot of each coordinate's diagonal entry.
    fill : (k,)
        Slot in the factor of every slot of K.
    column_start : (n + 1,)
        Range of each column of the factor below the diagonal.
    column_row, column_slot : (f,)
        Row and slot of each of its entries.
    update_start : (n + 1,)
        Range of the updates by each column.
    update : (u, 3)
        target −= first · second, by eliminated column.
    entry_row, entry_column : (k,)
        Coordinates of every slot of K.
    slots : int
        Entries of the factor.
    tool_node : int
    tool_moves : (g,)
        Coordinates that move the tool's cluster directly, or the workpiece's, and not both.
    tool_sign : (g,)
        1 where it is the tool's, −1 where it is the workpiece's; no unit.
    tool_touches : (h,)
        Independent coordinates that move the tool.
    loops : LoopProgram
    spread : SpreadProgram
    """

    axis_joint: Ints
    axis_direction: Ints
    axis_sign: Array
    turns: Ints
    pivot_node: Ints
    item_nodes: Ints
    item_beam: Ints
    item_offsets: Array
    properties: Array
    turn_frame: Ints
    orientation: Array
    orientation_joint: Ints
    link_nodes: Ints
    link_joint: Ints
    link_stiffness: Array
    touch_start: Ints
    touch_coordinate: Ints
    touch_ends: Ints
    pair_start: Ints
    pair_slot: Ints
    spring_slot: Ints
    spring_coordinate: Ints
    spring_value: Array
    diagonal: Ints
    fill: Ints
    column_start: Ints
    column_row: Ints
    column_slot: Ints
    update_start: Ints
    update: Ints
    entry_row: Ints
    entry_column: Ints
    slots: int
    tool_node: int
    tool_moves: Ints
    tool_sign: Array
    tool_touches: Ints
    loops: LoopProgram
    spread: SpreadProgram

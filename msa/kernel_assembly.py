"""Compiled assembly: stiffness on the joint coordinates of many poses in step."""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit
from strutwork.msa.kernel_loops import LANES, parted


@jit(contract=True)
def axes_and_pivots(p, point, frame, axis, pivot):  # type: ignore[no-untyped-def]
    """Direction and pivot of every coordinate.

    Parameters
    ----------
    p : Program
    point : (n, 3, w)
        Mesh nodes, m.
    frame : (j, 3, 3, w)
        Axes of joints and bodies as columns, no unit.
    axis : (c, 3, w)
        Filled; unit vectors, no unit.
    pivot : (c, 3, w)
        Filled, m.
    """
    for c in range(p.axis_joint.shape[0]):
        j, d, node = p.axis_joint[c], p.axis_direction[c], p.pivot_node[c]
        for k in range(3):
            for w in range(LANES):
                pivot[c, k, w] = point[node, k, w]
            if j < 0:
                for w in range(LANES):
                    axis[c, k, w] = 1.0 if k == d else 0.0
            else:
                for w in range(LANES):
                    axis[c, k, w] = p.axis_sign[c] * frame[j, k, d, w]


@jit(contract=True)
def _element_axes(p, item, point, frame, ends, local, length):  # type: ignore[no-untyped-def]
    """Ends (2, 3, w), local axes as rows (3, 3, w) and length (w) of a beam element."""
    beam = p.item_beam[item]
    body = p.turn_frame[beam]
    for e in range(2):
        node = p.item_nodes[item, e]
        ox, oy, oz = (
            p.item_offsets[item, e, 0],
            p.item_offsets[item, e, 1],
            p.item_offsets[item, e, 2],
        )
        for k in range(3):
            for w in range(LANES):
                ends[e, k, w] = point[node, k, w] + p.item_offsets[item, e, k]
        if body >= 0 and (ox != 0.0 or oy != 0.0 or oz != 0.0):
            for k in range(3):
                for w in range(LANES):
                    ends[e, k, w] = (
                        point[node, k, w]
                        + frame[body, k, 0, w] * ox
                        + frame[body, k, 1, w] * oy
                        + frame[body, k, 2, w] * oz
                    )
    for w in range(LANES):
        dx = ends[1, 0, w] - ends[0, 0, w]
        dy = ends[1, 1, w] - ends[0, 1, w]
        dz = ends[1, 2, w] - ends[0, 2, w]
        size = np.sqrt(dx * dx + dy * dy + dz * dz)
        length[w] = size
        local[0, 0, w], local[0, 1, w], local[0, 2, w] = dx / size, dy / size, dz / size
    joint = p.orientation_joint[beam]
    ox, oy, oz = p.orientation[beam, 0], p.orientation[beam, 1], p.orientation[beam, 2]
    given = not np.isnan(ox)
    for w in range(LANES):
        x, y, z = local[0, 0, w], local[0, 1, w], local[0, 2, w]
        if joint >= 0:
            ux, uy, uz = frame[joint, 0, 2, w], frame[joint, 1, 2, w], frame[joint, 2, 2, w]
        elif body >= 0:
            # the default is that of the body's axes
            px = frame[body, 0, 0, w] * x + frame[body, 1, 0, w] * y + frame[body, 2, 0, w] * z
            py = frame[body, 0, 1, w] * x + frame[body, 1, 1, w] * y + frame[body, 2, 1, w] * z
            along = px * px + py * py < 1e-12
            vx = ox if given else 0.0
            vy = oy if given else (1.0 if along else 0.0)
            vz = oz if given else (0.0 if along else 1.0)
            ux = frame[body, 0, 0, w] * vx + frame[body, 0, 1, w] * vy + frame[body, 0, 2, w] * vz
            uy = frame[body, 1, 0, w] * vx + frame[body, 1, 1, w] * vy + frame[body, 1, 2, w] * vz
            uz = frame[body, 2, 0, w] * vx + frame[body, 2, 1, w] * vy + frame[body, 2, 2, w] * vz
        elif given:
            ux, uy, uz = ox, oy, oz
        else:
            along = x * x + y * y < 1e-12
            ux, uy, uz = 0.0, (1.0 if along else 0.0), (0.0 if along else 1.0)
        part = ux * x + uy * y + uz * z
        whole = ux * ux + uy * uy + uz * uz
        ux, uy, uz = ux - part * x, uy - part * y, uz - part * z
        square = ux * ux + uy * uy + uz * uz
        # an orientation along its beam must not pass: NaN makes the pose doubtful
        size = np.sqrt(square) if square > 1e-18 * whole else np.nan
        ux, uy, uz = ux / size, uy / size, uz / size
        local[2, 0, w], local[2, 1, w], local[2, 2, w] = ux, uy, uz
        local[1, 0, w] = uy * z - uz * y
        local[1, 1, w] = uz * x - ux * z
        local[1, 2, w] = ux * y - uy * x


@jit(contract=True)
def _strains(p, t, axis, pivot, ends, local, length, strain):  # type: ignore[no-untyped-def]
    """The six deformations of a beam element per unit of one coordinate, (6, w).

    Elongation, twist, and in each plane the two end rotations against the chord.
    """
    c = p.touch_coordinate[t]
    first, second = float(p.touch_ends[t, 0]), float(p.touch_ends[t, 1])
    turns = p.turns[c] == 1
    for w in range(LANES):
        ax, ay, az = axis[c, 0, w], axis[c, 1, w], axis[c, 2, w]
        if turns:
            px = second * (ends[1, 0, w] - pivot[c, 0, w]) - first * (
                ends[0, 0, w] - pivot[c, 0, w]
            )
            py = second * (ends[1, 1, w] - pivot[c, 1, w]) - first * (
                ends[0, 1, w] - pivot[c, 1, w]
            )
            pz = second * (ends[1, 2, w] - pivot[c, 2, w]) - first * (
                ends[0, 2, w] - pivot[c, 2, w]
            )
            dx = ay * pz - az * py
            dy = az * px - ax * pz
            dz = ax * py - ay * px
        else:
            dx, dy, dz = (second - first) * ax, (second - first) * ay, (second - first) * az
        chord_y = (local[1, 0, w] * dx + local[1, 1, w] * dy + local[1, 2, w] * dz) / length[w]
        chord_z = (local[2, 0, w] * dx + local[2, 1, w] * dy + local[2, 2, w] * dz) / length[w]
        strain[0, w] = local[0, 0, w] * dx + local[0, 1, w] * dy + local[0, 2, w] * dz
        tx = ty = tz = 0.0
        if turns:
            tx = local[0, 0, w] * ax + local[0, 1, w] * ay + local[0, 2, w] * az
            ty = local[1, 0, w] * ax + local[1, 1, w] * ay + local[1, 2, w] * az
            tz = local[2, 0, w] * ax + local[2, 1, w] * ay + local[2, 2, w] * az
        strain[1, w] = (second - first) * tx
        strain[2, w] = first * tz - chord_y
        strain[3, w] = second * tz - chord_y
        strain[4, w] = first * ty + chord_z
        strain[5, w] = second * ty + chord_z


@jit(contract=True)
def _followed(p, item, entry, strain, reduced):  # type: ignore[no-untyped-def]
    """An item's deformations per unit of its independent coordinates, from those of all."""
    s = p.spread
    if s.plain[item] == 1:
        return strain
    for i in range(s.width[item]):
        reduced[i] = 0.0
    start = p.touch_start[item]
    for t in range(start, p.touch_start[item + 1]):
        if s.own[t] >= 0:
            for a in range(6):
                for w in range(LANES):
                    reduced[s.own[t], a, w] += strain[t - start, a, w]
        for k in range(s.start[t], s.start[t + 1]):
            i, e = s.target[k], s.entry[k]
            for a in range(6):
                for w in range(LANES):
                    reduced[i, a, w] += entry[e, w] * strain[t - start, a, w]
    return reduced


@jit(contract=True)
def _add_links(p, geometry, entry, matrix, work):  # type: ignore[no-untyped-def]
    """Add springs and elastic joints that carry nothing to K."""
    _, _, _, strain, reduced, stress = work
    beams = p.item_nodes.shape[0]
    for link in range(p.link_nodes.shape[0]):
        start, stop = p.touch_start[beams + link], p.touch_start[beams + link + 1]
        for t in range(start, stop):
            c = p.touch_coordinate[t]
            ends, nodes = p.touch_ends[t], p.link_nodes[link]
            parted(p, c, ends, nodes, p.link_joint[link], geometry, strain[t - start])
        motion = _followed(p, beams + link, entry, strain, reduced)
        q = p.pair_start[beams + link]
        for i in range(p.spread.width[beams + link]):
            for a in range(6):
                stress[a] = 0.0
                for b in range(6):
                    if p.link_stiffness[link, a, b] != 0.0:
                        for w in range(LANES):
                            stress[a, w] += p.link_stiffness[link, a, b] * motion[i, b, w]
            for j in range(i + 1):
                slot = p.pair_slot[q]
                q += 1
                for a in range(6):
                    for w in range(LANES):
                        matrix[slot, w] += stress[a, w] * motion[j, a, w]


@jit(contract=True)
def assemble(p, geometry, entry, matrix, work):  # type: ignore[no-untyped-def]
    """Stiffness K on the independent coordinates, by slots, (k, w).

    Parameters
    ----------
    p : Program
    geometry : (point, frame, axis, pivot)
        As `axes_and_pivots` takes and fills them.
    entry : (x, w)
        Loop entries, from `close_loops`; no unit, m/rad or rad/m.
    matrix : (k, w)
        Filled; N/m, N, N·m/rad.
    work : tuple of arrays
        Overwritten: ends (2, 3, w), axes (3, 3, w), length (w), strains (t, 6, w) and (i, 6, w) of
        an element with t touches and i independent coordinates, stress (6, w).
    """
    point, frame, axis, pivot = geometry
    ends, local, length, strain, reduced, stress = work
    matrix[:] = 0.0
    for item in range(p.item_nodes.shape[0]):
        _element_axes(p, item, point, frame, ends, local, length)
        b = p.item_beam[item]
        start, stop = p.touch_start[item], p.touch_start[item + 1]
        for t in range(start, stop):
            _strains(p, t, axis, pivot, ends, local, length, strain[t - start])
        ea, gj = p.properties[b, 0], p.properties[b, 1]
        ey, ez = p.properties[b, 2], p.properties[b, 3]
        sy, sz = p.properties[b, 4], p.properties[b, 5]
        motion = _followed(p, item, entry, strain, reduced)
        q = p.pair_start[item]
        for i in range(p.spread.width[item]):
            e = motion[i]
            for w in range(LANES):
                inverse = 1.0 / length[w]
                square = inverse * inverse
                fz, fy = sz * square, sy * square
                kz, ky = ez * inverse / (1.0 + fz), ey * inverse / (1.0 + fy)
                stress[0, w] = ea * inverse * e[0, w]
                stress[1, w] = gj * inverse * e[1, w]
                stress[2, w] = kz * ((4.0 + fz) * e[2, w] + (2.0 - fz) * e[3, w])
                stress[3, w] = kz * ((2.0 - fz) * e[2, w] + (4.0 + fz) * e[3, w])
                stress[4, w] = ky * ((4.0 + fy) * e[4, w] + (2.0 - fy) * e[5, w])
                stress[5, w] = ky * ((2.0 - fy) * e[4, w] + (4.0 + fy) * e[5, w])
            for j in range(i + 1):
                slot = p.pair_slot[q]
                q += 1
                f = motion[j]
                for w in range(LANES):
                    matrix[slot, w] += (
                        stress[0, w] * f[0, w]
                        + stress[1, w] * f[1, w]
                        + stress[2, w] * f[2, w]
                        + stress[3, w] * f[3, w]
                        + stress[4, w] * f[4, w]
                        + stress[5, w] * f[5, w]
                    )
    _add_links(p, geometry, entry, matrix, work)
    for s in range(p.spring_slot.shape[0]):
        for w in range(LANES):
            matrix[p.spring_slot[s], w] += p.spring_value[s]
    outer = p.spread
    for s in range(outer.outer_slot.shape[0]):
        slot, value = outer.outer_slot[s], outer.outer_value[s]
        first, second = outer.outer_first[s], outer.outer_second[s]
        for w in range(LANES):
            matrix[slot, w] += value * entry[first, w] * entry[second, w]

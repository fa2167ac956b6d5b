"""The border of a workspace as points, lines or triangles, and what it encloses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.margin_grid import MarginGrid

Array = NDArray[Any]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class LevelSet:
    """A border, closed where the grid ends, and the measure of what it encloses.

    Parameters
    ----------
    points : (v, d)
        m and rad.
    facets : (f, d) of int
        Points that bound an interval, segments of lines, or triangles.
    crossing : (v,) of int
        Edge of the grid that each point lies on; −1 where the grid ends.
    measure : float
        Length, area or volume, in products of m and rad.
    """

    points: Array
    facets: Indices
    crossing: Indices
    measure: float

    def __repr__(self) -> str:
        return f"<LevelSet: {len(self.points)} points, {len(self.facets)} facets>"

    def facet_sizes(self, unit: Array) -> Array:
        """Counts, lengths or areas of the facets, (f,), in the units that are given.

        Parameters
        ----------
        unit : (d,)
            Of each coordinate, m or rad.
        """
        corners = (self.points / unit)[self.facets]
        if corners.shape[-1] == 1:
            return np.ones(len(corners))
        sides = corners[:, 1:] - corners[:, :1]
        if corners.shape[-1] == 2:
            return np.asarray(np.linalg.norm(sides[:, 0], axis=-1))
        return np.asarray(0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=-1))


def level_set(grid: MarginGrid) -> LevelSet:
    """The border of the good part of a grid.

    Contours come from contourpy, isosurfaces from VTK's flying edges; their points are put where
    the border crosses the edges. Where the grid ends the border is closed along it.

    Parameters
    ----------
    grid : MarginGrid
    """
    # all corners lie equally far from the level: its points are middles of edges
    field = np.pad(np.where(grid.good, 1.0, -1.0), 1, constant_values=-1.0)
    if not grid.good.any():
        d = field.ndim
        none = np.zeros(0, dtype=np.intp)
        return LevelSet(np.zeros((0, d)), np.zeros((0, d), dtype=np.intp), none, 0.0)
    where, facets = (_ends, _lines, _triangles)[field.ndim - 1](field)
    points, crossing = _on_edges(grid, where - 1.0)
    return LevelSet(points, facets, crossing, _measure(points, facets))


def apart(fine: LevelSet, coarse: LevelSet, step: Array) -> float:
    """Measure of what lies between two borders, in products of m and rad.

    Where a border bulges outward and elsewhere inward, the measures of two grids may agree while
    neither is right; what lies between their borders adds up.

    Parameters
    ----------
    fine, coarse : LevelSet
    step : (d,)
        Cells of the coarse grid, m or rad, in which distances are measured.
    """
    total = abs(fine.measure - coarse.measure)
    if fine.points.shape[1] == 1 or not len(fine.facets):
        return total
    if not len(coarse.facets):
        return fine.measure
    points, corners = fine.points / step, (coarse.points / step)[coarse.facets]
    gaps = _distances(points, corners)
    sizes = fine.facet_sizes(step)
    between = float((sizes * gaps[fine.facets].mean(axis=1)).sum() * np.prod(step))
    return max(total, between)


def _distances(points: Array, corners: Array) -> Array:
    """Distances of points from segments or triangles, of those whose middles are nearest."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - as the other libraries here

    count = min(8, len(corners))
    _, near = cKDTree(corners.mean(axis=1)).query(points, k=count)
    near = np.reshape(near, (len(points), count))
    if points.shape[1] == 3:
        import trimesh  # noqa: PLC0415 - a fifth of a second

        many = np.repeat(points, count, axis=0)
        nearest: Any = trimesh.triangles.closest_point
        closest = nearest(corners[near.ravel()], many)
    else:
        start, along = corners[near, 0], corners[near, 1] - corners[near, 0]
        squared = (along * along).sum(axis=-1)
        share = ((points[:, None] - start) * along).sum(axis=-1) / np.maximum(squared, 1e-300)
        many = np.repeat(points, count, axis=0)
        closest = (start + np.clip(share, 0.0, 1.0)[..., None] * along).reshape(-1, 2)
    found = np.linalg.norm(many - closest, axis=1).reshape(len(points), count)
    return np.asarray(found.min(axis=1))


def _on_edges(grid: MarginGrid, where: Array) -> tuple[Array, Indices]:
    """Places of middles of edges, given in cells, and the crossings they belong to."""
    c = grid.crossings
    low = np.floor(where + 1e-6).astype(np.intp)
    axis = np.abs(where - low - 0.5).argmin(axis=1)
    shape = np.array(grid.good.shape)
    rows = np.arange(len(where))
    known = np.full((len(shape), *shape), -1, dtype=np.intp)
    known[(c.axis, *c.low.T)] = np.arange(len(c.axis))
    along = low[rows, axis]
    ends = (along < 0) | (along >= shape[axis] - 1)
    inner = np.clip(low, 0, shape - 1)
    crossing = np.where(ends, -1, known[(axis, *inner.T)])
    place = low.astype(float)
    place[rows, axis] += np.where(ends, 0.0, c.share[crossing] if len(c.share) else 0.0)
    place = np.clip(place, 0, shape - 1)
    start = np.array([a[0] for a in grid.axes])
    return start + place * grid.step, crossing


def _ends(field: Array) -> tuple[Array, Indices]:
    turned = np.flatnonzero(np.diff(field))
    return (turned + 0.5)[:, None], np.arange(len(turned), dtype=np.intp)[:, None]


def _lines(field: Array) -> tuple[Array, Indices]:
    import contourpy  # noqa: PLC0415 - only workspaces need it

    # outer lines run anticlockwise, those of holes clockwise: their areas add up with signs
    generator = contourpy.contour_generator(z=field.T, fill_type="OuterOffset")
    filled: Any = generator.filled(0.0, 2.0)
    polygons, offsets = filled
    points, facets, count = [], [], 0
    for polygon, offset in zip(polygons, offsets, strict=True):
        for first, last in zip(offset[:-1].astype(int), offset[1:].astype(int), strict=True):
            loop = polygon[first : last - 1]
            number = count + np.arange(len(loop))
            points.append(loop)
            facets.append(np.stack([number, np.roll(number, -1)], axis=-1))
            count += len(loop)
    return np.concatenate(points), np.concatenate(facets)


def _triangles(field: Array) -> tuple[Array, Indices]:
    import pyvista  # noqa: PLC0415 - a second that only workspaces in space need

    image = pyvista.ImageData(dimensions=field.shape)
    image["margin"] = field.ravel(order="F")
    surface = image.contour([0.0], scalars="margin", method="flying_edges")
    facets = np.asarray(surface.faces).reshape(-1, 4)[:, 1:].astype(np.intp)
    return np.asarray(surface.points, dtype=float), facets


def _measure(points: Array, facets: Indices) -> float:
    """Length, area or volume within a closed border, by the divergence theorem."""
    if points.shape[1] == 1:
        return float(np.abs(points[1::2] - points[::2]).sum())
    # near the border, so that little is lost to rounding
    corners = points[facets] - points.mean(axis=0)
    return float(abs(np.linalg.det(corners).sum()) / (1, 1, 2, 6)[points.shape[1]])

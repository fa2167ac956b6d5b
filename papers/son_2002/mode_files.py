"""Mode shapes of a machine on its granite as files that other programs open: .vtu and .glb."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from strutwork.fea.solid_fields import write_scene
from strutwork.papers.son_2002.figures.mode_surface import mode_surface
from strutwork.papers.son_2002.modes import ModePicture
from strutwork.reports.data_files import DataFile


def mode_scene(name: str, what: str, picture: ModePicture) -> DataFile:
    """A mode as a surface that swings, coloured by its displacement (.glb)."""
    surface = mode_surface(picture)
    return DataFile(name, what, lambda path: write_scene(surface, path))


def mode_fields(name: str, what: str, pictures: Mapping[str, ModePicture]) -> DataFile:
    """Modes as displacements of the granite's surface and of the mechanism's lines (.vtu).

    The largest displacement of each mode is one.

    Parameters
    ----------
    name : str
        Ends with .vtu.
    what : str
    pictures : mapping of label to ModePicture
        Of one machine at one pose.
    """
    picture = next(iter(pictures.values()))
    fields = {
        label: np.concatenate([p.displacement, p.node_displacement])
        for label, p in pictures.items()
    }

    def write(path: Path) -> None:
        import meshio

        made = meshio.Mesh(
            np.concatenate([picture.points, picture.nodes]),
            [("quad", picture.faces), ("line", picture.lines + len(picture.points))],
            point_data=fields,
        )
        meshio.vtu.write(str(path), made)

    return DataFile(name, what, write)

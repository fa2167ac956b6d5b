"""Pictures of fields on solids, rendered without a display by VTK through pyvista."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np

from strutwork.errors import NumericalError
from strutwork.fea.solid_fields import SurfaceField
from strutwork.files import write_whole


def picture(
    field: SurfaceField,
    size: tuple[int, int] = (900, 700),
    *,
    scale: float | None = None,
    view: tuple[float, float, float] = (1.0, 1.4, 0.7),
    edges: bool = False,
) -> bytes:
    """A picture of a solid, coloured and displaced, with its outline at rest.

    Parameters
    ----------
    field : SurfaceField
    size : (width, height)
        Pixels.
    scale : float or None
        Factor on the displacement, no unit; by default the largest is drawn at 8 % of the diagonal.
    view : (3,)
        Direction from the solid to the eye, no unit; z points up.
    edges : bool
        Draw the edges of the triangles.

    Returns
    -------
    bytes
        A PNG file.

    Raises
    ------
    NumericalError
        VTK cannot render here.
    """
    # VTK takes a second to load, and only pictures need it
    import pyvista  # noqa: PLC0415
    from PIL import Image  # noqa: PLC0415
    from vtkmodules.vtkCommonCore import vtkLogger  # noqa: PLC0415

    factor = field.drawing_scale if scale is None else scale
    faces = np.hstack([np.full((len(field.triangles), 1), 3), field.triangles]).ravel()
    rest = pyvista.PolyData(field.points, faces)
    drawn = pyvista.PolyData(field.points + factor * field.displacement, faces)
    drawn[field.name] = field.values
    # VTK warns on standard error when it finds no X server and turns to EGL or OSMesa
    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        pixels = _render(pyvista, drawn, rest, field.name, size, view, edges)
    except RuntimeError as error:
        raise NumericalError(
            "picture", f"VTK cannot render here ({error}).", "Install libegl1 or libosmesa6."
        ) from error
    finally:
        vtkLogger.SetStderrVerbosity(before)
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def write_picture(field: SurfaceField, path: Path | str, **options: Any) -> Path:
    """Write a picture to a .png file, whole or not at all.

    Parameters
    ----------
    field : SurfaceField
    path : Path or str
    **options : keyword arguments
        `size`, `scale`, `view` and `edges` of `picture`.
    """
    content = picture(field, **options)
    return write_whole(Path(path), lambda temporary: temporary.write_bytes(content))


def _render(
    pyvista: Any,
    drawn: Any,
    rest: Any,
    name: str,
    size: tuple[int, int],
    view: tuple[float, float, float],
    edges: bool,
) -> Any:
    plotter = pyvista.Plotter(off_screen=True, window_size=list(size))
    try:
        plotter.set_background("white")
        bar = {"title": name, "color": "black", "n_labels": 4, "fmt": "%.3g",
               "position_y": 0.02, "height": 0.09}  # fmt: skip
        plotter.add_mesh(
            drawn, scalars=name, cmap="viridis", show_edges=edges, scalar_bar_args=bar,
            smooth_shading=False, ambient=0.35, diffuse=0.7,
        )  # fmt: skip
        outline = rest.extract_feature_edges(feature_angle=30.0)
        if outline.n_points:
            plotter.add_mesh(outline, color="#404040", line_width=1.5)
        plotter.view_vector(view, viewup=(0.0, 0.0, 1.0))
        # room for the bar below
        plotter.camera.zoom(0.88)
        return plotter.screenshot(None, return_img=True)
    finally:
        plotter.close()

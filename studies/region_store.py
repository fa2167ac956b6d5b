"""A result on disk that grows chunk by chunk: Zarr arrays, written region by region.

Zarr keeps the arrays; each chunk of a study is one chunk of each array, with a checksum (CRC32C).
A chunk counts when the list of finished ones, which is written last, has it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from strutwork.errors import ModelError, OutputError
from strutwork.files import write_error

_KEY, _DONE, _COMPLETE = "study_key", "finished_chunks", "complete"


@dataclass(frozen=True)
class RegionStore:
    """A folder of Zarr arrays along one dimension, of which a beginning is finished.

    Parameters
    ----------
    path : Path
        The folder.
    key : str
        Hash of everything the results depend on.
    dim : str
        Dimension along which it grows.
    items, size : int
        Along it, of the study and of a chunk.
    """

    path: Path
    key: str
    dim: str
    items: int
    size: int

    def finished(self) -> list[dict[str, Any]]:
        """Notes of the finished chunks, from the first to the first that is missing or damaged.

        Raises
        ------
        OutputError
            The folder holds something else, or cannot be written.
        """
        with self._written():
            group = self._group()
            held = group.attrs.get(_KEY)
            if held is None and not any(True for _ in group):
                group.attrs.update({_KEY: self.key, _DONE: []})
            elif held != self.key:
                raise OutputError(
                    str(self.path),
                    "holds another study, or one of other inputs or of another version.",
                    "Name another folder, or remove this one.",
                )
            notes = list(group.attrs[_DONE])
            sound = next((k for k in range(len(notes)) if not self._sound(group, k)), len(notes))
            if sound < len(notes):
                group.attrs[_DONE] = notes[:sound]
        return [json.loads(note) for note in notes[:sound]]

    def write(
        self, number: int, variables: Mapping[str, xr.Variable], note: Mapping[str, Any]
    ) -> None:
        """Put a chunk in its place; it counts once all of it is there.

        Parameters
        ----------
        number : int
            Of the chunk; the next one.
        variables : mapping of str to xarray.Variable
            The first dimension is that of the store; arrays (k, ...), any unit.
        note : mapping
            Plain values that are kept with the chunk.

        Raises
        ------
        OutputError
            The disk is full, or refuses.
        """
        start = number * self.size
        # a chunk that holds nothing but the fill value is a file as well: missing is damaged
        with self._written(), _zarr().config.set({"array.write_empty_chunks": True}):
            group = self._group()
            for name, variable in variables.items():
                if name not in group:
                    self._make(group, name, variable)
                group[name][start : start + variable.shape[0]] = variable.to_numpy()
            group.attrs[_DONE] = [*group.attrs[_DONE], json.dumps(note)]

    def complete(self, rest: xr.Dataset) -> None:
        """Add what is not along the store's dimension, and the attributes.

        Parameters
        ----------
        rest : xarray.Dataset
        """
        with self._written():
            group = self._group()
            for name, variable in rest.variables.items():
                # text of one length each has no place in the specification yet
                text = variable.dtype.kind in "UO"
                array = group.create_array(
                    str(name),
                    shape=variable.shape,
                    dtype=str if text else variable.dtype,
                    dimension_names=variable.dims,
                    attributes={k: _plain(v) for k, v in variable.attrs.items()},
                    overwrite=True,
                )
                array[...] = variable.to_numpy().astype(object if text else variable.dtype)
            group.attrs.update({k: _plain(v) for k, v in rest.attrs.items()} | {_COMPLETE: True})

    def opened(self) -> xr.Dataset:
        """What is on disk; arrays are read when they are asked for."""
        found: xr.Dataset = xr.open_zarr(self.path, chunks=None, consolidated=False)
        found.attrs = {k: v for k, v in found.attrs.items() if k != _DONE}
        return found

    def _group(self) -> Any:
        return _zarr().open_group(self.path, mode="a", zarr_format=3)

    def _make(self, group: Any, name: str, variable: xr.Variable) -> None:
        codecs = _zarr().codecs
        own = variable.shape[1:]
        values = variable.to_numpy()
        group.create_array(
            name,
            shape=(self.items, *own),
            chunks=(self.size, *(max(1, n) for n in own)),
            dtype=values.dtype,
            fill_value=np.nan if values.dtype.kind == "f" else 0,
            dimension_names=variable.dims,
            attributes={k: _plain(v) for k, v in variable.attrs.items()},
            compressors=(codecs.ZstdCodec(level=1), codecs.Crc32cCodec()),
        )

    def _sound(self, group: Any, number: int) -> bool:
        start = number * self.size
        for name, array in group.arrays():
            if not array.size or array.metadata.dimension_names[0] != self.dim:
                continue
            file = Path(self.path, name, "c", str(number), *["0"] * (array.ndim - 1))
            if not file.is_file():
                return False
            try:
                _ = array[start : start + self.size]
            except (OSError, ValueError, RuntimeError):
                return False
        return True

    @contextmanager
    def _written(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise write_error(self.path, error) from error


def _zarr() -> Any:
    try:
        import zarr  # noqa: PLC0415 - an extra
        import zarr.codecs  # noqa: PLC0415
    except ImportError as error:
        raise ModelError(
            "streamed result",
            "needs Zarr, which is not installed.",
            "pip install strutwork[cluster]",
        ) from error
    return zarr


def _plain(value: object) -> Any:
    return value.tolist() if isinstance(value, np.generic | np.ndarray) else value

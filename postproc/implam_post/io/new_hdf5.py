"""New HDF5 files, built in memory: HDF5 ends the process if a disk is full as it closes a file."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py

from implam_post.io.files import replaced


@contextmanager
def new_hdf5(path: Path) -> Iterator[h5py.File]:
    """Yield a file in memory, which replaces `path` when it is complete."""
    with h5py.File(path, "w", driver="core", backing_store=False) as file:
        yield file
        file.flush()
        image = file.id.get_file_image()
    with replaced(path) as draft:
        draft.write_bytes(image)

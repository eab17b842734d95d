# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts small files in the place of large HDF5 files below a folder: the same groups, attributes and types, with the first
rows of long arrays. Only their digests are no longer right. Usage: shrink_hdf5.py FOLDER BYTES"""
import sys
from pathlib import Path

import h5py

LONG, ROWS = 3000, 4  # elements of an array that is cut, rows along each axis that stay


def copy(source, target):
    for name, value in source.attrs.items():
        target.attrs[name] = value
    for name, thing in source.items():
        if isinstance(thing, h5py.Group):
            copy(thing, target.create_group(name))
            continue
        if thing is None:  # a link that leads nowhere
            continue
        part = tuple(slice(ROWS) for _ in thing.shape) if thing.size > LONG else ()
        target.create_dataset(name, data=thing[part], dtype=thing.dtype)


def main(folder, most_bytes):
    for path in sorted(Path(folder).rglob("*")):
        if not path.is_file() or path.stat().st_size <= most_bytes:
            continue
        small = path.with_name(path.name + "-small")
        try:
            with h5py.File(path, "r") as source, h5py.File(small, "w", libver=("v110", "v110")) as target:
                copy(source, target)
        except (OSError, RuntimeError, KeyError):  # a test has damaged it
            small.unlink(missing_ok=True)
        path.unlink()


main(sys.argv[1], int(sys.argv[2]))

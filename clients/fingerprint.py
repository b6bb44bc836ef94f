#!/usr/bin/env python3
"""Prints a hash of what every file in a folder holds, decoded: values, geometry and pixels.

    clients/fingerprint.py FOLDER [--jobs N]

A line is: hash, what of the file, kind, path; in the order of paths. Compression, the order of bytes and where parts lie
in a file do not count, nor do versions, hashes of recipes, dates, seconds and rates. Prose (notes, captions, headings)
has lines of its own, marked `words`: these may change where texts are put better, `values` may not.

Needs NumPy, for .nc and .zarr the packages of `clients/install arrays` (run it with target/clients/arrays/bin/python),
and for videos ffmpeg.
"""

import argparse
import multiprocessing
import pathlib
import sys

# No compiled modules are left in the tree.
sys.dont_write_bytecode = True

from decoding import arrays, exr, gltf, png, prose, tiff, video
from decoding.digest import Digest

OF_BYTES = {
    "png": png.read, "apng": png.read, "tif": tiff.read, "tiff": tiff.read, "exr": exr.read, "glb": gltf.read,
    "npy": arrays.npy, "asc": arrays.ascii_grid, "ply": arrays.ply, "json": prose.read_json,
    "geojson": prose.read_json, "csv": prose.csv, "svg": prose.page, "html": prose.page, "md": prose.markdown,
    "prj": prose.plain, "txt": prose.plain,
}
OF_PATH = {"nc": arrays.netcdf, "zarr": arrays.zarr, "mp4": video.read, "webm": video.read}
# Their bytes are the numbers themselves; what they mean stands in the .json beside them.
BARE = {"raw", "r16", "r32"}


def lines_of(job):
    """The lines of one file, and what is wrong with it or nothing."""
    folder, path = job
    kind = path.suffix[1:].lower()
    digest = Digest()
    try:
        if kind in OF_PATH:
            OF_PATH[kind](path, digest)
        elif kind in OF_BYTES:
            OF_BYTES[kind](path.read_bytes(), digest)
        elif kind in BARE:
            digest.value("bytes", path.read_bytes())
        else:
            raise ValueError(f"files of kind {kind!r} are not known; add a decoder to clients/decoding")
    # Whatever is wrong with one file, the others are told.
    except Exception as error:
        return [], f"fingerprint: {path}: {type(error).__name__}: {error}"
    return [f"{code} {which:6} {kind:7} {path.relative_to(folder)}" for which, code in digest.results()], None


def files(folder):
    """All files in the order of their paths; a Zarr group, which is a folder, is one."""
    for path in sorted(folder.iterdir()):
        if path.is_dir() and path.suffix != ".zarr":
            yield from files(path)
        else:
            yield path


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=1, help="processes that decode")
    options = parser.parse_args()
    if not options.folder.is_dir():
        parser.error(f"{options.folder} is no folder")
    jobs = [(options.folder, path) for path in files(options.folder)]
    with multiprocessing.Pool(options.jobs) as pool:
        found = list(pool.imap(lines_of, jobs))
    for lines, fault in found:
        print("".join(f"{line}\n" for line in lines), end="")
        if fault:
            print(fault, file=sys.stderr)
    return int(any(fault for _, fault in found))


if __name__ == "__main__":
    sys.exit(main())

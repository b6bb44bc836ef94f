"""NumPy arrays, NetCDF files, Zarr groups, ESRI ASCII grids, and clouds of points."""

import io

import numpy

from .digest import VOLATILE


def npy(data, digest):
    """Feeds the array."""
    digest.array("values", numpy.load(io.BytesIO(data)))


def netcdf(path, digest):
    """Feeds dimensions, attributes and variables, as NetCDF's own library reads them."""
    import netCDF4

    with netCDF4.Dataset(path) as file:
        file.set_auto_maskandscale(False)
        for name, dimension in sorted(file.dimensions.items()):
            digest.value(f"dimension {name}", len(dimension))
        attributes({key: file.getncattr(key) for key in file.ncattrs()}, digest, "file")
        for name, variable in sorted(file.variables.items()):
            attributes({key: variable.getncattr(key) for key in variable.ncattrs()}, digest, name)
            digest.array(f"{name} {variable.dimensions}", variable[...])


def zarr(path, digest):
    """Feeds attributes and arrays of a group, as Zarr's own library reads them."""
    import zarr as library

    group = library.open_group(path, mode="r")
    attributes(dict(group.attrs), digest, "group")
    for name, array in sorted(group.arrays()):
        attributes(dict(array.attrs), digest, name)
        digest.array(f"{name} {array.metadata.dimension_names} {array.fill_value}", array[...])


def attributes(known, digest, label):
    """Attributes in order of their names; sentences are words."""
    for key in sorted(known.keys() - VOLATILE):
        if key in ("comment", "title", "source", "references", "long_name"):
            digest.word(f"{label} {key} {known[key]}")
        else:
            value = known[key]
            digest.value(f"{label} {key}", value.tolist() if hasattr(value, "tolist") else value)


def ascii_grid(data, digest):
    """Feeds the header's keys and the values as numbers."""
    lines = data.decode().splitlines()
    head = [line for line in lines if line[:1].isalpha() and not line.lower().startswith(("nan", "inf"))]
    for line in head:
        digest.value("header", line.split())
    digest.array("values", numpy.array(" ".join(lines[len(head) :]).split(), numpy.float64))


def ply(data, digest):
    """Feeds elements and their bytes; comments are words."""
    head, body = data.split(b"end_header\n", 1)
    for line in head.decode().splitlines():
        if line.startswith("comment"):
            digest.word(line)
        else:
            digest.value("header", line)
    digest.value("body", body)

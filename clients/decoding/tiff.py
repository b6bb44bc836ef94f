"""GeoTIFF as Weald writes it: one band in strips or tiles, uncompressed or Deflate, with or without predictor."""

import re
import struct
import zlib

import numpy

from .digest import VOLATILE

FORMATS = {1: "B", 2: "s", 3: "H", 4: "I", 5: "II", 6: "b", 8: "h", 9: "i", 11: "f", 12: "d", 16: "Q"}
COLUMNS, ROWS, BITS, COMPRESSION, DESCRIPTION, SOFTWARE, PREDICTOR = 256, 257, 258, 259, 270, 305, 317
SAMPLE, METADATA = 339, 42112
# Where chunks lie, how they are packed, and the program.
LEFT_OUT = {273, 278, 279, 322, 323, 324, 325, COMPRESSION, PREDICTOR, SOFTWARE, 306}
DEFLATE = (8, 32946)


def read(data, digest):
    """Feeds values and all tags that say something of them."""
    order = {b"II": "<", b"MM": ">"}[data[:2]]
    tags = directory(data, order)
    for tag in sorted(tags.keys() - LEFT_OUT):
        if tag == DESCRIPTION:
            digest.word(tags[tag].decode())
        elif tag == METADATA:
            items(tags[tag].decode(), digest)
        else:
            digest.value(f"tag {tag}", tags[tag])
    digest.array("values", values(data, tags, order))


def items(xml, digest):
    """GDAL's items under their names."""
    for name, text in re.findall(r'<Item name="([^"]*)"[^>]*>([^<]*)<', xml):
        if name not in VOLATILE:
            digest.value(name, text)


def directory(data, order):
    """Tags of the first directory, in classic files and in BigTIFF."""
    big = struct.unpack(order + "H", data[2:4])[0] == 43
    start = struct.unpack(order + ("Q" if big else "I"), data[8:16] if big else data[4:8])[0]
    width, head, slot = (20, 8, 8) if big else (12, 2, 4)
    count = struct.unpack(order + ("Q" if big else "H"), data[start : start + head])[0]
    tags = {}
    for entry in range(start + head, start + head + count * width, width):
        tag, kind = struct.unpack(order + "HH", data[entry : entry + 4])
        many = struct.unpack(order + ("Q" if big else "I"), data[entry + 4 : entry + 4 + slot])[0]
        length = struct.calcsize("=" + FORMATS[kind]) * many
        at = entry + 4 + slot
        if length > slot:
            at = struct.unpack(order + ("Q" if big else "I"), data[at : at + slot])[0]
        body = data[at : at + length]
        tags[tag] = body if kind == 2 else struct.unpack(order + FORMATS[kind] * many, body)
    return tags


def values(data, tags, order):
    """The band, its chunks put together."""
    columns, rows = tags[COLUMNS][0], tags[ROWS][0]
    kind = numpy.dtype({1: "u", 2: "i", 3: "f"}[tags.get(SAMPLE, (1,))[0]] + str(tags[BITS][0] // 8))
    tiled = 322 in tags
    wide, high = (tags[322][0], tags[323][0]) if tiled else (columns, tags.get(278, (rows,))[0])
    offsets, counts = (tags[324], tags[325]) if tiled else (tags[273], tags[279])
    across = -(-columns // wide)
    band = numpy.empty((rows, columns), kind)
    for at, (offset, count) in enumerate(zip(offsets, counts)):
        x, y = at % across * wide, at // across * high
        lines = high if tiled else min(high, rows - y)
        chunk = unpacked(data[offset : offset + count], tags, (lines, wide), kind.newbyteorder(order))
        band[y : y + high, x : x + wide] = chunk[: rows - y, : columns - x]
    return band


def unpacked(packed, tags, shape, kind):
    """The numbers of one chunk."""
    compression, predictor = tags.get(COMPRESSION, (1,))[0], tags.get(PREDICTOR, (1,))[0]
    if compression not in (1, *DEFLATE):
        raise ValueError(f"TIFF with compression {compression}, which Weald does not write")
    raw = zlib.decompress(packed) if compression in DEFLATE else packed
    if predictor == 3:
        planes = numpy.frombuffer(raw, numpy.uint8).reshape(shape[0], -1).cumsum(1, dtype=numpy.uint8)
        planes = planes.reshape(shape[0], kind.itemsize, shape[1]).transpose(0, 2, 1)
        return numpy.ascontiguousarray(planes).view(kind.newbyteorder(">"))[:, :, 0]
    numbers = numpy.frombuffer(raw, kind).reshape(shape)
    return numbers.cumsum(1, dtype=kind) if predictor == 2 else numbers

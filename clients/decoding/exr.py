"""OpenEXR as Weald writes it: scan lines, without compression or with ZIP."""

import struct
import zlib

import numpy

from .digest import VOLATILE

NONE, ZIPS, ZIP = 0, 2, 3
LINES = {NONE: 1, ZIPS: 1, ZIP: 16}
TYPES = {0: "<u4", 1: "<f2", 2: "<f4"}


def read(data, digest):
    """Feeds all attributes, and each channel."""
    attributes, at = header(data)
    for name, (kind, body) in sorted(attributes.items()):
        if name == "comments":
            digest.word(body.decode())
        elif name not in VOLATILE | {"compression"}:
            digest.value(f"{name} {kind}", body)
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"][1])
    columns, rows = right - left + 1, bottom - top + 1
    names = channels(attributes["channels"][1])
    picture = {name: numpy.empty((rows, columns), kind) for name, kind in names}
    compression = attributes["compression"][1][0]
    blocks = -(-rows // LINES[compression])
    for (offset,) in struct.iter_unpack("<Q", data[at : at + 8 * blocks]):
        y, length = struct.unpack("<iI", data[offset : offset + 8])
        block(data[offset + 8 : offset + 8 + length], compression, picture, (y - top, LINES[compression]))
    for name, channel in picture.items():
        digest.array(name, channel)


def header(data):
    """Attributes by name, as type and bytes, and where they end."""
    at, attributes = 8, {}
    while data[at]:
        name, kind, rest = data[at : at + 600].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        (length,) = struct.unpack("<I", data[at : at + 4])
        attributes[name.decode()] = (kind.decode(), data[at + 4 : at + 4 + length])
        at += 4 + length
    return attributes, at + 1


def channels(body):
    """Names and types of numbers."""
    found = []
    while body[0]:
        name, rest = body.split(b"\0", 1)
        found.append((name.decode(), TYPES[struct.unpack("<i", rest[:4])[0]]))
        body = rest[16:]
    return found


def block(packed, compression, picture, place):
    """Some rows of all channels, put where they belong."""
    first, lines = place
    rows = [channel[first : first + lines] for channel in picture.values()]
    length = sum(part.nbytes for part in rows)
    raw = packed if compression == NONE or len(packed) == length else unzipped(packed)
    at = 0
    for line in range(len(rows[0])):
        for part in rows:
            part[line] = numpy.frombuffer(raw, part.dtype, part.shape[1], at)
            at += part[line].nbytes


def unzipped(packed):
    """Deflate, then differences, then halves that take turns."""
    raw = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).astype(numpy.int64)
    raw[1:] -= 128
    raw = raw.cumsum().astype(numpy.uint8)
    half = (len(raw) + 1) // 2
    turns = numpy.empty_like(raw)
    turns[0::2], turns[1::2] = raw[:half], raw[half:]
    return turns.tobytes()

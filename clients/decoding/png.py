"""PNG and APNG: samples of every frame before filtering and compression, and all chunks that say something of them."""

import struct
import zlib

import numpy

from .digest import VOLATILE

SIGNATURE = b"\x89PNG\r\n\x1a\n"
CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}
TEXTS = (b"tEXt", b"zTXt", b"iTXt")


def read(data, digest, label="png"):
    """Feeds the decoded picture."""
    header, streams = None, []
    for kind, body in chunks(data):
        if kind == b"IHDR":
            header = body
            digest.value(f"{label} IHDR", body)
        elif kind == b"fcTL":
            # The number at its start counts chunks, not frames.
            digest.value(f"{label} fcTL", body[4:])
            streams.append((struct.unpack(">II", body[4:12]), []))
        elif kind in (b"IDAT", b"fdAT"):
            if not streams:
                streams.append((struct.unpack(">II", header[:8]), []))
            streams[-1][1].append(body if kind == b"IDAT" else body[4:])
        elif kind in TEXTS:
            text(kind, body, digest, label)
        elif kind != b"IEND":
            digest.value(f"{label} {kind.decode()}", body)
    depth, colour, _, _, interlaced = header[8:]
    if interlaced:
        raise ValueError("an interlaced PNG, which Weald does not write")
    for at, (size, parts) in enumerate(streams):
        digest.array(f"{label} frame {at}", samples(zlib.decompress(b"".join(parts)), size, depth * CHANNELS[colour]))


def chunks(data):
    """Kind and body of each chunk."""
    if not data.startswith(SIGNATURE):
        raise ValueError("no PNG")
    at = len(SIGNATURE)
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        yield data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        at += length + 12


def text(kind, body, digest, label):
    """A chunk of text under its key."""
    key, rest = body.split(b"\0", 1)
    if key.decode("latin-1") in VOLATILE:
        return
    if kind == b"zTXt":
        rest = zlib.decompress(rest[1:])
    digest.value(f"{label} {key.decode('latin-1')}", rest.decode("utf-8", "surrogateescape"))


def samples(raw, size, bits):
    """Bytes of the samples, row by row, with the filters of the rows undone."""
    width, height = size
    row, pixel = (width * bits + 7) // 8, max(1, bits // 8)
    lines = numpy.frombuffer(raw, numpy.uint8).reshape(height, row + 1)
    kinds, lines = lines[:, 0], lines[:, 1:].reshape(height, -1, pixel)
    if not kinds.any():
        return lines
    return diagonals(lines, kinds)


def diagonals(lines, kinds):
    """Undoes filters along diagonals: a pixel needs those left of, above, and left above it, all on earlier ones."""
    height, columns, pixel = lines.shape
    skewed = numpy.zeros((columns + height, height + 1, pixel), numpy.int16)
    rows = numpy.arange(height)
    left, above, mean, paeth = (numpy.flatnonzero(kinds == kind) for kind in (1, 2, 3, 4))
    # Row y of the picture is column y + 1 here, so that above the first one there are zeros.
    before, last = numpy.zeros((2, height + 1, pixel), numpy.int16)
    for at in range(columns + height - 1):
        first, end = max(0, at - columns + 1), min(height, at + 1)
        now = numpy.zeros_like(last)
        here = rows[first:end]
        now[here + 1] = lines[here, at - here]
        for chosen, predict in ((left, of_left), (above, of_above), (mean, of_mean), (paeth, of_paeth)):
            y = chosen[numpy.searchsorted(chosen, first) : numpy.searchsorted(chosen, end)]
            if len(y):
                now[y + 1] = (now[y + 1] + predict(last[y + 1], last[y], before[y])) & 255
        skewed[at] = now
        before, last = last, now
    picture = numpy.empty(lines.shape, numpy.uint8)
    for y in range(height):
        picture[y] = skewed[y : y + columns, y + 1]
    return picture


def of_left(left, _above, _corner):
    return left


def of_above(_left, above, _corner):
    return above


def of_mean(left, above, _corner):
    return (left + above) >> 1


def of_paeth(left, above, corner):
    to_left, to_above, to_corner = abs(above - corner), abs(left - corner), abs(left + above - 2 * corner)
    nearer = numpy.where(to_above <= to_corner, above, corner)
    return numpy.where((to_left <= to_above) & (to_left <= to_corner), left, nearer)

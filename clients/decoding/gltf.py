"""Binary glTF: every accessor as numbers, every picture as pixels, and the rest of the document."""

import json
import struct

import numpy

from . import png
from .digest import tree

TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def read(data, digest):
    """Feeds the document; where bytes lie in the file is left out."""
    document, binary = parts(data)
    views = document.pop("bufferViews", [])
    document.pop("buffers", None)
    used = set()
    for at, accessor in enumerate(document.get("accessors", [])):
        used.add(accessor.get("bufferView"))
        digest.array(f"accessor {at}", numbers(accessor, views, binary))
    for at, image in enumerate(document.get("images", [])):
        used.add(image.get("bufferView"))
        png.read(bytes_of(views[image["bufferView"]], binary), digest, f"image {at}")
    for at in sorted(set(range(len(views))) - used):
        digest.value(f"view {at}", bytes_of(views[at], binary))
    tree(digest, "document", document, words=("extras",))


def parts(data):
    """The JSON and the binary chunk."""
    at, found = 12, {}
    while at < len(data):
        length, kind = struct.unpack("<I4s", data[at : at + 8])
        found[kind] = data[at + 8 : at + 8 + length]
        at += 8 + length
    return json.loads(found[b"JSON"]), found.get(b"BIN\0", b"")


def bytes_of(view, binary):
    """The bytes of a view."""
    start = view.get("byteOffset", 0)
    return binary[start : start + view["byteLength"]]


def numbers(accessor, views, binary):
    """The numbers of an accessor, in rows."""
    kind, width = numpy.dtype(TYPES[accessor["componentType"]]), WIDTHS[accessor["type"]]
    view, count = views[accessor["bufferView"]], accessor["count"]
    start, stride = accessor.get("byteOffset", 0), view.get("byteStride", kind.itemsize * width)
    return numpy.ndarray((count, width), kind, bytes_of(view, binary), start, (stride, kind.itemsize))

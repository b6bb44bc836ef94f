"""What is kept of a decoded file: one hash of its values, and one of its words."""

import hashlib
import re

import numpy

# Keys and tags that say when, by which version, how fast and from which text a file was made, or on which machine.
VOLATILE = {
    "version", "weald", "WEALD_VERSION", "generator", "software", "Software", "history", "date", "created",
    "recipe", "recipe_blake3", "recipe_hash", "WEALD_RECIPE_BLAKE3", "weald_version", "weald_recipe_blake3",
    "seconds", "peak_memory", "cell_updates_per_second", "adapter",
}
HASH = re.compile(r"\b[0-9a-f]{64}\b")
VERSION = re.compile(r"\b(Weald|weald) \d+\.\d+\.\d+\S*")


def settled(text):
    """Text without versions and hashes of recipes."""
    return VERSION.sub("Weald", HASH.sub("HASH", text))


class Digest:
    """Two hashes: `values` are numbers, geometry and pixels, `words` the prose around them."""

    def __init__(self):
        self.hashers = {}

    def _feed(self, which, data):
        self.hashers.setdefault(which, hashlib.blake2b(digest_size=16)).update(len(data).to_bytes(8, "little") + data)

    def array(self, label, array):
        """An array: its label, type, shape and every bit, as little-endian numbers in rows."""
        array = numpy.asarray(array)
        array = numpy.ascontiguousarray(array, array.dtype.newbyteorder("<"))
        self._feed("values", f"{label} {array.dtype.str} {array.shape}".encode())
        self._feed("values", array.tobytes())

    def value(self, label, value):
        """A number, a name, or bytes that are no text."""
        data = value if isinstance(value, bytes) else settled(repr(value)).encode()
        self._feed("values", f"{label}=".encode() + data)

    def word(self, text):
        """Prose, which may be put better without a change of what was made."""
        self._feed("words", settled(text).encode())

    def results(self):
        """Pairs of which and hash."""
        return [(which, hasher.hexdigest()) for which, hasher in sorted(self.hashers.items())]


def tree(digest, label, node, words=()):
    """A tree as JSON has it, key by key in order of names; what stands under the keys `words` is prose."""
    if isinstance(node, dict):
        for key in sorted(node.keys() - VOLATILE):
            tree(digest, f"{label}.{key}", node[key], words)
    elif any(f".{word}" in label for word in words):
        digest.word(f"{label} {node}")
    elif isinstance(node, list):
        digest.value(f"{label}#", len(node))
        for at, item in enumerate(node):
            tree(digest, f"{label}[{at}]", item, words)
    else:
        digest.value(label, node)

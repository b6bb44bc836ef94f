"""Files of text: JSON, CSV, SVG, HTML with its pictures, and pages of Markdown."""

import base64
import html.parser
import json
import re

from . import png
from .digest import tree

NUMBER = re.compile(r"[-+−]?\d[\d  ,.]*(?:[eE][-+]?\d+)?")
# What tells of a run rather than of what it made.
TIMES = re.compile("seconds|million cell updates .*")
ORIGINS = ("recipe", "BLAKE3 of the recipe", "version")
WORDS = ("notes", "note", "hints", "advice", "help", "comment", "engine")
PICTURE = "data:image/png;base64,"


def read_json(data, digest):
    """Feeds the tree; notes to the reader are words."""
    tree(digest, "", json.loads(data), WORDS)


def csv(data, digest):
    """Feeds lines; comments are words."""
    for line in data.decode().splitlines():
        digest.word(line) if line.startswith("#") else digest.value("line", line)


def plain(data, digest):
    """Feeds text as it is."""
    digest.value("text", data.decode())


def markdown(data, digest):
    """Feeds the numbers in tables; the text is words."""
    text = data.decode()
    for line in text.splitlines():
        if line.startswith("|"):
            digest.value("row", NUMBER.findall(line))
    digest.word(text)


def page(data, digest):
    """Feeds what HTML and SVG show: pictures as pixels, lines as they are drawn, numbers in tables."""
    reader = Page(digest)
    reader.feed(data.decode())
    reader.finish_row()


class Page(html.parser.HTMLParser):
    """Splits a page into pictures, geometry, rows of tables, and words."""

    def __init__(self, digest):
        super().__init__()
        self.digest, self.row, self.heads, self.silent = digest, None, [], 0

    def handle_starttag(self, tag, attributes):
        if tag in ("style", "script"):
            self.silent += 1
        elif tag == "table":
            self.heads = []
        elif tag == "tr":
            self.finish_row()
            self.row = []
        elif tag in ("td", "th") and self.row is not None:
            self.row.append([tag, ""])
        for name, value in attributes:
            self.attribute(tag, name, value or "")

    def attribute(self, tag, name, value):
        if value.startswith(PICTURE):
            png.read(base64.b64decode(value[len(PICTURE) :]), self.digest, f"picture of {tag}")
        elif name in ("alt", "title", "content", "class", "lang", "aria-label", "id", "href"):
            self.digest.word(f"{tag} {name} {value}")
        else:
            self.digest.value(f"{tag} {name}", value)

    def handle_endtag(self, tag):
        if tag in ("style", "script"):
            self.silent -= 1
        elif tag in ("tr", "table"):
            self.finish_row()

    def handle_data(self, data):
        if self.silent or not data.strip():
            return
        if self.row:
            self.row[-1][1] += data
        elif NUMBER.fullmatch(data.strip()):
            self.digest.value("text", data.strip())
        else:
            self.digest.word(data)

    def finish_row(self):
        """A whole row is there: numbers in its cells are values, but for times and origins."""
        cells, self.row = self.row or [], None
        if cells and all(tag == "th" for tag, _ in cells):
            self.heads = [text for _, text in cells]
        if cells and cells[0][1] in ORIGINS:
            return
        for at, (_, text) in enumerate(cells):
            if at < len(self.heads) and TIMES.fullmatch(self.heads[at]) and not TIMES.fullmatch(text):
                continue
            number = NUMBER.fullmatch(text.strip())
            self.digest.value("cell", text.strip()) if number else self.digest.word(text)

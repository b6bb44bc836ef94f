"""Opens an image in Blender and prints what is there, as JSON.

    target/clients/blender/bin/python clients/blender_image.py FILE

`values` are those of the first channel, row after row from the top.
"""

import json
import sys

import bpy

arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]

image = bpy.data.images.load(arguments[0])
image.colorspace_settings.name = "Non-Color"
width, height = image.size
first = image.pixels[:][:: image.channels]
rows = [first[width * row : width * (row + 1)] for row in range(height)]
print(
    json.dumps(
        {
            "width": width,
            "height": height,
            "channels": image.channels,
            "is_float": image.is_float,
            "values": [value for row in reversed(rows) for value in row],
        }
    )
)

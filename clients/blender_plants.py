"""Imports a .glb of plants into Blender and prints what is there, as JSON.

    target/clients/blender/bin/python clients/blender_plants.py FILE

Places are Blender's: x east, y north, z up, in metres; `up` is where a plant's stem points.
"""

import json
import sys

import bpy
from mathutils import Vector

arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]

bpy.ops.wm.read_factory_settings(use_empty=True)
# What the importer says on the way goes to standard error.
bpy.ops.import_scene.gltf(filepath=arguments[0], merge_vertices=False)
plants = [thing for thing in bpy.data.objects if thing.type == "MESH"]
bpy.context.view_layer.update()
print(
    "\n"
    + json.dumps(
        {
            "plants": len(plants),
            "meshes": len({thing.data.name for thing in plants}),
            "vertices": len(plants[0].data.vertices),
            "textures": [layer.name for layer in plants[0].data.uv_layers],
            "places": [tuple(thing.matrix_world.translation) for thing in plants],
            "ups": [tuple((thing.matrix_world.to_3x3() @ Vector((0, 0, 1))).normalized()) for thing in plants],
            "sizes": [thing.matrix_world.to_scale()[2] for thing in plants],
        }
    )
)

"""Imports a .glb into Blender and prints what is there, as JSON.

    target/clients/blender/bin/python clients/blender_mesh.py FILE

Places are Blender's: x east, y north, z up, in metres. `tangents` are those that Blender makes for itself, one a vertex.
"""

import json
import sys

import bpy

arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]


def described(thing):
    mesh = thing.data
    places = [tuple(thing.matrix_world @ vertex.co) for vertex in mesh.vertices]
    mesh.calc_tangents()
    normals, tangents = [None] * len(places), [None] * len(places)
    for loop in mesh.loops:
        normals[loop.vertex_index] = tuple(loop.normal)
        tangents[loop.vertex_index] = (*loop.tangent, loop.bitangent_sign)
    material = mesh.materials[0]
    images = [node.image for node in material.node_tree.nodes if node.type == "TEX_IMAGE"]
    return {
        "vertices": len(places),
        "triangles": len(mesh.polygons),
        "low": [min(place[axis] for place in places) for axis in range(3)],
        "high": [max(place[axis] for place in places) for axis in range(3)],
        "places": places,
        "normals": normals,
        "tangents": tangents,
        "material": material.name,
        "images": {image.name: [*image.size, image.colorspace_settings.name] for image in images},
    }


bpy.ops.wm.read_factory_settings(use_empty=True)
# What the importer says on the way goes to standard error.
bpy.ops.import_scene.gltf(filepath=arguments[0], merge_vertices=False)
found = {thing.name: described(thing) for thing in bpy.data.objects if thing.type == "MESH"}
print(f"\n{json.dumps(found)}")

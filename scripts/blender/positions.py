"""Runs in Blender: writes where the vertices of the only mesh object are in the world, in frames
of the scene from FIRST on, as JSON: [frame][vertex][axis].

    blender -b FILE.blend --python positions.py -- OUT.json FIRST
"""

import json
import sys

import bpy


def positions(walk):
    evaluated = walk.evaluated_get(bpy.context.evaluated_depsgraph_get())
    found = [tuple(evaluated.matrix_world @ v.co) for v in evaluated.to_mesh().vertices]
    evaluated.to_mesh_clear()
    return found


def main(out, first):
    scene = bpy.context.scene
    (walk,) = (o for o in scene.objects if o.type == "MESH")
    frames = []
    for frame in range(scene.frame_end - scene.frame_start + 1):
        scene.frame_set(int(first) + frame)
        frames.append(positions(walk))
    with open(out, "w", encoding="utf-8") as file:
        json.dump(frames, file)


main(*sys.argv[sys.argv.index("--") + 1:])

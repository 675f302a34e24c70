"""Runs in Blender: makes the animations of blender_test.py in a folder.

modifiers.blend  a worm with an armature, shape keys, Subdivision and Wave, whose rig moves about
rig.blend        the same without Subdivision and Wave
empty.blend      nothing, at the same frames
"""

import math
import os
import sys

import bpy

RINGS, SIDES = 9, 8
KEYS = ((11, -0.6, 0.0), (22, 0.9, 1.0), (34, -0.3, 0.2))  # frame, angle, shape key


def save(folder, name):
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(os.path.abspath(folder), name))


def add(name, data):
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    return made


def add_tube():
    vertices = [(0.3 * math.cos(2 * math.pi * s / SIDES), 0.2 * math.sin(2 * math.pi * s / SIDES),
                 0.25 * r) for r in range(RINGS) for s in range(SIDES)]
    faces = [tuple(SIDES * (r + dr) + (s + ds) % SIDES
                   for dr, ds in ((0, 0), (0, 1), (1, 1), (1, 0)))
             for r in range(RINGS - 1) for s in range(SIDES)]
    mesh = bpy.data.meshes.new("Worm")
    mesh.from_pydata(vertices, [], faces)
    layer = mesh.uv_layers.new()  # has a seam, where glTF has vertices twice
    for polygon in mesh.polygons:
        r, s = divmod(polygon.index, SIDES)
        for loop, (du, dv) in zip(polygon.loop_indices, ((0, 0), (1, 0), (1, 1), (0, 1))):
            layer.data[loop].uv = ((s + du) / SIDES, (r + dv) / RINGS)
    return add("Worm", mesh)


def add_rig():
    rig = add("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    parent = None
    for i in range(2):
        bone = rig.data.edit_bones.new(f"Bone{i}")
        bone.head, bone.tail, bone.parent = (0, 0, i), (0, 0, i + 1), parent
        parent = bone
    bpy.ops.object.mode_set(mode="OBJECT")
    return rig


def bind(worm, rig):
    for i in range(2):
        group = worm.vertex_groups.new(name=f"Bone{i}")
        for v in worm.data.vertices:
            upper = min(max(v.co.z - 0.5, 0), 1)
            group.add([v.index], upper if i else 1 - upper, "REPLACE")
    worm.modifiers.new("Armature", "ARMATURE").object = rig
    worm.parent = rig


def animate(worm, rig):
    worm.shape_key_add(name="Basis")
    key = worm.shape_key_add(name="Thick")
    for v, to in zip(worm.data.vertices, key.data):
        to.co = (1.5 * v.co.x, 1.2 * v.co.y, v.co.z)
    bone = rig.pose.bones["Bone1"]
    bone.rotation_mode = "XYZ"
    for frame, angle, value in KEYS:
        bone.rotation_euler = (angle, 0, 0.4 * angle)
        bone.keyframe_insert("rotation_euler", frame=frame)
        rig.location, rig.rotation_euler = (1 + angle, 2, 0.5), (0, 0, 0.5 + angle)
        rig.keyframe_insert("location", frame=frame)
        rig.keyframe_insert("rotation_euler", frame=frame)
        key.value = value
        key.keyframe_insert("value", frame=frame)


def select(active, *others):
    for made in bpy.context.scene.objects:
        made.select_set(made in (active, *others))
    bpy.context.view_layer.objects.active = active


def main(folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = 24
    scene.frame_start, scene.frame_end = KEYS[0][0], KEYS[-1][0]
    save(folder, "empty.blend")
    worm, rig = add_tube(), add_rig()
    bind(worm, rig)
    animate(worm, rig)
    select(worm, rig)
    save(folder, "rig.blend")
    worm.modifiers.new("Subdivision", "SUBSURF").levels = 1
    wave = worm.modifiers.new("Wave", "WAVE")
    wave.height, wave.width, wave.narrowness = 0.05, 0.5, 4
    select(worm)
    save(folder, "modifiers.blend")


main(sys.argv[sys.argv.index("--") + 1])

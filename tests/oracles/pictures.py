#!/usr/bin/env python3
"""Pictures of glTF files by a loader and a renderer that are not lodmark's: trimesh reads, Embree casts. Run by
tests/all/io/gltf_pictures.rs.

    pictures.py check                    nothing but whether everything can be imported
    pictures.py rms ORIGINAL FILE...     a line for every FILE: its triangles, and the root mean square over 24 views of
                                         256 x 256 pixels of the difference of luma, 255 |n.v| of the nearest triangle on
                                         white, 127.5 where nothing is hit

The views are the corners of a small rhombicuboctahedron at twice the radius around the original's box, 60 degrees wide.
"""

import sys

import numpy as np
import trimesh
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

SIDE = 256


class Model:
    def __init__(self, path):
        scene = trimesh.load(path, force="scene", process=False, skip_materials=True)
        positions, triangles, count = [], [], 0
        for part in scene.dump():
            positions.append(part.vertices)
            triangles.append(part.faces + count)
            count += len(part.vertices)
        self.positions = np.vstack(positions)
        self.triangles = np.vstack(triangles)
        a, b, c = (self.positions[self.triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        self.normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
        self.scene = EmbreeScene(robust=True)
        floats = np.ascontiguousarray(self.positions, dtype=np.float32)
        TriangleMesh(self.scene, floats, np.ascontiguousarray(self.triangles, dtype=np.uint32))

    def luma(self, eye, rays):
        starts = np.ascontiguousarray(np.repeat(eye[None], len(rays), 0), dtype=np.float32)
        hits = self.scene.run(starts, np.ascontiguousarray(rays, dtype=np.float32), query="INTERSECT")
        hits = np.asarray(hits)
        luma = np.full(len(rays), 127.5)
        hit = hits >= 0
        luma[hit] = 255 * np.abs((self.normals[hits[hit]] * rays[hit]).sum(1))
        return luma


def views(model):
    low, high = model.positions.min(0), model.positions.max(0)
    center, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    long = 1 + 2**0.5
    for corner in [(1, 1, long), (1, long, 1), (long, 1, 1)]:
        for sign in range(8):
            signs = [1 - 2 * (sign >> k & 1) for k in range(3)]
            outward = np.array(corner) * signs
            outward = outward / np.linalg.norm(outward)
            right = np.cross(-outward, [0, 1, 0] if abs(outward[1]) < 0.9 else [1, 0, 0])
            right /= np.linalg.norm(right)
            up = np.cross(right, -outward)
            at = ((np.arange(SIDE) + 0.5) / SIDE * 2 - 1) * np.tan(np.radians(30))
            x, y = np.meshgrid(at, -at)
            rays = (-outward + x[..., None] * right + y[..., None] * up).reshape(-1, 3)
            yield center + outward * 2 * radius, rays / np.linalg.norm(rays, axis=1, keepdims=True)


def main():
    if sys.argv[1] == "check":
        return
    original = Model(sys.argv[2])
    cameras = list(views(original))
    wanted = [original.luma(*camera) for camera in cameras]
    for path in sys.argv[3:]:
        model = Model(path)
        squares = [((model.luma(*c) - w) ** 2).mean() for c, w in zip(cameras, wanted)]
        print(len(model.triangles), np.sqrt(np.mean(squares)))


main()

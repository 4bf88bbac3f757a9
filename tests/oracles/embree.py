#!/usr/bin/env python3
"""Embree as an oracle: casts the rays of a view file, and measures visibility with them. Run by tests/all/visibility/embree.rs.

    embree.py check                nothing but whether everything can be imported
    embree.py cast FOLDER          FOLDER/scene.json, positions.npy, indices.npy
                                   -> view-NN-ids.npy (triangle + 1, 0 where a ray misses), view-NN-depth.npy (z / w)
    embree.py paper FOLDER         the same input, orthographic views -> visibility.npy: V of every triangle by the rule of
                                   Zhang & Turk 2002 on the ID and depth buffers that Embree casts
    embree.py shadow FOLDER STEP   positions.npy, indices.npy, directions.npy -> visibility.npy: V of every STEP-th
                                   triangle (NaN for the others) by shadow rays from its centroid

Matrices are read as the bits of doubles; rays are made in doubles and rounded to the floats that Embree takes.
"""

import json
import pathlib
import struct
import sys

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

# How far above the surface a shadow ray starts, as a fraction of the largest extent: a few hundred floats.
LIFT = 2e-5
# How much deeper than a neighbouring pixel a vertex may lie, in pixels.
NEIGHBOR_TOLERANCE = 1.0


class Mesh:
    def __init__(self, folder):
        self.positions = np.load(folder / "positions.npy")
        self.triangles = np.load(folder / "indices.npy")
        self.scene = EmbreeScene(robust=True)
        TriangleMesh(
            self.scene,
            np.ascontiguousarray(self.positions, dtype=np.float32),
            np.ascontiguousarray(self.triangles, dtype=np.uint32),
        )

    def corners(self):
        return (self.positions[self.triangles[:, i]] for i in range(3))

    def normals(self):
        """Unit normals; 0 for triangles without area."""
        a, b, c = self.corners()
        normals = np.cross(b - a, c - a)
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        return np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)


def floats(rays):
    return np.ascontiguousarray(rays, dtype=np.float32)


def matrix_of(view):
    bits = [struct.unpack(">d", bytes.fromhex(m))[0] for m in view["matrix"]]
    return np.array(bits).reshape(4, 4)


def rays_of(view, width, height):
    """Origins and unit directions through the centres of all pixels, row by row from the top."""
    columns = (np.arange(width) + 0.5) / width * 2 - 1
    rows = 1 - (np.arange(height) + 0.5) / height * 2
    x, y = (plane.ravel() for plane in np.meshgrid(columns, rows))
    inverse = np.linalg.inv(matrix_of(view))

    def point(z):
        p = np.stack([x, y, np.full_like(x, z), np.ones_like(x)]) .T @ inverse.T
        return p[:, :3] / p[:, 3:]

    near, far = point(0.0), point(1.0)
    directions = far - near
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    if "point" in view["eye"]:
        origins = np.broadcast_to(np.array(view["eye"]["point"]), near.shape)
    else:
        origins = near - directions * (0.5 * np.linalg.norm(far - near, axis=1, keepdims=True))
    return origins, directions


def cast(mesh, view, width, height):
    """Triangles (-1 where a ray misses) and z / w (infinite there), as images."""
    origins, directions = map(floats, rays_of(view, width, height))
    result = mesh.scene.run(origins, directions, output=1)
    ids = np.asarray(result["primID"], dtype=np.int64)
    hit = ids >= 0
    depth = np.full(ids.shape, np.inf)
    points = origins[hit].astype(float) + directions[hit].astype(float) * result["tfar"][hit, None]
    clip = points @ matrix_of(view)[2:, :3].T + matrix_of(view)[2:, 3]
    depth[hit] = clip[:, 0] / clip[:, 1]
    return ids.reshape(height, width), depth.reshape(height, width)


def scene_of(folder):
    scene = json.loads((folder / "scene.json").read_text())
    return scene["views"], scene["width"], scene["height"]


def cast_all(folder):
    mesh = Mesh(folder)
    views, width, height = scene_of(folder)
    for i, view in enumerate(views):
        ids, depth = cast(mesh, view, width, height)
        np.save(folder / f"view-{i:02}-ids.npy", (ids + 1).astype("<u4"))
        np.save(folder / f"view-{i:02}-depth.npy", depth.astype("<f8"))


def visible_share(seen, weight):
    return np.divide(seen, weight, out=np.zeros_like(seen), where=weight > 0)


def save_visibility(folder, values):
    np.save(folder / "visibility.npy", values.astype("<f8").reshape(1, -1))


def paper(folder):
    mesh = Mesh(folder)
    views, width, height = scene_of(folder)
    normals = mesh.normals()
    seen, weight = (np.zeros(len(mesh.triangles)) for _ in range(2))
    for view in views:
        ids, depth = cast(mesh, view, width, height)
        shown = np.zeros(len(mesh.triangles), dtype=bool)
        shown[ids[ids >= 0]] = True
        # The deepest of the 3 x 3 pixels around every pixel; beyond the border there is nothing to be deeper than.
        padded = np.pad(depth, 1, constant_values=-np.inf)
        shifts = [padded[y : y + height, x : x + width] for y in range(3) for x in range(3)]
        deepest = np.max(shifts, axis=0)
        clip = mesh.positions @ matrix_of(view)[:3, :3].T + matrix_of(view)[:3, 3]
        column = np.clip(((clip[:, 0] * 0.5 + 0.5) * width).astype(int), 0, width - 1)
        row = np.clip(((0.5 - clip[:, 1] * 0.5) * height).astype(int), 0, height - 1)
        # The depth range is the diameter of the bounding sphere, which the image shows in `width` pixels.
        tolerance = NEIGHBOR_TOLERANCE / width
        visible = clip[:, 2] <= deepest[row, column] + tolerance
        shown |= visible[mesh.triangles].any(axis=1)
        cosine = np.maximum(normals @ np.array(view["eye"]["axis"]), 0)
        seen += cosine * shown
        weight += cosine
    save_visibility(folder, visible_share(seen, weight))


def shadow(folder, step):
    mesh = Mesh(folder)
    chosen = np.arange(0, len(mesh.triangles), step)
    normals = mesh.normals()[chosen]
    a, b, c = mesh.corners()
    centroids = ((a + b + c) / 3)[chosen]
    extent = np.ptp(mesh.positions[np.unique(mesh.triangles)], axis=0).max()
    origins = floats(centroids + normals * (LIFT * extent))
    seen, weight = (np.zeros(len(chosen)) for _ in range(2))
    for direction in np.load(folder / "directions.npy"):
        cosine = normals @ direction
        front = cosine > 0
        towards = floats(np.broadcast_to(direction, (np.count_nonzero(front), 3)))
        blocked = mesh.scene.run(origins[front], towards, query="OCCLUDED") == 0
        seen[front] += cosine[front] * ~blocked
        weight[front] += cosine[front]
    values = np.full(len(mesh.triangles), np.nan)
    values[chosen] = visible_share(seen, weight)
    save_visibility(folder, values)


def main():
    command, *rest = sys.argv[1:]
    if command == "check":
        return
    folder = pathlib.Path(rest[0])
    if command == "cast":
        cast_all(folder)
    elif command == "paper":
        paper(folder)
    elif command == "shadow":
        shadow(folder, int(rest[1]))
    else:
        sys.exit(f"no command {command}")


main()

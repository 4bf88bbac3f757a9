#!/usr/bin/env python3
"""One run of another program, file to file: race.py PROGRAM IN.ply OUT.ply TRIANGLES. Started by benches/measure.py table --race.

Prints the seconds that simplification alone took, without Python, imports and files. Meshes are binary PLY with float
positions and triangles, as the Stanford models are; vertices at equal places are united before, as lodmark does.
"""

import sys
import time

import numpy as np

FACE = [("count", "u1"), ("corners", "i4", 3)]


def read(path):
    with open(path, "rb") as file:
        lines = []
        while not lines or lines[-1] != "end_header":
            lines.append(file.readline().decode("ascii").strip())
        words = [line.split() for line in lines]
        order = {"binary_little_endian": "<", "binary_big_endian": ">"}[words[1][1]]
        counts, columns = {}, 0
        for word in words:
            if word[0] == "element":
                element = word[1]
                counts[element] = int(word[2])
            elif word[0] == "property" and element == "vertex":
                if word[1] not in ("float", "float32"):
                    sys.exit(f"{path}: vertex properties are {word[1]}; expected float")
                columns += 1
        points = np.frombuffer(file.read(4 * columns * counts["vertex"]), order + "f4").reshape(-1, columns)[:, :3]
        face = np.dtype(FACE).newbyteorder(order)
        faces = np.frombuffer(file.read(face.itemsize * counts["face"]), face)
    if (faces["count"] != 3).any():
        sys.exit(f"{path}: expected triangles only")
    return points.astype(np.float32), faces["corners"].astype(np.int32)


def weld(points, faces):
    _, first, inverse = np.unique(points.view("V12").ravel(), return_index=True, return_inverse=True)
    return points[first], inverse.astype(np.int32)[faces]


def write(path, points, faces):
    table = np.empty(len(faces), np.dtype(FACE).newbyteorder("<"))
    table["count"], table["corners"] = 3, faces
    with open(path, "wb") as file:
        file.write(
            f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode()
        )
        file.write(np.ascontiguousarray(points, "<f4").tobytes())
        file.write(table.tobytes())


def fast_simplification(points, faces, triangles):
    import fast_simplification

    def run():
        return fast_simplification.simplify(points, faces, target_count=triangles)

    return run


def pyfqmr(points, faces, triangles):
    import pyfqmr

    def run():
        simplifier = pyfqmr.Simplify()
        simplifier.setMesh(points, faces)
        simplifier.simplify_mesh(target_count=triangles, verbose=False)
        return simplifier.getMesh()[:2]

    return run


def meshoptimizer(points, faces, triangles):
    import meshoptimizer

    def run():
        indices = np.ascontiguousarray(faces.ravel(), np.uint32)
        left = np.zeros_like(indices)
        # No error limit: the largest float that a relative error can have.
        count = meshoptimizer.simplify(left, indices, points, target_index_count=3 * triangles, target_error=1e9)
        left = left[:count].reshape(-1, 3)
        used, left = np.unique(left, return_inverse=True)
        return points[used], left.reshape(-1, 3)

    return run


def pymeshlab(points, faces, triangles):
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(points, faces))

    def run():
        meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=triangles)
        mesh = meshes.current_mesh()
        return mesh.vertex_matrix(), mesh.face_matrix()

    return run


PROGRAMS = {f.__name__.replace("_", "-"): f for f in (fast_simplification, pyfqmr, meshoptimizer, pymeshlab)}


def main():
    name, source, out, triangles = sys.argv[1:]
    run = PROGRAMS[name](*weld(*read(source)), int(triangles))
    start = time.perf_counter()
    points, faces = run()
    print(time.perf_counter() - start)
    write(out, points, faces)


main()

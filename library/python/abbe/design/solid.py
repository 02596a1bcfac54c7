"""A height field as a closed solid with a flat back, as OBJ with normals, as STL, and in a scene."""
import json
import struct

import numpy as np


def solid(face):
    """(points [n, 3], normals [m, 3], triangles [k, 3], the triangles' normals [k, 3] as indices)
    of a Face, in metres, y upwards: the cut face below, rounded; back and sides flat."""
    setup = face.setup
    rows, columns = face.h.shape
    count = rows * columns
    p, q = face.slope
    long = np.sqrt(1 + p * p + q * q)
    cut = np.stack([setup.x, -setup.y, face.h], -1).reshape(-1, 3)
    normals = np.stack([p / long, -q / long, -1 / long], -1).reshape(-1, 3)
    at = np.arange(count).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[:-1, 1:], at[1:, :-1], at[1:, 1:]))
    triangles = [np.stack([a, b, c], -1), np.stack([b, d, c], -1)]
    which = [one.copy() for one in triangles]
    # The rim, clockwise as seen from above the rows: each side with its outward normal.
    rim, back = [], count
    for side, outward in ((at[0, :-1], (0, 1, 0)), (at[:-1, -1], (1, 0, 0)),
                          (at[-1, :0:-1], (0, -1, 0)), (at[:0:-1, 0], (-1, 0, 0))):
        rim.append((side, outward))
    ring = np.concatenate([side for side, _ in rim])
    over = np.arange(back, back + len(ring))
    middle = back + len(ring)
    top = cut[ring].copy()
    top[:, 2] = setup.thickness
    following, above = np.roll(ring, -1), np.roll(over, -1)
    sides = np.concatenate([np.full(len(side), count + k) for k, (side, _) in enumerate(rim)])
    triangles += [np.stack([ring, over, following], -1), np.stack([following, over, above], -1),
                  np.stack([over, np.full(len(ring), middle), above], -1)]
    which += [np.repeat(sides[:, None], 3, 1)] * 2 + [np.full((len(ring), 3), count + 4)]
    return (np.concatenate([cut, top, [[0, 0, setup.thickness]]]),
            np.concatenate([normals, [outward for _, outward in rim], [[0, 0, 1]]]),
            np.concatenate(triangles), np.concatenate(which))


def obj(face):
    """The bytes of an OBJ file."""
    points, normals, triangles, which = solid(face)
    lines = ["# a pane by abbe design, in metres: light comes from +z, onto the flat back"]
    lines += ["v %.9g %.9g %.9g" % tuple(one) for one in points.tolist()]
    lines += ["vn %.7g %.7g %.7g" % tuple(one) for one in normals.tolist()]
    lines += ["f %d//%d %d//%d %d//%d" % tuple(one)
              for one in (np.stack([triangles, which], -1).reshape(-1, 6) + 1).tolist()]
    return ("\n".join(lines) + "\n").encode()


def stl(face):
    """The bytes of a binary STL file, in millimetres, as mills and printers take it."""
    points, _, triangles, _ = solid(face)
    corners = (1000 * points[triangles]).astype("<f4")
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-30)[:, None]
    out = np.zeros(len(triangles), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("", "<u2")])
    out["normal"], out["corners"] = normals, corners
    head = b"a pane by abbe design, in mm".ljust(80)
    return head + struct.pack("<I", len(triangles)) + out.tobytes()


def scene(setup, mesh, table, material, name):
    """The text of a scene in which the pane's light falls on a screen that fills the picture."""
    x, y = setup.middle[0], 0 - setup.middle[1]  # no -0
    rows, columns = setup.shape
    high = 0.8 * setup.distance
    light = ("kind: directional\n    direction: [0, 0, -1]\n    irradiance: 1" if setup.lamp is None
             else "kind: point\n    position: [%.9g, %.9g, %.9g]\n    intensity: %.9g"
             % (*setup.lamp, setup.lamp[2]**2))
    tall = setup.pixel * rows
    name, mesh, table, material = (json.dumps(text, ensure_ascii=False)
                                   for text in (name, mesh, table, material))
    return f"""\
description: {name}
materials: {table}
camera:
  eye: [{x:.9g}, {y:.9g}, {high - setup.distance:.9g}]
  target: [{x:.9g}, {y:.9g}, {-setup.distance:.9g}]
  up: [0, 1, 0]
  fov: {np.degrees(2 * np.arctan(tall / 2 / high)):.9g}
  size: [{columns}, {rows}]
lights:
  - name: light
    {light}
objects:
  - name: pane
    mesh: {mesh}
    material: {material}
  - name: screen
    shape: rectangle
    width: {2 * setup.picture:.9g}
    height: {2 * tall:.9g}
    transform:
      - translate: [{x:.9g}, {y:.9g}, {-setup.distance:.9g}]
    reflectance: 0.8
"""

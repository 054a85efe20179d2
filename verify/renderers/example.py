#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A renderer of one kind of scene, and its adapter: one rectangle that glows, above one diffuse rectangle that it lights.

Nothing but Python's own library, so slow; docs/verify-your-renderer.md walks through it.
"""
import math
import random
import struct
import sys
import xml.etree.ElementTree as ElementTree


def add(a, b): return [x + y for x, y in zip(a, b)]
def sub(a, b): return [x - y for x, y in zip(a, b)]
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def scale(s, a): return [s * x for x in a]
def cross(a, b): return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
def unit(a): return scale(1 / math.sqrt(dot(a, a)), a)


def refuse(why):
    print(why)
    sys.exit(2)  # not an error: "I cannot render this scene"


def numbers(element, path):
    return [float(x) for x in element.find(path).get("value").split()]


def read(path):
    """Camera, receiver, lamp: each a matrix of columns u, v, w, origin; with fov, albedo, radiance."""
    root = ElementTree.parse(path).getroot()
    shapes, things = root.findall("shape"), {}
    if root.find("emitter") is not None or len(shapes) != 2 or any(s.get("type") != "rectangle" for s in shapes):
        refuse("only two rectangles, one of which glows")
    for element in shapes + [root.find("sensor")]:
        m = numbers(element, "transform/matrix")
        columns = [[m[4 * row + column] for row in range(3)] for column in range(4)]
        if element.tag == "sensor":
            things["camera"] = columns, numbers(element, "float[@name='fov']")[0]
        elif element.find("emitter/rgb") is not None:
            things["lamp"] = columns, numbers(element, "emitter/rgb")
        elif element.find("bsdf[@type='diffuse']/rgb") is not None:
            things["floor"] = columns, numbers(element, "bsdf/rgb")
    if len(things) != 3:
        refuse("only two rectangles, one of which glows")
    return things


def hit(rectangle, o, d):
    """Distance along the ray and its point, or None; with the normal (third column: no shear here)."""
    u, v, w, origin = rectangle
    n = unit(cross(u, v))
    if dot(n, w) < 0:
        n = scale(-1, n)
    facing = dot(n, d)
    t = dot(n, sub(origin, o)) / facing if facing else -1
    p = add(o, scale(t, d))
    inside = all(abs(dot(sub(p, origin), side)) <= dot(side, side) for side in (u, v))
    return (t, p, n) if t > 1e-9 and inside else None


def radiance(things, o, d, bounces):
    (lamp, glow), (floor, albedo) = things["lamp"], things["floor"]
    seen = [(h[0], h, which) for h, which in ((hit(lamp, o, d), "lamp"), (hit(floor, o, d), "floor")) if h]
    if not seen:
        return [0, 0, 0]
    _, (_, p, n), which = min(seen, key=lambda s: s[0])
    if which == "lamp":
        return glow if dot(n, d) < 0 else [0, 0, 0]
    if bounces < 1 or dot(n, d) > 0:
        return [0, 0, 0]
    u, v, _, origin = lamp
    q = add(origin, add(scale(2 * random.random() - 1, u), scale(2 * random.random() - 1, v)))
    wi, area = sub(q, p), 4 * math.sqrt(dot(cross(u, v), cross(u, v)))
    squared = dot(wi, wi)
    wi = unit(wi)
    cosines = max(0, dot(n, wi)) * max(0, -dot(hit(lamp, p, wi)[2], wi)) if hit(lamp, p, wi) else 0
    return [a * g / math.pi * cosines * area / squared for a, g in zip(albedo, glow)]


def write_exr(path, width, height, rows):
    """R G B as 32-bit floats, scan lines, no compression: the whole format in a few lines."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(c + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    head = struct.pack("<II", 20000630, 2) + attribute(b"channels", b"chlist", channels)
    head += attribute(b"compression", b"compression", b"\0") + attribute(b"dataWindow", b"box2i", window)
    head += attribute(b"displayWindow", b"box2i", window) + attribute(b"lineOrder", b"lineOrder", b"\0")
    head += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    head += attribute(b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0))
    head += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    size = 8 + 12 * width
    with open(path, "wb") as file:
        file.write(head + b"".join(struct.pack("<Q", len(head) + 8 * height + y * size) for y in range(height)))
        for y, row in enumerate(rows):
            file.write(struct.pack("<ii", y, 12 * width))
            for c in (2, 1, 0):
                file.write(struct.pack(f"<{width}f", *(pixel[c] for pixel in row)))


def render(scene, width, height, samples, seed, bounces, out):
    random.seed(seed)
    things = read(scene)
    (left, up, forward, eye), fov = things["camera"]
    half = math.tan(math.radians(fov) / 2)  # along x, the default; image right is the camera's -x

    def pixel(x, y):
        total = [0, 0, 0]
        for _ in range(samples):  # uniform over the pixel: a box filter
            sx = (1 - 2 * (x + random.random()) / width) * half
            sy = (1 - 2 * (y + random.random()) / height) * half * height / width
            total = add(total, radiance(things, eye, unit(add(forward, add(scale(sx, left), scale(sy, up)))), bounces))
        return scale(1 / samples, total)

    write_exr(out, width, height, [[pixel(x, y) for x in range(width)] for y in range(height)])


if sys.argv[1:] == ["--describe"]:
    print("name=example\nlobes=diffuse\nemitters=area\nmax_bounces=1")
else:
    render(sys.argv[1], *map(int, sys.argv[2:7]), sys.argv[7])

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mitsuba 3 as a renderer under test: one call, one process, any number of images.

    mitsuba_adapter.py scene.xml WIDTH HEIGHT SPP SEED BOUNCES OUT.exr [SEED OUT.exr ...]
    mitsuba_adapter.py --describe

VARIANT (scalar_rgb) and INTEGRATOR (path; see mitsuba_render.py) are environment variables. Exit status 2: Mitsuba cannot
read the scene (motion is a keyword of our own), so there is nothing to judge; 4: Mitsuba is missing or failed.
"""
import os
import sys

import mitsuba_render

# What `direct` leaves out, and what a particle tracer cannot connect to the camera.
LIMITS = {"direct": ["max_bounces=1"], "direct_emitter": ["max_bounces=1", "lobes=diffuse"],
          "direct_bsdf": ["max_bounces=1", "emitters=area,sky"], "ptracer": ["lobes=diffuse"]}


def describe(name):
    # float32, and sums of SPP numbers in it.
    print("\n".join([f"name=mitsuba_{name}", "batch=64", "rounding=1e-5"] + LIMITS.get(name, [])))
    return 0


def write(mi, np, image, path):
    bitmap = mi.Bitmap(np.ascontiguousarray(image[:, :, :3], dtype=np.float32))
    half = path + ".part.exr"
    bitmap.write(half)
    os.replace(half, path)


def main():
    name = os.environ.get("INTEGRATOR", "path")
    if name not in mitsuba_render.INTEGRATORS:
        print(f"INTEGRATOR={name}: expected one of {', '.join(mitsuba_render.INTEGRATORS)}", file=sys.stderr)
        return 4
    if sys.argv[1:] == ["--describe"]:
        return describe(name)
    if len(sys.argv) < 8 or len(sys.argv) % 2:
        print(__doc__, file=sys.stderr)
        return 4
    import mitsuba as mi
    import numpy as np
    scene_file, (width, height, samples, seed, bounces) = sys.argv[1], map(int, sys.argv[2:7])
    jobs = [(seed, sys.argv[7])] + [(int(s), out) for s, out in zip(sys.argv[8::2], sys.argv[9::2])]
    mi.set_variant(os.environ.get("VARIANT", "scalar_rgb"))
    mi.set_log_level(mi.LogLevel.Error)
    try:
        scene = mi.load_file(scene_file)
    except (RuntimeError, OSError) as error:
        print(" ".join(str(error).split()), file=sys.stderr)
        return 2
    if list(scene.sensors()[0].film().size()) != [width, height]:
        print(f"{scene_file} is not {width} x {height}", file=sys.stderr)
        return 4
    how = mitsuba_render.integrator(mi, "path" if bounces == 0 else name, bounces + 1)
    for seed, out in jobs:
        write(mi, np, np.array(mi.render(scene, integrator=how, spp=samples, seed=seed)), out)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (ImportError, OSError, RuntimeError) as problem:
        print(f"mitsuba_adapter.py: {problem}", file=sys.stderr)
        sys.exit(4)

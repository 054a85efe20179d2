#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders a scene with Mitsuba 3, as an image that knows its own error.

    mitsuba_render.py SCENE.xml OUT.exr --spp N --seed N [--bounces K] [--min-bounces 0|1] [--size WxH]
                      [--replicates R] [--variant NAME] [--integrator NAME] [-D NAME=VALUE]

OUT.exr (float32) holds the mean in R G B, the variance of that mean in variance.R/G/B, and in `samples` the number of
replicates. The variance comes from R independent replicates (seeds N, N+1, ...) of N/R samples each: it is itself
known to about sqrt(2/(R-1)). --bounces counts scattering events, so max_depth = bounces + 1; -1 has no limit.
rr_depth lies above that: no Russian roulette. --min-bounces 1 leaves out directly visible emission, by subtracting
a max_depth = 1 render in each replicate, so that the variance accounts for it; pixels on a lamp's edge may come out
negative.

Mitsuba and numpy must be importable. Exit status: 0, 2 bad usage or scene, 4 our own or Mitsuba's fault.
"""
import argparse
import os
import subprocess
import sys

NO_LIMIT = -1
DEEP = 1 << 30  # an rr_depth that no path reaches
# What --integrator may ask for; those of direct light do one bounce whatever --bounces says.
INTEGRATORS = {
    "path": {"type": "path"},
    "volpath": {"type": "volpath"},
    "ptracer": {"type": "ptracer"},
    "direct": {"type": "direct"},
    "direct_emitter": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0},
    "direct_bsdf": {"type": "direct", "emitter_samples": 0, "bsdf_samples": 1},
}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("out")
    parser.add_argument("--spp", type=int, required=True, help="samples a pixel, over all replicates")
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--bounces", type=int, help="default: the file's max_depth - 1")
    parser.add_argument("-k", "--min-bounces", type=int, choices=(0, 1), default=0)
    parser.add_argument("--size", help="WxH, default: the file's")
    parser.add_argument("--replicates", type=int, default=16, help="default 16, at most spp")
    parser.add_argument("--variant", help="default: llvm_ad_rgb where it works, else scalar_rgb")
    parser.add_argument("--integrator", choices=sorted(INTEGRATORS), default="path")
    parser.add_argument("-D", dest="parameters", action="append", default=[], metavar="NAME=VALUE")
    args = parser.parse_args()
    args.replicates = min(args.replicates, args.spp)
    if args.replicates < 1 or args.spp % args.replicates:
        parser.error(f"--spp {args.spp} is no multiple of --replicates {args.replicates}")
    if args.seed < 0 or args.seed + args.replicates > 1 << 32:
        parser.error("--seed must be in [0, 2^32 - replicates]")
    if args.bounces is not None and args.bounces < args.min_bounces and args.bounces != NO_LIMIT:
        parser.error("--bounces must be -1 or at least --min-bounces")
    try:
        args.size = [int(x) for x in args.size.split("x")] if args.size else None
        args.parameters = dict(p.split("=", 1) for p in args.parameters)
    except ValueError:
        parser.error("expected --size WxH and -D NAME=VALUE")
    if args.size and (len(args.size) != 2 or min(args.size) < 1):
        parser.error("expected --size WxH")
    return args


def llvm_works():
    """Some versions of LLVM abort the whole process while they compile a kernel: try it in another one."""
    trial = ("import mitsuba as mi; mi.set_variant('llvm_ad_rgb'); import drjit as dr;"
             "d = mi.cornell_box(); d['sensor']['film']['width'] = 4; d['sensor']['film']['height'] = 4;"
             "dr.eval(mi.render(mi.load_dict(d), spp=1))")
    return subprocess.run([sys.executable, "-c", trial], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, check=False).returncode == 0


def integrator(mi, name, max_depth):
    depths = {} if name.startswith("direct") else {"max_depth": max_depth, "rr_depth": DEEP}
    return mi.load_dict({**INTEGRATORS[name], **depths})


def max_depth_of(scene):
    """The file's max_depth; Mitsuba shows it only in the integrator's description."""
    for line in str(scene.integrator()).splitlines():
        if "max_depth" in line:
            depth = int(line.split("=")[1].strip(" ,"))
            return NO_LIMIT if depth == 0xFFFFFFFF else depth
    return 2 if str(scene.integrator()).startswith("Direct") else NO_LIMIT


def render(mi, np, scene, args):
    """Mean and variance of the mean, from the spread of the replicates."""
    depth = max_depth_of(scene) if args.bounces is None else (NO_LIMIT if args.bounces < 0 else args.bounces + 1)
    whole, emission = integrator(mi, args.integrator, depth), integrator(mi, "path", 1)
    spp = args.spp // args.replicates
    total, squares = 0, 0  # Welford over replicates
    for i in range(args.replicates):
        def picture(how, seed=args.seed + i):
            return np.array(mi.render(scene, integrator=how, spp=spp, seed=seed), dtype=np.float64)[:, :, :3]

        image = picture(whole)
        if args.min_bounces == 1:  # not hide_emitters, which also takes the lamps' surfaces away
            image -= picture(emission)
        delta = image - total
        total = total + delta / (i + 1)
        squares = squares + delta * (image - total)
        if sys.stderr.isatty():
            end = "\n" if i + 1 == args.replicates else ""
            print(f"\rreplicate {i + 1} of {args.replicates}", end=end, file=sys.stderr)
    n = args.replicates
    return total, squares / (n * (n - 1)) if n > 1 else np.zeros_like(total)


def main():
    args = parse_arguments()
    try:
        import mitsuba as mi
        import numpy as np
    except ImportError as error:
        print(f"mitsuba_render.py: {error}; expected Mitsuba 3 and numpy (pip install mitsuba numpy)", file=sys.stderr)
        return 4
    mi.set_variant(args.variant or ("llvm_ad_rgb" if llvm_works() else "scalar_rgb"))
    mi.set_log_level(mi.LogLevel.Error)
    try:
        scene = mi.load_file(args.scene, **args.parameters)
    except (RuntimeError, OSError) as error:
        print(f"mitsuba_render.py: {args.scene}: {error}", file=sys.stderr)
        return 2
    if args.size:
        parameters = mi.traverse(scene.sensors()[0])
        parameters["film.size"] = args.size
        parameters["film.crop_size"] = args.size
        parameters["film.crop_offset"] = [0, 0]
        parameters.update()
    mean, variance = render(mi, np, scene, args)
    # A sample, to whoever reads the file, is what the variance was measured from: one replicate.
    samples = np.full(mean.shape[:2] + (1,), args.replicates)
    pixels = np.concatenate([mean, variance, samples], axis=2).astype(np.float32)
    names = ["R", "G", "B", "variance.R", "variance.G", "variance.B", "samples"]
    bitmap = mi.Bitmap(np.ascontiguousarray(pixels), mi.Bitmap.PixelFormat.MultiChannel, names)
    half = args.out + ".part.exr"  # nothing half-written stays
    bitmap.write(half)
    os.replace(half, args.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())

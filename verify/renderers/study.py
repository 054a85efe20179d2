#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the suite finds in Mitsuba 3 and in POV-Ray: results/renderers.md.

    study.py -o FILE.md [--report DIR]        DIR: of a `lightcheck verify --renderer ... --report DIR` that was made already

The llvm variant needs a libLLVM that Mitsuba can use (libllvm19 of Debian; 14 and 16 abort), installed by hand; where there is
none the file says so. Exit status: 0 written, 2 no Mitsuba, 4 something failed.
"""
import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

import mitsuba_render

PROGRAM = os.environ.get("LIGHTCHECK", "build/lightcheck")
ADAPTER = "verify/renderers/mitsuba.sh"
LIFT = 1500 * 2.0**-24  # Mitsuba's RayEpsilon in float32


def report(folder, *selection, **environment):
    """The quick suite through the adapter, or a part of it."""
    environment = dict(os.environ, PYTHON=sys.executable, **environment)
    command = [PROGRAM, "verify", "--renderer", ADAPTER, "--report", folder, *selection]
    status = subprocess.run(command, env=environment, stdout=subprocess.DEVNULL, check=False).returncode
    if status not in (0, 1, 3):
        raise RuntimeError(f"{' '.join(command)} ended with status {status}")


def write_rows(out, folder):
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        found = json.load(file)
    rows = found["rows"]
    count = {v: sum(r["verdict"] == v for r in rows) for v in ("PASS", "FAIL", "UNDECIDED")}
    out.write(f"{len(rows)} rows over {len({r['scene'] for r in rows})} scenes: {count['PASS']} PASS, {count['FAIL']} FAIL, "
              f"{count['UNDECIDED']} UNDECIDED, {found['paths'] / 1e6:.0f} M paths.\n\n"
              "| check | scene | bounces | verdict | mean / expected | interval | margin |\n|---|---|---|---|---|---|---|\n")
    for r in rows:
        numbers = "exact | | "
        if not r["exact"] and r["ratio"] is not None and None not in r["interval"]:
            numbers = f"{r['ratio']:.5f} | {r['interval'][0]:.5f} .. {r['interval'][1]:.5f} | {100 * r['margin']:.2f}%"
        out.write(f"| {r['check']} | {r['scene']} | {r['min_bounces']} to {r['max_bounces']} | {r['verdict']} | {numbers} |\n")


def mean(mi, np, scene, integrator, images=16, samples=256):
    """Mean over an image and its standard error."""
    how = mi.load_dict(integrator)
    means = [float(np.mean(np.array(mi.render(scene, integrator=how, spp=samples, seed=i)), dtype=np.float64)) for i in range(images)]
    return np.mean(means), np.std(means, ddof=1) / math.sqrt(images)


def write_blend(out, mi, np):
    view = mi.ScalarTransform4f().look_at([0, 0, 1], [0, .1, 0], [0, 1, 0])
    out.write("| weight of the mirror | expected | found | predicted by the cause |\n|---|---|---|---|\n")
    for weight in (0.2, 0.4, 0.5, 0.8):
        blend = {"type": "blendbsdf", "weight": weight,
                 "a": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}},
                 "b": {"type": "conductor", "material": "none", "specular_reflectance": {"type": "rgb", "value": 1.0}}}
        film = {"type": "hdrfilm", "width": 8, "height": 8, "rfilter": {"type": "box"}}
        scene = mi.load_dict({"type": "scene", "sky": {"type": "constant", "radiance": 1.0},
                              "plate": {"type": "rectangle", "bsdf": blend},
                              "sensor": {"type": "perspective", "to_world": view, "fov": 1, "film": film}})
        found, error = mean(mi, np, scene, {"type": "path", "max_depth": 2})
        density = (1 / math.sqrt(1.01)) / math.pi  # the diffuse lobe's, of the mirror's direction
        out.write(f"| {weight} | {weight} | {found:.4f} +- {error:.4f} | {weight**2 / (weight + (1 - weight) * density):.4f} |\n")


def write_inside(out, mi, np):
    scene = mi.load_file("scenes/furnace_sphere.xml")
    strategies = (("lamps alone", {"emitter_samples": 1, "bsdf_samples": 0}), ("directions alone", {"emitter_samples": 0, "bsdf_samples": 1}),
                  ("both, weighted", {"emitter_samples": 1, "bsdf_samples": 1}))
    exact = np.mean([0.5 * 1.8, 1.5, 2 * 1.2])  # Le (1 + rho)
    out.write("| samples | mean / expected of the reflected light |\n|---|---|\n")
    for name, samples in strategies:
        found, error = mean(mi, np, scene, {"type": "direct", **samples}, samples=64)
        reflected = exact - np.mean([0.5, 1, 2])
        out.write(f"| {name} | {1 + (found - exact) / reflected:.5f} +- {error / reflected:.5f} |\n")


def corridor(np, lift, samples=400):
    """The mirror corridor in double, each ray lifted off its mirror as Mitsuba lifts it; the same numbers for any lift."""
    random = np.random.default_rng(1)
    eye, target, side = np.array([0.1, 0.2, 0.3]), np.array([-1, 0.1, -0.35]), 64
    axis = (target - eye) / np.linalg.norm(target - eye)
    left = np.cross([0, 0, 1.0], axis)
    left /= np.linalg.norm(left)
    up, half = np.cross(axis, left), math.tan(math.radians(15))
    tints, glow, total = np.array([[0.9, 0.7, 0.5], [0.6, 0.8, 0.95]]), np.array([3.0, 2, 1]), 0
    rows, columns = np.mgrid[0:side, 0:side]
    for _ in range(samples):
        x, y = (1 - 2 * (a + random.random(rows.shape)) / side for a in (columns, rows))
        d = axis + half * (x[..., None] * left + y[..., None] * up)
        p, weight, alive = np.broadcast_to(eye, d.shape).copy(), np.ones(d.shape), np.ones(rows.shape, bool)
        for _ in range(13):
            wall = np.sign(d[..., 0])
            to_wall, to_floor = (wall - p[..., 0]) / d[..., 0], (-3 - p[..., 2]) / d[..., 2]
            ends = alive & (d[..., 2] < 0) & (to_floor < to_wall)
            total = total + np.sum((weight * glow)[ends], axis=0)
            alive &= ~ends
            p = p + to_wall[..., None] * d
            p[..., 0] = wall - wall * lift * (1 + np.abs(p).max(axis=-1))
            weight = weight * tints[(wall > 0).astype(int)]
            d = d * [-1, 1, 1]
    return total


def write_lift(out, np):
    change = 100 * (corridor(np, LIFT) / corridor(np, 0) - 1)
    out.write(f"Lifting rays so in a double-precision walk changes the means of `mirror_corridor` by {change[0]:.4f}%, {change[1]:.4f}% and "
              f"{change[2]:.4f}% (R, G, B); Mitsuba was found to be off by -0.006%.\n")


def write_sizes(out, mi, np, images=32, samples=16):
    """The same box at three sizes with the same random numbers, light of one bounce: what a length that does not scale does."""
    means = {}
    for name in ("cornell", "cornell_small", "cornell_large"):
        scene, glow = mi.load_file(f"scenes/{name}.xml"), mi.load_dict({"type": "path", "max_depth": 1})
        how = mi.load_dict({"type": "direct"})
        means[name] = np.array([sum(sign * np.mean(np.array(mi.render(scene, integrator=i, spp=samples, seed=seed)), dtype=np.float64)
                                    for sign, i in ((1, how), (-1, glow))) for seed in range(images)])
    whole = means["cornell"].mean()
    out.write("\nThe same box at other sizes, reflected light of one bounce:\n\n| scene | mean / that of `cornell` |\n|---|---|\n")
    for name in ("cornell_small", "cornell_large"):
        differences = (means[name] - means["cornell"]) / whole
        out.write(f"| {name} | {1 + differences.mean():.5f} +- {differences.std(ddof=1) / math.sqrt(images):.5f} |\n")


# (integrator, scene, check): a closed form, a reference by another program, and where `path` fails.
JUDGED = (("direct", "plane_tilted", "analytic"), ("direct", "furnace_sphere", "furnace"), ("direct", "mirror_sky", "specular"),
          ("volpath", "plane_tilted", "analytic"), ("volpath", "furnace_sphere", "furnace"), ("volpath", "glass_sphere", "specular"),
          ("ptracer", "plane_tilted", "analytic"))


def write_integrators(out, folder):
    runs = [("scalar_rgb", *j) for j in JUDGED]
    if mitsuba_render.llvm_works():
        runs += [("llvm_ad_rgb", "path", s, c) for s, c in (("plane_tilted", "analytic"), ("mirror_corridor", "specular"))]
    else:
        out.write("`llvm_ad_rgb` does not run here: its LLVM is missing, or of a version that aborts while it compiles.\n\n")
    out.write("| variant | integrator | check | scene | bounces | verdict | mean / expected | interval |\n|---|---|---|---|---|---|---|---|\n")
    for n, (variant, integrator, scene, check) in enumerate(runs):
        here = os.path.join(folder, str(n))
        report(here, "--scene", scene, "-c", check, VARIANT=variant, INTEGRATOR=integrator)
        with open(os.path.join(here, "report.json"), encoding="utf-8") as file:
            rows = json.load(file)["rows"]
        for r in rows:
            exact = r["exact"] or r["ratio"] is None or None in r["interval"]
            numbers = "exact | " if exact else f"{r['ratio']:.5f} | {r['interval'][0]:.5f} .. {r['interval'][1]:.5f}"
            out.write(f"| {variant} | {integrator} | {check} | {scene} | {r['min_bounces']} to {r['max_bounces']} | {r['verdict']} | {numbers} |\n")


def povray(scene, image, side):
    subprocess.run(["povray", f"+I{scene}", f"+O{image}", "+FE", f"+W{side}", f"+H{side}", "-A", "-D", "+WT1"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


FURNACE = """#version 3.7;
global_settings {{
    assumed_gamma 1.0 max_trace_level 30 adc_bailout 1e-6
    radiosity {{ recursion_limit 20 count 20 error_bound 0.1 always_sample on gray_threshold 0 brightness 1 {bailout} }}
}}
camera {{ location <0, 0, 0> right x up y direction z }}
sphere {{ <0, 0, 0>, 100 pigment {{ rgb 1 }} finish {{ ambient 0 emission 1 diffuse 0.5 }} }}
"""


def write_bailout(out, mi, np, folder):
    out.write("| radiosity's adc_bailout | shown, expected 2 |\n|---|---|\n")
    for name, bailout in ((".01, the default", ""), ("1e-4", "adc_bailout 1e-4")):
        scene, image = os.path.join(folder, "furnace.pov"), os.path.join(folder, "furnace.exr")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(FURNACE.format(bailout=bailout))
        povray(scene, image, 8)
        out.write(f"| {name} | {read_rgb(mi, np, image).mean():.6f} |\n")


def write_table(out, mi, np, folder):
    ours = os.path.join(folder, "sky.exr")
    subprocess.run([PROGRAM, "render", "sky_wall", "-e", "hemisphere_direct", "-s", "16384", "--min-bounces", "1", "-o", ours],
                   check=True, stdout=subprocess.DEVNULL)
    expected = read_rgb(mi, np, ours).mean()
    out.write("| rays of a gathering | POV-Ray / ours - 1 |\n|---|---|\n")
    for count in (200, 400, 1600):
        pov, image = os.path.join(folder, "wall.pov"), os.path.join(folder, "wall.exr")
        subprocess.run([PROGRAM, "export", "sky_wall", "--to", "pov", "--mode", "radiosity", "--bounces", "1", "--count", str(count), "-o", pov],
                       check=True)
        povray(pov, image, 128)
        out.write(f"| {count} | {100 * (read_rgb(mi, np, image).mean() / expected - 1):+.3f}% |\n")


def read_rgb(mi, np, path):
    bitmap = mi.Bitmap(path)
    names = [field.name for field in bitmap.struct_()]
    return np.array(bitmap, copy=False).astype(np.float64)[..., [names.index(c) for c in "RGB"]]


def write_points(out, mi, np, folder):
    """POV-Ray's lamps as N x N points, against light_direct."""
    ours = os.path.join(folder, "ours.exr")
    subprocess.run([PROGRAM, "render", "plane_rectangle", "-e", "light_direct", "-s", "16384", "--min-bounces", "1", "-o", ours],
                   check=True, stdout=subprocess.DEVNULL)
    expected = read_rgb(mi, np, ours)
    out.write("| points | image mean / ours - 1 | rms of a pixel (our own noise is 0.7%) |\n|---|---|---|\n")
    for points in (3, 4, 8, 16):
        pov, image = os.path.join(folder, "scene.pov"), os.path.join(folder, "scene.exr")
        subprocess.run([PROGRAM, "export", "plane_rectangle", "--to", "pov", "--points", str(points), "-o", pov], check=True)
        subprocess.run(["povray", f"+I{pov}", f"+O{image}", "+FE", "+W512", "+H512", "-A", "-D"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        theirs = read_rgb(mi, np, image).reshape(64, 8, 64, 8, 3).mean(axis=(1, 3))
        rms = math.sqrt(np.mean((theirs - expected)**2)) / expected.mean()
        out.write(f"| {points} x {points} | {100 * (theirs.mean() / expected.mean() - 1):+.4f}% | {100 * rms:.3f}% |\n")


TEXT = ["""# What the suite finds in other renderers

Made by `make renderer-study`; Mitsuba {version}, {variant}, integrator `path`; POV-Ray 3.7.

## Mitsuba 3 through the adapter
`lightcheck verify --renderer verify/renderers/mitsuba.sh`. """, """
Three causes explain every FAIL. [mitsuba.md](mitsuba.md) compares image by image, and agrees once they are worked around.

### A mirror in `blendbsdf` loses light
White sky, a plate that is a perfect mirror by the weight, else black: it must show the weight. A sampled mirror is weighed
with its probability PLUS the other lobe's density in that direction, as if both were densities: of the mirror's weight w comes
w^2 / (w + (1 - w) cos / pi). FAIL of `mirror_sky`, `bright_mirrors` and `cornell_mirror`. With a rough
mirror (`roughconductor`, alpha 0.001), which has a density, all agree.

""", """
Again: `PYTHON=... lightcheck verify --renderer verify/renderers/mitsuba.sh --scene mirror_sky`.

### Inside a glowing sphere the weights do not add up
`sphere.cpp` tells the inside from the outside by the distance from the centre, but `sample_direction` allows for rounding
(radius times 1 + RayEpsilon) and `pdf_direction` does not. A point OF the sphere, seen from inside, is outside for the density
in one case of fifty, which is then that of a cone. One strategy alone is exact; together they give {more}:

""", """
Again: `--scene furnace_sphere`.

### Rays are lifted by 1500 float32 epsilons of 1 + |p|
`Interaction::offset_p` moves each origin by 8.9e-5 (1 + max |p|) along the normal: an absolute length for small scenes. Of
`cornell_small`, 2 mm wide, that is 4.5%: FAIL, 3.4% too dark in the worst tile. It adds up along mirrors:

""", """
### Other integrators and variants
INTEGRATOR and VARIANT of the adapter choose; rows of `lightcheck verify --renderer verify/renderers/mitsuba.sh --scene SCENE -c CHECK`.

""", """
## POV-Ray
### Few points for a lamp
Its area lights are points. What N x N Gauss-Legendre points of a lamp as wide as its distance is high leave
(`plane_rectangle`, the exporter's lamps):

""", """
### Radiosity stops early by default
A closed white sphere that glows with 1 and has albedo 1/2 shows 2. Its own `adc_bailout`, not that of the scene, ends a chain:

""", """
### More radiosity rays do not converge to the right value
`sky_wall`, a floor beside a wall under a sky, gathered; ours is `hemisphere_direct`. More rays change nothing. Presumably
since they are the first of one table for all points, and neighbours share what they gathered.

""", """
The exporter avoids the first two (docs/povray.md), and the band of `sky_wall` is wide for the third. With that all images agree: the
povray rows of `lightcheck verify`.
"""]


def write(out, folder):
    import mitsuba as mi
    import numpy as np
    mi.set_variant("scalar_rgb")
    mi.set_log_level(mi.LogLevel.Error)
    out.write(TEXT[0].format(version=mi.__version__, variant=mi.variant()))
    write_rows(out, folder)
    out.write(TEXT[1])
    write_blend(out, mi, np)
    out.write(TEXT[2].format(more="0.14% too much"))
    write_inside(out, mi, np)
    out.write(TEXT[3])
    write_lift(out, np)
    write_sizes(out, mi, np)
    out.write(TEXT[4])
    with tempfile.TemporaryDirectory() as work:
        write_integrators(out, work)
        out.write(TEXT[5])
        write_points(out, mi, np, work)
        out.write(TEXT[6])
        write_bailout(out, mi, np, work)
        out.write(TEXT[7])
        write_table(out, mi, np, work)
    out.write(TEXT[8])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", dest="out", required=True)
    parser.add_argument("--report")
    args = parser.parse_args()
    try:
        import mitsuba  # noqa: F401 (what is missing is said at once)
        import numpy  # noqa: F401
    except ImportError as error:
        print(f"study.py: {error}; expected Mitsuba 3 and numpy: pip install mitsuba numpy, and PYTHON=interpreter that has them",
              file=sys.stderr)
        return 2
    folder = args.report or tempfile.mkdtemp()
    half = args.out + ".part"
    try:
        if not args.report:
            report(folder)
        with open(half, "w", encoding="utf-8") as out:
            write(out, folder)
        os.replace(half, args.out)  # nothing half-written stays
    finally:
        if os.path.exists(half):
            os.remove(half)
        if not args.report:
            shutil.rmtree(folder)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (subprocess.CalledProcessError, OSError, RuntimeError) as problem:
        print(f"study.py: {problem}", file=sys.stderr)
        sys.exit(4)

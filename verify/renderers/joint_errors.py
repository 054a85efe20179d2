#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares two images that know their own errors: the whole image, and every 8x8 tile.

    joint_errors.py OURS.exr THEIRS.exr LABEL

Prints one row of a Markdown table: label, ratio of the means, the largest |z| of a channel over the image, the largest over the 8x8 tiles and
how many tiles there are. z is the difference over its joint standard error. Exit status 1 where a z is beyond what chance gives once in a
million such tables (5.5 for the image, 6.5 for a tile). For the verdict of the judge use `lightcheck compare`, which also guards against
heavy tails; it needs third moments, which only a film in memory has, so that most pairs of files stay undecided there.
"""
import sys

import mitsuba as mi
import numpy as np

IMAGE_LIMIT, TILE_LIMIT = 5.5, 6.5


def read(path):
    mi.set_variant("scalar_rgb")
    bitmap = mi.Bitmap(path)
    names = [field.name for field in bitmap.struct_()]
    pixels = np.array(bitmap, copy=False).astype(np.float64)
    pick = lambda wanted: np.stack([pixels[..., names.index(name)] for name in wanted], axis=-1)
    return pick(["R", "G", "B"]), pick(["variance.R", "variance.G", "variance.B"])


def tiles(values, size):
    height, width = values.shape[:2]
    return values.reshape(height // size, size, width // size, size, 3).sum(axis=(1, 3))


def largest_z(difference, variance):
    still = variance == 0
    if np.any(np.abs(difference[still]) > 1e-6):
        return np.inf
    return np.max(np.abs(difference[~still]) / np.sqrt(variance[~still]), initial=0.0)


def main():
    (ours, our_variance), (theirs, their_variance) = read(sys.argv[1]), read(sys.argv[2])
    variance = our_variance + their_variance
    # Images that differ by rounding only have variances of rounding, too.
    difference, floor = ours - theirs, 1e-6 * np.mean(theirs)
    difference = np.where(np.abs(difference) < floor, 0.0, difference)
    image = largest_z(difference.sum(axis=(0, 1)), variance.sum(axis=(0, 1)))
    local = largest_z(tiles(difference, 8), tiles(variance, 8))
    total = np.mean(theirs)
    ratio = f"{np.mean(ours) / total:.5f}" if total > 0 else "both black" if np.all(ours == 0) else "inf"
    count = ours.shape[0] * ours.shape[1] // 64
    good = image < IMAGE_LIMIT and local < TILE_LIMIT
    print(f"| {sys.argv[3]} | {ratio} | {image:.2f} | {local:.2f} | {count} | {'agrees' if good else 'DIFFERS'} |")
    return 0 if good else 1


sys.exit(main())

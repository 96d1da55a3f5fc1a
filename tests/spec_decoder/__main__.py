"""A slow decoder of .gim version 1, written from SPEC.md alone, to check that page against the golden files.

usage: python3 spec_decoder HASHES.txt FILE.gim...
Each file's samples and triangles must have the hash that the list tells.
"""
import os
import struct
import sys

from container import read_chunks
from fusing import make_unit
from images import read_attribute, read_image
from mesh import triangles
from seam import classes, read_seam


def hash_of(path):
    with open(path, "rb") as file:
        chunks, is_prefix = read_chunks(file.read())
    seam = read_seam(chunks["S"])
    value = 14695981039346656037

    def add(data):
        nonlocal value
        for byte in data:
            value = (value ^ byte) * 1099511628211 & 0xFFFFFFFFFFFFFFFF

    n, coding, xyz = read_image(chunks["G"], seam, True, True, is_prefix)
    for fuse, diffuse in ((True, True), (False, False), (True, False)):
        if coding == 0:
            n, _, xyz = read_image(chunks["G"], seam, fuse, diffuse)
        add(struct.pack("<%df" % len(xyz), *xyz))
    if "n" in chunks:
        _, coding, normals = read_image(chunks["n"], seam, True, True)
        if coding != 2:
            make_unit(normals)
        add(struct.pack("<%df" % len(normals), *normals))
    for attribute in chunks.get("a", []):
        bits, samples = read_attribute(attribute, seam)
        add(struct.pack("<%d%s" % (len(samples), "I" if bits else "f"), *samples))
    indices = triangles(n, classes(seam, n), xyz)
    add(struct.pack("<%dI" % len(indices), *indices))
    return "%016x" % value


def main():
    with open(sys.argv[1]) as file:
        expected = dict(line.split() for line in file)
    wrong = 0
    for path in sys.argv[2:]:
        name = os.path.splitext(os.path.basename(path))[0]
        found = hash_of(path)
        if found != expected.get(name):
            wrong += 1
        print(name, found, "as expected" if found == expected.get(name) else "DIFFERS")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

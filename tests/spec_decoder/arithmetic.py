"""Numbers that several sections share: f32, vectors, classes of sums."""
import struct

from container import demand


def f32(x):
    demand(abs(x) <= 3.4028234663852886e38)
    return struct.unpack("<f", struct.pack("<f", x))[0]


def cls(x, cap):
    if x < 2:
        return x
    if x > 65535:
        return cap
    o = x.bit_length() - 1
    return min(cap, 2 * o + (x >> (o - 1) & 1))


def sg(x):
    return (x > 0) - (x < 0)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def times(f, a):
    return (f * a[0], f * a[1], f * a[2])


def root(k):
    return [1.0, 1.189207115002721, 1.4142135623730951, 1.6817928305074292][k % 4] * float(1 << k // 4)

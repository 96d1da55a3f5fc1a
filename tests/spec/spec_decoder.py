#!/usr/bin/env python3
"""A slow decoder of .gim version 1, written from SPEC.md alone, to check that page against the golden files.

usage: spec_decoder.py HASHES.txt FILE.gim...
Each file's samples and triangles must have the hash that the list tells.
"""
import math
import os
import struct
import sys
import zlib

M32 = 0xFFFFFFFF


class Refused(Exception):
    pass


def demand(condition, error="CORRUPT"):
    if not condition:
        raise Refused(error)


# --- section 2: container

def read_chunks(data):
    """The chunks, and whether the file is cut short within its geometry."""
    demand(data[:4] == b"\x89GIM")
    demand(data[4] == 1, "UNSUPPORTED")
    demand(struct.unpack_from("<I", data, 6)[0] == zlib.crc32(data[:6]))
    chunks, at = {}, 10
    for _ in range(data[5]):
        begin, kind = at, chr(data[at])
        at += 1
        length = shift = 0
        while True:
            byte = data[at]
            at += 1
            length |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
        if at + length > len(data):
            demand(kind == "G" and "S" in chunks, "MORE_INPUT")
            chunks[kind] = data[at:]
            return chunks, True
        if kind == "a":
            chunks.setdefault(kind, []).append(data[at:at + length])
        else:
            chunks[kind] = data[at:at + length]
        at += length
        demand(struct.unpack_from("<I", data, at)[0] == zlib.crc32(data[begin:at]))
        at += 4
    demand(at == len(data))
    return chunks, False


# --- section 3: range coder

class Model:
    def __init__(self):
        self.v, self.seen = 1 << 15, 0

    def estimate(self):
        return self.v >> 1

    def update(self, bit):
        rate = 327680 // (10 * self.seen + 16)
        self.v += ((64 if bit else 65471) - self.v) * rate >> 15
        self.seen = min(self.seen + 1, 62)


def start_weights(count):
    return [4096 * 12 // 10 // count] * count


L = [11, 18, 30, 49, 81, 133, 219, 360, 589, 961, 1554, 2486, 3906, 5978, 8813, 12371, 16384, 20397, 23955,
     26790, 28862, 30282, 31214, 31807, 32179, 32408, 32549, 32635, 32687, 32719, 32738, 32750, 32757]


def squash(x):
    o = max(-2047, min(2047, x)) + 2048
    c, w = o >> 7, o & 127
    return (L[c] * (128 - w) + L[c + 1] * w + 64) >> 7


STRETCH = []
_x = -2047
for _k in range(4096):
    while _x < 2047 and squash(_x) < 8 * _k + 4:
        _x += 1
    STRETCH.append(_x)


class Decoder:
    def __init__(self, data, is_prefix=False):
        self.data, self.at, self.range, self.code, self.is_prefix = data, 0, M32, 0, is_prefix
        for _ in range(4):
            self.code = self.code << 8 | self.byte()

    def byte(self):
        self.at += 1
        demand(self.is_prefix or self.at <= len(self.data) + 4)
        return self.data[self.at - 1] if self.at <= len(self.data) else 0

    def finish(self):
        demand(self.is_prefix or self.at >= len(self.data))

    def has_ended(self):
        return self.is_prefix and self.at > len(self.data)

    def renormalise(self):
        while self.range < 1 << 24:
            self.range = self.range << 8 & M32
            self.code = (self.code << 8 | self.byte()) & M32

    def with_probability(self, z):
        bound = (self.range >> 15) * z
        bit = self.code >= bound
        if bit:
            self.code -= bound
            self.range -= bound
        else:
            self.range = bound
        self.renormalise()
        return int(bit)

    def raw(self, count):
        value = 0
        for _ in range(count):
            self.range >>= 1
            bit = self.code >= self.range
            if bit:
                self.code -= self.range
            value = value << 1 | bit
            self.renormalise()
        return value

    def bit(self, model):
        bit = self.with_probability(model.estimate())
        model.update(bit)
        return bit

    def mixed(self, models, weights):
        s = [2 * STRETCH[m.estimate() >> 3] * (32767 * m.seen // (m.seen + 1)) >> 16 for m in models]
        z = squash(sum(w * x for w, x in zip(weights, s)) >> 12)
        bit = self.with_probability(z)
        e = 3 * ((0 if bit else 1 << 15) - z) >> 4
        for k, model in enumerate(models):
            moves = 2 * s[k] * e >> 16
            weights[k] = max(-32600, min(32600, weights[k] + (moves + 1 >> 1)))
            model.update(bit)
        return bit


class ExpGolomb:
    def __init__(self, prefixes):
        self.more = [Model() for _ in range(prefixes)]
        self.upper = [Model() for _ in range(prefixes)]

    def read(self, d):
        b = 0
        while b < len(self.more) and d.bit(self.more[b]):
            b += 1
        if b == 0:
            return 0
        demand(b < len(self.more))
        t = 2 + d.bit(self.upper[b])
        return (t << (b - 1) | d.raw(b - 1)) - 1


class Models(dict):
    """Models by context, made when first used."""

    def __init__(self, make=Model):
        super().__init__()
        self.make = make

    def __missing__(self, key):
        self[key] = self.make()
        return self[key]


# --- section 4: seam

BOUNDARY, FIRST, MATE = 0, 1, 2


def read_seam(content):
    l = content[0]
    demand(l > 0)
    total = 4 << l
    d = Decoder(content[1:])
    start = d.raw(l + 2)
    mate_model, boundary_model = Models(), Models()
    rank_code, length_code = ExpGolomb(15), ExpGolomb(15)
    sides, opened, used, reserved, labels, before = [], [], 0, 0, 0, None
    while used < total:
        left = total - used - reserved
        if left == 0 or (opened and d.bit(mate_model[before == FIRST])):
            rank = rank_code.read(d) if len(opened) > 1 else 0
            demand(rank < len(opened))
            label, length = opened.pop(len(opened) - 1 - rank)
            reserved -= length
            before = MATE
        else:
            boundary = left == 1 or d.bit(boundary_model[before == BOUNDARY])
            label, length = labels, 1 + length_code.read(d)
            labels += 1
            demand(length <= (left if boundary else left // 2))
            before = BOUNDARY if boundary else FIRST
            if not boundary:
                opened.append((label, length))
                reserved += length
        sides.append((label, length, before))
        used += length
    d.finish()
    return l, start, sides


def classes(seam, n):
    l, start, sides = seam
    size, u = 4 * (n - 1), (n - 1) >> l
    glued = {k: [] for k in range(size)}
    at, first = start * u, {}
    for label, length, kind in sides:
        d = length * u
        if kind == FIRST:
            first[label] = at
        if kind == MATE:
            for k in range(d + 1):
                a, b = (first[label] + k) % size, (at + d - k) % size
                glued[a].append(b)
                glued[b].append(a)
        at += d
    least = [None] * size
    for k in range(size):
        if least[k] is None:
            stack = [k]
            while stack:
                p = stack.pop()
                if least[p] is None:
                    least[p] = k
                    stack += glued[p]
    return least


def border_sample(n, p):
    last = n - 1
    side, along = divmod(p, last)
    return [(along, 0), (last, along), (last - along, last), (0, last - along)][side]


# --- section 5: images

def f32(x):
    demand(abs(x) <= 3.4028234663852886e38)
    return struct.unpack("<f", struct.pack("<f", x))[0]


def read_image(content, seam, fuse, diffuse, is_prefix=False):
    kind = content[0]
    demand(kind >> 7 == 0 and 1 <= (kind & 15) <= 12, "UNSUPPORTED")
    n = (1 << (kind & 15)) + 1
    coding = kind >> 4
    if coding == 0:
        return n, coding, read_wavelet(n, content[1:], seam, fuse, diffuse)
    if coding == 3:
        return n, coding, read_surface(n, content[1:], seam, is_prefix)
    if coding == 5:
        return n, coding, [f32(x) for x in read_field(n, content[1:], seam, 3, True)]
    least_of = classes(seam, n)
    if coding == 1:
        least, (step,) = struct.unpack_from("<3f", content, 1), struct.unpack_from("<f", content, 13)
        demand(2.0 ** -100 <= step <= 2.0 ** 100 and all(map(math.isfinite, least)))
        integers = ExactImage(n, 3, 12, least_of, Decoder(content[17:])).samples
        return n, coding, [f32(least[k % 3] + q * step) for k, q in enumerate(integers)]
    demand(coding == 2, "UNSUPPORTED")
    return n, coding, ExactImage(n, 3, 0, least_of, Decoder(content[1:])).samples


def read_attribute(content, seam):
    L = content[0]
    demand(1 <= L <= 63)
    name, (k, flags, kind) = content[1:1 + L].decode("utf-8"), content[1 + L:4 + L]
    demand(1 <= k <= 16)
    demand(flags & 3 < 3 and flags >> 4 == 0 and kind >> 7 == 0, "UNSUPPORTED")
    n, coding, rest = (1 << (kind & 15)) + 1, kind >> 4, content[4 + L:]
    bits, glued = (8, 16, 0)[flags & 3], flags >> 2 & 1
    demand(bits or not flags & 8)
    if coding == 2:
        least_of = classes(seam, n) if glued else list(range(4 * (n - 1)))
        return bits, ExactImage(n, k, bits, least_of, Decoder(rest)).samples
    demand(coding == 5, "UNSUPPORTED")
    samples = read_field(n, rest, seam, k, glued)
    if bits:
        return bits, [int(max(0.0, min((1 << bits) - 1, x)) + 0.5) for x in samples]
    return bits, [f32(x) for x in samples]


def bits_of(value):
    return struct.unpack("<I", struct.pack("<f", value))[0]


def order_of(value):
    bits = bits_of(value)
    return ~bits & M32 if bits >> 31 else bits | 1 << 31


def quarters(x):
    bits = struct.unpack("<Q", struct.pack("<d", abs(x)))[0]
    return max(0, 4 * ((bits >> 52) - 1023 + 150) + 4 + (bits >> 50 & 3))


class Fit:
    def __init__(self, start):
        self.start, self.w = start, list(start)
        N = len(start)
        self.A, self.b, self.E, self.M = [[0.0] * N for _ in range(N)], [0.0] * N, 0.0, 0.0

    def fade(self, f):
        self.E, self.M = self.E * f, self.M * f
        self.b = [value * f for value in self.b]
        self.A = [[value * f for value in row] for row in self.A]

    def learn(self, x, y, d, g):
        self.E += g * (d * d)
        self.M += 1.0
        for k in range(len(x)):
            h = g * x[k]
            self.b[k] += h * y
            for l in range(k + 1):
                self.A[k][l] += h * x[l]

    def solve(self):
        if not self.M > 0:
            return
        N, trace = len(self.w), 0.0
        for k in range(N):
            trace += self.A[k][k]
        p = 100.0 * (self.E / self.M) + 1e-12 * trace
        F, z = [[0.0] * N for _ in range(N)], [0.0] * N
        for k in range(N):
            for l in range(k + 1):
                value = self.A[k][l] + p if k == l else self.A[k][l]
                for q in range(l):
                    value -= F[k][q] * F[l][q]
                if k == l:
                    if not value > 0:
                        return
                    F[k][k] = math.sqrt(value)
                else:
                    F[k][l] = value / F[l][l]
        for k in range(N):
            value = self.b[k] + p * self.start[k]
            for q in range(k):
                value -= F[k][q] * z[q]
            z[k] = value / F[k][k]
        for k in reversed(range(N)):
            value = z[k]
            for q in range(k + 1, N):
                value -= F[q][k] * z[q]
            z[k] = value / F[k][k]
        self.w = z


CORNERS = [(-1, -1), (1, -1), (-1, 1), (1, 1)]
THIS_BAND = [(-2, 0), (0, -2), (-2, -2), (2, -2)]
PREDICTED_FROM = [  # nearest, their number; others known; of this band; weights at first
    ([(1, 0), (-1, 0)], [(-3, 0), (3, 0), (-1, -2), (1, -2), (-1, 2), (1, 2)], THIS_BAND,
     [0.0, -0.0625, -0.0625] + [0.0] * 8),
    ([(0, 1), (0, -1)], [(0, -3), (0, 3)] + CORNERS + [(-2, -1), (2, -1), (-2, 1), (2, 1)], THIS_BAND,
     [0.0, -0.0625, -0.0625] + [0.0] * 12),
    ([(0, 1), (-1, 0), (1, 0), (0, -1)], CORNERS + [(-3, 0), (3, 0), (0, -3), (0, 3)], THIS_BAND[:2],
     [0.25] * 3 + [-0.25] * 4 + [0.0] * 6)]
COARSER = [[(-1, 0), (1, 0)], CORNERS, [(-1, 0), (1, 0), (0, -1), (0, 1)]]
NEAR = [(3, -2, 0), (3, 0, -2), (2, -2, -2), (2, 2, -2), (1, -4, 0), (1, 0, -4)]


class ExactImage:
    """n x n samples of K channels of integers of B bits, or of f32 for B = 0."""

    def __init__(self, n, K, B, least_of, d):
        self.n, self.K, self.B, self.d = n, K, B, d
        self.samples, self.S = [None] * (K * n * n), [None] * (K * n * n)
        self.members = {}
        for p, least in enumerate(least_of):
            self.members.setdefault(least, []).append(border_sample(n, p))
        self.glued = {at: group for group in self.members.values() for at in group}
        self.models, self.weights = Models(), Models(lambda: start_weights(3))
        half = (n - 1) // 2
        for j in range(0, n, half):
            for i in range(0, n, half):
                self.visit(i, j, self.coarse)
        self.fits = [[Fit(PREDICTED_FROM[band][3]) for _ in range(K)] for band in range(3)]
        self.s = half // 2
        while self.s >= 1:
            for band in range(3):
                for fit in self.fits[band]:
                    fit.fade(0.1)
                for j in range(0 if band == 0 else self.s, n, 2 * self.s):
                    for fit in self.fits[band]:
                        fit.fade(0.95)
                        fit.solve()
                    for i in range(0 if band == 1 else self.s, n, 2 * self.s):
                        self.visit(i, j, lambda i, j, c: self.detail(band, i, j, c))
            self.s //= 2
        d.finish()

    def visit(self, i, j, code):
        K, at = self.K, self.K * (j * self.n + i)
        if self.samples[at] is not None:
            return
        for c in range(K):
            order, self.S[at + c] = code(i, j, c)
            self.samples[at + c] = self.sample_of(order)
            if code != self.coarse:
                self.learn(self.samples[at + c])
        for x, y in self.glued.get((i, j), []):
            to = K * (y * self.n + x)
            self.samples[to:to + K], self.S[to:to + K] = self.samples[at:at + K], self.S[at:at + K]

    def sample_of(self, order):
        if self.B:
            demand(order < 1 << self.B)
            return order
        value = struct.unpack("<f", struct.pack("<I", order & ~(1 << 31) if order >> 31 else ~order & M32))[0]
        demand(math.isfinite(value))
        return value

    def coarse(self, i, j, c):
        return self.d.raw(self.B or 32), (0, 0)

    def inside(self, i, j):
        return 0 <= i < self.n and 0 <= j < self.n

    def folded(self, x):
        while x < 0:
            x += 2 * self.s
        while x >= self.n:
            x -= 2 * self.s
        return x

    def predict(self, band, i, j, c):
        nearest, known, this_band, _ = PREDICTED_FROM[band]
        value = lambda x, y: float(self.samples[self.K * (y * self.n + x) + c])
        v = [value(self.folded(i + x * self.s), self.folded(j + y * self.s)) for x, y in nearest + known]
        base = 0.0
        for k in range(len(nearest)):
            base += v[k]
        base *= 1.0 / len(nearest)
        for x, y in this_band:
            x, y = i + x * self.s, j + y * self.s
            v.append(value(x, y) if self.inside(x, y) else base)
        x = [value - base for value in v[1:]]
        correction = 0.0
        for w, value in zip(self.fits[band][c].w, x):
            correction += w * value
        prediction = base + correction
        if not abs(prediction) <= 3.4028234663852886e38:
            prediction = base
        return prediction, base, x

    def detail(self, band, i, j, c):
        d, K, s = self.d, self.K, self.s
        prediction, base, x = self.predict(band, i, j, c)
        u = 150 if self.B else max(1, bits_of(f32(prediction)) >> 23 & 255)

        def size(x, y, channel=c):
            x, y = i + x * s, j + y * s
            return self.S[K * (y * self.n + x) + channel] if self.inside(x, y) else (0, 0)

        def mean(weighted):
            weights = sum(w for w, q in weighted if q)
            return sum(w * q for w, q in weighted) // weights if weights else 0

        near = mean([(w, size(x, y)[0]) for w, x, y in NEAR])
        coarser = mean([(1, size(x, y)[0]) for x, y in COARSER[band]])
        if c > 0:
            other = mean([(1, size(0, 0, k)[0]) for k in range(c)])
        else:
            other = mean([(1, size(x, y, k)[0]) for k in range(1, K) for x, y in THIS_BAND[:2]])
        corr = quarters(prediction - base)
        X = mean([(6, near), (2, coarser), (4 if c else 1, other)]) or corr
        self.learn = lambda sample: self.learn_from(band, c, sample, prediction, base, x, X, u)
        rel = lambda q: max(0, min(130, q - 4 * u))
        near, coarser, corr, here = rel(near or X), rel(coarser or X), rel(corr), rel(X)
        clamp = lambda q, count: max(0, min(count - 1, q))

        most = self.B or 32
        first, component = min(here >> 2, most - 1), min(c, 2)

        def is_above(t):
            place = 0 if t == first else 1 if t == first + 1 else 2 if t > first else 3 if t == first - 1 else 4
            small = min(t, 3)
            keys = [(0, clamp(4 * t - here + 32, 64), component, place, small),
                    (1, clamp(4 * t - coarser + 24, 48), clamp((corr - coarser + 16) >> 1, 16), place, small),
                    (2, clamp(4 * t - corr + 24, 48), clamp((near - corr + 16) >> 1, 16), place, small)]
            return d.mixed([self.models[key] for key in keys], self.weights[place, small, band])

        length = first
        if is_above(first):
            length += 1
            while length < most and is_above(length):
                length += 1
        else:
            while length > 0 and not is_above(length - 1):
                length -= 1
        if self.B:
            order = int(max(0.0, min((1 << self.B) - 1, prediction)) + 0.5)
        else:
            order = order_of(f32(prediction))
        if length == 0:
            return order, (4 * u, 1)
        distance = 1
        keys = [lambda: ("leading", length, clamp((here - 4 * length + 16) >> 2, 8)),
                lambda: ("second", length, distance & 1), lambda: ("third", length, distance & 3)]
        for key in keys[:length - 1]:
            distance = distance << 1 | d.bit(self.models[key()])
        if length > 4:
            distance = distance << (length - 4) | d.raw(length - 4)
        before = [size(0, 0, c - k)[1] if c >= k else 0 for k in (1, 2)]
        negative = d.bit(self.models["negative", component, size(-2, 0)[1], size(0, -2)[1], *before])
        order = (order + (-distance if negative else distance)) & M32
        below = (distance << 2 >> (length - 1)) & 3
        return order, (4 * u + 4 * length + below, 1 + negative)

    def learn_from(self, band, c, sample, prediction, base, x, X, u):
        error = sample - prediction
        g = 1.0 / ((error * error + 2.0 ** ((X >> 1) - 300)) + 2.0 ** (2 * u - 300))
        self.fits[band][c].learn(x, sample - base, error, g)


def cls(x, cap):
    if x < 2:
        return x
    if x > 65535:
        return cap
    o = x.bit_length() - 1
    return min(cap, 2 * o + (x >> (o - 1) & 1))


def sg(x):
    return (x > 0) - (x < 0)


def read_coarse(d, coarse_code=None, components=3):
    coarse = [[0] * 9 for _ in range(3)]
    coarse_code = coarse_code or ExpGolomb(50)
    for c in range(components):
        for k in range(9):
            if k == 0:
                b = d.raw(6)
                demand(b <= 50)
                magnitude, expected = d.raw(b), 0
            else:
                magnitude = coarse_code.read(d)
                expected = coarse[c][k - 3 if k % 3 == 0 else k - 1]
            if magnitude and d.raw(1):
                magnitude = -magnitude
            coarse[c][k] = expected if d.has_ended() else expected + magnitude
            demand(abs(coarse[c][k]) < 1 << 50)
    return coarse


def read_coefficients(n, d):
    coarse = read_coarse(d)
    empty_models, magnitude_models, sign_models = Models(), Models(), Models()
    larger = Models(lambda: ExpGolomb(30))
    weights = Models(lambda: start_weights(5))
    sign_weights = Models(lambda: start_weights(3))
    bands = {}
    m = 3
    while 2 * m - 1 <= n:
        for band, (width, height) in enumerate([(m - 1, m), (m, m - 1), (m - 1, m - 1)]):
            empty = [d.bit(empty_models[c]) for c in range(3)]
            planes = [[[0] * width for _ in range(height)] for _ in range(3)]
            bands[m, band] = planes
            if all(empty):
                continue
            for j in range(height):
                for i in range(width):
                    near = []
                    for c in range(3):
                        q = planes[c]
                        v = lambda x, y: q[y][x] if 0 <= x < width and y >= 0 else 0
                        p = bands[(m + 1) // 2, band][c][j // 2][i // 2] if m > 3 else 0
                        h = bands[m, 0][c][j][min(i, m - 2)] if band > 0 else 0
                        vert = bands[m, 1][c][j][i] if band == 2 else 0
                        near.append(([v(i - 1, j), v(i, j - 1), v(i - 1, j - 1), v(i + 1, j - 1), p, h],
                                     abs(v(i - 2, j)) + abs(v(i, j - 2)), vert))
                    here = [0, 0, 0]
                    for c in range(3):
                        if empty[c]:
                            continue
                        own, farther, vert = near[c]
                        W, N, NW, NE, P, H = map(abs, own)
                        around = 2 * (W + N) + NW + NE + farther
                        family = P + 2 * (H + abs(vert))
                        others = sum(2 * abs(here[k]) for k in range(c))
                        others += sum((abs(near[k][0][0]) + abs(near[k][0][1]) + 1) // 2 for k in range(c + 1, 3))
                        a, b, f = cls(around, 17), cls(others, 7), cls(family, 7)
                        w, nn, dd = cls(W, 7), cls(N, 7), cls(NW + NE, 7)
                        t = cls(2 * around + 3 * others + 2 * family, 23)
                        k = 0
                        while k < 3:
                            keys = [(0, a, b, c, k), (1, a, f, band == 2, k), (2, w, nn, dd, k), (3, t, c, k),
                                    (4, m, band, min(a, 9), k)]
                            if not d.mixed([magnitude_models[key] for key in keys], weights[t, k]):
                                break
                            k += 1
                        if k == 0:
                            continue
                        magnitude = k if k < 3 else 3 + larger[a].read(d)
                        demand(magnitude < 1 << 30)
                        x = 0
                        for o in range(c):
                            x += sg(here[o]) * sum(sg(near[o][0][e]) * sg(own[e]) * cls(abs(near[o][0][e]), 63) *
                                                   cls(abs(own[e]), 63) for e in range(6))
                        e = 0 if x == 0 else (1 if x < 0 else 4) + (0 if abs(x) < 4 else 1 if abs(x) < 16 else 2)
                        keys = [(0, band, sg(own[0]), sg(own[1]), sg(own[2]), sg(own[3])), (1, c, e),
                                (2, band, sg(own[4]), sg(own[5]))]
                        negative = d.mixed([sign_models[key] for key in keys], sign_weights[band])
                        here[c] = planes[c][j][i] = -magnitude if negative else magnitude
        m = 2 * m - 1
    return coarse, bands


Z = 1.149604398860241
A = Z * Z
STEPS = [(0, -0.443506852043971), (1, -0.882911075530934), (0, 0.052980118572961), (1, 1.586134342059924)]


def lift(line):
    last = len(line) - 1
    for parity, factor in STEPS:
        for k in range(parity, last + 1, 2):
            line[k] += factor * (line[1 if k == 0 else k - 1] + line[last - 1 if k == last else k + 1])


def read_wavelet(n, content, seam, fuse, diffuse):
    step, shifts = struct.unpack_from("<fB", content)
    demand(2.0 ** -100 <= step <= 2.0 ** 100)
    d = Decoder(content[5:])
    coarse, bands = read_coefficients(n, d)
    d.finish()
    shift1, shift2 = ((shifts & 15) - 8) / 32, ((shifts >> 4) - 8) / 32

    def real(q):
        value = (abs(q) - (shift1 if abs(q) == 1 else shift2)) * step if q else 0.0
        return -value if q < 0 else value

    out = [0.0] * (3 * n * n)
    for c in range(3):
        image, m = [[coarse[c][3 * j + i] * step for i in range(3)] for j in range(3)], 3
        while 2 * m - 1 <= n:
            size = 2 * m - 1
            fine = [[0.0] * size for _ in range(size)]
            for j in range(size):
                for i in range(size):
                    y, x = j // 2, i // 2
                    if i % 2 == 0 and j % 2 == 0:
                        fine[j][i] = image[y][x] * (1.0 / A)
                    else:
                        band = 0 if j % 2 == 0 else 1 if i % 2 == 0 else 2
                        fine[j][i] = real(bands[m, band][c][y][x]) * (A if band == 2 else 1.0)
            for i in range(size):
                column = [fine[j][i] for j in range(size)]
                lift(column)
                for j in range(size):
                    fine[j][i] = column[j]
            for line in fine:
                lift(line)
            image, m = fine, size
        if fuse:
            fuse_component(image, n, classes(seam, n), diffuse)
        for j in range(n):
            for i in range(n):
                out[3 * (j * n + i) + c] = f32(image[j][i])
    return out


# --- section 5.3: surface

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


class Border:
    def __init__(self, seam, n):
        l, start, sides = seam
        numbers = [1 << l, start] + [length for _, length, _ in sides]
        z = 0
        while all(x % (2 << z) == 0 for x in numbers):
            z += 1
        self.coarsest = max(2, (1 << l) >> z) + 1
        self.n, self.least = n, classes(seam, n)

    def glued(self, n):
        return n >= self.coarsest

    def classes(self, n):
        stride = (self.n - 1) // (n - 1)
        return [self.least[k * stride] // stride for k in range(4 * (n - 1))]

    def mates(self, n):
        members = {}
        for p, c in enumerate(self.classes(n)):
            members.setdefault(c, []).append(p)
        mate = {}
        for group in members.values():
            if len(group) == 2:
                a, b = (border_sample(n, p) for p in group)
                mate[a], mate[b] = b, a
        return mate

    def average(self, image, n):
        least, size = self.classes(n), 4 * (n - 1)
        total, weight = [0.0] * size, [0.0] * size
        for p in range(size):
            i, j = border_sample(n, p)
            w = 1.0 if p % (n - 1) == 0 else 2.0
            total[least[p]] += w * image[j][i]
            weight[least[p]] += w
        for p in range(size):
            i, j = border_sample(n, p)
            image[j][i] = total[least[p]] / weight[least[p]]


def transform_along_seam(image, n, border):
    last = n - 1
    for parity, factor in STEPS:
        for j in range(parity, n, 2):
            above, below = image[1 if j == 0 else j - 1], image[last - 1 if j == last else j + 1]
            for i in range(n):
                image[j][i] += factor * (above[i] + below[i])
        for line in image:
            for k in range(parity, n, 2):
                line[k] += factor * (line[1 if k == 0 else k - 1] + line[last - 1 if k == last else k + 1])
        if parity == 0 and border:
            border.average(image, n)


class DetailModels:
    def __init__(self):
        self.coarse = ExpGolomb(50)
        self.empty, self.block, self.growth, self.next, self.sign = Models(), Models(), Models(), Models(), Models()
        self.lonely, self.run, self.lonely_run, self.first = Models(), Models(), Models(), Models()
        self.run_weights = Models(lambda: start_weights(3))
        self.block_weights = Models(lambda: start_weights(3))
        self.growth_weights = Models(lambda: start_weights(4))
        self.sign_weights = Models(lambda: start_weights(3))


class Level:
    """Details by (component, i, j): q in steps, without the missing bits; known, their magnitudes without these."""

    def __init__(self, n, mates, glued):
        self.n, self.mates, self.glued, self.B = n, mates, glued, max(1, (n - 1) // 8)
        self.q, self.known, self.filled, self.missing, self.is_filled = {}, {}, set(), 0, False

    def block(self, i, j):
        return min(i // 8, self.B - 1), min(j // 8, self.B - 1)

    def has(self, e, block):
        return (e,) + block in self.filled

    def begins_run(self, band, i, j, block):
        """Whether the details of four places are told at once."""
        if not self.has(0, block) or self.has(1, block) or i // 2 % 4 or i // 8 != block[0]:
            return False
        end = self.n if block[0] == self.B - 1 else 8 * block[0] + 8
        if i + 6 >= end or self.glued and (i == 0 or j in (0, self.n - 1)):
            return False
        return not any(self.known.get((0, i + x, j + y)) for y in (-2, 0, 2) for x in range(-2, 10, 2))

    def places(self):
        for band, (i0, j0) in enumerate([(1, 0), (0, 1), (1, 1)]):
            for j in range(j0, self.n, 2):
                for i in range(i0, self.n, 2):
                    bi, bj = self.block(i, j)
                    if not self.has(0, (bi, bj)) and not self.has(1, (bi, bj)):
                        continue
                    other = self.mates.get((i, j))
                    if other:
                        other_band = 1 if other[0] % 2 == 0 else 0
                        if (other_band, other[1], other[0]) < (band, j, i):
                            continue
                    yield band, i, j, (bi, bj), other


def read_all_details(d, models, border, n_file, components):
    """The coarse image, and the levels."""
    passes = d.raw(5)
    demand(passes <= 30)
    coarse = read_coarse(d, models.coarse, components)
    levels, m = [], 3
    while m < n_file:
        levels.append(Level(2 * m - 1, border.mates(2 * m - 1) if border.glued(m) else {}, border.glued(m)))
        m = 2 * m - 1
    for k in reversed(range(passes)):
        if d.has_ended() or not read_pass(d, models, levels, components, k):
            break
    return coarse, levels


def read_pass(d, models, levels, components, k):
    for v, level in enumerate(levels):
        level.missing = k
        if level.is_filled:
            for key in level.known:
                level.known[key] = min(255, 2 * level.known[key])
        else:
            empty = d.bit(models.empty[v])
            if d.has_ended():
                return False
            if empty:
                continue
            level.is_filled = True
        coarser = levels[v - 1] if v else None
        finer = levels[v + 1] if v + 1 < len(levels) else None
        if not read_blocks(d, models, v, level, coarser, components):
            return False
        told = set()
        for band, i, j, block, other in level.places():
            if (i, j) in told:
                continue
            if level.begins_run(band, i, j, block):
                x, q = read_run(d, models, level, coarser, finer, v, k, band, i, j)
                if d.has_ended():
                    return False
                told |= {(i + other_x, j) for other_x in range(0, min(x + 2, 8), 2)}
                if q is not None:
                    level.q[0, i + x, j], level.known[0, i + x, j] = q, 1
                if (i, j) in told:
                    continue
            for c in range(components):
                if not level.has(min(c, 1), block):
                    continue
                q = read_bit(d, models, level, coarser, finer, v, k, band, i, j, c, components)
                if d.has_ended():
                    return False
                if q is None:
                    continue
                known = min(255, level.known.get((c, i, j), 0) + 1)
                for at in ((i, j), other) if other else ((i, j),):
                    level.q[(c,) + at], level.known[(c,) + at] = q, known
    return True


def read_blocks(d, models, v, level, coarser, components):
    before = coarser.known if coarser else {}
    directions = 1 if components == 1 else 2
    for bj in range(level.B):
        for bi in range(level.B):
            if all(level.has(e, (bi, bj)) for e in range(directions)):
                continue

            def sum_of(e, least, most):
                return sum(before.get((c, 4 * bi + x, 4 * bj + y), 0) for c in ((0,), (1, 2))[e]
                           for y in range(least, most + 1) for x in range(least, most + 1))

            g = 0
            for e in range(directions):
                if not level.has(e, (bi, bj)):
                    f = lambda x, y: int(level.has(e, (bi + x, bj + y)))
                    o = 2 * (f(-1, 0) + f(0, -1)) + f(-1, -1) + f(1, -1) + f(1, 0) + f(0, 1)
                    below = sum_of(e, 0, 4)
                    x, y = cls(below, 13), cls(sum_of(e, -2, 6) - below, 13)
                    keys = [(0, e, g, v, o), (1, e, g, o, x), (2, e, g, min(x, 9), y)]
                    fills = d.mixed([models.block[key] for key in keys], models.block_weights[e, g])
                    if d.has_ended():
                        return False
                    if not fills:
                        continue
                    level.filled.add((e, bi, bj))
                g = 1
    return True


class Surroundings:
    def __init__(self, level, coarser, finer, band, i, j, c):
        K = lambda x, y: level.known.get((c, i + x, j + y), 0)
        self.across, self.along = K(-2, 0) + K(2, 0), K(0, -2) + K(0, 2)
        self.dia = K(-2, -2) + K(2, -2) + K(-2, 2) + K(2, 2)
        self.sib = 0
        if band != 2:
            self.sib += K(-1, -1) + K(1, -1) + K(-1, 1) + K(1, 1)
        if band != 1:
            self.sib += K(0, -1) + K(0, 1)
        if band != 0:
            self.sib += K(-1, 0) + K(1, 0)
        U, D = relatives(coarser, finer, i, j, c)
        self.up = 2 * U(0, 0) + U(-2, 0) + U(2, 0) + U(0, -2) + U(0, 2)
        self.below = 2 * sum(D(x, y) for x in (0, 2) for y in (0, 2))
        self.others = 2 * sum(level.known.get((o, i, j), 0) for o in range(3) if o != c)
        self.near = self.across + self.along + (self.dia + 1) // 2
        self.sum = 2 * (self.near + self.others) + self.up + self.sib + self.below


def relatives(coarser, finer, i, j, c):
    """Known magnitudes of the level before and of that after, around a place."""
    pi, pj = i // 4 * 2 + i % 2, j // 4 * 2 + j % 2
    ci, cj = i // 2 * 4 + i % 2, j // 2 * 4 + j % 2
    return (lambda x, y: coarser.known.get((c, pi + x, pj + y), 0) if coarser else 0,
            lambda x, y: finer.known.get((c, ci + x, cj + y), 0) if finer else 0)


def read_run(d, models, level, coarser, finer, v, k, band, i, j):
    """How far the first detail is that is not 0, and the detail; (6, None) if all are 0."""
    sib = sum(level.known.get((0, i + x, j + y), 0) for y in (-1, 0, 1) for x in range(-1, 8))
    U, D = relatives(coarser, finer, i, j, 0)
    up = 3 * (U(0, 0) + U(2, 0)) + U(-2, 0) + U(4, 0) + U(0, -2) + U(2, -2) + U(0, 2) + U(2, 2)
    below = sum(D(x, y) for y in (0, 2) for x in range(0, 16, 2))
    total = 2 * up + sib + below
    if total == 0:
        grows = d.bit(models.lonely_run[v, band])
    else:
        keys = [(0, cls(up, 9), cls(sib, 13), band), (1, cls(below, 7), cls(up + sib, 13)), (2, v, band, cls(total, 13))]
        grows = d.mixed([models.run[key] for key in keys], models.run_weights[band])
    if d.has_ended() or not grows:
        return 6, None
    sums = [Surroundings(level, coarser, finer, band, i + x, j, 0).sum for x in (0, 2, 4, 6)]
    first = 0
    while first < 3 and not d.bit(models.first[first, cls(sums[first], 5), cls(sum(sums[first + 1:]), 5)]):
        if d.has_ended():
            return 6, None
        first += 1
    if d.has_ended():
        return 6, None
    return 2 * first, read_sign(d, models, level, coarser, k, band, i + 2 * first, j, 0)


def read_bit(d, models, level, coarser, finer, v, k, band, i, j, c, components):
    """The detail with bit k, None if that is 0."""
    e = min(c, 1)
    s = Surroundings(level, coarser, finer, band, i, j, c)
    t = cls(s.sum, 23)
    here = level.q.get((c, i, j), 0)
    if here:
        known = level.known.get((c, i, j), 0)
        size = 0 if known < 4 else 1 if known < 8 else 2 if known < 16 else 3
        if not d.bit(models.next[size, t]):
            return None
        return here + (1 << k) if here > 0 else here - (1 << k)
    if s.sum == 0:
        grows = d.bit(models.lonely[v, band, e])
    else:
        keys = [(0, cls(s.across, 7), cls(s.along, 7), cls(s.dia, 7), e), (1, t, c, v),
                (2, cls(s.up, 9), cls(s.sib, 11), band, e), (3, cls(s.near, 13), cls(2 * s.others + s.below, 11), e)]
        grows = d.mixed([models.growth[key] for key in keys], models.growth_weights[t // 2, e])
    return read_sign(d, models, level, coarser, k, band, i, j, c) if grows else None


def read_sign(d, models, level, coarser, k, band, i, j, c):
    """The detail, of which this is the highest bit."""
    e = min(c, 1)
    q = lambda x, y: level.q.get((c, i + x, j + y), 0)
    if band == 2:
        F = q(0, -1) + q(0, 1) + q(-1, 0) + q(1, 0)
    else:
        F = q(-1, -1) - q(1, -1) - q(-1, 1) + q(1, 1)
    parent = sg(coarser.q.get((c, i // 4 * 2 + i % 2, j // 4 * 2 + j % 2), 0)) if coarser else 0
    W = sg(q(-2, 0))
    keys = [(0, band, W, sg(q(2, 0)), sg(q(0, -2)), sg(q(0, 2)), e), (1, band, parent, sg(F), W, e),
            (2, band, parent, sg(q(-2, 0) + q(2, 0)), sg(q(0, -2) + q(0, 2)), e)]
    return -(1 << k) if d.mixed([models.sign[key] for key in keys], models.sign_weights[band, e]) else 1 << k


def read_surface(n_file, content, seam, is_prefix):
    step, ratios, limits = struct.unpack_from("<fBB", content)
    demand(2.0 ** -100 <= step <= 2.0 ** 100)
    d = Decoder(content[6:], is_prefix)
    border = Border(seam, n_file)
    coarse, levels = read_all_details(d, DetailModels(), border, n_file, 3)
    d.finish()
    surface = build(border, coarse, levels, n_file, 3, SurfaceFrames(step, ratios, limits))
    return [f32(surface[c][j][i]) for j in range(n_file) for i in range(n_file) for c in range(3)]


def read_field(n, content, seam, channels, glued):
    step, kind = struct.unpack_from("<fB", content)
    demand(2.0 ** -100 <= step <= 2.0 ** 100)
    demand(kind & 15 < 3, "UNSUPPORTED")
    d, models, images = Decoder(content[5:]), DetailModels(), []
    border = Border(seam, n) if glued else OpenBorder()
    while len(images) < channels:
        count = min(3, channels - len(images))
        coarse, levels = read_all_details(d, models, border, n, count)
        frames = FieldFrames(step, kind & 15 if count == 3 else 0, root(2 * (kind >> 4)))
        images += build(border, coarse, levels, n, count, frames)[:count]
    d.finish()
    return [image[j][i] for j in range(n) for i in range(n) for image in images]


class OpenBorder:
    def glued(self, n):
        return False


def build(border, coarse, levels, n_file, components, frames):
    surface = [[[q * frames.step for q in image[3 * j:3 * j + 3]] for j in range(3)] for image in coarse]
    if border.glued(3):
        for image in surface:
            border.average(image, 3)
    m = 3
    for v, level in enumerate(levels):
        n = level.n
        glued = border if border.glued(m) else None
        prediction = []
        for image in surface:
            fine = [[0.0] * n for _ in range(n)]
            for j in range(m):
                for i in range(m):
                    fine[2 * j][2 * i] = image[j][i] * (1.0 / A)
            transform_along_seam(fine, n, glued)
            prediction.append(fine)
        if level.is_filled:
            frames.begin(prediction, n, v, level.mates)
            details = {}
            middle = 0.5 * ((1 << level.missing) - 1)
            for band, i, j, block, other in level.places():
                q = [level.q.get((c, i, j), 0) for c in range(3)]
                if not any(q):
                    continue
                axes, steps = frames.at(i, j)
                detail = (0.0, 0.0, 0.0)
                for c in range(components):
                    if q[c]:
                        value = q[c] - middle if q[c] < 0 else q[c] + middle
                        detail = add(detail, times(value * steps[c], axes[c]))
                details[i, j] = detail
                if other:
                    details[other] = detail
            for c in range(components):
                fine = [[0.0] * n for _ in range(n)]
                for (i, j), value in details.items():
                    fine[j][i] = value[c] * A if i % 2 and j % 2 else value[c]
                transform_along_seam(fine, n, glued)
                for j in range(n):
                    for i in range(n):
                        prediction[c][j][i] += fine[j][i]
        if not glued and border.glued(n):
            for image in prediction:
                border.average(image, n)
        surface, m = prediction, n
    return surface


def root(k):
    return [1.0, 1.189207115002721, 1.4142135623730951, 1.6817928305074292][k % 4] * float(1 << k // 4)


class Prediction:
    """A level before its details."""

    def begin(self, prediction, n, v, mate):
        self.prediction, self.last, self.mate = prediction, n - 1, mate

    def P(self, i, j):
        return self.prediction[0][j][i], self.prediction[1][j][i], self.prediction[2][j][i]

    def derivative(self, i, j, x, y):
        P, last = self.P, self.last
        i0, j0, i1, j1 = i - x, j - y, i + x, j + y
        low, high = i0 >= 0 and j0 >= 0, i1 <= last and j1 <= last
        if low and high:
            return sub(P(i1, j1), P(i0, j0))
        inner = P(i1, j1) if high else P(i0, j0)
        if (i, j) in self.mate:
            a, b = self.mate[i, j]
            inside = lambda k: min(max(k, 1), last - 1) if k in (0, last) else k
            outer = P(inside(a), inside(b))
        else:
            outer = add(P(i, j), sub(P(i, j), inner))
        return sub(inner, outer) if high else sub(outer, inner)


class SurfaceFrames(Prediction):
    def __init__(self, step, ratios, limits):
        self.step, self.ratios, self.limits = step, ratios, limits

    def begin(self, prediction, n, v, mate):
        super().begin(prediction, n, v, mate)
        mean, P = 0.0, self.P
        for j in range(self.last):
            for i in range(self.last):
                c = cross(sub(P(i + 1, j + 1), P(i, j)), sub(P(i, j + 1), P(i + 1, j)))
                mean += math.sqrt(dot(c, c))
        self.mean = mean * 0.5 / (float(self.last) * float(self.last))
        self.most = root(min(v * (self.ratios & 15), 2 * (self.ratios >> 4)))

    def at(self, i, j):
        P, last, mean, most = self.P, self.last, self.mean, self.most
        limit, flatness = 1 + (self.limits & 15) / 4, root(2 * (self.limits >> 4))
        di, dj = self.derivative(i, j, 1, 0), self.derivative(i, j, 0, 1)
        g = cross(di, dj)
        G, I = dot(g, g), dot(di, di)
        if G > 0 and I > 0:
            normal, along = times(1.0 / math.sqrt(G), g), times(1.0 / math.sqrt(I), di)
            axes = (normal, along, cross(normal, along))
        else:
            axes = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
        f, area = 1.0, math.sqrt(G) * 0.25
        if mean > 0:
            r, squared = area / mean, limit * limit
            f = math.sqrt(squared if r * limit * limit < 1 else 1.0 / squared if r > squared else 1.0 / r)
        w = self.step * f
        si = sj = (0.0, 0.0, 0.0)
        if 0 < i < last:
            si = sub(add(P(i + 1, j), P(i - 1, j)), times(2.0, P(i, j)))
        if 0 < j < last:
            sj = sub(add(P(i, j + 1), P(i, j - 1)), times(2.0, P(i, j)))
        bent, flat = dot(si, si) + dot(sj, sj), flatness * flatness * area
        ratio = most if flat >= most * most * bent else math.sqrt(flat / bent) if flat > bent else 1.0
        return axes, (w, w * ratio, w * ratio)


class FieldFrames(Prediction):
    def __init__(self, step, kind, ratio):
        self.step, self.kind, self.ratio = step, kind, ratio

    def at(self, i, j):
        step, ratio = self.step, self.ratio
        axes, steps = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), [step] * 3
        if self.kind == 1:
            a, b, c, e = 0.5773502691896258, 0.7071067811865476, 0.4082482904638631, 0.8164965809277261
            axes, steps = ((a, a, a), (b, 0.0, -b), (c, -e, c)), [step, step * ratio, step * ratio]
        if self.kind == 2:
            steps = [step * ratio, step, step]
            p = self.P(i, j)
            if dot(p, p) > 0:
                radial = times(1.0 / math.sqrt(dot(p, p)), p)
                di = self.derivative(i, j, 1, 0)
                across = sub(di, times(dot(di, radial), radial))
                if dot(across, across) > 0:
                    along = times(1.0 / math.sqrt(dot(across, across)), across)
                    axes = (radial, along, cross(radial, along))
        return axes, steps


# --- section 6: fusing and diffusion

def fuse_component(image, n, least, diffuse):
    size, last = 4 * (n - 1), n - 1
    total, count = [0.0] * size, [0] * size
    for p in range(size):
        i, j = border_sample(n, p)
        total[least[p]] += image[j][i]
        count[least[p]] += 1
    D = [0.0] * size
    for p in range(size):
        i, j = border_sample(n, p)
        mean = total[least[p]] / count[least[p]]
        D[p] = mean - image[j][i]
        image[j][i] = mean
    if not diffuse:
        return
    R = min(16, (n - 1) // 2)
    for r in range(1, R):
        D = [(D[p - 1] + D[(p + 1) % size]) * 0.25 + D[p] * 0.5 for p in range(size)]
        w = (1.0 - r / R) * (1.0 - r / R)
        for j in range(r, n - r):
            for i in range(r, n - r):
                if min(i, j, last - i, last - j) != r:
                    continue
                feet = []
                if j == r:
                    feet.append(D[i])
                if i == last - r:
                    feet.append(D[last + j])
                if j == last - r:
                    feet.append(D[3 * last - i])
                if i == r:
                    feet.append(D[4 * last - j])
                image[j][i] += w * (feet[0] if len(feet) == 1 else (feet[0] + feet[1]) * 0.5)


def make_unit(values):
    for k in range(0, len(values), 3):
        x, y, z = values[k:k + 3]
        g = max(abs(x), abs(y), abs(z))
        if g == 0:
            values[k:k + 3] = [0.0, 0.0, 1.0]
            continue
        x, y, z = x / g, y / g, z / g
        length = math.sqrt(x * x + y * y + z * z)
        values[k:k + 3] = [f32(x / length), f32(y / length), f32(z / length)]


# --- section 7: triangles

def triangles(n, least, xyz):
    vertex, of_class, count = {}, {}, 0
    position = {border_sample(n, p): p for p in range(4 * (n - 1))}
    for j in range(n):
        for i in range(n):
            if (i, j) in position:
                key = least[position[i, j]]
                if key not in of_class:
                    of_class[key], count = count, count + 1
                vertex[i, j] = of_class[key]
            else:
                vertex[i, j], count = count, count + 1

    def squared(a, b):
        dx, dy, dz = (xyz[3 * (a[1] * n + a[0]) + k] - xyz[3 * (b[1] * n + b[0]) + k] for k in range(3))
        return dx * dx + dy * dy + dz * dz

    out, end = [], n - 2
    for j in range(n - 1):
        for i in range(n - 1):
            a, b, c, d = (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)
            if i in (0, end) and j in (0, end):
                rising = (i == 0 and j == 0) or (i == end and j == end)
            elif j in (0, end):
                rising = True
            elif i in (0, end):
                rising = False
            else:
                rising = squared(a, c) <= squared(b, d)
            for corner in (a, b, c, a, c, d) if rising else (a, b, d, b, c, d):
                out.append(vertex[corner])
    return out


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

"""Section 5.1: float and integer samples."""
import math
import struct

from arithmetic import f32
from container import demand
from range_coder import M32, Models, start_weights
from seam import border_sample


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

"""Section 5.2: wavelet coding."""
import struct

from arithmetic import cls, f32, sg
from container import demand
from fusing import fuse_component
from range_coder import Decoder, ExpGolomb, Models, start_weights
from seam import classes


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

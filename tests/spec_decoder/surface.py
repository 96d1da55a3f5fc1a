"""Sections 5.3 and 5.4: a surface, or the channels of a field, from its details."""
import math
import struct

from arithmetic import add, cross, dot, f32, root, sub, times
from container import demand
from details import DetailModels, read_all_details
from range_coder import Decoder
from seam import border_sample, classes
from wavelet import A, STEPS


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

"""Section 3: the range coder and its models."""
from container import demand

M32 = 0xFFFFFFFF


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

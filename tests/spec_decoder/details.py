"""Section 5.3, passes: the details of a surface or field, bit by bit."""
from arithmetic import cls, sg
from container import demand
from range_coder import ExpGolomb, Models, start_weights
from wavelet import read_coarse


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

"""Section 4: the seam, and what is glued to what."""
from container import demand
from range_coder import Decoder, ExpGolomb, Models

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

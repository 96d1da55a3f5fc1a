"""Section 7: triangles."""
from seam import border_sample


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

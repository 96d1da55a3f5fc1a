"""Section 6: fusing, diffusion and unit normals."""
import math

from arithmetic import f32
from seam import border_sample


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

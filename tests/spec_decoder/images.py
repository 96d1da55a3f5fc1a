"""Section 5: image and attribute chunks."""
import math
import struct

from arithmetic import f32
from container import demand
from exact import ExactImage
from range_coder import Decoder
from seam import classes
from surface import read_field, read_surface
from wavelet import read_wavelet


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

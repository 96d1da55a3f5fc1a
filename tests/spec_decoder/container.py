"""Section 2: the container, and how a file is refused."""
import struct
import zlib


class Refused(Exception):
    pass


def demand(condition, error="CORRUPT"):
    if not condition:
        raise Refused(error)


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

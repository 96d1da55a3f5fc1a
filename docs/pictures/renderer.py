"""A software renderer for the pictures of docs/images: meshes, an orthographic camera, rows of panels.

Needs the Debian packages python3-numpy and python3-pil.
"""
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).resolve().parents[2]
IMAGES = ROOT / "docs" / "images"
CLAY = (205, 196, 182)
INSIDE = (214, 40, 40)  # back faces: what shows through a crack
LINE = (58, 74, 102)
SEAM = (200, 30, 30)
HIDDEN_SEAM = (240, 140, 130)
PAPER = (255, 255, 255)
SUPERSAMPLING = 3


# ---- meshes --------------------------------------------------------------------------------------------------

class Mesh:
    """With st, (s, t) of every vertex, it is a surface opened along its cut, as gimparam writes it; stretch is per face."""

    def __init__(self, positions, faces, st=None, stretch=None):
        self.positions, self.faces, self.st, self.stretch = positions, faces, st, stretch

    def face_normals(self):
        a, b, c = (self.positions[self.faces[:, k]] for k in range(3))
        return np.cross(b - a, c - a)

    def vertex_normals(self):
        """Area-weighted, which is what a sum of cross products is."""
        joined = np.arange(len(self.positions))
        if self.st is not None:  # the copies of a vertex on the cut
            joined = np.unique(self.positions, axis=0, return_inverse=True)[1].reshape(-1)
        normals = np.zeros_like(self.positions)
        for k in range(3):
            np.add.at(normals, joined[self.faces[:, k]], self.face_normals())
        return unit(normals)[joined]

    def parameters(self):
        """(s, t) of every face's corners: of an opened surface in the unit square, of a decoded one in cells."""
        return self.grid_coordinates()[0] if self.st is None else self.st[self.faces]

    def flat(self):
        """The same faces in the plane."""
        return Mesh(np.pad(self.st, ((0, 0), (0, 1))), self.faces, self.st, self.stretch)

    def on_square(self):
        """A decoded mesh with the (s, t) of its samples; corners of faces are not shared."""
        corners, n = self.grid_coordinates()
        faces = np.arange(3 * len(self.faces)).reshape(-1, 3)
        return Mesh(self.positions[self.faces.reshape(-1)], faces, corners.reshape(-1, 2) / n, self.stretch)

    def border_edges(self):
        """Pairs of vertices: the edges of one face only, counter-clockwise."""
        edges = np.concatenate([self.faces[:, [k, (k + 1) % 3]] for k in range(3)])
        key = np.sort(edges, axis=1)
        _, first, count = np.unique(key, axis=0, return_index=True, return_counts=True)
        return edges[first[count == 1]]

    def tips(self):
        """Points where the cut of a closed surface ends: the vertices on it that it does not double."""
        points, count = np.unique(self.positions[self.border_edges()[:, 0]], axis=0, return_counts=True)
        return points[count == 1]

    def cut_lines(self):
        """Polylines of vertices: the border of the square."""
        return [self.border()] if self.st is None else list(self.border_edges())

    def grid_coordinates(self):
        """(s, t) of every face's corners in cells: gimdec writes two faces a cell, in rows (SPEC.md, section 7)."""
        n = int(round((len(self.faces) / 2) ** 0.5))
        first, second = self.faces[0::2], self.faces[1::2]
        rising = (first[:, 0] == second[:, 0]) & (first[:, 2] == second[:, 1])
        a, b, c, d = np.array([0, 0]), np.array([1, 0]), np.array([1, 1]), np.array([0, 1])
        corners = np.empty((len(first), 2, 3, 2))
        corners[rising] = [[a, b, c], [a, c, d]]
        corners[~rising] = [[a, b, d], [b, c, d]]
        cell = np.arange(len(first))
        corners += np.stack([cell % n, cell // n], axis=1)[:, None, None, :]
        return corners.reshape(-1, 3, 2), n

    def border(self):
        """The vertices along the square's border, counter-clockwise from (0, 0), the first one once more at the end."""
        corners, n = self.grid_coordinates()
        vertex = np.empty((n + 1, n + 1), int)
        s, t = corners.reshape(-1, 2).astype(int).T
        vertex[s, t] = self.faces.reshape(-1)
        return np.concatenate([vertex[:-1, 0], vertex[-1, :-1], vertex[:0:-1, -1], vertex[0, ::-1]])


def unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-300)


def read_ply(path):
    """The binary PLY that gimdec, gimshape and gimparam write."""
    kinds = {"float": "<f4", "double": "<f8"}
    with open(path, "rb") as file:
        counts, fields = {}, {}
        for line in iter(file.readline, b"end_header\n"):
            word = line.decode().split()
            if word[0] == "element":
                element = word[1]
                counts[element], fields[element] = int(word[2]), []
            elif word[:2] == ["property", "list"]:
                fields[element] += [("n", "u1"), ("v", "<i4", 3)]
            elif word[0] == "property":
                fields[element].append((word[2], kinds[word[1]]))
        vertices, faces = (np.fromfile(file, np.dtype(fields[e]), counts[e]) for e in ("vertex", "face"))
    assert (faces["n"] == 3).all()
    named = lambda names: np.stack([vertices[k] for k in names], axis=1).astype(float)
    if "s" not in vertices.dtype.names:
        return Mesh(named("xyz"), faces["v"])
    return Mesh(named("xyz"), faces["v"], named("st"), faces["quality"])


# ---- the renderer --------------------------------------------------------------------------------------------

def turn(yaw=0, pitch=0):
    """Rows: right, up and towards the viewer, in the mesh's coordinates."""
    y, p = np.radians(yaw), np.radians(pitch)
    about_up = np.array([[np.cos(y), 0, -np.sin(y)], [0, 1, 0], [np.sin(y), 0, np.cos(y)]])
    tilt = np.array([[1, 0, 0], [0, np.cos(p), -np.sin(p)], [0, np.sin(p), np.cos(p)]])
    return tilt @ about_up


def facing(direction):
    """Looks against `direction`, with y as far up as that allows."""
    towards = unit(np.asarray(direction, float))
    right = unit(np.cross([0, 1, 0], towards))
    return np.stack([right, np.cross(towards, right), towards])


class View:
    """An orthographic camera that shows all of the mesh, unless told to come closer."""

    def __init__(self, mesh, rotation, width, height, zoom=1.0, at=None, more=()):
        """at: the point in the middle. more: lists of points to show with the mesh."""
        self.rotation, self.size = rotation, (width, height)
        p = np.concatenate([mesh.positions, *more]) @ rotation.T
        low, high = p.min(axis=0), p.max(axis=0)
        self.scale = zoom * 0.94 * min(width / (high[0] - low[0]), height / (high[1] - low[1]))
        self.centre = (low + high) / 2 if at is None else rotation @ np.asarray(at)


def scan(screen, faces, width, height):
    """Z-buffer: for every pixel the nearest face and the barycentric coordinates in it."""
    nearest = np.full(width * height, -np.inf)
    face_at = np.full(width * height, -1)
    bary_at = np.zeros((width * height, 3))
    corner = screen[faces]
    low = np.clip(np.ceil(corner[..., :2].min(axis=1)), 0, [width, height]).astype(int)
    high = np.clip(np.floor(corner[..., :2].max(axis=1)) + 1, 0, [width, height]).astype(int)
    extent = np.maximum(high - low, 0)
    count = extent[:, 0] * extent[:, 1]
    order = np.flatnonzero(count)
    chunk_of = np.cumsum(count[order]) // 2_000_000
    for chunk in np.unique(chunk_of):
        some = order[chunk_of == chunk]
        f = np.repeat(some, count[some])
        start = np.repeat(np.cumsum(count[some]) - count[some], count[some])
        k = np.arange(len(f)) - start
        x, y = low[f, 0] + k % extent[f, 0], low[f, 1] + k // extent[f, 0]
        a, b, c = corner[f, 0], corner[f, 1], corner[f, 2]
        area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        with np.errstate(divide="ignore", invalid="ignore"):
            v = ((x - a[:, 0]) * (c[:, 1] - a[:, 1]) - (y - a[:, 1]) * (c[:, 0] - a[:, 0])) / area
            w = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (b[:, 1] - a[:, 1]) * (x - a[:, 0])) / area
        u = 1 - v - w
        keep = np.flatnonzero((u >= 0) & (v >= 0) & (w >= 0))
        f, pixel = f[keep], y[keep] * width + x[keep]
        bary = np.stack([u[keep], v[keep], w[keep]], axis=1)
        depth = (bary * corner[f, :, 2]).sum(axis=1)
        far_first = np.argsort(depth, kind="stable")  # the nearest is written last
        far_first = far_first[depth[far_first] > nearest[pixel[far_first]]]
        nearest[pixel[far_first]] = depth[far_first]
        face_at[pixel[far_first]] = f[far_first]
        bary_at[pixel[far_first]] = bary[far_first]
    return face_at, bary_at, nearest


def stroke(points, radius, nearest, width, height, bias):
    """Pixels of a polyline on the surface that nothing hides."""
    drawn = np.zeros(width * height, bool)
    disk = [(x, y) for x in range(-radius, radius + 1) for y in range(-radius, radius + 1) if x * x + y * y <= radius**2]
    for a, b in zip(points[:-1], points[1:]):
        steps = max(1, int(np.abs((b - a)[:2]).max()))
        p = a + np.linspace(0, 1, steps, endpoint=False)[:, None] * (b - a)
        for dx, dy in disk:
            x, y = np.round(p[:, 0]).astype(int) + dx, np.round(p[:, 1]).astype(int) + dy
            seen = (x >= 0) & (x < width) & (y >= 0) & (y < height)
            pixel = (y * width + x)[seen]
            drawn[pixel[p[seen, 2] + bias > nearest[pixel]]] = True
    return drawn & np.isfinite(nearest)


def blend(colour, other, amount):
    return colour + np.clip(amount, 0, 1)[:, None] * (np.asarray(other, float) - colour)


def gradients(screen, faces):
    """Per face, how the three barycentric coordinates change with screen x and y."""
    a, b, c = (screen[faces[:, k], :2] for k in range(3))
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    opposite = np.stack([c - b, a - c, b - a], axis=1)
    return np.stack([-opposite[..., 1], opposite[..., 0]], axis=2) / area[:, None, None]


def render(mesh, view, smooth=True, edges=False, grid=0, seam=False, inside=CLAY, colours=None, lit=True, tips=False):
    """edges: outline every face. grid: draw the parameter lines that are so far apart. seam: draw the square's
    border; "through": what the surface hides of it too. inside: the colour of back faces. colours: one a face. tips: mark where the cut ends."""
    ss = SUPERSAMPLING
    width, height = view.size[0] * ss, view.size[1] * ss
    p = (mesh.positions @ view.rotation.T - view.centre) * view.scale * ss
    screen = np.stack([width / 2 + p[:, 0], height / 2 - p[:, 1], p[:, 2]], axis=1)
    face_at, bary, nearest = scan(screen, mesh.faces, width, height)
    hit = np.flatnonzero(face_at >= 0)
    f, bary = face_at[hit], bary[hit]

    flat = unit(mesh.face_normals() @ view.rotation.T)[f]
    back = flat[:, 2] < 0
    normal = flat
    if smooth:
        normal = unit((bary[:, :, None] * (mesh.vertex_normals() @ view.rotation.T)[mesh.faces[f]]).sum(axis=1))
    normal = np.where((normal[:, 2] < 0)[:, None], -normal, normal)
    key, fill = unit(np.array([-0.5, 0.7, 0.65])), unit(np.array([0.8, 0.1, 0.4]))
    light = 0.2 + 0.85 * np.maximum(normal @ key, 0) + 0.15 * np.maximum(normal @ fill, 0)
    shine = np.maximum(normal @ unit(key + [0, 0, 1]), 0) ** 40
    base = np.where(back[:, None], inside, CLAY if colours is None else colours[f]).astype(float)
    colour = base * light[:, None] + 28 * shine[:, None] if lit else base

    if edges or grid:
        g = gradients(screen, mesh.faces)[f]
    if edges:
        pixels = (bary / np.maximum(np.linalg.norm(g, axis=2), 1e-12)).min(axis=1) / ss
        colour = blend(colour, LINE, 0.8 * (1.05 - pixels))
    if grid:
        corners = mesh.parameters()
        st = (bary[:, :, None] * corners[f]).sum(axis=1)
        slope = np.linalg.norm(np.einsum("fkc,fkx->fcx", corners[f], g), axis=2)
        away = np.abs(st - grid * np.round(st / grid)) / np.maximum(slope, 1e-12) / ss
        colour = blend(colour, LINE, 0.85 * (1.15 - away.min(axis=1)))
    if seam:
        if seam == "through":
            for line in mesh.cut_lines():
                drawn = stroke(screen[line], ss, nearest, width, height, bias=np.inf)[hit]
                colour[drawn] = blend(colour[drawn], HIDDEN_SEAM, np.array([0.6]))
        for line in mesh.cut_lines():
            drawn = stroke(screen[line], 2 * ss - 1, nearest, width, height, bias=0.01 * width)
            colour[drawn[hit]] = SEAM
    if tips:
        for point in mesh.tips():
            x, y, z = (view.rotation @ point - view.centre) * view.scale * ss
            spot = np.array([[width / 2 + x, height / 2 - y, z]] * 2)
            for radius, paint in ((5 * ss, PAPER), (4 * ss, SEAM)):
                drawn = stroke(spot, radius, nearest, width, height, bias=0.02 * width)
                colour[drawn[hit]] = paint

    out = np.full((width * height, 3), PAPER, float)
    out[hit] = np.clip(colour, 0, 255)
    out = out.reshape(height // ss, ss, width // ss, ss, 3).mean(axis=(1, 3))
    return Image.fromarray(np.round(out).astype(np.uint8))


def square_panel(mesh, size, colours):
    """An opened surface in the plane, and the outline of the unit square."""
    flat = mesh.flat()
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]], float)
    view = View(flat, turn(), size, size, more=[corners])
    panel = render(flat, view, colours=colours, lit=False)
    outline = (corners - view.centre)[:, :2] * view.scale * [1, -1] + size / 2
    ImageDraw.Draw(panel).line([tuple(p) for p in outline], fill=LINE)
    return panel


# ---- pages ---------------------------------------------------------------------------------------------------

# A change of colour at equal steps of the logarithm, palest at 1: (value, colour).
STRETCH_COLOURS = [(-2, (30, 66, 140)), (-1, (112, 160, 206)), (0, (240, 237, 228)), (1, (226, 138, 92)),
                   (2, (160, 28, 40))]


def stretch_colours(stretch):
    """From blue, a quarter, to red, four times the spacing of even samples."""
    values, colours = zip(*STRETCH_COLOURS)
    log = np.log2(np.maximum(stretch, 1e-300))
    return np.stack([np.interp(log, values, channel) for channel in zip(*colours)], axis=1)


def board(st):
    """Colours of a board of 16 x 16 fields, each quarter of the square with a pair of its own."""
    pairs = np.array([[(222, 186, 110), (250, 236, 205)], [(108, 158, 190), (216, 232, 240)],
                      [(200, 120, 104), (245, 216, 206)], [(126, 168, 112), (222, 236, 212)]], float)
    s, t = np.clip(np.floor(16 * st), 0, 15).astype(int).T
    return pairs[s // 8 + 2 * (t // 8), (s + t) % 2]


def font():
    for name in ("DejaVuSans.ttf", "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"):
        try:
            return ImageFont.truetype(name, 13)
        except OSError:
            pass
    return ImageFont.load_default()


def stretch_scale(width, bar=260, height=12):
    """The legend of stretch_colours, in the middle of a strip."""
    page = Image.new("RGB", (width, height + 22), PAPER)
    x = (width - bar) // 2
    log = np.linspace(STRETCH_COLOURS[0][0], STRETCH_COLOURS[-1][0], bar)
    page.paste(Image.fromarray(np.tile(np.round(stretch_colours(2**log)).astype(np.uint8), (height, 1, 1))), (x, 2))
    draw = ImageDraw.Draw(page)
    for log, text in ((-2, "1/4"), (-1, "1/2"), (0, "1"), (1, "2"), (2, "4")):
        draw.text((x + (log + 2) / 4 * bar, height + 4), text, fill=(60, 60, 60), font=font(), anchor="ma")
    draw.text((x - 16, 2 + height / 2), "local stretch", fill=(60, 60, 60), font=font(), anchor="rm")
    return page


def column(pages, gap=6):
    page = Image.new("RGB", (max(p.width for p in pages), sum(p.height for p in pages) + gap * (len(pages) - 1)), PAPER)
    y = 0
    for part in pages:
        page.paste(part, ((page.width - part.width) // 2, y))
        y += part.height + gap
    return page


def row(panels, captions=None, gap=14):
    foot = 24 if captions else 0
    width = sum(p.width for p in panels) + gap * (len(panels) - 1)
    page = Image.new("RGB", (width, max(p.height for p in panels) + foot), PAPER)
    draw = ImageDraw.Draw(page)
    x = 0
    for k, panel in enumerate(panels):
        page.paste(panel, (x, page.height - foot - panel.height))
        if captions:
            draw.text((x + panel.width / 2, page.height - foot + 5), captions[k], fill=(60, 60, 60), font=font(),
                      anchor="ma")
        x += panel.width + gap
    return page


def fewer_bits(image):
    """Six bits a channel: no eye sees the rest, and the file is much smaller."""
    return image.point(lambda value: value & 0xFC | value >> 6)


def few_colours(page, colours=128):
    """A part of a page with a palette of its own, rare bright colours included."""
    return page.quantize(colours, method=Image.MAXCOVERAGE, dither=Image.NONE).convert("RGB")


def save(page, name, colours=256, method=Image.MEDIANCUT):
    """A palette keeps renderings of one material small; colours=0 saves all colours. A median cut leaves rare bright
    colours out, a maximum coverage does not."""
    path = IMAGES / name
    if colours:
        page = page.quantize(colours, method=method, dither=Image.NONE)
    page.save(path, optimize=True)
    print(f"{path.relative_to(ROOT)}: {page.width} x {page.height}, {path.stat().st_size} bytes")

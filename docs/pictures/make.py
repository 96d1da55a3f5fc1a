#!/usr/bin/python3
"""Makes the pictures of docs/images from the output of our own tools.

    docs/pictures/make.py [--bin DIR] [--keep DIR] [NAME...]

--bin: where the programs are, build/release/bin by default. --keep: where encoded files stay for the next run.

Needs the Debian packages python3-numpy and python3-pil, and the bunny (corpus/fetch bunny).
"""
import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).resolve().parents[2]
IMAGES = ROOT / "docs" / "images"
CLAY = (205, 196, 182)
INSIDE = (214, 40, 40)  # back faces: what shows through a crack
LINE = (58, 74, 102)
SEAM = (200, 30, 30)
PAPER = (255, 255, 255)
SUPERSAMPLING = 3


# ---- meshes --------------------------------------------------------------------------------------------------

class Mesh:
    def __init__(self, positions, faces):
        self.positions, self.faces = positions, faces

    def face_normals(self):
        a, b, c = (self.positions[self.faces[:, k]] for k in range(3))
        return np.cross(b - a, c - a)

    def vertex_normals(self):
        """Area-weighted, which is what a sum of cross products is."""
        normals = np.zeros_like(self.positions)
        for k in range(3):
            np.add.at(normals, self.faces[:, k], self.face_normals())
        return unit(normals)

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
    """The binary PLY that gimdec and gimshape write: a vertex is x, y, z and perhaps a normal."""
    with open(path, "rb") as file:
        counts, fields, element = {}, [], None
        for line in iter(file.readline, b"end_header\n"):
            word = line.decode().split()
            if word[0] == "element":
                element = word[1]
                counts[element] = int(word[2])
            elif word[0] == "property" and element == "vertex":
                fields.append((word[2], {"float": "<f4", "double": "<f8"}[word[1]]))
        vertices = np.fromfile(file, np.dtype(fields), counts["vertex"])
        faces = np.fromfile(file, np.dtype([("n", "u1"), ("v", "<i4", 3)]), counts["face"])
    assert (faces["n"] == 3).all()
    return Mesh(np.stack([vertices[k] for k in "xyz"], axis=1).astype(float), faces["v"])


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

    def __init__(self, mesh, rotation, width, height, zoom=1.0, at=None):  # at: the point in the middle
        self.rotation, self.size = rotation, (width, height)
        p = mesh.positions @ rotation.T
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


def render(mesh, view, smooth=True, edges=False, grid=0, seam=False, inside=CLAY):
    """edges: outline every face. grid: draw each grid-th parameter line. seam: draw the square's
    border. inside: the colour of back faces."""
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
    base = np.where(back[:, None], inside, CLAY).astype(float)
    colour = base * light[:, None] + 28 * shine[:, None]

    if edges or grid:
        g = gradients(screen, mesh.faces)[f]
    if edges:
        pixels = (bary / np.maximum(np.linalg.norm(g, axis=2), 1e-12)).min(axis=1) / ss
        colour = blend(colour, LINE, 0.8 * (1.05 - pixels))
    if grid:
        corners, _ = mesh.grid_coordinates()
        st = (bary[:, :, None] * corners[f]).sum(axis=1)
        slope = np.linalg.norm(np.einsum("fkc,fkx->fcx", corners[f], g), axis=2)
        away = np.abs(st - grid * np.round(st / grid)) / np.maximum(slope, 1e-12) / ss
        colour = blend(colour, LINE, 0.85 * (1.15 - away.min(axis=1)))
    if seam:
        drawn = stroke(screen[mesh.border()], 2 * ss - 1, nearest, width, height, bias=0.01 * width)
        colour[drawn[hit]] = SEAM

    out = np.full((width * height, 3), PAPER, float)
    out[hit] = np.clip(colour, 0, 255)
    out = out.reshape(height // ss, ss, width // ss, ss, 3).mean(axis=(1, 3))
    return Image.fromarray(np.round(out).astype(np.uint8))


# ---- pages ---------------------------------------------------------------------------------------------------

def row(panels, captions=None, gap=14):
    font = ImageFont.load_default()
    for name in ("DejaVuSans.ttf", "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"):
        try:
            font = ImageFont.truetype(name, 13)
            break
        except OSError:
            pass
    foot = 24 if captions else 0
    width = sum(p.width for p in panels) + gap * (len(panels) - 1)
    page = Image.new("RGB", (width, max(p.height for p in panels) + foot), PAPER)
    draw = ImageDraw.Draw(page)
    x = 0
    for k, panel in enumerate(panels):
        page.paste(panel, (x, page.height - foot - panel.height))
        if captions:
            room = draw.textlength(captions[k], font=font)
            draw.text((x + (panel.width - room) / 2, page.height - foot + 5), captions[k], fill=(60, 60, 60), font=font)
        x += panel.width + gap
    return page


def fewer_bits(image):
    """Six bits a channel: no eye sees the rest, and the file is much smaller."""
    return image.point(lambda value: value & 0xFC | value >> 6)


def save(page, name, colours=256):
    """A palette keeps renderings of one material small; colours=0 saves all colours."""
    path = IMAGES / name
    if colours:
        page = page.quantize(colours, method=Image.MEDIANCUT, dither=Image.NONE)
    page.save(path, optimize=True)
    print(f"{path.relative_to(ROOT)}: {page.width} x {page.height}, {path.stat().st_size} bytes")


class Studio:
    """Runs the tools and keeps what they made."""

    def __init__(self, programs, folder):
        self.programs, self.folder = programs, Path(folder)
        self.bunny = self.fetched("bunny")

    def fetched(self, name):
        run = subprocess.run([ROOT / "corpus" / "fetch", name], check=True, capture_output=True, text=True)
        return run.stdout.strip()

    def run(self, program, *arguments):
        subprocess.run([self.programs / program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)

    def path(self, name):
        return self.folder / name

    def shape(self, *arguments):
        path = self.path("-".join(a.strip("-") for a in arguments) + ".ply")
        self.run("gimshape", arguments[0], path, *arguments[1:])
        return path

    def encoded(self, mesh, *options):
        path = self.path(Path(mesh).stem + "-" + "-".join(str(o).strip("-") for o in options) + ".gim")
        if not path.exists():
            self.run("gimenc", "--quiet", *options, mesh, path)
        return path

    def decoded(self, gim, *options):
        path = self.path("decoded.ply")
        self.run("gimdec", *options, gim, path)
        return read_ply(path)


BUNNY_VIEW = turn(yaw=12, pitch=8)
GENUS_VIEW = turn(yaw=20, pitch=-42)


def bunny(studio):
    """README: geometry image, normal map, decoded mesh."""
    gim = studio.encoded(studio.bunny, "--bytes", 12000)
    mesh = studio.decoded(gim, "--image", studio.path("geometry.png"))
    with_normals = studio.encoded(studio.bunny, "--bytes", 16000, "--normals", 257)
    studio.decoded(with_normals, "--normal-map", studio.path("normals.png"))
    images = [fewer_bits(Image.open(studio.path(name)).convert("RGB")) for name in ("geometry.png", "normals.png")]
    rendering = render(mesh, View(mesh, BUNNY_VIEW, 290, 257)).quantize(48, dither=Image.NONE).convert("RGB")
    save(row(images + [rendering]), "bunny.png", colours=0)


def levels(studio):
    """Every level of detail of one file."""
    gim = studio.encoded(studio.bunny, "--bytes", 12000)
    meshes = [studio.decoded(gim, "--level", level) for level in (3, 2, 1, 0)]
    view = View(meshes[-1], BUNNY_VIEW, 250, 240)
    panels = [render(mesh, view, smooth=False, edges=n < 100) for mesh, n in zip(meshes, (33, 65, 129, 257))]
    save(row(panels, [f"level {k}: {n} x {n}" for k, n in ((3, 33), (2, 65), (1, 129), (0, 257))]), "levels.png")


def rates(studio):
    """The bunny at growing file sizes."""
    sizes = (1500, 3000, 6000, 12000)
    meshes = [studio.decoded(studio.encoded(studio.bunny, "--bytes", size)) for size in sizes]
    view = View(meshes[-1], BUNNY_VIEW, 250, 240)
    panels = [render(mesh, view, smooth=False) for mesh in meshes]
    save(row(panels, [f"{size:,} bytes" for size in sizes]), "rates.png")


def seam(studio):
    """The widest crack at a low rate: open, fused, fused and diffused."""
    gim = studio.encoded(studio.shape("torus", "--resolution", "48"), "--bytes", 250, "--coding", "wavelet")
    opened, fused, diffused = (studio.decoded(gim, *flags) for flags in (["--no-fuse"], ["--no-diffuse"], []))
    gap = np.linalg.norm(opened.positions[opened.border()] - fused.positions[fused.border()], axis=1)
    normal = diffused.vertex_normals()[diffused.border()]
    worst = (gap * np.maximum(normal @ GENUS_VIEW[2], 0)).argmax()  # of those on the side that other pictures show
    rotation = facing(normal[worst] + GENUS_VIEW[2])
    view = View(diffused, rotation, 280, 240, zoom=2, at=fused.positions[fused.border()[worst]])
    panels = [render(mesh, view, smooth=False, inside=INSIDE) for mesh in (opened, fused, diffused)]
    save(row(panels, ["as coded", "fused", "fused and diffused"]), "seam.png")


def genus(studio):
    """A surface of genus 3: its geometry image, and the seam and parameter lines on it."""
    gim = studio.encoded(studio.shape("genus", "--genus", "3", "--resolution", "48"), "--bytes", 12000)
    mesh = studio.decoded(gim, "--image", studio.path("genus.png"))
    image = fewer_bits(Image.open(studio.path("genus.png")).convert("RGB"))
    rendering = render(mesh, View(mesh, GENUS_VIEW, 520, 257), grid=8, seam=True)
    save(row([image, rendering.quantize(64, dither=Image.NONE).convert("RGB")]), "genus.png", colours=0)


def lines(studio):
    """Parameter lines on the bunny: how samples spread."""
    mesh = studio.decoded(studio.encoded(studio.bunny, "--raw", "float"))
    views = [View(mesh, turn(yaw=yaw, pitch=8), 300, 280) for yaw in (12, 192)]
    save(row([render(mesh, view, grid=8, seam=True) for view in views]), "lines.png")


def topology(studio):
    """The dragon's scan with and without its topological noise. Takes minutes."""
    options = ["--component", "largest", "--bytes", 12000]
    files = [studio.encoded(studio.fetched("dragon"), *options, *more)
             for more in ([], ["--close-holes", "100%", "--max-genus", "auto"])]
    meshes = [studio.decoded(gim) for gim in files]
    panels = [render(mesh, View(mesh, turn(yaw=15, pitch=8), 380, 280), seam=True) for mesh in meshes]
    save(row(panels, ["genus 46, 257 holes", "genus 1, closed"]), "topology.png")


def heatmap(studio):
    """gimrd's own picture of where the bunny is off."""
    studio.decoded(studio.encoded(studio.bunny, "--bytes", 1500))
    studio.run("gimrd", "compare", "--heatmap", studio.path("heatmap.png"), studio.bunny, studio.path("decoded.ply"))
    picture = Image.open(studio.path("heatmap.png")).convert("RGB")
    # A median cut would leave the rare bright colours of the bar out.
    save(picture.quantize(256, method=Image.MAXCOVERAGE, dither=Image.NONE), "heatmap.png", colours=0)


PICTURES = {f.__name__: f for f in (bunny, levels, rates, seam, genus, lines, topology, heatmap)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=Path, default=ROOT / "build" / "release" / "bin")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(PICTURES))
    parser.add_argument("--keep", type=Path, metavar="DIR", help="keep the encoded files there for the next run")
    arguments = parser.parse_args()
    IMAGES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        if arguments.keep:
            arguments.keep.mkdir(exist_ok=True)
        studio = Studio(arguments.bin.resolve(), arguments.keep or folder)
        for name in arguments.names or PICTURES:
            PICTURES[name](studio)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Makes the pictures of docs/images from the output of our own tools.

    docs/pictures/make.py [--bin DIR] [--keep DIR] [NAME...]

--bin: where the programs are, build/release/bin by default. --keep: where encoded files stay for the next run.

Needs the Debian packages python3-numpy and python3-pil; corpus/fetch brings the meshes.
"""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageOps

from renderer import (IMAGES, INSIDE, ROOT, Mesh, View, board, column, facing, few_colours, fewer_bits, read_ply, render, row,
                      save, square_panel, stretch_colours, stretch_scale, turn)


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


    def mapped(self, mesh, *options):
        """What gimparam makes of a mesh: the opened surface, and the report."""
        stem = Path(mesh).stem + "-map-" + "-".join(str(o).strip("-") for o in options)
        path, report = self.path(stem + ".ply"), self.path(stem + ".json")
        if not report.exists():
            self.run("gimparam", "--quiet", *options, "--json", report, mesh, path)
        return read_ply(path), json.loads(report.read_text())


BUNNY_VIEW = turn(yaw=12, pitch=8)
GENUS_VIEW = turn(yaw=20, pitch=-42)
Z_UP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])  # for meshes that stand along z


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
    save(picture, "heatmap.png", method=Image.MAXCOVERAGE)


def cut_stages(studio):
    """The cut as it is extended to one tip after the other, and the square of each stage."""
    name, most, rotation = "man", 3, turn(yaw=155, pitch=8) @ Z_UP
    above, below, captions = [], [], []
    for tips in range(most + 1):
        mesh, report = studio.mapped(studio.fetched(name), "--density", "even", "--extrema", tips)
        colours = stretch_colours(mesh.stretch)
        above.append(render(mesh, View(mesh, rotation, 210, 290), seam="through", tips=True))
        below.append(square_panel(mesh, 210, colours))
        cut = ("initial cut", "one extremum", "two extrema", "three extrema")[report["cut"]["extrema"]]
        captions.append(f"{cut}: {report['stretch_efficiency']:.2f}")
    parts = [few_colours(row(above)), few_colours(row(below, captions)), stretch_scale(row(above).width)]
    save(column(parts), "cut-stages.png", colours=0)


def stretch(studio):
    """Local stretch on the bunny, of a linear map and of ours."""
    maps = (("mean values", ["--param", "mvc"]), ("stretch, even", ["--density", "even"]), ("stretch, curvature", []))
    above, below, captions = [], [], []
    for name, options in maps:
        mesh, report = studio.mapped(studio.bunny, *options)
        colours = stretch_colours(mesh.stretch)
        above.append(render(mesh, View(mesh, BUNNY_VIEW, 300, 280), colours=colours, grid=1 / 32, seam=True))
        below.append(square_panel(mesh, 250, colours))
        captions.append(f"{name}: {report['stretch_efficiency']:.2f}")
    parts = [few_colours(row(above), 64), few_colours(row(below, captions, gap=64)), stretch_scale(row(above).width)]
    save(column(parts), "stretch.png", colours=0)


def maps(studio):
    """Every map to the square, on a part with the same cut and layout."""
    panels, captions = [], []
    for param in ("tutte", "mvc", "harmonic", "stretch"):
        mesh, report = studio.mapped(studio.fetched("fandisk"), "--param", param, "--density", "even")
        view = View(mesh, turn(yaw=-60, pitch=20), 220, 222)
        panels.append(render(mesh, view, colours=stretch_colours(mesh.stretch), grid=1 / 32, smooth=False))
        captions.append(f"{param}: {report['stretch_efficiency']:.2f}")
    page = row(panels, captions)
    save(column([page, stretch_scale(page.width)]), "maps.png", method=Image.MAXCOVERAGE)


def layouts(studio):
    """The bunny in both layouts: a board of fields on the square, and where they come to lie."""
    rows = []
    for layout in ("cut", "octahedral"):
        mesh = studio.decoded(studio.encoded(studio.bunny, "--layout", layout, "--raw", "float", "--no-fit"))
        corners, n = mesh.grid_coordinates()
        colours = board(corners.mean(axis=1) / n)
        panels = [square_panel(mesh.on_square(), 190, colours)]
        panels += [render(mesh, View(mesh, turn(yaw=yaw, pitch=8), 330, 280), colours=colours, seam=True)
                   for yaw in (12, 192)]
        rows.append(row(panels, [f"--layout {layout}", "", ""]))
    save(column(rows), "layouts.png")


def checkered(studio, mesh, *options):
    """gimparam's own picture of a surface under a checkerboard, without its empty margins."""
    path = studio.path("checkered.png")
    studio.run("gimparam", "uv", "--quiet", "--picture", path, "--picture-size", 400, *options, mesh, studio.path("uv.obj"))
    picture = Image.open(path).convert("RGB")
    return picture.crop(ImageOps.invert(picture).getbbox())


def conformal_handles(studio):
    """Checkerboards of holomorphic forms; handles in colours of their own, branch points red."""
    above = ["--look", "0.2,0.9,-1", "--fields", 32]
    panels = [checkered(studio, studio.fetched("eight"), "--subdivide", 2, "--modular", "--look", "-0.3,-0.9,-0.6", "--fields", 28),
              checkered(studio, studio.shape("genus", "--genus", "3", "--resolution", "16"), "--modular", *above)]
    save(row(panels, ["eight", "genus 3"]), "conformal-handles.png", colours=128)


def conformal_limbs(studio):
    """What holes at the tips of limbs do to a conformal map."""
    elephant, horse = studio.fetched("elephant"), studio.fetched("horse")
    back = ["--look", "0.3,-0.2,-1"]
    panels = [checkered(studio, elephant, *back),
              checkered(studio, elephant, "--puncture", "13484,18303,40780,2286,43530,30375", *back),
              checkered(studio, horse, "--puncture", "14848,37481,14704,40651,40659,36447",
                        "--look", "1,-0.1,-0.3", "--up", "0,0,1")]
    save(row(panels, ["elephant", "with 6 holes", "horse, with 6 holes"]), "conformal-limbs.png", colours=128)


def spheres(studio):
    """The bunny, on the sphere with the light it has itself, and the lines of two geometry images of it."""
    lines = [line.split() for line in open(studio.bunny) if line[:2] in ("v ", "f ")]
    surface = Mesh(np.array([line[1:4] for line in lines if line[0] == "v"], float),
                   np.array([[c.split("/")[0] for c in line[1:4]] for line in lines if line[0] == "f"], int) - 1)
    studio.run("gimparam", "sphere", "--quiet", studio.bunny, studio.path("sphere.ply"))
    sphere = read_ply(studio.path("sphere.ply"))
    assert (sphere.faces == surface.faces).all()
    normals = surface.vertex_normals()
    sphere.vertex_normals = lambda: normals
    panels = [render(surface, View(surface, BUNNY_VIEW, 250, 240)), render(sphere, View(sphere, BUNNY_VIEW, 230, 240))]
    for param in ("conformal", "stretch"):
        image = studio.decoded(studio.encoded(studio.bunny, "--raw", "float", "--no-fit", "--grid", 257, "--layout",
                                              "octahedral", "--param", param))
        panels.append(render(image, View(surface, BUNNY_VIEW, 250, 240), grid=4))
    save(row(panels, ["bunny", "on the sphere", "lines of --param conformal", "of --param stretch"]), "spheres.png")


PICTURES = {f.__name__: f for f in (bunny, levels, rates, seam, genus, lines, topology, heatmap, cut_stages, stretch, maps, layouts,
                                    spheres, conformal_handles, conformal_limbs)}


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

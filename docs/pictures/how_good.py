#!/usr/bin/python3
"""Puts the tables of docs/how-good.md in from a sweep, and copies its curves to docs/images.

    docs/pictures/how_good.py report-output
    docs/pictures/how_good.py --all report-output     # only the table of all meshes

The folder is one that `bench/report` or `gimrd sweep` wrote. Needs nothing but Python.
"""
import json
import shutil
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1]
IMAGES = DOCS / "images"
PAGE = DOCS / "how-good.md"
SHOWN = ["gim", "draco-lt", "draco-meshopt", "meshopt"]
CURVES = {"curves/bunny.png": "how-good-bunny.png"}


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---|" + "--:|" * (len(header) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def put(page, name, text):
    """Between the comments `<!-- name -->` and `<!-- end -->`."""
    before, rest = page.split(f"<!-- {name} -->\n")
    _, after = rest.split("<!-- end -->", 1)
    return f"{before}<!-- {name} -->\n{text}\n<!-- end -->{after}"


def read(folder):
    """PSNR by mesh, coder and bytes; the meshes' triangles; the sizes."""
    results = json.loads((folder / "results.json").read_text())
    points = {}
    triangles = {m["name"]: m["faces"] for m in results["meshes"]}
    for p in results["points"]:
        if p["state"] == "done":
            points.setdefault(p["mesh"], {}).setdefault(p["coder"], {})[p["target"]] = p["psnr"]
    return points, triangles, sorted({t for coders in points.values() for done in coders.values() for t in done})


def beside_draco(coders, sizes):
    cells = []
    for size in sizes:
        ours, theirs = (coders.get(c, {}).get(size) for c in ("gim", "draco-lt"))
        text = [f"{v:.1f}" if v is not None else "-" for v in (ours, theirs)]
        best = None if None in (ours, theirs) else int(theirs > ours)
        if best is not None:
            text[best] = f"**{text[best]}**"
        cells.append(" / ".join(text))
    return cells


def put_all(folder):
    points, triangles, sizes = read(folder)
    rows = [[mesh, f"{triangles[mesh]:,}"] + beside_draco(points[mesh], sizes)
            for mesh in sorted(points, key=lambda mesh: (-triangles[mesh], mesh))]
    PAGE.write_text(put(PAGE.read_text(), "all", table(["mesh", "triangles"] + [f"{s:,}" for s in sizes], rows)))


def put_chosen(folder):
    points, _, sizes = read(folder)
    page = PAGE.read_text()
    rows = []
    for mesh, coders in sorted(points.items()):
        rows.append([mesh] + beside_draco(coders, sizes))
    page = put(page, "meshes", table(["mesh"] + [f"{s:,}" for s in sizes], rows))

    whole = [m for m, c in points.items() if all(c.get(k, {}).get(s) is not None for k in SHOWN if k in c for s in sizes)]
    rows = []
    for coder in SHOWN:
        means = [[points[m].get(coder, {}).get(s) for m in whole] for s in sizes]
        if whole and all(None not in column for column in means):
            rows.append([coder] + [f"{sum(column) / len(column):.1f}" for column in means])
    page = put(page, "means", table([f"{len(whole)} meshes"] + [f"{s:,}" for s in sizes], rows))
    PAGE.write_text(page)

    for source, target in CURVES.items():
        if (folder / source).exists():
            shutil.copyfile(folder / source, IMAGES / target)


if sys.argv[1] == "--all":
    put_all(Path(sys.argv[2]))
else:
    put_chosen(Path(sys.argv[1]))

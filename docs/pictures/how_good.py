#!/usr/bin/python3
"""Prints the tables of docs/how-good.md from a sweep, and copies its curves to docs/images.

    docs/pictures/how_good.py report-output

The folder is one that `bench/report` or `gimrd sweep` wrote. Needs nothing but Python.
"""
import json
import shutil
import sys
from pathlib import Path

IMAGES = Path(__file__).resolve().parents[1] / "images"
SHOWN = ["gim", "draco-lt", "draco-meshopt", "meshopt", "openjpeg", "jxl", "raw-zlib"]
CURVES = {"mean.png": "how-good-mean.png", "curves/bunny.png": "how-good-bunny.png"}


def table(header, rows):
    print("| " + " | ".join(header) + " |")
    print("|---|" + "--:|" * (len(header) - 1))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def main(folder):
    results = json.loads((folder / "results.json").read_text())
    points = {}
    for p in results["points"]:
        if p["state"] == "done":
            points.setdefault(p["mesh"], {}).setdefault(p["coder"], {})[p["target"]] = p["psnr"]
    sizes = sorted({t for coders in points.values() for done in coders.values() for t in done})

    print("dB of gimg / simplify + Draco:\n")
    rows = []
    for mesh, coders in sorted(points.items()):
        cells = []
        for size in sizes:
            ours, theirs = (coders.get(c, {}).get(size) for c in ("gim", "draco-lt"))
            text = [f"{v:.1f}" if v is not None else "-" for v in (ours, theirs)]
            best = None if None in (ours, theirs) else int(theirs > ours)
            if best is not None:
                text[best] = f"**{text[best]}**"
            cells.append(" / ".join(text))
        rows.append([mesh] + cells)
    table(["mesh"] + [f"{s:,}" for s in sizes], rows)

    print("Mean dB over the meshes for which every coder has all sizes:\n")
    whole = [m for m, c in points.items() if all(c.get(k, {}).get(s) is not None for k in SHOWN if k in c for s in sizes)]
    rows = []
    for coder in SHOWN:
        means = [[points[m].get(coder, {}).get(s) for m in whole] for s in sizes]
        if whole and all(None not in column for column in means):
            rows.append([coder] + [f"{sum(column) / len(column):.1f}" for column in means])
    table([f"{len(whole)} meshes"] + [f"{s:,}" for s in sizes], rows)

    for source, target in CURVES.items():
        if (folder / source).exists():
            shutil.copyfile(folder / source, IMAGES / target)


main(Path(sys.argv[1]))

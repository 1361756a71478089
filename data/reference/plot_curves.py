#!/usr/bin/env python3
"""Draws curves over each other: tables case,code,t_s,value beside this file -> SVG. No dependencies.

dosta2024_*.csv: jamscope's curves come from `JAMSCOPE_CURVES=data/reference build/tests/dem_tests --gtest_filter='Dosta*'`.
force_history.csv: README.md of this folder's parent says how it was made.
"""
import csv
import pathlib

HERE = pathlib.Path(__file__).parent
COLOURS = {"LIGGGHTS": "#d95f02", "MUSEN": "#7570b3", "jamscope": "#1b9e77", "every step": "#d95f02", "own rate": "#1b9e77"}
PLOTS = [
    ("dosta2024", "impact_25k", "Steel ball into 25,000 grains (Dosta et al. 2024)", "displacement of the ball (mm)", 1e3),
    ("dosta2024", "silo_large_M1", "Silo, orifice of 60 mm (Dosta et al. 2024)", "grains above the orifice (thousand)", 1e-3),
    ("force_history", "force_history", "The first jam of ft4_quick, contacts at every step of 5e-8 s and at their own rate", "compressive force (N)", 1),
]
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 640, 400, 70, 40, 20, 50


def curves(tables, scene):
    found = {}
    for path in sorted(HERE.glob(f"{tables}*.csv")):
        with open(path) as file:
            for row in csv.DictReader(file):
                if row["case"] == scene:
                    found.setdefault(row["code"], []).append((float(row["t_s"]), float(row["value"])))
    # Our silos begin with less in them: shifted to the moment at which the others hold as much.
    if scene.startswith("silo") and "jamscope" in found and "MUSEN" in found:
        full = found["jamscope"][0][1]
        reference = found["MUSEN"]
        for (t0, n0), (t1, n1) in zip(reference, reference[1:]):
            if n0 >= full > n1:
                shift = t0 + (t1 - t0) * (n0 - full) / (n0 - n1)
                found["jamscope"] = [(t + shift, n) for t, n in found["jamscope"]]
    return found


def ticks(low, high):
    step = next(s for p in range(-6, 9) for s in (10.0**p, 2 * 10.0**p, 5 * 10.0**p) if (high - low) / s <= 8)
    first = -(-low // step) * step
    return [first + k * step for k in range(int((high - first) / step + 1e-9) + 1)]


def draw(tables, scene, title, label, scale):
    found = curves(tables, scene)
    if not found:
        return
    points = [(t, v * scale) for curve in found.values() for t, v in curve]
    x0, x1 = min(t for t, _ in points), max(t for t, _ in points)
    y0, y1 = min(v for _, v in points), max(v for _, v in points)
    if x1 < 0.5:
        unit, time_scale = "ms", 1e3
    else:
        unit, time_scale = "s", 1
    px = lambda t: LEFT + (t - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT)
    py = lambda v: HEIGHT - BOTTOM - (v - y0) / (y1 - y0) * (HEIGHT - TOP - BOTTOM)
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
        f'<text x="{WIDTH / 2}" y="20" text-anchor="middle" font-size="14">{title}</text>',
        f'<text x="{WIDTH / 2}" y="{HEIGHT - 10}" text-anchor="middle">time ({unit})</text>',
        f'<text transform="translate(16 {HEIGHT / 2}) rotate(-90)" text-anchor="middle">{label}</text>',
    ]
    for t in ticks(x0 * time_scale, x1 * time_scale):
        out.append(f'<line x1="{px(t / time_scale):.1f}" x2="{px(t / time_scale):.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}" stroke="#ddd"/>')
        out.append(f'<text x="{px(t / time_scale):.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{t:g}</text>')
    for v in ticks(y0, y1):
        out.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{py(v):.1f}" y2="{py(v):.1f}" stroke="#ddd"/>')
        out.append(f'<text x="{LEFT - 6}" y="{py(v) + 4:.1f}" text-anchor="end">{v:g}</text>')
    ends_low = max(curve[-1][1] for curve in found.values()) * scale < (y0 + y1) / 2
    legend = TOP + 12 + 16 * (len(found) - 1) if ends_low else HEIGHT - BOTTOM - 28  # away from the curves' ends
    for k, (code, curve) in enumerate(sorted(found.items())):
        path = " ".join(f"{px(t):.1f},{py(v * scale):.1f}" for t, v in curve)
        out.append(f'<polyline points="{path}" fill="none" stroke="{COLOURS[code]}" stroke-width="2"/>')
        out.append(f'<text x="{WIDTH - RIGHT - 90}" y="{legend - 16 * k}" fill="{COLOURS[code]}">{code}</text>')
    out.append("</svg>")
    name = scene if scene == tables else f"{tables}_{scene}"
    (HERE / f"{name}.svg").write_text("\n".join(out) + "\n")


for plot in PLOTS:
    draw(*plot)

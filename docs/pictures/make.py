#!/usr/bin/python3
"""Draws the figures of docs/theory with the model itself.

    PYTHONPATH=build/ci/python python3 docs/pictures/make.py build/ci/papilla

contact.svg, electrode_at_a_wall.svg and one_patch.svg, beside this file. The same bytes at every run.
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import papilla as pp

HERE = pathlib.Path(__file__).resolve().parent
DESIGNS = HERE.parent.parent / "designs"
BLUE, RED, GREY, GREEN, WATER = "#1b6ca8", "#d1495b", "#777777", "#3c8d5a", "#a9d3ee"
LEFT, WIDTH, HEIGHT, GAP, TOP = 74, 600, 130, 26, 34


def ticks(low, high):
    """Three to six round numbers within a range."""
    step = 10 ** np.floor(np.log10(high - low))
    step = next(s for s in (step / 5, step / 2, step, 2 * step, 5 * step) if (high - low) / s <= 6)
    return step * np.arange(np.ceil(low / step), np.floor(high / step) + 1)


class Panel:
    """A plot over the same x as its neighbours: curves, and spans of x that are shaded."""

    def __init__(self, y, curves, spans=()):
        self.y, self.curves, self.spans = y, curves, spans

    def svg(self, x, top):
        values = np.concatenate([v for _, v, _, _ in self.curves])
        low, high = float(values.min()), float(values.max())
        low, high = low - 0.05 * (high - low), high + 0.05 * (high - low)
        px = lambda v: LEFT + WIDTH * (v - x[0]) / (x[-1] - x[0])
        py = lambda v: top + HEIGHT * (1 - (v - low) / (high - low))
        out = [f'<rect x="{LEFT}" y="{top}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#bbb"/>']
        for begin, end in self.spans:
            out.append(f'<rect x="{px(begin):.1f}" y="{top}" width="{px(end) - px(begin):.1f}" height="{HEIGHT}" '
                       f'fill="{WATER}" fill-opacity=".6"/>')
        for v in ticks(low, high):
            out.append(f'<text x="{LEFT - 6}" y="{py(v) + 4:.1f}" text-anchor="end">{v + 0:g}</text>')
        out.append(f'<text transform="translate(16 {top + HEIGHT / 2:.0f}) rotate(-90)" text-anchor="middle">{self.y}</text>')
        for k, (name, v, colour, dash) in enumerate(self.curves):
            points = " ".join(f"{px(a):.1f},{py(b):.1f}" for a, b in zip(x, v))
            out.append(f'<polyline fill="none" stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dash}" points="{points}"/>')
            if name:
                out.append(f'<text x="{LEFT + WIDTH + 10}" y="{top + 16 + 18 * k}" fill="{colour}">{name}</text>')
        return out


def draw(file, title, x, x_title, panels):
    height = TOP + len(panels) * (HEIGHT + GAP) + 26
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 860 {height}" font-family="sans-serif" font-size="12">',
           f'<rect width="860" height="{height}" fill="white"/>', f'<text x="{LEFT}" y="22" font-size="14">{title}</text>']
    for k, panel in enumerate(panels):
        out += panel.svg(x, TOP + k * (HEIGHT + GAP))
    bottom = TOP + len(panels) * (HEIGHT + GAP) - GAP
    for v in ticks(x[0], x[-1]):
        place = LEFT + WIDTH * (v - x[0]) / (x[-1] - x[0])
        out.append(f'<text x="{place:.0f}" y="{bottom + 16}" text-anchor="middle">{v + 0:g}</text>')
    out.append(f'<text x="{LEFT + WIDTH / 2}" y="{bottom + 34}" text-anchor="middle">{x_title}</text>')
    (HERE / file).write_text("\n".join(out + ["</svg>"]) + "\n")


def contact():
    """A wavy rough surface under a layered solid: where it touches, and what the touching parts carry."""
    n, size = 256, 12e-6
    x = (np.arange(n) + 0.5) * size / n
    random = np.random.default_rng(3)
    rough = random.standard_normal((n, n))
    q = np.hypot(*np.meshgrid(np.fft.fftfreq(n), np.fft.fftfreq(n))) * n
    rough = np.fft.ifft2(np.fft.fft2(rough) * np.where((q > 2) & (q < 40), np.maximum(q, 1) ** -1.8, 0)).real
    z = rough * 80e-9 / rough.std() + 60e-9 * np.cos(2 * np.pi * x / size * 3)
    z -= z.max()
    solved = pp.contact(z, size, pressure="0.5 MPa", layer_modulus="60 MPa", layer_thickness="2 um",
                        bulk_modulus="10 MPa", tolerance=1e-8)
    row = int(np.argmax((solved.pressure > 0).sum(axis=1)))
    draw("contact.svg", "Contact along one section: surface, deformed skin, pressure", 1e6 * x, "x [um]",
         [Panel("height [nm]", [("surface", 1e9 * z[row], GREY, ""), ("skin", 1e9 * (z + solved.gap)[row], RED, "")]),
          Panel("pressure [MPa]", [("", 1e-6 * solved.pressure[row], BLUE, "")])])


def electrode_at_a_wall():
    """The pull near a step of 350 nm whose oxide follows it, by the three field rules."""
    n, size, depth = 128, 4e-6, 350e-9
    x = (np.arange(n) + 0.5) * size / n
    z = np.where((x > size / 4) & (x < 3 * size / 4), -depth, 0.0) * np.ones((n, 1))
    gap = 40e-9 - z
    pulls = [pp.field(gap, size, voltage="200 V", thickness="500 nm", method=method, surface=z).pressure[n // 2]
             for method in ("local", "spread", "full")]
    draw("electrode_at_a_wall.svg", "Pull over a trench of 350 nm, 200 V, 500 nm of oxide that follows it", 1e6 * x, "x [um]",
         [Panel("height [nm]", [("surface", 1e9 * z[0], GREY, ""), ("skin", 40 + 0 * x, RED, "")]),
          Panel("pull [MPa]", [("columns", 1e-6 * pulls[0], GREY, "5 4"), ("flux spreads", 1e-6 * pulls[1], BLUE, ""),
                               ("3-D", 1e-6 * pulls[2], RED, "2 3")])])


def one_patch(program):
    """What the pieces hand to each other, along one section of a patch of the sample a3h350."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "evaluate", DESIGNS / "m3_samples" / "a3h350.toml", "--quiet", "--out", folder,
                        "--set", "accuracy.level=draft", "--set", 'environment.relative_humidity=["55 %"]'],
                       check=True, stdout=subprocess.DEVNULL)
        maps = {name: np.load(pathlib.Path(folder) / f"{name}_55.npy") for name in
                ("gap", "water", "pressure_off", "pressure_on", "pull")}
    row = int(np.argmax((maps["water"] > 0).sum(axis=1)))
    n = maps["gap"].shape[1]
    x = np.linspace(0, 12, n)
    wet = np.flatnonzero(np.diff(np.concatenate([[0], (maps["water"][row] > 0).astype(int), [0]])))
    step = x[1] - x[0]
    spans = [(max(x[b] - step / 2, x[0]), min(x[e - 1] + step / 2, x[-1])) for b, e in zip(wet[::2], wet[1::2])]
    draw("one_patch.svg", "One patch of a3h350 at 55 % RH: gap, water (blue), pull, pressure", x, "x [um]",
         [Panel("gap [nm]", [("dry contact", 1e9 * maps["gap"][row], GREY, "")], spans),
          Panel("pull [MPa]", [("drive on", 1e-6 * maps["pull"][row], BLUE, "")], spans),
          Panel("pressure [MPa]", [("drive off", 1e-6 * maps["pressure_off"][row], GREY, ""),
                                   ("drive on", 1e-6 * maps["pressure_on"][row], RED, "3 3")], spans)])


if __name__ == "__main__":
    contact()
    electrode_at_a_wall()
    one_patch(sys.argv[1])

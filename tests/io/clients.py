"""Asks other programs what they see in exported files: clients.py gds|oasis|masks|gwyddion|images FOLDER. Prints facts as NAME VALUE."""
import os
import re
import struct
import subprocess
import sys
import tempfile


def output(*command):
    environment = dict(os.environ, QT_QPA_PLATFORM="offscreen")
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, env=environment)
    if done.returncode:
        sys.exit(f"{' '.join(command)}: {done.stderr}")
    return done.stdout


KLAYOUT = """
import pya
l = pya.Layout(); l.read(f)
top = l.top_cell()
print("dbu", l.dbu)
for info in l.layer_infos():
    region = pya.Region()
    for cell in l.each_cell():
        region.insert(cell.shapes(l.layer(info)))
    print("area_%d" % info.layer, region.merged().area() * l.dbu ** 2)
for i in top.each_inst():
    print("count", i.na * i.nb)
    print("pitch_x", max(i.a.x, i.b.x) * l.dbu)
    print("pitch_y", max(i.a.y, i.b.y) * l.dbu)
l.write(f + ".oas")
again = pya.Layout(); again.read(f + ".oas")
for i in again.top_cell().each_inst():
    print("oasis_count", i.na * i.nb)
print("oasis_layers", len(again.layer_infos()))
"""


def layout(path):
    with tempfile.NamedTemporaryFile("w", suffix=".py") as script:
        script.write(KLAYOUT)
        script.flush()
        print(output("klayout", "-b", "-rd", f"f={path}", "-r", script.name), end="")


def gds(folder):
    layout(f"{folder}/texture.gds")


def oasis(folder):
    layout(f"{folder}/texture.oas")


def gwyddion(folder):
    for name in ("heightmap.gsf", "heightmap.x3p", "heightmap.png"):
        result = f"{folder}/{name}.gwy"
        output("gwyddion", f"--convert-to-gwy={result}", f"{folder}/{name}")
        data = open(result, "rb").read()
        ending = name[-3:]
        for key in ("xreal", "yreal"):
            at = data.index(key.encode() + b"\0d") + len(key) + 2
            print(f"{ending}_{key}", struct.unpack("<d", data[at:at + 8])[0])
        at = data.index(b"data\0D") + 6
        count = struct.unpack("<I", data[at:at + 4])[0]
        values = struct.unpack(f"<{count}d", data[at + 4:at + 4 + 8 * count])
        print(f"{ending}_pixels", count)
        print(f"{ending}_range", max(values) - min(values))
        # Top row first: a hole in one corner alone tells up from down.
        side = int(count ** 0.5)
        print(f"{ending}_top", sum(values[:count // 2]) - sum(values[count // 2:]))
        assert side * side == count


def images(folder):
    text = output("tiffinfo", f"{folder}/heightmap.tif")
    print("tiff_resolution", re.search(r"Resolution: ([\d.]+), ([\d.]+) pixels/cm", text)[1])
    print("tiff_none", int("Compression Scheme: None" in text))
    print("tiff_bits", re.search(r"Bits/Sample: (\d+)", text)[1])
    text = output("exrheader", f"{folder}/heightmap.exr")
    print("exr_xreal", re.search(r"Gwy::XReal \(type double\): ([\d.e+-]+)", text)[1])
    print("exr_channel", re.search(r"\n\s+(\w+), 32-bit floating-point", text)[1])
    text = output("iinfo", "--stats", f"{folder}/heightmap.exr")
    print("exr_max", re.search(r"Stats Max: ([\d.]+)", text)[1])
    text = output("iinfo", "--stats", f"{folder}/mask.tif")
    print("mask_mean", re.search(r"Stats Avg: ([\d.]+)", text)[1])


def magick(folder):
    for name in ("heightmap.tif", "heightmap.png"):  # Debian's reads no EXR
        print(name, output("identify", "-format", "%wx%h %m", f"{folder}/{name}"))


globals()[sys.argv[1]](sys.argv[2])

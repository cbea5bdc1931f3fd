"""Files of strangers: damaged ones, and folders with links, pipes and endless devices in the place of files."""
import os
import random
import shutil
import time

from . import running, work

READERS = [
    ["report", "results"],
    ["export", "results", "--out", "again", "--pixels", "16"],
    ["optimize", "study.toml", "--out", "results", "--jobs", "1", "--resume"],
    ["verify", "files"],
    ["surface", "files/preview.png", "--size", "12 um"],
    ["surface", "files/heightmap.exr"],
    ["surface", "files/heightmap.gsf"],
    ["surface", "files/heightmap.x3p"],
    ["surface", "files/heightmap.tif", "--size", "12 um"],
]


def changed(source, bytes_):
    """One to four changes: a bit, a byte, a cut, a repetition, a long digit string."""
    out = bytearray(bytes_)
    for _ in range(source.randint(1, 4)):
        if not out:
            break
        at = source.randrange(len(out))
        what = source.randrange(5)
        if what == 0:
            out[at] ^= 1 << source.randrange(8)
        elif what == 1:
            out[at] = source.randrange(256)
        elif what == 2:
            del out[at:at + source.randint(1, max(1, len(out) // 2))]
        elif what == 3:
            out[at:at] = out[at:at + 64] * source.randint(1, 16)
        else:
            out[at:at] = source.choice([b"999999999", b"-1", b"1e308", b"nan", b"\xff\xfe", b"\x00" * 8])
    return bytes(out)


def damaged(bench, seconds):
    """One file of a folder of results or of exported files is damaged; every reader of that folder refuses or copes."""
    tally = running.Tally("damaged files")
    source = random.Random(7)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        arguments = source.choice(READERS)
        folder = "results" if "results" in arguments else "files"
        files = [name for name in bench.made if name.startswith(folder + "/")]
        if arguments[0] == "surface":
            files = [arguments[1]]
        name = source.choice(files)
        place = bench.copy()
        (place / name).write_bytes(changed(source, (place / name).read_bytes()))
        _, outcome = bench.run(work.Command("", arguments), place=place)
        tally.judge(outcome, f"papilla {' '.join(arguments)} with a damaged {name}")
    return tally


def strange(bench, seconds):
    """A link to a file of the user, a pipe, an endless device or a folder in the place of each file in turn."""
    tally = running.Tally("links, pipes and devices")
    precious = bench.folder / "precious"
    end = time.monotonic() + seconds
    places = [(name, kind) for kind in ("link", "pipe", "device", "folder") for name in bench.made]
    random.Random(8).shuffle(places)
    for name, kind in places:
        if time.monotonic() > end:
            break
        for arguments in READERS:
            if arguments[0] == "surface" and arguments[1] != name:
                continue
            if arguments[0] != "surface" and ("results" in arguments) != name.startswith("results/"):
                continue
            place = bench.copy()
            precious.write_text("the user's own\n")
            path = place / name
            path.unlink()
            if kind == "link":
                path.symlink_to(precious)
            elif kind == "pipe":
                os.mkfifo(path)
            elif kind == "device":
                path.symlink_to("/dev/zero")
            else:
                path.mkdir()
            _, outcome = bench.run(work.Command("", arguments), place=place)
            more = "" if precious.read_text() == "the user's own\n" else "wrote through the link"
            tally.judge(outcome, f"papilla {' '.join(arguments)} with a {kind} at {name}", more)
    shutil.rmtree(bench.folder / "run", ignore_errors=True)
    return tally

"""The studio measured: studio_bench.py PROGRAM OUT.csv [EVENTS].

From the event of a slider to the drawn curve, in headless Chromium on this machine; 300 events over flat glass, holes, a particle film and holes
under a film, without and as many with a search running, each once the design at hand was refined. Beside it the processor time that the studio itself spends
on an event, which other work on the machine does not change.
"""
import os
import random
import shutil
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "studio"))
from browser import TREE, Browser, Studio, go, until  # noqa: E402

PARTICLES = """schema_version = 1
base = "m3_samples/a3h600.toml"
title = "Particle film"

[texture]
type = "particle_film"
radius = "1 um"
coverage = "30 %"
"""
KEYS = {
    "flat": ["drive.amplitude", "surface.contact_angle", "finger.load"],
    "holes": ["drive.amplitude", "surface.contact_angle", "finger.load", "texture.depth"],
    "particles": ["drive.amplitude", "surface.contact_angle", "finger.load", "texture.radius"],
    "film": ["drive.amplitude", "surface.contact_angle", "finger.load", "texture.depth"],
}
FILES = {"flat": "m3_samples/flat.toml", "holes": "m3_samples/a3h600.toml", "film": "m3_glass/directional.toml"}


def design(folder, kind):
    if kind != "particles":
        return os.path.join(TREE, "designs", FILES[kind])
    path = os.path.join(folder, "particles.toml")
    with open(path, "w") as file:
        file.write(PARTICLES)
    return path


def quantile(values, share):
    values = sorted(values)
    at = share * (len(values) - 1)
    low = int(at)
    return values[low] + (at - low) * (values[min(low + 1, len(values) - 1)] - values[low])


MOVE = """
const row = document.getElementById('k-%s').closest('.key').querySelector('input[type=range]');
row.value = Math.round(%f * row.max); row.dispatchEvent(new Event('input', {bubbles: true}));"""


def processor_seconds(process):
    with open(f"/proc/{process.pid}/stat") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def latency(out, count):
    rows = []
    each = -(-count // sum(len(k) for k in KEYS.values()))
    before = os.getloadavg()[0]
    folder, profile = tempfile.mkdtemp(), tempfile.mkdtemp()
    browser = Browser(profile)
    browser.metrics(1440, 900)
    draw = random.Random(300)
    for searching in [False, True]:
        for kind, keys in KEYS.items():
            studio = Studio(tempfile.mkdtemp(dir=folder), design(folder, kind))
            go(browser, studio)
            until(browser, "document.documentElement.dataset.step !== 'first'", 300, "a refined answer")
            if searching:
                browser.run("document.getElementById('evaluations').value = 5000; const b = [...document.querySelectorAll('#variables tbody tr')].find(r => r.dataset.path === 'surface.contact_angle').querySelector('input'); b.checked = true; document.getElementById('start').click()")
                until(browser, "document.getElementById('searchstate').textContent === 'running'", 60)
            for key in keys:
                browser.run("papilla.latency.done.length = 0")
                spent = processor_seconds(studio.process)
                for n in range(each):
                    browser.run(MOVE % (key.replace(".", "-"), draw.random()))
                    until(browser, f"papilla.latency.done.length > {n}", 60, f"event {n} of {key}")
                    time.sleep(0.1)
                done = browser.run("return papilla.latency.done")
                spent = 1e3 * (processor_seconds(studio.process) - spent) / len(done)
                rows.append([kind, key, "yes" if searching else "no", len(done), quantile(done, 0.5), quantile(done, 0.95), spent])
                print(rows[-1], flush=True)
            studio.close()
    browser.close()
    shutil.rmtree(folder, ignore_errors=True)
    shutil.rmtree(profile, ignore_errors=True)
    with open(out, "w") as file:
        file.write(f"# from the event of a slider to the drawn curve; {os.cpu_count()} cores, load {before:.1f} before the first event\n")
        file.write("texture,key,search running,events,median [ms],p95 [ms],processor time of the studio per event [ms]\n")
        for row in rows:
            file.write(",".join(str(v) if not isinstance(v, float) else f"{v:.0f}" for v in row) + "\n")


if __name__ == "__main__":
    latency(sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 300)

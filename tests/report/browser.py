"""Opens a report in headless Chromium: browser.py PAGE.html [PICTURE_FOLDER]. Exit 0: all as it should be.

Every chart has drawn something, nothing is written to the console, nothing is asked of the network, pointing and
selecting work, the page prints. In light and dark, at 1100 and 380 px: no sideways scrolling, no table cut, text of
enough contrast (WCAG 2.1: 4.5, large text 3), a name for every canvas, choice and region.
"""
import base64
import json
import os
import re
import shutil
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from chromium import FAINT, Browser, check, eventually  # noqa: E402

# The charts that a page must have, by what it calls itself.
CHARTS = {
    "Papilla report": ["section", "humidity", "pareto", "budget", "progress"],
    "Papilla report: ranking": ["criterion0", "criterion1", "together"],
    "Papilla report: fit of a finger": ["widths", "directions", "misses", "held"],
}


# How many colours a canvas shows: an empty one has one.
COLOURS = """
const c = document.getElementById(arguments_id), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
const seen = new Set(); for (let i = 0; i < d.length; i += 4) seen.add(d[i] << 16 | d[i+1] << 8 | d[i+2]); return seen.size;
"""


def inspect_optimize(browser):
    headings = "return [...document.querySelectorAll('#stability h2, #sensitivity h2')].map(h => h.textContent)"
    advice = browser.run("return document.getElementById('lead').textContent")
    check(re.match("Build|Leave it flat|Whether", advice), f"no recommendation: {advice}")
    rows = browser.run("return document.querySelectorAll('#steps tbody tr').length")
    check(rows >= 1 and browser.run("return document.getElementById('change').hidden") == (rows < 2), f"{rows} steps from flat to best")
    held = browser.run("""
        const c = papilla.charts.pareto, sets = c.data.datasets.filter(s => s.bars).flatMap(s => s.data);
        return sets.every(p => p.x - p.ex >= c.scales.x.min && p.x + p.ex <= c.scales.x.max && p.y - p.ey >= c.scales.y.min && p.y + p.ey <= c.scales.y.max)""")
    check(held, "error bars leave the chart of the trade-offs")
    check("What the best design is sensitive to" in browser.run(headings), f"headings {browser.run(headings)}")
    check(browser.run("return document.querySelectorAll('#sensitivity tbody tr').length") >= 2, "no sensitivities")
    nothing = "return [...document.querySelectorAll('#finalists td')].filter(t => t.textContent === '–').length"
    check(browser.run(nothing) == 0, "finalists with a number or a kind that is not shown")
    cut = "return [...document.querySelectorAll('#numbers, #finalists')].map(t => t.parentElement.scrollWidth - t.parentElement.clientWidth)"
    check(max(browser.run(cut)) <= 0, f"tables cut by {browser.run(cut)} px")
    check(browser.run(COLOURS.replace("arguments_id", "'top'")) > 4, "the picture from above is empty")
    if browser.run("return papilla.solid.ready"):
        distinct = browser.run("""
            const s = papilla.solid; s.renderer.render(s.scene, s.camera);
            const c = document.createElement('canvas'); c.width = c.height = 64;
            c.getContext('2d').drawImage(s.renderer.domElement, 0, 0, 64, 64);
            return new Set(c.getContext('2d').getImageData(0, 0, 64, 64).data).size""")
        check(distinct > 4, "the solid is empty")
        # The lowest y is in front, and the section cuts there.
        ends = "const z = papilla.solid.turn.children[0].geometry.attributes.position.array.filter((v, i) => i % 3 === 2); return [z[0], Math.max(...z), Math.min(...z)]"
        first, front, back = browser.run(ends)
        check(first == front > 0 > back, f"the lowest y of the solid at {first} of {back} to {front}")
        cut = "const r = document.querySelectorAll('.solidtools input')[1]; r.value = {}; r.dispatchEvent(new Event('input'))"
        browser.run(cut.format(60))
        after = browser.run(ends)
        browser.run(cut.format(0))
        check(after[1] < 0 and after[2] == back, f"a section at 60 % leaves {after[2]} to {after[1]} of {back} to {front}")
    # The lowest y of a map is at the bottom of its picture, as in every file: its row alone is bright here.
    rows = browser.run("""
        const c = document.getElementById('top'), { map } = c.$map, { low, high } = map, kept = map.values.slice(), height = c.height - 46;
        [map.low, map.high] = [0, 1];
        map.values.fill(0, map.nx).fill(1, 0, map.nx);
        const copy = Object.assign(document.createElement('canvas'), { width: c.width, height: c.height });
        const brush = copy.getContext('2d', { willReadFrequently: true });
        c.$paint(brush);
        const red = (y) => brush.getImageData(c.width / 2, y, 1, 1).data[0], rows = [red(1), red(height - 2)];
        map.values.set(kept);
        [map.low, map.high] = [low, high];
        return rows""")
    check(rows[0] < 100 and rows[1] > 200, f"the lowest row is not at the bottom: red {rows}")
    told = browser.run("""
        const c = document.getElementById('top');
        c.onmousemove({ offsetX: 1, offsetY: c.clientHeight * (c.height - 46) / c.height - 1 });
        return [c.title, c.$map.map.ly / c.$map.map.ny / 2]""")
    at, unit = re.search(r", ([0-9.]+) (nm|µm)$", told[0]).groups()
    check(abs(float(at) * {"nm": 1e-9, "µm": 1e-6}[unit] - told[1]) < 0.1 * told[1], f"pointing at the bottom says {told}")
    check(browser.run("return document.querySelectorAll('#maps canvas').length") >= 4, "no pictures of the contact")

    # Point at the last design of the front, then select it.
    spot = browser.run("""
        const c = papilla.charts.pareto, set = c.data.datasets.findIndex(s => s.label.startsWith('front'));
        const meta = c.getDatasetMeta(set).data, p = meta[meta.length - 1];
        c.canvas.scrollIntoView({block: 'center', behavior: 'instant'});
        const box = c.canvas.getBoundingClientRect();
        return [box.left + p.x, box.top + p.y, c.data.datasets[set].data[meta.length - 1].row.design]""")
    point_at(browser, "pareto", spot)
    browser.pointer(spot[0], spot[1], True)
    chosen = "return document.documentElement.dataset.design"
    check(eventually(lambda: browser.run(chosen) == spot[2]), "selecting a design does nothing")
    check(browser.run("return document.getElementById('design').value") == spot[2], "the choice does not follow")


def bar(browser, chart):
    """A place inside the longest bar, and what pointing there has to say."""
    return browser.run(f"""
        const c = papilla.charts['{chart}'], bars = c.getDatasetMeta(0).data;
        const i = bars.reduce((m, b, k) => Math.abs(b.x - b.base) > Math.abs(bars[m].x - bars[m].base) ? k : m, 0);
        c.canvas.scrollIntoView({{block: 'center', behavior: 'instant'}});
        const box = c.canvas.getBoundingClientRect();
        return [box.left + (bars[i].x + bars[i].base) / 2, box.top + bars[i].y, c.data.datasets[0].text[i]]""")


def point_at(browser, chart, spot):
    browser.pointer(spot[0], spot[1], False)
    tip = f"const t = papilla.charts['{chart}'].tooltip; return t.opacity ? t.body.map(b => b.lines.join()).join() : ''"
    check(eventually(lambda: spot[2] in browser.run(tip)), f"pointing at {spot[2]} says '{browser.run(tip)}'")


def inspect_rank(browser):
    scored = "score" in browser.run("return Object.keys(papilla.charts)")
    chart = "score" if scored else "criterion0"
    point_at(browser, chart, bar(browser, chart))
    pairs = browser.run("return document.querySelectorAll('#pairs tbody tr').length")
    check((pairs >= 2) != scored, f"{pairs} rows of who beats whom, scored {scored}")
    before = browser.run("return document.getElementById('lead').textContent")
    browser.run("const s = document.getElementById('finger'); s.value = '1'; s.dispatchEvent(new Event('change'))")
    after = browser.run("return document.getElementById('lead').textContent")
    check("clean finger" in before and "natural finger" in after, f"the choice of a finger does nothing: {after}")
    check(browser.run("return document.querySelectorAll('#pictures canvas').length") >= 2, "no pictures of the candidates")
    check(browser.run("return document.querySelectorAll('#places tbody tr').length") >= 2, "no table of places")
    check(browser.run("return document.querySelectorAll('#differences tbody tr').length") >= 1, "no table of differences")


def inspect_calibrate(browser):
    point_at(browser, "directions", bar(browser, "directions"))
    cells = browser.run("""return [...document.querySelectorAll('#matrix tbody td.number')].map(c => c.style.backgroundColor)""")
    check(len(cells) >= 4 and len(set(cells)) > 1, "the correlations have no colours")
    for name in ["values", "directiontable", "residualtable", "claimtable"]:
        check(browser.run(f"return document.querySelectorAll('#{name} tbody tr').length") >= 2, f"table {name} is empty")


NAMELESS = """
return [...document.querySelectorAll('canvas:not([aria-label]), .scroll:not([aria-label])')].map(e => e.id || e.className)
  .concat([...document.querySelectorAll('select')].filter(s => !s.labels.length).map(s => s.id))
  .concat(document.documentElement.lang && document.title ? [] : ['page']);
"""
CUT = """
return [...document.querySelectorAll('.scroll')].filter(b => b.scrollWidth > b.clientWidth + 1 && b.getClientRects().length).map(b => b.firstElementChild.id || 'table');
"""


def inspect_looks(browser, page):
    for scheme in ["dark", "light"]:
        browser.scheme(scheme)
        for width in [1100, 380]:
            browser.metrics(width, 900)
            browser.call("POST", "/url", {"url": "file://" + os.path.abspath(page)})
            check(browser.run("return document.documentElement.dataset.charts"), f"the script ended early in {scheme}")
            paper = browser.run("return getComputedStyle(document.body).backgroundColor")
            check((paper == "rgb(255, 255, 255)") == (scheme == "light"), f"{scheme} on {paper}")
            # Charts take the new width a frame later.
            wide = "return document.documentElement.scrollWidth"
            check(eventually(lambda: browser.run(wide) <= width), f"{browser.run(wide)} px wide at {width} px")
            faint, nameless = browser.run(FAINT), browser.run(NAMELESS)
            check(not faint, f"too faint in {scheme} at {width} px: {faint}")
            check(not nameless, f"without a name: {nameless}")
            cut = browser.run(CUT) if width == 380 else []
            check(not cut, f"tables cut at {width} px: {cut}")
            browser.picture(sys.argv[2] if len(sys.argv) > 2 else "", f"{scheme}_{width}.png")


def inspect(browser, page):
    inspect_looks(browser, page)
    browser.metrics(1100, 900)
    browser.call("POST", "/url", {"url": "file://" + os.path.abspath(page)})
    kind = browser.run("return document.querySelector('.kicker').textContent")
    check(browser.run("return document.documentElement.dataset.charts"), "the page script ended early")
    charts = browser.run("return Object.keys(papilla.charts)")
    check(set(CHARTS[kind]) <= set(charts), f"charts {charts}")
    for name in charts:
        colours = browser.run(COLOURS.replace("arguments_id", f"'{name}'"))
        check(colours > 4, f"chart {name} is empty")
    check(browser.run("return document.querySelectorAll('#filelist tr').length") > 3, "no list of files")
    {"Papilla report": inspect_optimize, "Papilla report: ranking": inspect_rank,
     "Papilla report: fit of a finger": inspect_calibrate}[kind](browser)

    paper = base64.b64decode(browser.call("POST", "/print", {}))
    check(paper.startswith(b"%PDF") and len(paper) > 20000, "does not print")

    # The software renderer complains about its own speed when this script reads the solid back.
    console = [entry["message"] for entry in browser.log("browser") if "(OpenGL, Performance" not in entry["message"]]
    check(not console, "console: " + "; ".join(console))
    requests = set()
    for entry in browser.log("performance"):
        message = json.loads(entry["message"])["message"]
        # Of this page alone: the browser's own start page asks for things too.
        if message["method"] == "Network.requestWillBeSent" and message["params"]["documentURL"].startswith("file:"):
            requests.add(message["params"]["request"]["url"][:100])
    outside = [url for url in requests if not url.startswith(("file://", "data:", "blob:"))]
    check(not outside and len(requests) >= 1, f"asked for {outside}")


def main():
    folder = tempfile.mkdtemp()
    browser = Browser(folder)
    try:
        inspect(browser, sys.argv[1])
    finally:
        browser.close()
        shutil.rmtree(folder, ignore_errors=True)


try:
    main()
except AssertionError as error:
    sys.exit(str(error))

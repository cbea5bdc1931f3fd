"""The studio in headless Chromium: browser.py PROGRAM PART [PICTURE_FOLDER]. Exit 0: all as it should be.

Parts: smoke (page, sliders, undo, pin, widths, dark, console), modules (what the page makes of what it is told), pages (two pages one state, reconnect, foreign
origin), hour (open, change, pin, search, steer, plan and tell measurements, pick, scan, export, verify, save, reopen), keys (the same hour by keys alone),
thousand (events of a slider without a pause), latency (300 events of each of five keys on five kinds of design, and memory after them: a table).
"""
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
import xml.etree.ElementTree as xml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from chromium import FAINT, Browser, check  # noqa: E402

TREE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
THOROUGH = "PAPILLA_THOROUGH" in os.environ
PICTURES = sys.argv[3] if __name__ == "__main__" and len(sys.argv) > 3 else ""


class Studio:
    def __init__(self, folder, file, port=0):
        self.process = subprocess.Popen([sys.argv[1], "studio", file, "--folder", folder, "--no-open", "--port", str(port), "--quiet"],
                                        stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        self.port = int(re.search(r":(\d+)/", self.address)[1])

    def close(self):
        self.process.terminate()
        self.process.wait()


def two_humidities(folder):
    """Holes of m3_samples in a fraction of the time: what is tried is the page."""
    path = os.path.join(folder, "mine.toml")
    with open(path, "w") as file:
        file.write('schema_version = 1\nbase = "m3_samples/a3h600.toml"\n\n[environment]\nrelative_humidity = ["15 %", "75 %"]\n\n[accuracy]\nlevel = "draft"\ngrid = 64\n')
    return path


def until(browser, script, seconds=60, what=""):
    end = time.time() + seconds
    while time.time() < end:
        if browser.run("return Boolean(" + script + ")"):
            return
        time.sleep(0.05)
    check(False, f"waited {seconds} s for {what or script}")


def go(browser, studio):
    browser.call("POST", "/url", {"url": studio.address})
    until(browser, "document.documentElement.dataset.revision", 60, "a first answer")


def slide(browser, path, share):
    """Moves a slider to a share of its way, as a hand does."""
    browser.run(f"""
        const row = document.getElementById('k-{path.replace('.', '-')}').closest('.key').querySelector('input[type=range]');
        row.value = Math.round({share} * row.max); row.dispatchEvent(new Event('input', {{bubbles: true}})); row.dispatchEvent(new Event('change', {{bubbles: true}}));""")


def value(browser, path):
    return browser.run(f"return document.getElementById('k-{path.replace('.', '-')}').value")


def press(browser, *keys):
    actions = []
    for key in keys:
        actions += [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
    browser.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": actions}]})


def quiet(browser):
    console = [e["message"] for e in browser.log("browser") if "GPU stall" not in e["message"] and "OpenGL" not in e["message"] and "swiftshader" not in e["message"].lower()]
    check(not console, "console: " + "; ".join(console))


def inside_page(browser):
    requests = set()
    for entry in browser.log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent" and message["params"]["documentURL"].startswith("http://127.0.0.1"):
            requests.add(message["params"]["request"]["url"])
    outside = [u for u in requests if not u.startswith(("http://127.0.0.1", "data:", "blob:"))]
    check(not outside, f"asked for {outside}")


NAMELESS = """
return [...document.querySelectorAll('canvas:not([aria-label]):not([aria-hidden])')].map(e => e.id || 'canvas')
  .concat([...document.querySelectorAll('input, select')].filter(s => !s.labels.length && !s.getAttribute('aria-label')).map(s => s.id || s.type))
  .concat([...document.querySelectorAll('button')].filter(b => !(b.textContent.trim() || b.getAttribute('aria-label'))).map(b => b.id || 'button'));
"""


def looks(browser, studio):
    """In both schemes at each width. In scripts/test --thorough it is loaded anew at each, else at the narrowest, and then the window grows."""
    for scheme in ["dark", "light"]:
        browser.scheme(scheme)
        for width in [360, 1024, 1440, 2560] if THOROUGH else [360, 1440]:
            browser.metrics(width, 900)
            if THOROUGH or width == 360:
                go(browser, studio)
                until(browser, "document.documentElement.dataset.shape", 30, "the shape")
            until(browser, f"innerWidth === {width}", 10, "the width of the window")
            wide = browser.run("return document.documentElement.scrollWidth")
            browser.picture(PICTURES, f"studio_{scheme}_{width}.png")
            check(wide <= width, f"{wide} px wide at {width} px")
            feel, front = browser.run("return ['answer', 'search'].map(id => { const b = document.getElementById(id).getBoundingClientRect(); return [b.left, b.right, b.top]; })")
            check(width < 1280 or front[2] < 200 and front[0] >= feel[1] - 1, f"the search is not beside Feel at {width} px: {feel}, {front}")
            faint, nameless = browser.run(FAINT), browser.run(NAMELESS)
            check(not faint, f"too faint in {scheme} at {width} px: {faint}")
            check(not nameless, f"without a name: {nameless}")


def moved(browser, share, what):
    before = value(browser, "texture.depth")
    slide(browser, "texture.depth", share)
    until(browser, f"(k => k.changed && parseFloat(k.value) !== parseFloat('{before}'))(papilla.session().keys.find(k => k.path === 'texture.depth'))", 10, what)


def smoke(browser, folder):
    studio = Studio(folder, two_humidities(folder))
    try:
        browser.metrics(1440, 900)
        go(browser, studio)
        before = browser.run("return papilla.charts.modulation.data.datasets[0].data.map(p => p.y)")
        check(len(before) == 2, f"a curve of {before}")
        browser.run("window.row = document.getElementById('k-drive-amplitude')")
        slide(browser, "drive.amplitude", 0.35)
        until(browser, f"papilla.charts.modulation.data.datasets[0].data[0].y < {0.9 * before[0]}", 30, "a weaker drive")
        check(browser.run("return document.getElementById('file').textContent").endswith("1 changed"), "no change is said")
        check(browser.run("return window.row === document.getElementById('k-drive-amplitude')"), "a change of a value builds the form anew")
        until(browser, "papilla.charts.section", 20, "the section")
        lines = browser.run("return papilla.charts.section.data.datasets[0].dimensions.lines.map(l => [l.text, l.to - l.from])")
        check([t for t, _ in lines] == ["period 6 µm", "diameter 3 µm", "depth 600 nm"], f"dimension lines {lines}")
        check(abs(lines[0][1] - 6) < 1e-6 and abs(lines[1][1] - 3) < 1e-6, f"dimension lines as long as {lines}")
        # A slider by arrows, undo by its key, a pin.
        browser.run("document.getElementById('k-texture-depth').closest('.key').querySelector('input[type=range]').focus()")
        depth = value(browser, "texture.depth")
        press(browser, *["\ue014"] * 5)
        until(browser, f"document.getElementById('k-texture-depth').value !== '{depth}'", 10, "the arrow keys")
        until(browser, "papilla.session().keys.find(k => k.path === 'texture.depth').changed", 30, "the arrows' change")
        browser.run("document.body.focus(); document.activeElement.blur()")
        press(browser, "p")
        until(browser, "document.querySelectorAll('.pinned').length === 1", 10, "a pin")
        slide(browser, "surface.contact_angle", 0.6)
        until(browser, "document.documentElement.dataset.step === 'draft' || document.documentElement.dataset.step === 'design'", 200, "a refined answer")
        until(browser, "/modulation (better|worse)|not told/.test(document.querySelector('.pinned p').textContent)", 200, "a paired difference")
        browser.run("document.getElementById('undo').click()")
        until(browser, "!papilla.session().keys.find(k => k.path === 'surface.contact_angle').changed", 10, "undo")
        # By tabs from the top every control is reached.
        browser.run("document.querySelector('.skip').focus()")
        reached = set()
        for _ in range(30):
            press(browser, "\ue004")
            reached.add(browser.run("const e = document.activeElement; return e.id || e.dataset.kind || e.type || e.tagName"))
        check({"undo", "pin", "save", "hole_array"} <= reached, f"by keys alone only {sorted(reached)}")
        # Another kind, and back.
        browser.run("document.querySelector('[data-kind=pillar_array]').click()")
        until(browser, "papilla.session().kind === 'pillar_array' && document.getElementById('k-texture-height')", 10, "pillars")
        browser.run("document.getElementById('undo').click()")
        until(browser, "papilla.session().kind === 'hole_array'", 10, "holes again")
        # What is refused is said, and changes nothing.
        browser.run("const i = document.getElementById('k-texture-diameter'); i.value = '7 um'; i.dispatchEvent(new Event('change'))")
        until(browser, "!document.getElementById('k-texture-diameter-said').hidden", 10, "a refusal at its field")
        # A slider ends where the design ends, and says why.
        slide(browser, "texture.diameter", 1)
        until(browser, "/^ends here: /.test(document.getElementById('k-texture-diameter-said').textContent)", 10, "the end of a slider")
        until(browser, "parseFloat(document.getElementById('k-texture-diameter').value) < 6", 10, "the value that the design has")
        ended = float(browser.run("return papilla.session().keys.find(k => k.path === 'texture.diameter').shown"))
        check(5.9 < ended < 6.0, f"holes of {ended} um end in a period of 6 um")
        # A kind that is left and come back to has its values.
        browser.run("document.querySelector('[data-kind=pillar_array]').click()")
        until(browser, "papilla.session().kind === 'pillar_array'", 10, "pillars")
        browser.run("document.querySelector('[data-kind=hole_array]').click()")
        until(browser, "papilla.session().kind === 'hole_array'", 10, "holes once more")
        check(float(browser.run("return papilla.session().keys.find(k => k.path === 'texture.diameter').shown")) == ended, "the kind forgot its values")
        for _ in range(3):
            browser.run("document.getElementById('undo').click()")
        # Keys are found by a word; a comma is a decimal one.
        browser.run("const f = document.getElementById('filter'); f.value = 'resistivity'; f.dispatchEvent(new Event('input'))")
        with_the_word = "return [...document.querySelectorAll('.key.match label')].map(l => l.textContent)"
        found = browser.run(with_the_word)
        check(found and all("resistivity" in text for text in found), f"keys of a word: {found}")
        # Rows of another kind are found by it, too.
        browser.run("document.querySelector('[data-kind=grating]').click()")
        until(browser, "papilla.session().kind === 'grating' && document.getElementById('k-texture-width')", 10, "grooves")
        check(browser.run(with_the_word) == found, f"of another kind: {browser.run(with_the_word)} for {found}")
        browser.run("document.getElementById('undo').click()")
        until(browser, "papilla.session().kind === 'hole_array' && document.getElementById('k-texture-diameter')", 10, "holes again")
        browser.run("const f = document.getElementById('filter'); f.value = ''; f.dispatchEvent(new Event('input'))")
        browser.run("const i = document.getElementById('k-texture-period'); i.value = '6,5 µm'; i.dispatchEvent(new Event('change'))")
        until(browser, "papilla.session().keys.find(k => k.path === 'texture.period').value === '6.5 um'", 10, "a decimal comma")
        until(browser, "document.title.includes('texture.period 6.5 µm') && document.getElementById('title').textContent.includes('texture.period 6.5 µm')", 10, "the title as people read it")
        browser.run("document.getElementById('undo').click()")
        # Before three digits it may be of thousands.
        browser.run("const i = document.getElementById('k-texture-depth'); i.value = '1,200 nm'; i.dispatchEvent(new Event('change'))")
        until(browser, "/thousands/.test(document.getElementById('k-texture-depth-said').textContent)", 10, "the question at a comma before three digits")
        # In a list a comma parts numbers.
        browser.run("const i = document.getElementById('k-environment-relative_humidity'); i.value = '30,50,70'; i.dispatchEvent(new Event('change'))")
        until(browser, "papilla.session().keys.find(k => k.path === 'environment.relative_humidity').value === '30 %, 50 %, 70 %'", 10, "a list of three")
        until(browser, "document.querySelectorAll('#values tbody tr').length === 3", 30, "three humidities")
        browser.run("document.getElementById('undo').click()")
        until(browser, "document.querySelectorAll('#values tbody tr').length === 2", 30, "the two humidities again")
        # The curves as a table, for those who hear the page.
        rows = browser.run("return [...document.querySelectorAll('#values tbody tr')].map(r => [...r.cells].map(c => c.textContent))")
        check(len(rows) == 2 and all(" ± " in cell and cell.endswith("mN") for cell in (row[-1] for row in rows)), f"values over humidity: {rows}")
        # Light and dark change colours alone: what is written and open stays.
        browser.run("document.getElementById('filter').value = 'kept'; window.before = papilla.charts.modulation.data.datasets[0].borderColor")
        browser.scheme("dark")
        until(browser, "papilla.charts.modulation && papilla.charts.modulation.data.datasets[0].borderColor !== window.before", 10, "other colours")
        check(browser.run("return document.getElementById('filter').value") == "kept", "the page was loaded again")
        browser.scheme("light")
        until(browser, "papilla.charts.modulation && papilla.charts.modulation.data.datasets[0].borderColor === window.before", 10, "the colours of before")
        browser.run("document.getElementById('filter').value = ''")
        # What was written into the form of searches is there after a reload; the file's own comes back on demand.
        browser.run("const k = document.querySelector('#wishkinds input[value=pillar_array]'); k.click(); const e = document.getElementById('evaluations'); e.value = 37; e.dispatchEvent(new Event('input', {bubbles: true}))")
        # A share of people that feel it is of a modulation that one names.
        browser.run("""
            const line = document.querySelector('.goal'), metric = line.querySelectorAll('select')[2], at = line.querySelector('input');
            window.hidden = at.parentElement.hidden;
            metric.value = 'felt';
            metric.dispatchEvent(new Event('change', {bubbles: true}));
            at.value = '0.15';
            at.dispatchEvent(new Event('input', {bubbles: true}));""")
        check(browser.run("return window.hidden && !document.querySelector('.goal label').hidden"), "the modulation of a share of people")
        first_depth = value(browser, "texture.depth")
        moved(browser, 0.3, "a move")
        time.sleep(1)
        go(browser, studio)
        until(browser, "document.getElementById('evaluations').value === '37' && document.querySelector('#wishkinds input[value=pillar_array]').checked", 10, "the wish after a reload")
        check(browser.run("const line = document.querySelector('.goal'); return line.querySelectorAll('select')[2].value + line.querySelector('input').value") == "felt0.15", "the modulation after a reload")
        browser.run("document.getElementById('proposed').click()")
        until(browser, "document.getElementById('evaluations').value === '' && !document.querySelector('#wishkinds input[value=pillar_array]').checked", 10, "the file's own wish")
        # A move after a reload is a step of its own.
        before = value(browser, "texture.depth")
        moved(browser, 0.6, "a move after a reload")
        go(browser, studio)
        for depth, what in [(before, "the move before the reload"), (first_depth, "the depth before both moves")]:
            browser.run("document.getElementById('undo').click()")
            until(browser, f"document.getElementById('k-texture-depth').value === '{depth}'", 10, what)
        # A mistake of the wish is said below it.
        browser.run("document.querySelectorAll('#variables [type=checkbox]').forEach(b => { if (b.checked) b.click(); }); document.getElementById('start').click()")
        until(browser, "/needs a variable/.test(document.getElementById('wishnotice').textContent)", 10, "the mistake at the form")
        browser.run("document.getElementById('proposed').click()")
        until(browser, "document.getElementById('wishnotice').hidden", 10, "the file's wish in place of a mistaken one")
        # It is seen, its line is marked, and both end with the mistake.
        browser.run("""
            const [low, high, without] = document.querySelectorAll('#variables [data-path="texture.depth"] [type=text]');
            without.value = '0 nm to 1 mm';
            window.scrollTo(0, 0);
            document.getElementById('start').click();""")
        until(browser, "/depth/.test(document.getElementById('wishnotice').textContent)", 10, "the mistake of a range")
        seen = "(b => b.top >= 0 && b.bottom <= innerHeight)(document.getElementById('wishnotice').getBoundingClientRect())"
        until(browser, seen, 10, "the mistake where it is seen")
        marked = browser.run("return [...document.querySelectorAll('#wish .wrong:not([role])')].map(line => line.dataset.path)")
        check(marked == ["texture.depth"], f"lines that are marked: {marked}")
        browser.run("""
            const [low, high, without] = document.querySelectorAll('#variables [data-path="texture.depth"] [type=text]');
            without.value = '';
            without.dispatchEvent(new Event('input', { bubbles: true }));""")
        check(browser.run("return document.getElementById('wishnotice').hidden && !document.querySelector('#wish .wrong:not([role])')"), "a mistake stays after it was mended")
        browser.run("document.getElementById('inside').open = true")
        until(browser, "document.querySelectorAll('#maps canvas').length >= 4", 60, "maps of the contact")
        # A humidity that is chosen while a patch is worked out is drawn after it.
        browser.run("""
            const humidity = document.getElementById('rh'), send = window.fetch;
            window.asked = [];
            window.fetch = (url, what) => { if (url === 'maps') window.asked.push(JSON.parse(what.body).humidity); return send(url, what); };
            [0, 1].forEach((i) => { humidity.selectedIndex = i; humidity.dispatchEvent(new Event('change')); });""")
        until(browser, "window.asked.length === 2 && window.asked[1] === +document.getElementById('rh').value && !document.getElementById('maps').classList.contains('stale')", 60, "maps of the humidity that was chosen last")
        browser.picture(PICTURES, "smoke.png")
        looks(browser, studio)
        inside_page(browser)
        quiet(browser)
    finally:
        studio.close()


SEARCH = """{
    state: 'finished', number: 1, numbers: [1], folder: 'searches/001', stage: 'search', done: 3, total: 3, trouble: '', progress: null,
    variables: [{path: 'texture.depth', unit: 'nm'}], fingers: [], worth: {scale: 1, unit: ''}, front: [],
    objectives: [{name: 'mean(modulation)', maximise: true, scale: 1, unit: ''}],
    points: [0.3, 0.5, 0.4].map((v) => ({values: ['300 nm'], objectives: [v], ok: true, feasible: true})),
    confirmed: [['front/01', 0.5], ['front/02', 0.4]].map(([design, v]) => ({design, 'texture.depth [nm]': '300', 'mean(modulation)': String(v), 'mean(modulation) se': '0.1', 'on front': 'yes'})),
    recommended: {design: 'front/02', words: 'Build design 02.'}
}"""


def searched(browser):
    """A front has the names of its folders, best first, with what is recommended; a failed search has neither hint nor report, and no bar goes back."""
    browser.run(f"window.search = {SEARCH}; parts.showSearch(search)")
    rows = browser.run("return [...document.querySelectorAll('#frontlist tbody tr')].map(r => [r.cells[1].textContent, r.cells[2].textContent, r.className])")
    check(rows == [["front/01", "0.5", ""], ["front/02, recommended", "0.4", "recommended"]], f"the front: {rows}")
    sets = browser.run("return papilla.charts.pareto.data.datasets.map(s => [s.label, s.data.length])")
    check(["recommended", 1] in sets, f"the chart of the front: {sets}")
    check(browser.run("return document.getElementById('recommendation').textContent") == "Build design 02.", "what is recommended")
    bar = "return document.getElementById('bar').getAttribute('aria-valuenow')"
    shares = []
    for share in [0.48, 0.37, 0.6]:
        browser.run(f"parts.showSearch({{...search, state: 'running', folder: 'searches/002', confirmed: [], recommended: null, progress: {{share: {share}, seconds_left: 9}}}})")
        shares.append(browser.run(bar))
    check(shares == ["48", "48", "60"], f"the bar of a search: {shares}")
    # Feel is of the finger at hand, a front of all fingers of its search: said where they are several.
    felt = browser.run("return [['reference'], ['reference', 'moist']].map((fingers) => { parts.showSearch({...search, fingers}); return document.getElementById('felt').textContent; })")
    check(felt == ["", "Of the finger at hand; the search below judges by reference, moist."], f"whose fingers: {felt}")
    # A stop that is refused as no design was judged yet: said until one was.
    browser.run("""
        window.sent = window.fetch;
        window.fetch = (url, what) => url === 'search/stop' ? Promise.resolve(new Response('{"error": "no design was judged yet"}')) : window.sent(url, what);
        parts.showSearch({...search, state: 'running', folder: 'searches/002', done: 0, points: [], confirmed: [], recommended: null});
        document.getElementById('stop').click();""")
    until(browser, "document.getElementById('wishnotice').textContent === 'no design was judged yet'", 10, "the refusal of a stop")
    browser.run("window.fetch = window.sent; parts.showSearch({...search, state: 'running', folder: 'searches/002', done: 12, confirmed: [], recommended: null})")
    check(browser.run("return document.getElementById('wishnotice').hidden"), "the refusal of a stop stays after designs were judged")
    browser.run("parts.showSearch({...search, state: 'failed', folder: 'searches/003', trouble: 'error: no texture keeps it', done: 0, points: [], confirmed: [], recommended: null})")
    failed = browser.run("return [...['fronthint', 'stage', 'recommendation'].map(id => document.getElementById(id).textContent), document.getElementById('report').hidden]")
    check(failed == ["", "error: no texture keeps it", "", True], f"a search that failed: {failed}")


def modules(browser, folder):
    studio = Studio(folder, two_humidities(folder))
    try:
        go(browser, studio)
        until(browser, "document.documentElement.dataset.shape && document.documentElement.dataset.ready", 30, "the page")
        browser.run("Promise.all(['plots/maps.js', 'plots/curves.js', 'plots/solid.js', 'page/answer.js', 'page/form.js', 'page/scene.js', 'page/search.js', 'page/lab.js', 'page/files.js'].map((file) => import(new URL(file, location.href)))).then((all) => { window.parts = Object.assign({}, ...all); })")
        until(browser, "window.parts", 10, "the modules of the page")
        # The margin that limits, beside that of the solved field.
        margins = browser.run("return [[3.2, 2.5], [1.18, 0.909], [0.9, 0.95], [2, null], [null, null]].map(([oxide_margin, bridged_margin]) => parts.breakdownMargin([{oxide_margin, bridged_margin}]))")
        check(margins == ["2.5; by the solved field 3.2", "0.909: the film is at risk; by the solved field 1.18", "0.9: the film breaks down", "2", None], f"breakdown margins: {margins}")
        same = browser.run("return parts.breakdownMargin([{oxide_margin: 72.0001, bridged_margin: 72}])")
        check(same == "72", f"two margins that read the same: {same}")
        # Where a design has no answer, what stands there is of one before it, and says so.
        none = browser.run("parts.showUnanswered('7e5 droplets'); const a = document.getElementById('answer'), said = [a.classList.contains('stale'), document.getElementById('level').textContent, document.querySelector('#caveats .over').textContent]; a.classList.remove('stale'); return said")
        check(none == [True, "no answer", "warning: this design has no answer, what stands here is of one before it: 7e5 droplets"], f"no answer: {none}")
        # Of a title only what the program says of changed keys is written as people write it.
        title = browser.run("return parts.titled('Plate 3.14159265 of 2.50000 um; texture.depth 345.6789 nm; texture.period 6.5 um')")
        check(title == "Plate 3.14159265 of 2.50000 um; texture.depth 345.68 nm; texture.period 6.5 µm", f"a title: {title}")
        # What evaluate says of the numbers stands below them, and warnings are seen.
        said = browser.run("parts.showCaveats(['air beyond its breakdown field on up to 30 %; 270 V/um', 'warning: the smallest feature is 0.3 pixels wide']); return [...document.querySelectorAll('#caveats li')].map(li => [li.textContent, li.className]).concat([document.getElementById('caveats').hidden])")
        check(said == [["air beyond its breakdown field on up to 30 %; 270 V/µm", ""], ["warning: the smallest feature is 0.3 pixels wide", "over"], False], f"caveats: {said}")
        # A difference is told apart by both parts of its error; without the part of the model nothing is judged.
        words = browser.run("""
            const told = (difference, error, model, own) => { const s = parts.sentence({metric: 'mean(modulation)', difference, error, model}, {mean_modulation: {value: 0.5, model: own}}); return s && [s.textContent, s.className]; };
            return [told(0.03, 0.01, 0.004, 0.1), told(0.03, 0.01, 0.02, 0.1), told(0.03, 0.01, null, 0.1), told(-0.03, 0.01, null, null), told(1e-12, 1e-17, null, null)];""")
        check(words == [["modulation better by 0.0300 ± 0.0100 numerical ± 0.0040 model", "better"], None, ["modulation better by 0.030 ± 0.010 numerical, model part not known", ""], ["modulation worse by 0.030 ± 0.010 numerical", "worse"], None], f"differences: {words}")
        # A section goes through the middle of a hole, of a particle, and across what is flat elsewhere.
        rows = browser.run("""
            const map = (height) => ({nx: 16, ny: 16, lx: 1, ly: 1, low: -1, high: 1, values: Float64Array.from({length: 256}, (_, i) => height(i % 16, i >> 4))});
            const cap = (x, y) => Math.max(0, 1 - ((x - 5) ** 2 + (y - 9) ** 2) / 16);
            return [cap, (x, y) => -cap(x, y), (x, y) => y < 8 ? -1 : x < 8 ? 0 : 0.5].map((height) => parts.sectionRow(map(height)));""")
        check(rows == [9, 9, 8], f"rows of sections: {rows}")
        # One humidity has a bar, several have a band.
        bars = browser.run("""
            const point = (rh) => ({relative_humidity: rh, modulation: {value: 0.5, se: 0.1, parts: {}}});
            return [[point(0.5)], [point(0.2), point(0.5)]].map((points) => parts.curve('a', points, '#000')[0]).map((set) => [set.bars, set.data[0].ey]);""")
        check(bars == [[True, 0.2], [False, 0.2]], f"bars: {bars}")
        # All parts of a stack, as its form calls them; margins of each part.
        names = browser.run("""
            const keys = [0, 1, 2, 3].flatMap((part) => ['period', 'depth'].map((key) => ({path: `texture.parts.${part}.${key}`, type: 'number', value: '1 um'})));
            parts.showDimensions({...papilla.session(), keys: papilla.session().keys.filter((k) => !k.path.startsWith('texture.')).concat(keys)});
            return [...document.querySelectorAll('#dimensions li > span')].map((s) => s.textContent);""")
        check(names == [f"parts {part} {key}" for part in range(1, 5) for key in ("period", "depth")], f"parts of a stack: {names}")
        look = browser.run("""
            window.look = {haze: 0, transmittance: 0.9, total_transmittance: 0.9, gloss: 90, distinctness: 1, sparkle: 0, colour_shift: 6.2e-17, revision: papilla.session().revision};
            parts.showLook(look);
            parts.showMargins({min_hole: 1e-6, min_wall: 1.1e-6, aspect_ratio: 0, of_parts: true});
            return [...document.querySelectorAll('#look li, #making li')].map((li) => [...li.childNodes].filter((n) => !n.matches || !n.matches('.what')).map((n) => n.firstChild ? n.firstChild.textContent : n.textContent).join(': '));""")
        check({"colour shift: 0", "smallest hole of a part: 1 µm", "smallest wall of a part: 1.1 µm"} <= set(look), f"the look of a stack: {look}")
        # The look of a design before this one is faint until its own is there.
        faint = browser.run("""
            const now = () => document.getElementById('look').classList.contains('stale'), session = papilla.session(), own = now();
            parts.showDimensions({...session, revision: session.revision + 1});
            const moved = now();
            parts.showLook({...look, revision: session.revision + 1});
            return [own, moved, now()];""")
        check(faint == [False, True, False], f"the look of another design: {faint}")
        searched(browser)
        # The lab in the words of lab.md, and what came of a file that was told.
        browser.run("parts.showLab({folder: 'searches/001', doing: '', trouble: '', said: 'a.csv: 1 reading told\\n\\nBefore: no reading\\n\\nb.csv: 1 row not measured yet, left planned\\n\\n# Where the lab stands\\n\\nfront/01 is the best', lab: {summary: 'front/01 is the best with probability over 99 %', plans: [], told: [], decisions: [], standing: {designs: []}}})")
        said = browser.run("return ['labstanding', 'labtold'].map((id) => document.getElementById(id).textContent)")
        check(said == ["front/01 is the best with probability over 99 %", "a.csv: 1 reading told\n\nBefore: no reading\n\nb.csv: 1 row not measured yet, left planned"], f"the lab: {said}")
        # Of a lab that an earlier version wrote, and after a plan.
        browser.run("parts.showLab({folder: 'searches/001', doing: '', trouble: '', said: '# What to measure next', lab: {plans: [], told: [], decisions: [], standing: {designs: []}}})")
        said = browser.run("return ['labstanding', 'labtold'].map((id) => document.getElementById(id).textContent)")
        check("plan or tell once to see it" in said[0] and said[1] == "", f"an earlier lab: {said}")
        # The ground of the solid is of the light or the dark of now.
        ground = "!parts.solid.ready || parts.solid.renderer.getClearColor(new THREE.Color()).getHexString() === new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue('--tint').trim()).getHexString()"
        for scheme in ["dark", "light"]:
            browser.scheme(scheme)
            until(browser, ground, 10, f"the ground of the solid in {scheme}")
        # A decimal comma in the width of a map.
        browser.run("""
            const send = window.fetch;
            window.widths = [];
            window.fetch = async (url, what) => {
                if (String(url).startsWith('scan?')) return new Response('{"name": "scans/a.npy"}');
                if (url !== 'scan/view') return send(url, what);
                window.widths.push(JSON.parse(what.body).size);
                return new Response('{"error": "no map"}');
            };
            parts.takeScan(new File(['x'], 'a.npy'));""")
        until(browser, "window.widths.length === 1", 10, "the import view")
        browser.run("document.querySelector('#dialogbody input[type=text]').value = '12,5 µm'")
        click(browser, "Look again")
        until(browser, "window.widths.length === 2", 10, "a second look")
        check(browser.run("return window.widths[1]") == "12.5 um", "a decimal comma in the width of a map")
        quiet(browser)
    finally:
        studio.close()


def pages(browser, folder):
    studio = Studio(folder, two_humidities(folder))
    try:
        go(browser, studio)
        first = browser.call("GET", "/window")
        second = browser.call("POST", "/window/new", {"type": "tab"})["handle"]
        browser.call("POST", "/window", {"handle": second})
        go(browser, studio)
        slide(browser, "texture.depth", 0.2)
        until(browser, "papilla.session().keys.find(k => k.path === 'texture.depth').changed", 20, "the change here")
        here = browser.run("return papilla.session().keys.find(k => k.path === 'texture.depth').value")
        browser.call("POST", "/window", {"handle": first})
        until(browser, f"papilla.session().keys.find(k => k.path === 'texture.depth').value === '{here}'", 20, "the change on the other page")
        # A page of another site may neither read nor write.
        foreign = urllib.request.Request(studio.address + "set", b'{"path":"texture.depth","value":"1 nm"}', {"Origin": "http://evil.example", "Content-Type": "application/json"})
        try:
            urllib.request.build_opener(urllib.request.ProxyHandler({})).open(foreign, timeout=10)
            check(False, "a foreign origin was answered")
        except urllib.error.HTTPError as error:
            check(error.code == 403, f"a foreign origin got {error.code}")
        until(browser, f"papilla.session().keys.find(k => k.path === 'texture.depth').value === '{here}'", 5, "the state")
        # The studio goes and comes back: the state is found again.
        studio.process.kill()
        studio.process.wait()
        until(browser, "document.documentElement.dataset.connected === 'false'", 30, "the loss")
        studio = Studio(folder, two_humidities(folder))
        go(browser, studio)
        again = value(browser, "texture.depth")
        check(again.replace("µ", "u") == here, f"{here} is {again} after a kill")
    finally:
        studio.close()


def click(browser, text):
    browser.run(f"[...document.querySelectorAll('#dialogtools button')].find(b => b.textContent === '{text}').click()")


def unfinished(browser):
    """The report of a search that runs says that it does."""
    page = browser.call("GET", "/window")
    address = browser.run("return document.getElementById('report').href")
    browser.call("POST", "/window", {"handle": browser.call("POST", "/window/new", {"type": "tab"})["handle"]})
    browser.call("POST", "/url", {"url": address})
    until(browser, "document.documentElement.dataset.charts", 20, "the report so far")
    lead, rows = browser.run("return document.getElementById('lead').textContent"), browser.run("return document.querySelectorAll('#frontlist tbody tr').length")
    check(lead.startswith("Not finished") and "of 30 designs" in lead and rows > 0, f"the report so far: {rows} rows, {lead}")
    browser.picture(PICTURES, "unfinished.png")
    browser.call("DELETE", "/window")
    browser.call("POST", "/window", {"handle": page})


def through_history(browser):
    """To the first step and back to the last: the dialog has every step, and the design goes along."""
    done = browser.run("return papilla.session().done")
    for to, depth in ((0, False), (done, True)):
        browser.run("document.getElementById('history').click()")
        until(browser, "document.querySelector('#dialog').open && document.querySelector('#dialogbody select')", 10, "the history")
        check(browser.run("return document.querySelectorAll('#dialogbody option').length") == done + 1, "steps of the history")
        browser.run(f"document.querySelector('#dialogbody select').value = {to}")
        click(browser, "Go there")
        until(browser, f"papilla.session().done === {to} && !document.querySelector('#dialog').open", 20, f"step {to}")
        check(browser.run("return papilla.session().keys.find(k => k.path === 'texture.depth').changed") == depth, f"the depth at step {to}")
    until(browser, "document.documentElement.dataset.idle === 'yes'", 120, "the answer of the last step")


def by_numbers(browser):
    """All designs over their numbers: those of the upper half of an axis, by the server's own texts, pass; a line opens its design."""
    browser.run("document.getElementById('allbox').open = true")
    until(browser, "document.querySelectorAll('#all polyline').length > 5", 10, "lines of designs")
    counts = browser.run("""
        const axis = [...document.querySelectorAll('#all .axis')].find(a => a.getAttribute('aria-label').startsWith('depth'));
        for (let k = 0; k < 10; ++k) axis.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowUp', bubbles: true}));
        const titles = [...document.querySelectorAll('#all polyline')].map(l => l.querySelector('title').textContent), depths = titles.map(t => parseFloat(/depth ([\\d.]+)/.exec(t)[1]));
        const middle = (Math.min(...depths) + Math.max(...depths)) / 2;
        const out = [titles.length, +document.getElementById('all').dataset.passing, document.querySelectorAll('#all polyline:not(.out)').length, depths.filter(d => d >= middle).length, axis.getAttribute('aria-valuetext')];
        axis.dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape', bubbles: true}));
        return out.concat(+document.getElementById('all').dataset.passing);""")
    check(0 < counts[1] < counts[0] and counts[1] == counts[2] == counts[3], f"designs that pass the upper half of the depths: {counts}")
    check(counts[5] == counts[0], f"Escape leaves a range: {counts}")


def measured(browser, results):
    """Two touches are planned for the finalists, and told as the plan expects them."""
    browser.run("document.getElementById('labtouches').value = 2; document.getElementById('labplan').click()")
    until(browser, "(document.querySelectorAll('#labbatch tbody tr').length > 0 || !document.getElementById('labnotice').hidden) && !document.getElementById('labplan').disabled", 600, "a plan")
    trouble = "return document.getElementById('labnotice').textContent"
    check(not browser.run(trouble), browser.run(trouble))
    with open(os.path.join(results, "lab", "plan_01.csv"), newline="") as file:
        lines = file.read().split("\n")
    check(browser.run("return document.getElementById('labwhy').textContent").startswith("Why these: "), "why these measurements")
    check(any("F_off_N" in line for line in lines), f"the plan as a table: {lines[:4]}")
    rows = list(csv.reader(line for line in lines if line and not line.startswith("#")))
    planned = browser.run("return [...document.querySelectorAll('#labbatch tbody tr')].map(r => [...r.cells].map(c => c.textContent))")
    expects = {row[0].split(" ")[0]: [re.match(r"[\d.]+", cell)[0] for cell in row[8:10] if cell] for row in planned}
    head, told = rows[0], os.path.join(results, "filled.csv")
    for row in rows[1:]:
        for column, value in zip(("F_off_N", "F_on_N"), expects[row[0]]):
            row[head.index(column)] = str(float(value) / 1000)
    with open(told, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)
    element = browser.call("POST", "/element", {"using": "css selector", "value": "#labfiles"})
    browser.call("POST", f"/element/{list(element.values())[0]}/value", {"text": told})
    until(browser, "/ readings of 1 file told/.test(document.getElementById('labstanding').textContent) || !document.getElementById('labnotice').hidden", 300, "what was told")
    check(not browser.run(trouble), browser.run(trouble))
    check(browser.run("return [...document.querySelectorAll('#labbatch tbody tr')].every(r => r.cells[7].textContent === r.cells[6].textContent)"), "touches that were told")
    browser.run("document.getElementById('labhead').scrollIntoView()")
    browser.picture(PICTURES, "hour_4_lab.png")


def taken(browser):
    """What is on the page as files: each chart, map and the designs as SVG, some as CSV, the page itself."""
    browser.run("""window.given = {};
        const make = URL.createObjectURL, click = HTMLAnchorElement.prototype.click;
        let last;
        URL.createObjectURL = (blob) => { last = blob.text(); return make.call(URL, blob); };
        HTMLAnchorElement.prototype.click = function () {
          if (!this.download) return click.call(this);
          last.then((text) => { window.given[this.download] = text; });
        };
        document.querySelectorAll('.take button').forEach((b) => { if (/SVG|CSV/.test(b.textContent) && b.offsetParent) b.click(); });
        document.getElementById('keep').click();""")
    until(browser, "['modulation.svg', 'section.svg', 'designs.svg', 'heights.svg', 'heights.csv', 'all designs.svg', 'all designs.csv', 'papilla.html'].every(name => window.given[name])", 20, "files of the page")
    given = browser.run("return window.given")
    for name, words in [("modulation.svg", ["relative humidity [%]", "modulation ΔF/F_off", "this design"]), ("section.svg", ["height [nm]", "along the section [µm]"]), ("designs.svg", ["front, confirmed", "mean(modulation)"])]:
        root = xml.fromstring(given[name])
        texts = [t.text for t in root.iter("{http://www.w3.org/2000/svg}text")]
        check(all(w in texts for w in words), f"{name} says {texts}")
        lines = [p for p in root.iter("{http://www.w3.org/2000/svg}path") if p.get("stroke")]
        curves = [p.get("d").count("L") for p in lines if p.get("stroke-width") in ("1.5", "2", "2.5") and not p.get("d").endswith("Z")]
        check(name == "designs.svg" or (curves and max(curves) >= 1), f"{name} has no curve")  # designs are points
        check(len(lines) > 5 and all("NaN" not in p.get("d") for p in lines), f"{name} has {len(lines)} lines")
    root = xml.fromstring(given["heights.svg"])
    check(len(list(root.iter("{http://www.w3.org/2000/svg}image"))) == 1 and any((t.text or "").endswith(" nm") for t in root.iter("{http://www.w3.org/2000/svg}text")), "the map of heights as SVG")
    rows = [[float(cell) for cell in row] for row in list(csv.reader(given["heights.csv"].splitlines()))[1:]]
    depth = float(browser.run("return papilla.session().keys.find(k => k.path === 'texture.depth').shown"))
    check(abs(max(r[2] for r in rows) - min(r[2] for r in rows) - depth) < 0.01 * depth, f"heights over {len(rows)} pixels, holes of {depth} nm")
    root, rows = xml.fromstring(given["all designs.svg"]), list(csv.reader(given["all designs.csv"].splitlines()))
    lines = list(root.iter("{http://www.w3.org/2000/svg}polyline"))
    check(len(lines) == len(rows) - 1 > 5 and rows[0][-1] == "group" and "var(" not in given["all designs.svg"], f"{len(lines)} lines, {len(rows)} rows of designs")
    check(browser.run("return Object.values(papilla.charts).every(c => c.ctx instanceof CanvasRenderingContext2D)"), "a chart draws into its SVG")
    if PICTURES:
        for name, text in given.items():
            with open(os.path.join(PICTURES, name), "w") as file:
                file.write(text)
    page = given["papilla.html"]
    check("<script" not in page and "<button" not in page and page.count("data:image/png") >= 4 and "±" in page, "the page as a file is not what it shows")


def explained(browser):
    """A word and its meaning; what each number does."""
    browser.run("document.querySelector('#numbers .what').click()")
    check("F_off" in browser.run("const n = document.getElementById('meaning'); return n.hidden ? '' : n.textContent"), "modulation is not explained")
    press(browser, "\ue00c")
    check(browser.run("return document.getElementById('meaning').hidden"), "Escape leaves the meaning open")
    browser.run("document.querySelector('#limits .add').click(); document.querySelector('.limit .what').click()")
    check(len(browser.run("const n = document.getElementById('meaning'); return n.hidden ? '' : n.textContent")) > 20, "a limit is not explained")
    browser.run("document.querySelector('.limit button:last-child').click()")
    press(browser, "\ue00c")
    check(len(browser.run("return [...document.querySelectorAll('#look .what, #making .what')].map(b => b.getAttribute('aria-label'))")) >= 4, "looks are not explained")
    browser.run("document.getElementById('slopes').click()")
    until(browser, "[...document.querySelectorAll('.key .slope')].filter(p => !p.hidden && /modulation [+−].* ± /.test(p.textContent)).length >= 2", 120, "what numbers do")
    browser.run("document.getElementById('slopes').click()")
    check(browser.run("return ![...document.querySelectorAll('.key .slope')].some(p => !p.hidden)"), "slopes stay")


def hour(browser, folder):
    shutil.copy(os.path.join(TREE, "designs", "measured_surface", "scan.gsf"), folder)
    studio = Studio(folder, two_humidities(folder))
    try:
        browser.metrics(1440, 1000)
        go(browser, studio)
        browser.picture(PICTURES, "hour_1_opened.png")
        slide(browser, "texture.depth", 0.3)
        until(browser, "document.documentElement.dataset.idle === 'yes' && document.documentElement.dataset.step !== 'first'", 120, "a refined answer")
        browser.run("document.getElementById('pin').click()")
        until(browser, "document.querySelectorAll('.pinned').length === 1", 10, "a pin")
        slide(browser, "texture.diameter", 0.7)
        until(browser, "papilla.session().keys.find(k => k.path === 'texture.diameter').changed && +document.documentElement.dataset.shape === papilla.session().revision", 30, "the shape of the change")
        until(browser, "document.documentElement.dataset.idle === 'yes' && document.documentElement.dataset.step !== 'first'", 120, "the comparison")
        browser.picture(PICTURES, "hour_2_pinned.png")
        explained(browser)
        through_history(browser)
        # Search, steered once.
        browser.run("document.getElementById('evaluations').value = 30; document.getElementById('start').click()")
        until(browser, "papilla.charts.pareto && papilla.charts.pareto.data.datasets.some(s => s.data.length > 5)", 180, "designs of the search")
        by_numbers(browser)
        browser.picture(PICTURES, "hour_3_search.png")
        unfinished(browser)
        browser.run("document.querySelector('#frontlist button').click()")
        until(browser, "papilla.session().changes.length > 0", 20, "a picked design")
        browser.run("""document.getElementById('evaluations').value = 4000;
            [...document.querySelectorAll('#variables tbody tr')].find(r => r.dataset.path === 'texture.depth').querySelectorAll('[type=text]')[1].value = '500 nm';
            document.getElementById('steer').click()""")
        until(browser, "document.getElementById('stage').textContent.includes('searches/002')", 60, "the steered search")
        until(browser, "papilla.charts.pareto.data.datasets.some(s => s.data.length > 3)", 180, "designs of the steered search")
        browser.run("document.getElementById('stop').click()")
        until(browser, "document.getElementById('searchstate').textContent === 'finished'", 600, "the end of the search")
        until(browser, "papilla.charts.pareto.data.datasets[0].label === 'front, confirmed'", 10, "a confirmed front")
        check(browser.run("return document.getElementById('report').textContent") == "Report", "a finished search has no report")
        browser.picture(PICTURES, "hour_4_front.png")
        taken(browser)
        for number in ["1", "2"]:
            browser.run(f"const s = document.getElementById('searches'); s.value = '{number}'; s.dispatchEvent(new Event('change'))")
            until(browser, f"document.getElementById('stage').textContent.includes('searches/00{number}')", 20, "an earlier search")
        measured(browser, os.path.join(folder, "searches", "002"))
        browser.run("document.querySelector('#frontlist button').click()")
        until(browser, "document.documentElement.dataset.idle === 'yes'", 180, "the picked design")
        # A measured map.
        with open(os.path.join(folder, "scan.gsf"), "rb") as file:
            size = len(file.read())
        check(size > 100, "no scan")
        element = browser.call("POST", "/element", {"using": "css selector", "value": "#scanfile"})
        browser.call("POST", f"/element/{list(element.values())[0]}/value", {"text": os.path.join(folder, "scan.gsf")})
        until(browser, "document.querySelector('#dialog').open && papilla.charts.spectrum", 60, "the import view")
        browser.picture(PICTURES, "hour_5_scan.png")
        click(browser, "Use as the texture")
        until(browser, "papilla.session().kind === 'measured'", 30, "the scan as the texture")
        until(browser, "document.documentElement.dataset.idle === 'yes'", 240, "the scan's answer")
        browser.run("document.getElementById('undo').click()")
        until(browser, "papilla.session().kind === 'hole_array'", 20, "undo of the scan")
        # Out: the file, the masks, the verdict.
        browser.run("document.getElementById('save').click()")
        until(browser, "document.querySelector('#dialog').open", 10, "the dialog to save")
        browser.run("document.querySelector('#dialogbody input[type=text]').value = 'chosen.toml'")
        click(browser, "Save")
        until(browser, "document.documentElement.dataset.saved === 'chosen.toml'", 30, "the saved file")
        browser.run("document.getElementById('export').click()")
        until(browser, "document.querySelector('#dialog').open && document.querySelector('#dialogbody table')", 20, "the dialog to export")
        click(browser, "Export and verify")
        until(browser, "document.documentElement.dataset.exported", 180, "the verdict")
        check(browser.run("return document.documentElement.dataset.exported") == "true", "the export is not sound: " + browser.run("return document.querySelector('#dialogbody pre').textContent"))
        browser.picture(PICTURES, "hour_6_export.png")
        depth = browser.run("return papilla.session().keys.find(k => k.path === 'texture.depth').value")
        browser.call("POST", "/url", {"url": "about:blank"})
    finally:
        studio.close()
    verdict = subprocess.run([sys.argv[1], "verify", os.path.join(folder, "export", "chosen"), "--geometry"], capture_output=True, text=True)
    check(verdict.returncode == 0, "verify: " + verdict.stdout + verdict.stderr)
    # Later.
    studio = Studio(folder, os.path.join(folder, "chosen.toml"))
    try:
        go(browser, studio)
        again = browser.run("return papilla.session().keys.find(k => k.path === 'texture.depth').value")
        check(again == depth, f"{depth} was saved, {again} is read")
        until(browser, "document.getElementById('searchstate').textContent === 'finished'", 20, "the search of before")
        quiet(browser)
    finally:
        studio.close()


TAB, ENTER, SPACE, DOWN, RIGHT, SHIFT, CONTROL = "\ue004", "\ue007", " ", "\ue015", "\ue014", "\ue008", "\ue009"


def chord(browser, held, key):
    browser.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": [
        {"type": "keyDown", "value": held}, {"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}, {"type": "keyUp", "value": held}]}]})


def tab_to(browser, script, what, most=160):
    """Walks by Tab until the element that has the focus, e, is as the script says."""
    for _ in range(most):
        press(browser, TAB)
        if browser.run(f"const e = document.activeElement; return Boolean({script})"):
            return
    check(False, f"Tab does not reach {what}")


def type_over(browser, text):
    chord(browser, CONTROL, "a")
    press(browser, *text)


def keys(browser, folder):
    """The hour, without a mouse and without a script that touches the page: keys go in, the page is only read."""
    shutil.copy(os.path.join(TREE, "designs", "measured_surface", "scan.gsf"), folder)
    studio = Studio(folder, two_humidities(folder))
    try:
        browser.metrics(1440, 1000)
        go(browser, studio)
        tab_to(browser, "e.type === 'range' && e.closest('.key').querySelector('#k-texture-depth')", "the depth's slider")
        press(browser, *[RIGHT] * 8)
        until(browser, "papilla.session().keys.find(k => k.path === 'texture.depth').changed", 30, "the arrows' change")
        press(browser, "p")
        until(browser, "document.querySelectorAll('.pinned').length === 1", 10, "a pin")
        tab_to(browser, "e.id === 'k-surface-contact_angle'", "the contact angle")
        type_over(browser, "70 deg")
        press(browser, ENTER)
        until(browser, "papilla.session().keys.find(k => k.path === 'surface.contact_angle').value === '70 deg'", 20, "the typed angle")
        until(browser, "/modulation (better|worse)|not told/.test(document.querySelector('.pinned p').textContent)", 200, "a paired difference")
        # A search with a range left out, one that is steered, and a design of it.
        tab_to(browser, "e.getAttribute('aria-label') === 'depth excluding'", "what the search leaves out")
        type_over(browser, "500 to 600 nm")
        tab_to(browser, "e.id === 'evaluations'", "the number of evaluations")
        type_over(browser, "24")
        tab_to(browser, "e.id === 'start'", "Start")
        press(browser, ENTER)
        until(browser, "document.getElementById('searchstate').textContent === 'running'", 60, "a search")
        until(browser, "document.querySelector('#frontlist button')", 180, "a design of the search")
        tab_to(browser, "e.id === 'steer'", "Steer")
        press(browser, ENTER)
        until(browser, "document.getElementById('stage').textContent.includes('searches/002')", 60, "the steered search")
        until(browser, "document.querySelector('#frontlist button')", 180, "a design of the steered search")
        tab_to(browser, "e.closest('#frontlist') && e.tagName === 'BUTTON'", "a design of the front")
        press(browser, ENTER)
        until(browser, "papilla.session().changes.length > 0", 30, "the picked design")
        # Not what was still told of the first search.
        until(browser, "document.getElementById('stage').textContent.includes('searches/002') && papilla.charts.pareto.data.datasets.some(s => s.data.length)", 180, "designs of the steered search")
        tab_to(browser, "e.id === 'pause'", "Pause")
        press(browser, SPACE)
        until(browser, "document.getElementById('searchstate').textContent === 'paused'", 30, "the pause")
        depths = browser.run("return papilla.charts.pareto.data.datasets.flatMap(s => s.data).map(p => parseFloat(p.values[0]))")
        check(depths and not [d for d in depths if 500 < d < 600], f"depths that were left out: {depths}")
        # Out.
        chord(browser, CONTROL, "s")
        until(browser, "document.querySelector('#dialog').open", 10, "the dialog to save")
        tab_to(browser, "e.type === 'text' && e.closest('#dialogbody')", "the name", 12)
        type_over(browser, "typed.toml")
        press(browser, ENTER)
        until(browser, "document.documentElement.dataset.saved === 'typed.toml'", 30, "the saved file")
        check(browser.run("return document.querySelector('[data-path=\"texture.depth\"] td:last-child input').value") == "500 to 600 nm", "the wish is gone after a save")
        tab_to(browser, "e.id === 'export'", "Export")
        press(browser, ENTER)
        until(browser, "document.querySelector('#dialog').open && document.querySelector('#dialogbody table')", 20, "the dialog to export")
        tab_to(browser, "e.textContent === 'Export and verify'", "Export and verify", 20)
        press(browser, ENTER)
        until(browser, "document.documentElement.dataset.exported", 180, "the verdict")
        check(browser.run("return document.documentElement.dataset.exported") == "true", "the export is not sound")
        tab_to(browser, "e.textContent === 'Close'", "Close", 20)
        press(browser, ENTER)
        until(browser, "!document.querySelector('#dialog').open", 10, "the closed dialog")
        chord(browser, CONTROL, "z")
        browser.picture(PICTURES, "keys.png")
        quiet(browser)
    finally:
        studio.close()


def thousand(browser, folder):
    """A hand that does not rest: the page drops positions, never the last one."""
    studio = Studio(folder, two_humidities(folder))
    try:
        go(browser, studio)
        until(browser, "document.documentElement.dataset.step !== 'first'", 120, "a refined answer")
        browser.run("""
            const row = document.getElementById('k-drive-amplitude').closest('.key').querySelector('input[type=range]');
            let n = 0;
            window.moved = 0;
            const move = () => {
              row.value = Math.round((0.5 + 0.45 * Math.sin(n / 40)) * row.max);
              row.dispatchEvent(new Event('input', { bubbles: true }));
              window.moved = ++n;
              if (n < 1000) setTimeout(move, 16);
              else { row.value = Math.round(0.3 * row.max); row.dispatchEvent(new Event('input', { bubbles: true })); row.dispatchEvent(new Event('change', { bubbles: true })); }
            };
            move();""")
        until(browser, "window.moved === 1000", 120, "a thousand events")
        shown = value(browser, "drive.amplitude").replace("µ", "u")
        until(browser, f"papilla.session().keys.find(k => k.path === 'drive.amplitude').value === '{shown}'", 30, f"the last position, {shown}")
        until(browser, "+document.documentElement.dataset.revision === papilla.session().revision && document.documentElement.dataset.step === 'design'", 120, "its refined answer")
        done = browser.run("return papilla.latency.done.length")
        check(done == 1001, f"{done} of 1001 events were answered")
        check(len(browser.run("return papilla.session().changes")) == 1, "more than one key changed")
        quiet(browser)
    finally:
        studio.close()


def memory_of(studio):
    with open(f"/proc/{studio.process.pid}/status") as file:
        return sum(int(line.split()[1]) for line in file if line.startswith("RssAnon:")) / 1024


KEYS = ["drive.amplitude", "texture.depth", "surface.contact_angle", "finger.load", "texture.edge_radius"]
DESIGNS = ["m3_samples/flat.toml", "m3_samples/a3h600.toml", "grooves.toml", "m3_glass/directional.toml", "coatings/fine.toml"]
GROOVES = """schema_version = 1
base = "m3_samples/a3h600.toml"
[texture]
type = "grating"
period = "5.5 um"
width = "5.1 um"
depth = "390 nm"
wall_angle = "60 deg"
edge_radius = "100 nm"
"""


def latency(browser, folder):
    print("| design | key | events | median [ms] | p95 [ms] |\n|---|---|---|---|---|")
    with open(os.path.join(folder, "grooves.toml"), "w") as file:
        file.write(GROOVES)
    for design in DESIGNS:
        studio = Studio(tempfile.mkdtemp(dir=folder), os.path.join(folder if design == "grooves.toml" else os.path.join(TREE, "designs"), design))
        try:
            go(browser, studio)
            until(browser, "document.documentElement.dataset.step !== 'first'", 120, "a refined answer")
            for path in KEYS:
                name = f"k-{path.replace('.', '-')}"
                if not browser.run(f"const f = document.getElementById('{name}'); return Boolean(f && f.closest('.key').querySelector('input[type=range]'))"):
                    continue
                browser.run(f"""
                    const row = document.getElementById('{name}').closest('.key').querySelector('input[type=range]'), start = +row.value;
                    papilla.latency.done.length = 0;
                    let n = 0;
                    window.moved = 0;
                    const move = () => {{
                      row.value = Math.round(Math.min(1, Math.max(0, start / row.max + 0.08 * Math.sin(n / 15))) * row.max);
                      row.dispatchEvent(new Event('input', {{ bubbles: true }}));
                      window.moved = ++n;
                      if (n < 300) setTimeout(move, 50);
                      else row.dispatchEvent(new Event('change', {{ bubbles: true }}));
                    }};
                    move();""")
                time.sleep(15)  # asking takes a fifth of a core from what is measured
                until(browser, "window.moved === 300 && papilla.latency.done.length >= 300", 120, f"300 events of {path}")
                took = sorted(browser.run("return papilla.latency.done"))
                print(f"| {design} | {path} | {len(took)} | {took[len(took) // 2]:.0f} | {took[int(0.95 * len(took))]:.0f} |")
                sys.stdout.flush()
            print(f"memory of the studio after {design}: {memory_of(studio):.0f} MB")
        finally:
            studio.close()


def main():
    folder, profile = tempfile.mkdtemp(), tempfile.mkdtemp()
    browser = Browser(profile)
    try:
        {"smoke": smoke, "modules": modules, "pages": pages, "hour": hour, "keys": keys, "thousand": thousand, "latency": latency}[sys.argv[2]](browser, folder)
    finally:
        browser.close()
        shutil.rmtree(profile, ignore_errors=True)
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    try:
        main()
    except AssertionError as error:
        sys.exit(str(error))

// The page of `papilla optimize`.
// Mean over fingers and scenarios by their weights; they share their skins, so errors add linearly.
function meanPoints(tasks, key) {
  const counted = tasks.filter((t) => t.weight > 0 && t[key]);
  if (!counted.length) return null;
  const mean = (i, of) => counted.reduce((s, t) => s + t.weight * of(t[key][i].modulation), 0) / counted.reduce((s, t) => s + t.weight, 0);
  return counted[0][key].map((p, i) => ({
    relative_humidity: p.relative_humidity,
    modulation: counted.every((t) => t[key][i].modulation) ? { value: mean(i, (m) => m.value), se: mean(i, ownError), parts: {} } : null,
  }));
}
function showHumidity() {
  const tasks = data.designs[state.design].tasks, flats = data.designs.best.tasks;
  const pick = (list, key) => state.finger === 'mean' ? meanPoints(list, key) : (list[+state.finger] || {})[key];
  const sets = curve(label(state.design), pick(tasks, 'points') || [], colours[0]);
  const flat = pick(flats, 'flat');
  if (flat) sets.push(...curve('flat', flat, faint.flat, [6, 4]));
  draw('humidity', overHumidity(sets, 'modulation ΔF/F_off', { min: 0 }));
}

const finalists = csv(data.pareto), history = csv(data.history);
const heads = data.pareto.split('\n')[0].split(',');
const objectives = heads.filter((h) => heads.includes(h + ' se'));
const variables = heads.slice(1, heads.indexOf(objectives[0]));
// Of voltages that are found, and without a drive, the tables have none.
const hasWorst = finalists.concat(history).some((r) => r['worst modulation'] !== '');
// One objective without it has nothing to be traded for.
const second = objectives[1] || (hasWorst ? 'worst modulation' : objectives[0]);
const label = (name) => name === 'best' ? (data.picked ? 'picked' : 'best') : name.replace('front/', 'design ');
const describe = (row) => variables.map((v) => {
  const unit = / \[(.*)\]$/.exec(v);
  return row[v] === '' ? '' : `${v.replace(/ \[.*/, '').replace(/^[a-z]+\./, '')} ${entry(row[v])}${unit ? ' ' + unit[1] : ''}`;
}).filter(Boolean);
// Scenarios may have humidities of their own: a mean over all is of tasks that share theirs.
const air = (task) => JSON.stringify(task.points.map((p) => p.relative_humidity));
const sameAir = data.designs.best.tasks.every((t) => air(t) === air(data.designs.best.tasks[0]));
const state = { design: 'best', finger: sameAir ? 'mean' : '0' };
const run = data.run;
// Objectives in the units that people read: forces in mN. decimals: null of quantities, which have so many digits; by the
// unit where the run does not say them, as those of 0.2.1.
const shownAs = (name) => {
  const s = { scale: 1, unit: '', ...(run.shown || {})[name] };
  return { ...s, decimals: s.decimals !== undefined ? s.decimals : s.unit === '' ? 3 : s.unit === '%' ? 2 : null };
};
const called = (name) => name + (shownAs(name).unit ? ' [' + shownAs(name).unit + ']' : '');
// Of two values; se: of the second.
function change(v, name, se) {
  const { scale, decimals } = shownAs(name), text = decimals === null ? round(v * scale, 3) : fixed(v * scale, reaching(decimals, se * scale));
  return text.startsWith('-') ? '−' + text.slice(1) : '+' + text;
}
function quantity(q, name) {
  const s = shownAs(name);
  if (!q || q.value === null) return '–';
  if (s.decimals !== null) return withError(q, s);
  return round(q.value * s.scale, 4) + (q.se !== undefined && q.se !== null ? ' ± ' + round(q.se * s.scale, 2) : '') + (q.parameters ? ' (' + round(q.parameters * s.scale, 2) + ')' : '');
}

// What the page is about, 'best', is a copy of a design of the front: the one with the same variables.
const twin = Object.keys(data.designs).find((name) => name !== 'best' && JSON.stringify(data.designs[name].variables) === JSON.stringify(data.designs.best.variables)) || 'best';
const shown = () => state.design === 'best' ? twin : state.design;
// Of this one the run has the build sheet and the limits as built.
const recommended = () => data.picked ? state.design === run.design : state.design === 'best' || state.design === twin;

function showPareto() {
  const sx = shownAs(objectives[0]).scale, sy = shownAs(second).scale;
  const point = (row, se) => ({ x: sx * row[objectives[0]], y: sy * row[second], ex: se ? sx * row[objectives[0] + ' se'] || 0 : 0, ey: se ? sy * row[second + ' se'] || 0 : 0, row });
  const number = (row) => row[objectives[0]] !== '' && row[second] !== '';
  const front = finalists.filter((r) => r['on front'] === 'yes' && number(r)).sort((a, b) => a[objectives[0]] - b[objectives[0]]);
  const dominated = finalists.filter((r) => r['on front'] !== 'yes' && number(r));
  const chosen = front.filter((r) => r.design === shown());
  const sets = [
    { label: 'shown on this page', data: chosen.map((r) => point(r)), pointRadius: 12, pointHoverRadius: 12, borderWidth: 2.5, backgroundColor: 'transparent', borderColor: colours[1] },
    // No line: by belief a design stays on the front that another beats by the numbers alone.
    { label: 'front, confirmed', data: front.map((r) => point(r, true)), bars: true, borderWidth: 1.5, pointRadius: 6, pointHoverRadius: 8, borderColor: colours[0], backgroundColor: colours[0] },
    { label: 'confirmed, dominated', data: dominated.map((r) => point(r, true)), pointRadius: 3.5, pointStyle: 'rect', borderColor: faint.dominated, backgroundColor: faint.dominated },
    { label: 'searched (cheaper level, biased)', hidden: front.length + dominated.length > 0, data: history.filter((r) => r.status === 'ok' && number(r)).map((r) => point(r)), pointRadius: 3, borderColor: faint.searched, backgroundColor: faint.searched },
  ];
  const flat = data.designs.best.flat;
  if (flat) {
    const q = (name) => name === 'worst modulation' ? { value: flat.worst_modulation, se: 0 } : flat.objectives[name];
    sets.push({ label: 'flat', data: [{ x: sx * q(objectives[0]).value, y: sy * q(second).value, ex: sx * q(objectives[0]).se, ey: sy * q(second).se }], bars: true, pointRadius: 7, pointStyle: 'triangle', borderColor: faint.flat, backgroundColor: faint.flat });
  }
  const barred = sets.filter((s) => s.bars).flatMap((s) => s.data);
  draw('pareto', {
    type: 'scatter',
    data: { datasets: sets },
    plugins: [errorBars],
    options: {
      scales: { x: axis(called(objectives[0]), around(barred, 'x', 'ex')), y: axis(called(second), around(barred, 'y', 'ey')) },
      onClick: (event, items, chart) => {
        const hit = items.map((i) => chart.data.datasets[i.datasetIndex].data[i.index]).find((p) => p.row && data.designs[p.row.design]);
        // After this event: selecting draws this chart anew.
        if (hit) setTimeout(() => select(hit.row.design));
      },
      plugins: {
        legend: { labels: { usePointStyle: true, boxHeight: 7 } },
        tooltip: {
          filter: (item, i, items) => items.findIndex((o) => o.raw.row === item.raw.row && o.dataset.bars === item.dataset.bars) === i && (item.datasetIndex > 0),
          callbacks: {
            label: (item) => {
              const p = item.raw, name = p.row ? (p.row.design || 'evaluation ' + p.row.evaluation) : 'flat';
              return [`${name}: ${round(p.x)}${p.ex ? ' ± ' + round(p.ex, 2) : ''}, ${round(p.y)}${p.ey ? ' ± ' + round(p.ey, 2) : ''}`].concat(p.row ? describe(p.row) : []);
            },
          },
        },
      },
    },
  });
}
function showFinalists() {
  // Keys and kinds break where people read a break, not inside words.
  const breaking = (text) => String(text).replace(/([._(])(?=[a-z])/g, '$1\u200b');
  const columns = ['design'].concat(variables, objectives, hasWorst ? ['worst modulation'] : [], ['feasible']);
  const value = (r, c) => objectives.includes(c) ? (r[c] === '' ? 'failed' : quantity({ value: +r[c], se: +r[c + ' se'], parameters: +r[c + ' model'] }, c)) : c === 'design' || c === 'feasible' || r[c] === '' ? r[c] : breaking(entry(r[c]));
  const heading = (c) => breaking(called(c));
  const body = table($('finalists'), columns.map(heading), finalists.map((r) => columns.map((c) => value(r, c))), columns.map((c, i) => i).slice(1, -1));
  $('finalists').classList.toggle('many', columns.length > 10);
  finalists.forEach((r, i) => {
    const row = body.rows[i];
    if (!data.designs[r.design]) return;
    row.className = 'pick' + (r.design === shown() ? ' chosen' : '');
    row.onclick = () => select(r.design);
    row.tabIndex = 0;
    row.onkeydown = (e) => { if (e.key === 'Enter') select(r.design); };
  });
  // What each has of the limits that the study sets: a table of its own, as both together are wider than a page.
  const limits = heads.filter((h) => h.startsWith('limit '));
  $('kept').parentElement.hidden = !limits.length;
  table($('kept'), ['design'].concat(limits.map(heading)), finalists.map((r) => ['design'].concat(limits).map((c) => r[c])), limits.map((c, i) => i + 1));
}

// Every design of the search over its objectives and its numbers, at the level of the search.
function showAll() {
  const names = objectives.concat(variables), done = history.filter((r) => r.status === 'ok');
  $('allbox').hidden = done.length < 2;
  if ($('allbox').hidden) return;
  const number = (text) => text === '' || Number.isNaN(+text) ? text : +text, axes = names.map((name) => {
    const m = /^(.*?)(?: \[(.*)\])?$/.exec(name), s = shownAs(name);
    return { name: m[1].replace(/^[a-z]+\./, '').replace(/_/g, ' '), unit: m[2] || s.unit, scale: objectives.includes(name) ? s.scale : 1 };
  });
  parallel($('all'), axes, done.map((r) => ({
    values: names.map((name, i) => { const v = number(r[name]); return typeof v === 'number' ? v * axes[i].scale : v; }),
    group: r.feasible === 'no' ? 'broken' : 'searched',
    text: names.filter((name) => r[name] !== '').map((name) => objectives.includes(name) ? `${called(name)} ${round(r[name] * shownAs(name).scale)}` : `${name} ${entry(r[name])}`).join(', '),
  })), () => {});
}

// The range of each number over all good designs, within what it may be.
function showShared() {
  const shared = run.shared;
  $('shared').hidden = !shared;
  if (!shared) return;
  $('sharedsaid').textContent = shared.said;
  const bars = shared.ranges.filter((r) => r.to > r.from), part = (r, v) => (v - r.from) / (r.to - r.from);
  draw('ranges', {
    type: 'bar',
    data: { labels: bars.map((r) => r.name), datasets: [{ data: bars.map((r) => [part(r, r.low), part(r, r.high)]), minBarLength: 3, barPercentage: 0.5, backgroundColor: colours[0] }] },
    options: {
      indexAxis: 'y',
      scales: { x: axis('share of what it may be', { min: 0, max: 1 }), y: { ticks: { autoSkip: false } } },
      plugins: { legend: { display: false }, tooltip: { callbacks: { label: (item) => `${bars[item.dataIndex].text} of ${bars[item.dataIndex].possible}` } } },
    },
  });
  table($('sharedtable'), ['Number', 'Good designs', 'Possible', 'Designs'], shared.ranges.map((r) => [r.name, r.text, r.possible || '', r.designs]), [3]);
}

function showBudget() {
  const tasks = data.designs[state.design].tasks, task = tasks[state.finger === 'mean' ? 0 : +state.finger] || tasks[0];
  const points = task.points.filter((p) => p.modulation);
  const beside = ['model', 'water'];  // common to all designs, in no total
  const parts = points.length ? Object.keys(points[0].modulation.parts).filter((part) => !beside.includes(part)) : [];
  const sets = parts.map((part, i) => ({
    label: part, backgroundColor: colours[i % colours.length],
    data: points.map((p) => p.modulation.se > 0 ? Math.pow(p.modulation.parts[part], 2) / p.modulation.se : 0),
    part: points.map((p) => p.modulation.parts[part]),
  })).filter((set) => set.data.some((v) => v > 0));
  draw('budget', {
    type: 'bar',
    data: { labels: points.map((p) => round(100 * p.relative_humidity) + ' %'), datasets: sets },
    options: {
      scales: { x: axis('relative humidity, finger ' + task.name, { stacked: true }), y: axis('standard error of the modulation', { stacked: true }) },
      plugins: { tooltip: { callbacks: { label: (item) => `${item.dataset.label}: alone ± ${round(item.dataset.part[item.dataIndex], 2)}` } } },
    },
  });
}

// The explanation and the table of summary.md below a heading; `none`: what to say without them.
function showSection(box, heading, none) {
  const text = (data.summary.split('## ' + heading + '\n')[1] || '').split('\n## ')[0];
  if (!text) {
    box.textContent = none;
    return;
  }
  const lines = text.split('\n').map((l) => l.trim()).filter((l) => !l.startsWith('Files: '));
  const h = document.createElement('h2');
  h.textContent = heading;
  const p = document.createElement('p');
  p.className = 'note';
  p.textContent = lines.find((l) => l && !l.startsWith('|'));
  const scroll = document.createElement('div'), t = document.createElement('table');
  scroll.className = 'scroll';
  scroll.appendChild(t);
  box.append(h, p, scroll);
  // What follows the table: which designs it is about, and what would change it.
  lines.filter((l) => l && !l.startsWith('|')).slice(1).forEach((l) => {
    const note = document.createElement('p');
    note.className = 'note';
    note.textContent = l.replace(/^- /, '');
    box.append(note);
  });
  const rows = lines.filter((l) => l.startsWith('|') && !l.startsWith('|-')).map((l) => l.slice(1, -1).split('|').map((c) => c.trim().replace(/\*\*/g, '').replace(/ \*$/, '\u00a0*')));
  if (rows.length) table(t, rows[0], rows.slice(1));
}

function showProgress() {
  const better = history.map((r) => +r.hypervolume);
  const sets = [{ label: 'hypervolume of the front (share)', data: better.map((y, i) => ({ x: i + 1, y })), stepped: true, borderColor: colours[0], backgroundColor: colours[0], pointRadius: 0, borderWidth: 2.5, yAxisID: 'y' }];
  objectives.forEach((name, k) => sets.push({ label: called(name), data: history.filter((r) => r[name] !== '').map((r) => ({ x: +r.evaluation, y: +r[name] * shownAs(name).scale })), showLine: false, borderColor: colours[1 + k], backgroundColor: colours[1 + k], pointRadius: 3.5, yAxisID: 'v' }));
  draw('progress', {
    type: 'line',
    data: { datasets: objectives.length > 1 ? sets : sets.slice(1) },
    options: {
      parsing: false,
      scales: { x: axis('evaluation', { type: 'linear', ticks: { precision: 0 } }), y: axis('hypervolume', { min: 0, display: objectives.length > 1 }), v: axis('objectives at the search level', { position: 'right', grid: { drawOnChartArea: false } }) },
    },
  });
}

const showMaps = (index) => mapFigures($('maps'), data.fields[index].maps);

const people = (text) => text.replace(/(\d ?)um\b/g, '$1µm').replace(/ deg\b/g, '°');
// The build sheet of what is recommended; other designs, and a flat surface without numbers that were searched, have their
// dimensions alone.
function showDimensions(d) {
  const sheet = recommended() && run.sheet.length ? run.sheet : null;
  $('tolerance').hidden = !sheet;
  $('yield').hidden = !recommended();
  if (!sheet) {
    const rows = sectionOf(d.toml, 'texture'), angle = /contact_angle = "([\d.]+) deg"/.exec(d.toml);
    if (angle) rows.push(['contact angle of the surface', round(+angle[1], 3) + ' °']);
    table($('dimensions'), ['Dimension', 'As searched'], rows, [1]);
    return;
  }
  table($('dimensions'), ['Dimension', 'Build', 'Tolerance down', 'up', 'As searched'],
    sheet.map((r) => [r.words + (r.bound ? ` (on the ${r.bound} bound)` : ''), people(r.text.build), people(r.text.down), people(r.text.up), people(`${round(r.value, 6)} ${r.unit}`)]), [1, 2, 3, 4]);
}
const limitRows = (limits) => limits.map((l) => [l.name.replace(/_/g, ' '), l.asked, l.text + (l.kept ? '' : ': broken')]);
// Each limit of the study and what the design shown has of it.
function showLimits(d) {
  const built = recommended();
  const limits = (built ? run.limits : d.limits) || [];
  $('limits').parentElement.hidden = !limits.length;
  table($('limits'), ['Limit', 'Asked for', built ? 'As built' : 'This design'], limitRows(limits), [2]);
}
// From the study's flat surface to the best one, step by step.
function showSteps() {
  const steps = run.steps || [], names = steps.length ? Object.keys(steps[0].objectives) : [];
  const before = { 'flat, finish and drive of the study': 'finish', 'flat, finish and drive of the best': 'finish', 'best, with its texture': 'texture', 'best, on the grid of the fab': 'rounding', 'flat, on the grid of the fab': 'rounding' };
  $('change').hidden = steps.length + (run.best_flat ? 1 : 0) < 2;  // the study's own surface is the best
  table($('steps'), ['Surface'].concat(names.map(called), ['what changed']), steps.map((s, i) => [s.surface].concat(names.map((n) => quantity(s.objectives[n], n) + (i ? ` (${change(s.objectives[n].value - steps[i - 1].objectives[n].value, n, s.objectives[n].se)})` : '')), [i ? before[s.surface] || '' : '']))
    .concat(run.best_flat ? [[run.best_flat.surface].concat(names.map((n) => quantity(run.best_flat.objectives[n], n)), ['beside it'])] : []), names.map((n, i) => i + 1));
}

function showDesign() {
  const d = data.designs[state.design], map = d.heights, row = sectionRow(map, d.section);
  showSolid(map);
  drawMap($('top'), map, 'nm', 1e9, row);
  draw('section', alongLine(heightLine(map, d.section, row), map.lx * 1e6, d.measures));
  showDimensions(d);
  showLimits(d);
  const flat = data.designs.best.flat;
  // The difference has an error of its own: both met the same skins, droplets and grids.
  const lead = (d.flat || {}).difference || {};
  table($('numbers'), ['Result', label(state.design), 'flat', 'difference'],
    Object.keys(d.objectives).map((name) => [called(name), quantity(d.objectives[name], name), flat ? quantity(flat.objectives[name], name) : '–', quantity(lead[name], name)])
      .concat(hasWorst ? [['worst modulation', round(d.worst_modulation), flat ? round(flat.worst_modulation) : '–', '']] : [])
      .concat([['oxide breakdown margin', round(d.oxide_breakdown_margin), '', '']])
      .concat(d.stability && Object.values(data.designs).filter((o) => o.stability).length > 2 ? [['place on the front holds', `${d.stability.on_front} of ${d.stability.variants} variants` + (d.stability.why ? ': unstable.' + d.stability.why : ''), '', '']] : []), [1, 2, 3]);
  $('toml').textContent = d.toml;
}

function select(name) {
  state.design = name;
  $('design').value = name;
  document.documentElement.dataset.design = name;
  showDesign();
  showHumidity();
  showPareto();
  showFinalists();
  showBudget();
}

// ---- the page ----
const best = data.designs.best, flat = best.flat;
// Between backticks stand commands; the grounds of a decision begin with what they are about.
function words(place, text) {
  text.split('`').forEach((part, i) => {
    const piece = i % 2 ? document.createElement('code') : document.createTextNode('');
    piece.textContent = part;
    place.appendChild(piece);
  });
  return place;
}
words($('lead'), run.recommendation);
const said = (list, texts) => (texts || []).forEach((text) => {
  const item = document.createElement('li'), [all, about, rest] = /^(How sure|What would overturn it|To be surer)(:? ?.*)$/s.exec(text) || [];
  if (all) item.appendChild(document.createElement('strong')).textContent = about;
  list.appendChild(words(item, all ? rest : text));
});
said($('grounds'), run.grounds);
said($('remarks'), run.remarks);
$('grid').textContent = run.build ? run.build.said.replace(/`/g, '') : '';
$('yield').textContent = run.yield ? run.yield.said : '';
$('facts').textContent = run.facts || '';
$('first').hidden = !run.compared;
if (run.compared) {
  table($('tobuild'), ['To build', ''], run.sheet.map((r) => [r.words, people(r.text.build)]).concat(run.beside.map((r) => [r.words, people(r.text)])), [1]);
  table($('compared'), ['Surface'].concat(run.compared.names), run.compared.rows.map((r) => [r.surface].concat(r.values)), run.compared.names.map((n, i) => i + 1));
  if (run.limits.length) table($('kepthere'), ['Limit', 'Asked for', 'As built'], limitRows(run.limits), [2]);
}
$('receipts').hidden = !run.receipts;
options($('design'), Object.keys(data.designs).map((n) => [n, n !== 'best' ? label(n) : twin !== n ? `${label(n)} (${label(twin)})` : run.design === null ? 'flat, as recommended' : label(n)]), select);
options($('finger'), (sameAir ? [['mean', 'mean over fingers']] : []).concat(best.tasks.map((t, i) => [i, t.name])), (value) => { state.finger = value; showHumidity(); showBudget(); });
options($('rh'), data.fields.map((f, i) => [i, round(100 * f.relative_humidity) + ' %']), showMaps);
startSolid();
select('best');
showSteps();
showSection($('decision'), 'Which of them, by belief', '');
showAll();
showShared();
showSection($('stability'), 'Does the order hold?', Object.keys(data.designs).length > 2 ? 'Whether the order holds under other choices of the model was not checked.' : 'One design on the front: there is no order to check.');
showSection($('sensitivity'), 'What the best design is sensitive to', '');
const known = best.parameters;
$('parameters').textContent = !known ? '' : known.status !== 'ok' ? `What is not known of finger and model is in no error here: ${known.status}.`
  : `Numbers in brackets are the model part: what ${known.source} leaves open, one standard deviation. It moves all designs together`
  + Object.entries(known.of_the_difference_to_flat).filter(([n, v]) => v !== null).map(([n, v], i) => `${i ? ', ' : `: of the difference between ${label('best')} and flat it leaves `}${round(v, 2)} of ${n}`).join('') + '.';
showProgress();
if (data.fields.length) showMaps(0);
const plan = best.plan;
table($('modelled'), ['Modelled', 'How', 'Why', 'Error'], plan.steps.map((s) => [s.piece, s.method, s.reason, s.error ? round(100 * s.error, 2) + ' %' : '']), [3]);
table($('skipped'), ['Not modelled', 'Why', 'Of friction'], plan.skipped.map((s) => [s.piece, s.reason, s.bound ? (s.estimate ? 'about ' : 'at most ') + round(100 * s.bound, 2) + ' %' : '']), [2]);
$('plantext').textContent = data.plan;
$('polarity').textContent = 'Bright is high in the EXR and the preview; white is deep in mask.tif, which textures with an outline have.';
window.addEventListener('beforeprint', render);
finish({ select, solid });

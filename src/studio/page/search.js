// The search: what may change and what is wanted, the front as it grows, designs to open.
import { $ } from '../plots/look.js';
import { charts, draw, errorBars } from '../plots/charts.js';
import { calledDesign, found, foundChart, foundTable } from '../plots/found.js';
import { round, withBar } from '../plots/numbers.js';
import { parallel } from '../plots/parallel.js';
import { table } from '../plots/tables.js';
import { called, machine, people } from './form.js';
import { ask, post } from './server.js';
import { question } from './words.js';

const state = { wish: null, search: null, refused: '', bar: { folder: '', share: 0 } };
const make = (tag, more = {}) => Object.assign(document.createElement(tag), more);
const summaries = ['mean', 'worst', 'variation', 'range', 'std', 'best', 'first', 'last'];

// ---- the wish ----
export function showWish(wish) {
  state.wish = wish;
  const body = $('variables').tBodies[0];
  body.textContent = '';
  wish.variables.forEach((v) => {
    const row = body.insertRow(), name = called(v.path), box = make('input', { type: 'checkbox', checked: v.vary }), low = make('input', { type: 'text', value: people(v.low) }), high = make('input', { type: 'text', value: people(v.high) }), without = make('input', { type: 'text', value: people(v.excluding), placeholder: 'nothing', title: 'Values between these that the search leaves out: 300 to 400 nm, 600 to 650 nm' });
    box.setAttribute('aria-label', `vary ${name}`);
    low.setAttribute('aria-label', `${name} from`);
    high.setAttribute('aria-label', `${name} to`);
    without.setAttribute('aria-label', `${name} excluding`);
    row.dataset.path = v.path;
    row.classList.toggle('off', !v.vary);
    box.addEventListener('change', () => row.classList.toggle('off', !box.checked));
    [box, name, low, high, without].forEach((c) => row.insertCell().append(c));
  });
  const goals = $('goals');
  goals.querySelectorAll('.wishline, .add').forEach((e) => e.remove());
  wish.maximise.forEach((m) => goals.append(goal('maximise', m)));
  wish.minimise.forEach((m) => goals.append(goal('minimise', m)));
  goals.append(adder('Add a wish', () => goal('maximise', 'worst(modulation)')));
  const limits = $('limits');
  limits.querySelectorAll('.wishline, .add').forEach((e) => e.remove());
  wish.limits.forEach((l) => limits.append(limit(l)));
  limits.append(adder('Add a limit', () => limit({ name: wish.known_limits[0].name, limit: '' })));
  $('wishkept').textContent = `Stays as the file has it where nothing above is of it: ${people(wish.kept.join('; '))}`;
  $('wishkept').hidden = !wish.kept.length;
  $('evaluations').value = wish.evaluations || '';
  const own = document.querySelector('#kinds [aria-checked=true]');
  boxes('wishkinds', wish.known_kinds, wish.kinds.length ? wish.kinds : own ? [own.dataset.kind] : []);
  boxes('wishfingers', wish.known_fingers, wish.fingers);
  said('');
}
function boxes(id, names, chosen) {
  $(id).hidden = !names.length;
  $(id).querySelector('.boxes').replaceChildren(...names.map((name) => {
    const label = make('label'), box = make('input', { type: 'checkbox', value: name, checked: chosen.includes(name) });
    label.append(box, name.replace(/_/g, ' '));
    return label;
  }));
}
const checked = (id) => [...$(id).querySelectorAll('input:checked')].map((box) => box.value);
// The lines of the form that a key of the study is written in: "design_space.texture.depth.exclude", "constraints.min_wall".
function linesOf(key) {
  const names = (name) => name && `.${key}.`.includes(`.${name}.`);
  return [...$('variables').tBodies[0].rows].filter((r) => names(r.dataset.path)).concat([...document.querySelectorAll('.limit')].filter((l) => names(l.querySelector('select').value)));
}
// What the server says of the wish stands below it, where it is seen, until the wish is another; the lines that it is said of are marked. refused: where the search stood that it is said of; that is taken back once the search has moved on.
function said(text, { refused = '', keys = [] } = {}) {
  state.refused = refused;
  $('wishnotice').textContent = text;
  $('wishnotice').hidden = !text;
  $('wish').querySelectorAll('.wrong:not([role])').forEach((line) => line.classList.remove('wrong'));
  keys.flatMap(linesOf).forEach((line) => line.classList.add('wrong'));
  if (text) $('wishnotice').scrollIntoView({ block: 'nearest' });
}
function adder(text, line) {
  const button = make('button', { type: 'button', className: 'add', textContent: text });
  button.addEventListener('click', () => { const l = line(); button.before(l); l.querySelector('select').focus(); });
  return button;
}
function select(names, value, label) {
  const s = make('select');
  names.forEach((n) => s.add(new Option(n.replace(/_/g, ' '), n)));
  if (![...s.options].some((o) => o.value === value)) s.add(new Option(value, value));
  s.value = value;
  s.setAttribute('aria-label', label);
  return s;
}
// A choice among words, and what the chosen one means.
function explained(choice, words) {
  const of = () => ({ word: choice.value.replace(/_/g, ' '), text: people((words.find((w) => w.name === choice.value) || { doc: 'no word of this program' }).doc) });
  return [choice, question(of)];
}
function remover(line, what) {
  const b = make('button', { type: 'button', textContent: '×' });
  b.setAttribute('aria-label', `remove this ${what}`);
  b.addEventListener('click', () => line.remove());
  return b;
}
// Whether a metric is of a modulation that one names: voltage for, felt.
function atModulation(metric) {
  return Boolean((state.wish.metrics.find((x) => x.name === metric) || {}).at_modulation);
}
function goal(direction, expression) {
  const line = make('div', { className: 'wishline goal' }), m = /^(\w+)\((.*)\)$/.exec(expression) || [0, 'mean', expression];
  const inner = /^(\w+)\(\s*modulation\s*=\s*(.*)\)$/.exec(m[2]) || [0, m[2], '0.3'];
  const metric = select(state.wish.metrics.map((x) => x.name), inner[1], 'metric'), at = make('input', { type: 'text', value: inner[2], size: 4 }), word = make('label', { className: 'line', textContent: 'of modulation ' });
  word.append(at);
  const say = () => { word.hidden = !atModulation(metric.value); };
  metric.addEventListener('change', say);
  say();
  line.append(select(['maximise', 'minimise'], direction, 'direction'), select(summaries, m[1], 'over humidity'), ...explained(metric, state.wish.metrics), word, remover(line, 'wish'));
  return line;
}
function limit({ name, limit: value }) {
  const line = make('div', { className: 'wishline limit' }), known = state.wish.known_limits, word = make('span'), text = make('input', { type: 'text', value: people(value), size: 9 });
  const choice = select(known.map((k) => k.name), name, 'limit on');
  const say = () => { const k = known.find((x) => x.name === choice.value); word.textContent = !k ? '' : k.at_least ? 'at least' : 'at most'; text.placeholder = k ? people(k.unit) : ''; };
  choice.addEventListener('change', say);
  text.setAttribute('aria-label', 'limit');
  say();
  line.append(...explained(choice, known), word, text, remover(line, 'limit'));
  return line;
}
function wishNow() {
  const parts = (line) => {
    const [way, summary, metric] = [...line.querySelectorAll('select')].map((s) => s.value);
    return [way, summary, atModulation(metric) ? `${metric}(modulation = ${machine(line.querySelector('input').value)})` : metric];
  };
  const of = (direction) => [...document.querySelectorAll('.goal')].map(parts).filter((p) => p[0] === direction).map((p) => `${p[1]}(${p[2]})`);
  return {
    variables: [...$('variables').tBodies[0].rows].filter((r) => r.querySelector('[type=checkbox]').checked).map((r) => {
      const [low, high, excluding] = [...r.querySelectorAll('[type=text]')].map((t) => machine(t.value));
      return { path: r.dataset.path, low, high, excluding };
    }),
    kinds: checked('wishkinds'),
    fingers: checked('wishfingers'),
    maximise: of('maximise'),
    minimise: of('minimise'),
    limits: [...document.querySelectorAll('.limit')].map((l) => ({ name: l.querySelector('select').value, limit: machine(l.querySelector('input').value) })).filter((l) => l.limit),
    evaluations: +$('evaluations').value || 0,
  };
}
// The form as it stands, pinned variables too: kept by the server, so that a page that is loaded again has it.
function formNow() {
  const varied = wishNow();
  varied.variables = [...$('variables').tBodies[0].rows].map((r) => {
    const [low, high, excluding] = [...r.querySelectorAll('[type=text]')].map((t) => machine(t.value));
    return { path: r.dataset.path, low, high, excluding, vary: r.querySelector('[type=checkbox]').checked };
  });
  return varied;
}
let keeping = 0;
function keep() {
  clearTimeout(keeping);
  keeping = setTimeout(() => post('search/wish', formNow()).catch((error) => said(error.message)), 300);
}
export function startSearch() {
  ['input', 'change', 'click'].forEach((what) => $('wish').addEventListener(what, (e) => { if (what === 'click' && !e.target.matches('.add, .wishline button')) return; said(''); keep(); }));
  $('proposed').addEventListener('click', async () => { clearTimeout(keeping); const wish = await ask('search/forget'); if (wish) showWish(wish); });
  $('wish').addEventListener('submit', (e) => { e.preventDefault(); run('search/start', wishNow()); });
  $('steer').addEventListener('click', () => run('search/start', Object.assign(wishNow(), { steer: true })));
  $('pause').addEventListener('click', () => run('search/pause'));
  $('resume').addEventListener('click', () => run('search/resume'));
  $('stop').addEventListener('click', () => run('search/stop'));
  $('searches').addEventListener('change', () => run('search/show', { number: +$('searches').value }));
}
// Where a search stands: what is refused because of it, as a stop before a design was judged, is of this alone.
const standing = (search) => `${search.folder} ${search.state} ${search.done}`;
async function run(path, body) {
  try {
    showSearch(await post(path, body));
    said('');
  } catch (error) {
    const problems = error.problems || [];
    said(problems.map((p) => (p.key ? `${called(p.key) || p.key}: ` : '') + people(p.message)).join('; ') || error.message, { refused: body ? '' : standing(state.search), keys: problems.map((p) => p.key) });
  }
}
const open = (point) => ask('search/pick', point.front ? { front: point.front } : { evaluation: point.evaluation });

// ---- what it found ----
const words = { none: '', running: 'running', paused: 'paused', finished: 'finished', failed: 'failed' };
const stages = { search: 'looks for designs', narrow: 'judges the best again', confirm: 'confirms the finalists', belief: 'judges the finalists over belief', check: 'checks what is said of them' };
const time = (seconds) => seconds < 100 ? `${Math.ceil(seconds)} s` : `${Math.ceil(seconds / 60)} min`;
export function showSearch(search) {
  state.search = search;
  if (state.refused && state.refused !== standing(search)) said('');
  const running = search.state === 'running';
  $('searchstate').textContent = words[search.state];
  $('searchstate').classList.toggle('live', running);
  $('start').disabled = running;
  $('pause').disabled = !running;
  $('resume').disabled = search.state !== 'paused';
  $('steer').disabled = $('stop').disabled = !running && search.state !== 'paused';
  const numbers = search.numbers || [], list = numbers.join();
  $('searchesbox').hidden = numbers.length < 2;
  $('searches').disabled = running;
  if ($('searches').dataset.list !== list) {
    $('searches').dataset.list = list;
    $('searches').replaceChildren(...numbers.map((n) => new Option(String(n).padStart(3, '0'), n)));
  }
  $('searches').value = search.number;
  const finished = search.state === 'finished', reported = finished || search.done > 0;
  $('report').hidden = !reported;
  if (reported) { $('report').href = `report/${search.folder}`; $('report').textContent = finished ? 'Report' : 'Report so far'; }
  $('progress').hidden = $('frontbox').hidden = !search.folder;
  const fingers = search.fingers || [];
  $('felt').textContent = fingers.length > 1 ? `Of the finger at hand; the search below judges by ${fingers.join(', ')}.` : '';
  if (!search.folder) return;
  // A search that runs says how far the whole of it is, its confirmation and checks included.
  const told = search.progress, share = furthest(search.folder, told ? told.share : finished ? 1 : search.total ? Math.min(1, search.done / search.total) : 0);
  $('bar').style.setProperty('--share', `${100 * share}%`);
  $('bar').setAttribute('aria-valuenow', Math.round(100 * share));
  $('stage').textContent = search.state === 'failed' ? search.trouble : `${search.done} of ${search.total} designs` + (running ? `; ${stages[search.stage] || ''}` : '') + (told && told.seconds_left !== null ? `, about ${time(told.seconds_left)} left` : '') + `; ${search.folder}`;
  showFront(search);
}
// Of a search whose time was estimated too short the share that is done becomes less: its bar waits.
function furthest(folder, share) {
  state.bar = { folder, share: state.bar.folder === folder ? Math.max(state.bar.share, share) : share };
  return state.bar.share;
}
// Every design that the search looked at, over all its numbers.
function showAll(searched, front, search, wanted) {
  const on = new Set(front);
  const number = (text) => { const m = /^-?[\d.]+(e[-+]?\d+)?(?=\s|$)/i.exec(text); return m ? +m[0] : text; };
  const unit = (i) => { const text = searched.map((p) => p.values[i]).find((v) => v && typeof number(v) === 'number'); return text ? people(text).replace(/^\S+\s?/, '') : ''; };
  $('allbox').hidden = searched.length < 2;
  if ($('allbox').hidden) return;
  const axes = wanted.map((name) => ({ name, unit: '' })).concat(search.variables.map((v, i) => ({ name: called(v.path), unit: unit(i) })));
  parallel($('all'), axes, searched.map((p) => ({
    values: [p.x, p.y].slice(0, wanted.length).concat(p.values.map(number)),
    group: on.has(p) ? 'front' : p.ok ? 'searched' : 'broken',
    text: wanted.map((name, k) => `${name} ${round([p.x, p.y][k], 4)}`).concat(search.variables.map((v, i) => p.values[i] ? `${called(v.path)} ${people(p.values[i])}` : '').filter(Boolean)).join(', '),
    evaluation: p.evaluation,
  })), open);
}
// Where no design was judged yet; a search that failed says why beside its bar.
const waits = { running: 'The first designs are on their way.', paused: 'No design was judged yet.', finished: 'No design was judged.' };
function showFront(search) {
  const all = found(search), { searched, confirmed, front, names, objectives } = all, { sets, scales } = foundChart(all);
  if (charts.pareto && charts.pareto.$names === names.join()) {
    charts.pareto.data.datasets = sets;
    Object.assign(charts.pareto.options.scales.x, scales.x);
    Object.assign(charts.pareto.options.scales.y, scales.y);
    charts.pareto.update('none');
  } else {
    draw('pareto', {
      type: 'scatter',
      data: { datasets: sets },
      plugins: [errorBars],
      options: {
        scales,
        onClick: (event, items, chart) => { if (items.length) open(chart.data.datasets[items[0].datasetIndex].data[items[0].index]); },
        onHover: (event, items) => { event.native.target.style.cursor = items.length ? 'pointer' : ''; },
        plugins: {
          legend: { labels: { usePointStyle: true, boxHeight: 7 } },
          tooltip: { filter: (item, i, items) => items.findIndex((other) => other.raw === item.raw) === i, callbacks: { label: (item) => (item.raw.front ? [calledDesign(item.raw)] : []).concat(['x', 'y'].slice(0, objectives.length).map((at, k) => `${objectives[k]} ${item.raw['e' + at] ? withBar(item.raw[at], item.raw['e' + at]) : round(item.raw[at], 4)}`), state.search.variables.map((v, i) => `${called(v.path)} ${people(item.raw.values[i])}`)) } },
        },
      },
    });
    charts.pareto.$names = names.join();
  }
  $('fronthint').textContent = searched.length ? (confirmed.length ? 'Bars: ± one standard error. Points of the search are of a cheaper level: compare them with each other only. ' : 'Searched at a cheap level: the finalists are confirmed at the end. ') + 'Select a point, or Open, to make it the design at hand.' : waits[search.state] || '';
  $('recommendation').textContent = search.recommended ? people(search.recommended.words) : '';
  $('recommendation').hidden = !$('recommendation').textContent;
  showAll(searched, front, search, objectives);
  // The same by keys and for those who hear the page.
  const list = confirmed.length ? confirmed : front;
  const shown = foundTable(list, objectives, search.variables.map((v) => called(v.path)), people);
  const body = table($('frontlist'), [''].concat(shown.head), shown.rows.map((r) => [''].concat(r)));
  list.forEach((p, i) => {
    const button = make('button', { type: 'button', textContent: 'Open' });
    button.setAttribute('aria-label', p.front ? `open ${calledDesign(p)}` : `open the design with ${names[0]} ${round(p.x, 3)}`);
    body.rows[i].classList.toggle('recommended', Boolean(p.recommended));
    button.addEventListener('click', () => open(p));
    body.rows[i].cells[0].append(button);
  });
}

// The form: one row a key, sliders that answer under the hand, kinds of texture as pictures.
import { $ } from '../plots/look.js';
import { pixelsOf } from '../plots/maps.js';
import { round } from '../plots/numbers.js';
import { ask, notice, post } from './server.js';

// What people try first; everything else is one step away.
const first = (k) => k.path.startsWith('texture.') || ['surface.contact_angle', 'surface.dielectric.0.thickness', 'surface.process', 'drive.amplitude', 'drive.frequency', 'drive.waveform', 'finger.load', 'finger.state'].includes(k.path);
const sections = { texture: 'Texture', surface: 'Surface', drive: 'Drive', finger: 'Finger', counterface: 'Counterface', environment: 'Air', view: 'Look', model: 'Model', accuracy: 'Accuracy' };
export const called = (path) => path.split('.').slice(1).map((p) => /^\d+$/.test(p) ? String(+p + 1) : p.replace(/_/g, ' ')).join(' ');
// As people write it: their letters, and no more than five digits of what a search found.
export const people = (text) => text.replace(/\d+\.\d{3,}/g, (n) => round(+n, 5)).replace(/(-?\d[\d.e+-]*) rad\b/g, (all, n) => `${round(180 / Math.PI * n, 5)} deg`).replace(/\bum\b/g, 'µm').replace(/\bdeg\b/g, '°').replace(/um(\d)/g, 'µm$1');
// A title with what the program says in it of changed keys as people write it; what its author wrote stays.
export const titled = (title) => title.split('; ').map((part, i) => (i && /^[a-z]+(\.\w+)+ /.test(part) ? people(part) : part)).join('; ');
// Names and words are nobody's numbers.
const verbatim = (k) => ['choice', 'flag', 'text', 'path'].includes(k.type), valueOf = (k) => verbatim(k) ? k.value : people(k.value);
const plain = (text) => text.replace(/µm|μm/g, 'um').replace(/°/g, 'deg').trim();
// A comma between digits of a single number is a decimal one; in a list it parts two. "1,200" may be of thousands: the server asks.
export const machine = (text) => plain(text).replace(/^(?!-?[1-9]\d{0,2},\d{3}(?!\d))(-?\d+),(\d+)(?=\s*[a-zA-Z%]*$)/, '$1.$2');

const rows = {};
// Gestures are numbered on after a reload: one number is one step of undo. atHand: revision of the session that is shown.
let gesture = Date.now(), shape = '', atHand = 0;

// ---- sending: the newest position counts, the next goes out when the one before is answered ----
const wait = { busy: false, next: null, timer: 0, revision: Infinity };
export const latency = { events: [], done: [] };
let asked = [];  // { revision, times } that wait to be drawn
export const unanswered = () => wait.busy || asked.length > 0;

function send(path, value, time, slider = false) {
  if (wait.busy) {
    const times = wait.next && wait.next.path === path ? wait.next.times : [];
    if (wait.next && wait.next.path !== path) deliver(wait.next);
    wait.next = { path, value, slider, step: gesture, times: times.concat(time) };
    return;
  }
  deliver({ path, value, slider, step: gesture, times: [time] });
}
// What the server says of a value stands at its row.
function say(row, text, revision = atHand) {
  if (!row) return;
  row.saidAt = revision;
  row.said.textContent = text;
  row.said.hidden = !text;
  row.box.classList.toggle('wrong', Boolean(text));
}
async function deliver(change) {
  wait.busy = true;
  clearTimeout(wait.timer);
  wait.timer = setTimeout(release, 1500);
  const row = rows[change.path];
  try {
    const { revision, ends } = await post('set', { path: change.path, value: change.value, step: change.step, slider: change.slider });
    notice('');
    say(row, ends ? `ends here: ${people(ends)}` : '', revision);
    if (ends && row) {  // the slider goes back to where the design ends
      row.held = false;
      row.touched = 0;
      update(row.key);
    }
    asked.push({ revision, times: change.times });
    wait.revision = revision;
    answered(latest);
    drawn(shown);
  } catch (error) {
    if (row) say(row, people(error.message));
    else notice(`${called(change.path)}: ${error.message}`);
    release();
  }
}
function release() {
  clearTimeout(wait.timer);
  wait.busy = false;
  wait.revision = Infinity;
  const next = wait.next;
  wait.next = null;
  if (next) deliver(next);
}
let latest = 0, shown = 0;
// The answer to this revision is here: the next is worked out while it is drawn.
export function answered(revision) {
  latest = Math.max(latest, revision);
  if (latest >= wait.revision) release();
}
// The curve of this revision is on the screen.
export function drawn(revision) {
  shown = Math.max(shown, revision);
  const now = performance.now(), ready = asked.filter((a) => a.revision <= shown);
  asked = asked.filter((a) => a.revision > shown);
  ready.forEach((a) => a.times.forEach((t) => latency.done.push(now - t)));
}

// ---- one key ----
const position = (k, v) => k.slider.log ? Math.log(v / k.slider.low) / Math.log(k.slider.high / k.slider.low) : (v - k.slider.low) / (k.slider.high - k.slider.low || 1);
const valueAt = (k, share) => k.slider.log ? k.slider.low * Math.pow(k.slider.high / k.slider.low, share) : k.slider.low + share * (k.slider.high - k.slider.low);
const withUnit = (k, v) => k.type === 'integer' ? String(Math.round(v)) : `${round(v, 3)}${k.unit ? ' ' + k.unit : ''}`;

function element(tag, className, text) {
  const e = document.createElement(tag);
  if (className) e.className = className;
  if (text !== undefined) e.textContent = text;
  return e;
}
function input(k, row) {
  if (k.type === 'choice' || k.type === 'flag') {
    const select = element('select');
    (k.choices || ['true', 'false']).forEach((c) => select.add(new Option(c.replace(/_/g, ' '), c)));
    select.addEventListener('change', () => { ++gesture; send(k.path, select.value, performance.now()); });
    return select;
  }
  const text = element('input', k.type === 'numbers' ? 'list' : '');
  text.type = 'text';
  text.autocomplete = 'off';
  text.spellcheck = false;
  text.readOnly = k.type === 'path';
  text.addEventListener('change', () => { ++gesture; send(k.path, verbatim(k) ? text.value : (k.type === 'numbers' ? plain : machine)(text.value), performance.now()); });
  text.addEventListener('keydown', (e) => { if (e.key === 'Escape') { text.value = valueOf(row.key); text.blur(); } });
  return text;
}
function slider(k, row) {
  const range = element('input');
  range.type = 'range';
  range.min = 0;
  range.max = k.type === 'integer' ? Math.max(1, Math.round(k.slider.high - k.slider.low)) : 400;
  range.setAttribute('aria-label', `${called(k.path)}, slider`);
  range.addEventListener('pointerdown', () => { ++gesture; row.held = true; });
  range.addEventListener('pointerup', () => { row.held = false; });
  range.addEventListener('change', () => { row.held = false; ++gesture; });
  range.addEventListener('input', () => {
    const value = withUnit(row.key, valueAt(row.key, range.value / range.max));
    row.field.value = people(value);
    range.setAttribute('aria-valuetext', row.field.value);
    row.touched = performance.now();
    send(k.path, value, row.touched, true);
  });
  return range;
}
function build(k) {
  const row = { key: k, held: false, touched: 0 }, box = element('div', 'key'), top = element('div', 'top');
  const id = 'k-' + k.path.replace(/\W/g, '-'), label = element('label', '', called(k.path));
  label.htmlFor = id;
  row.box = box;
  row.field = input(k, row);
  row.field.id = id;
  row.about = element('p', 'about');
  row.about.id = id + '-about';
  row.slope = element('p', 'slope');
  row.slope.hidden = true;
  row.said = element('p', 'said');
  row.said.id = id + '-said';
  row.said.hidden = true;
  row.said.setAttribute('role', 'alert');
  row.field.setAttribute('aria-describedby', `${row.about.id} ${row.said.id}`);
  top.append(label);
  box.append(top);
  (k.type === 'numbers' || k.type === 'path' || k.type === 'text' ? box : top).append(row.field);
  if (k.slider) {
    row.range = slider(k, row);
    box.append(row.range);
  }
  box.append(row.slope, row.said, row.about);
  rows[k.path] = row;
  return box;
}
// Beside the value of a row: where it comes from.
function tell(row, k) {
  row.box.classList.toggle('changed', k.changed);
  row.about.textContent = `${people(k.doc)}. ${k.type === 'number' || k.type === 'integer' ? `${round(k.low, 4)} to ${round(k.high, 4)} ${people(k.unit)}. ` : ''}${k.place}`;
  if (k.changed) {
    const back = element('button', '', 'as the file has it');
    back.type = 'button';
    back.addEventListener('click', () => ask('reset', { path: k.path }));
    row.about.append(back);
  }
}
function update(k) {
  const row = rows[k.path], shown = valueOf(k);
  const told = row.drawn && row.key.form === k.form && row.key.place === k.place && row.key.changed === k.changed;
  const kept = told && row.key.value === k.value && row.key.shown === k.shown && !row.touched && row.field.value === shown;
  row.key = k;
  row.drawn = true;
  if (kept) return;
  if (!told) tell(row, k);
  // Not what the hand is at.
  if (row.held || performance.now() - row.touched < 600 || wait.busy && wait.next && wait.next.path === k.path) return;
  if (document.activeElement !== row.field || row.field.tagName === 'SELECT') row.field.value = shown;
  if (row.range) {
    row.range.value = Math.round(row.range.max * position(k, k.shown));
    row.range.setAttribute('aria-valuetext', people(k.value));
  }
}

// What a number does to the answer, below it; of another design the words are faint.
const effects = { 'mean(modulation)': 'modulation', 'variation(modulation)': 'variation', 'mean(friction)': 'friction', 'variation(friction)': 'variation' };
const signed = (v, scale) => `${v < 0 ? '−' : '+'}${round(Math.abs(scale * v), 2)}`;
export function showSlopes({ slopes }) {
  const of = new Map(slopes.map((s) => [s.path, s]));
  Object.values(rows).forEach((row) => {
    const s = $('slopes').checked && of.get(row.key.path);
    row.slope.hidden = !s || !s.changes.length;
    if (row.slope.hidden) return;
    const unit = people(s.unit), told = s.changes.map((c) => {
      const scale = c.metric === 'mean(friction)' ? 1e3 : 1, after = scale === 1e3 ? ' mN' : '';
      return c.value === null ? '' : `${effects[c.metric]} ${signed(c.value, scale)} ± ${round(scale * (c.error || 0), 2)}${after}`;
    }).filter(Boolean);
    row.slope.textContent = `${round(s.down, 3)} to ${round(s.up, 3)}${unit ? ' ' + unit : ''}: ${told.join(', ')}`;
  });
}
export function startSlopes() {
  $('slopes').addEventListener('change', () => {
    if (!$('slopes').checked) showSlopes({ slopes: [] });
    ask('slopes', { wanted: $('slopes').checked });
  });
}

// Rows whose key or meaning has the word that is typed.
function filterRows() {
  const box = $('keys'), word = $('filter').value.trim().toLowerCase();
  box.classList.toggle('filtered', Boolean(word));
  Object.values(rows).forEach((row) => row.box.classList.toggle('match', Boolean(word) && `${row.key.path.replace(/[._]/g, ' ')} ${row.key.doc}`.toLowerCase().includes(word)));
  const more = box.querySelector('details');
  if (more && word) more.open = Boolean(more.querySelector('.match'));
}

export function startFilter() {
  const filter = $('filter');
  filter.addEventListener('input', filterRows);
  filter.addEventListener('keydown', (e) => { if (e.key === 'Escape') { filter.value = ''; filterRows(); } });
}

// Other rows: another kind of texture, another file.
function rebuild(keys) {
  Object.keys(rows).forEach((path) => delete rows[path]);
  const box = $('keys');
  box.textContent = '';
  const group = (into, name, list) => {
    if (!list.length) return;
    const g = element('div', 'group');
    g.append(element('h3', '', name), ...list.map(build));
    into.append(g);
  };
  const editable = keys.filter((k) => k.path !== 'texture.type'), of = (k) => k.path.split('.')[0];
  const named = new Set([...Object.keys(sections), ...editable.map(of)]);
  const groups = (into, wanted) => named.forEach((section) => group(into, sections[section] || section, editable.filter((k) => of(k) === section && wanted(k))));
  groups(box, first);
  const more = element('details');
  more.append(element('summary', '', 'All keys'));
  groups(more, (k) => !first(k));
  box.append(more);
  filterRows();
}

export function showKinds(kinds) {
  const box = $('kinds');
  box.textContent = '';
  kinds.forEach(({ kind, heights }) => {
    const button = element('button'), canvas = element('canvas'), image = element('img');
    canvas.width = heights.nx;
    canvas.height = heights.ny;
    const span = heights.high - heights.low;
    canvas.getContext('2d').putImageData(pixelsOf(heights, (v) => (span > 0 ? (v - heights.low) / span : 0.6)), 0, 0);
    image.src = canvas.toDataURL();  // a canvas would be a layer of its own, drawn again with each frame of the page
    image.alt = '';
    button.type = 'button';
    button.setAttribute('role', 'radio');
    button.dataset.kind = kind;
    button.append(image, kind.replace(/_/g, ' '));
    button.addEventListener('click', () => ask('kind', { kind }));
    box.append(button);
  });
  box.addEventListener('keydown', (e) => {
    const all = [...box.children], at = all.indexOf(document.activeElement), move = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[e.key];
    if (!move || at < 0) return;
    e.preventDefault();
    all[(at + move + all.length) % all.length].focus();
  });
}

export function showForm(session) {
  // A form of the same rows stays: the hand and the focus are in it.
  const now = session.keys.map((k) => k.path + (k.slider ? ' slider' : '')).join();
  if (shape !== now) rebuild(session.keys);
  shape = now;
  atHand = session.revision;
  // What was said was of the design before.
  Object.values(rows).forEach((row) => { if (!row.said.hidden && atHand > row.saidAt) say(row, ''); });
  session.keys.forEach((k) => { if (rows[k.path]) update(k); });
  [...$('kinds').children].forEach((b) => {
    const chosen = b.dataset.kind === session.kind;
    b.setAttribute('aria-checked', chosen);
    b.tabIndex = chosen ? 0 : -1;
  });
  if (![...$('kinds').children].some((b) => b.tabIndex === 0) && $('kinds').firstChild) $('kinds').firstChild.tabIndex = 0;
}

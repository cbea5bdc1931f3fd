// The answer: curves over humidity with their bands, numbers with ±, pinned designs beside each other.
import { $, colours } from '../plots/look.js';
import { charts, draw } from '../plots/charts.js';
import { curve, overHumidity } from '../plots/curves.js';
import { fixed, level, round } from '../plots/numbers.js';
import { refreshTable, table } from '../plots/tables.js';
import { people } from './form.js';
import { ask } from './server.js';

const state = { session: null, answer: null, unanswered: '' };
// Eight pins, eight lines: four colours, each once dashed and once dotted.
const tint = (i) => colours[2 + i % 4];
const dash = (i) => i < 4 ? [6, 4] : [2, 3];

function show(id, config) {
  const chart = charts[id];
  if (!chart) return draw(id, config);
  chart.data = config.data;
  chart.options.scales.y.title.text = config.options.scales.y.title.text;
  chart.update('none');
}

export function showAnswer(answer) {
  state.answer = answer;
  state.unanswered = '';
  const r = answer.response, sets = r.points.some((p) => p.modulation) ? curve('this design', r.points, colours[0]) : [];
  pins().forEach((pin, i) => {
    const pinned = answer.pinned[pin.number];
    if (pinned) sets.push(...curve(pin.name, pinned.points, tint(i), dash(i)));
  });
  $('modulationbox').hidden = !sets.length;
  if (sets.length) show('modulation', overHumidity(sets, 'modulation ΔF/F_off', { min: 0 }));
  const mn = (key, name, colour, dash) => curve(name, r.points, colour, dash, key, 1e3);
  show('friction', overHumidity([...mn('F_off', 'drive off', colours[5]), ...mn('F_on', 'drive on', colours[1])], 'friction [mN]', { min: 0 }));
  $('level').textContent = `${levelOf(answer)} · ${answer.seconds < 10 ? Math.round(1000 * answer.seconds) + ' ms' : round(answer.seconds) + ' s'}`;
  $('level').title = { first: 'Refined while nothing moves; the band says what that may change.', design: 'At the accuracy that the design states (Accuracy, below All keys): the numbers of papilla evaluate.' }[answer.step] || '';
  $('answer').classList.remove('stale');
  showNumbers(r);
  showCaveats(answer.caveats);
  showValues(r.points);
  showPins();
  showModel(r.plan);
  document.documentElement.dataset.step = answer.step;
  document.documentElement.dataset.revision = answer.revision;
}

// No answer to the design at hand: what stands here is of one before it, if there was one.
export function showUnanswered(why) {
  state.unanswered = why;
  $('answer').classList.add('stale');
  $('level').textContent = 'no answer';
  $('level').title = '';
  showCaveats([`warning: this design has no answer${state.answer ? ', what stands here is of one before it' : ''}: ${why}`]);
}

// In other colours.
export function showAnswerAgain() {
  const why = state.unanswered;
  if (state.answer) showAnswer(state.answer);
  if (why) showUnanswered(why);
}

function levelOf({ step, response }) {
  const f = response.fidelity;
  return { first: 'first answer', draft: 'draft' }[step] || `as the design asks: ${f.level} level, ${f.grid} pixels, ${f.skins} skins`;
}
// Two parts with their names where belief has been run, else the numerical one alone. named: without, where a table's head names them.
const of = (q, scale = 1, unit = '', named = true) => {
  if (!q) return '–';
  // What is rounding beside the value is no error: a film scatters nothing.
  const error = (v) => unit ? round(scale * level(v, Math.abs(q.value)), 2) : v.toFixed(3);
  const parts = q.model === null || q.model === undefined ? error(q.se) : named ? `${error(q.numerical)} numerical ± ${error(q.model)} model` : `${error(q.numerical)} ± ${error(q.model)}`;
  return `${unit ? round(scale * q.value, 4) : fixed(q.value)} ± ${parts}${unit}`;
};
// Of one humidity there is no variation.
const varies = (r) => r.points.length > 1;
// The one that limits a study, oxide_breakdown_margin (Eq. electrostatics.9): the field that was solved and a bridge or a
// contact that puts the whole voltage on the thinnest place of the film, whichever leaves less. Null: no film, or no number.
export function breakdownMargin(points) {
  const least = (key) => Math.min(...points.map((p) => p[key]).filter((v) => v !== null && v !== undefined));
  const solved = least('oxide_margin'), bridged = least('bridged_margin'), margin = Math.min(solved, bridged);
  if (!isFinite(margin)) return null;
  const risk = solved < 1 ? ': the film breaks down' : margin < 1 ? ': the film is at risk' : '';
  return round(margin, 3) + risk + (isFinite(solved) && round(solved, 3) !== round(margin, 3) ? `; by the solved field ${round(solved, 3)}` : '');
}
function showNumbers(r) {
  const s = r.summary, rows = [];
  if (s.mean_modulation) rows.push(['modulation, mean', of(s.mean_modulation)], ['worst', of(s.worst)]);
  if (s.mean_modulation && varies(r)) rows.push(['variation over humidity', of(s.variation)]);
  rows.push(['friction, drive off, mean', of(s.mean_friction, 1e3, ' mN')]);
  if (r.belief) rows.push(['model part of ±', r.belief.members.length ? `${r.belief.members.length} members of belief, as good as ${round(r.belief.effective_members, 3)} equal ones` : `not stated: ${r.belief.status}`]);
  const margin = breakdownMargin(r.points);
  if (margin) rows.push(['breakdown margin', margin]);
  r.points.filter((p) => p.status !== 'ok').forEach((p) => rows.push([`at ${round(100 * p.relative_humidity, 3)} %`, p.status]));
  refreshTable($('numbers'), null, rows, [1]);
}

// What limits trust in these numbers, in the lines of papilla evaluate.
export function showCaveats(lines) {
  const list = $('caveats'), now = lines.join('\n');
  if (list.dataset.lines === now) return;
  list.dataset.lines = now;
  list.hidden = !lines.length;
  list.replaceChildren(...lines.map((line) => Object.assign(document.createElement('li'), { textContent: people(line), className: line.startsWith('warning:') ? 'over' : '' })));
}

// The curves for those who hear the page, or copy numbers.
function showValues(points) {
  const driven = points.some((p) => p.modulation);
  refreshTable($('values'), ['humidity', ...(driven ? ['modulation'] : []), 'drive off', ...(driven ? ['drive on'] : [])], points.map((p) => [`${round(100 * p.relative_humidity)} %`, ...(driven ? [of(p.modulation)] : []), of(p.F_off, 1e3, ' mN'), ...(driven ? [of(p.F_on, 1e3, ' mN')] : [])]), [1, 2, 3]);
}

const pins = () => state.session ? state.session.pins : [];
const words = { 'mean(modulation)': ['modulation', 1, '', 'mean_modulation'], 'worst(modulation)': ['worst', 1, '', 'worst'], 'variation(modulation)': ['variation', -1, '', 'variation'], 'mean(friction)': ['friction', 0, ' mN', 'mean_friction'] };
// "better by .030 ± .010 numerical ± .004 model": both parts are of the difference, as both designs met the same skins and members; null:
// not told apart. summary: of the design at hand; where its numbers have a model part and the difference has none yet, nothing is judged by its colour.
export function sentence(c, summary) {
  const [name, better, unit, key] = words[c.metric], scale = unit ? 1e3 : 1, own = summary[key] || {}, size = scale * Math.abs(own.value || 0);
  const [d, e, m] = [c.difference, c.error, c.model].map((v) => v === null || v === undefined ? null : level(scale * v, size));
  const total = Math.hypot(e, m);
  if (e === null || Math.abs(d) <= 2 * total) return null;
  const least = Math.min(...[e, m].filter((v) => v > 0)), places = isFinite(least) ? Math.min(6, Math.max(3, 1 - Math.floor(Math.log10(least)))) : 3;  // two digits of the least part
  const text = (v, digits) => unit ? round(Math.abs(v), digits) : Math.abs(v).toFixed(places);
  const word = better === 0 ? (d > 0 ? 'higher by' : 'lower by') : d * better > 0 ? 'better by' : 'worse by';
  const open = m === null && own.model !== null && own.model !== undefined;
  const span = document.createElement('span');
  span.textContent = `${name} ${word} ${text(d, 3)} ± ${text(e, 2)}${unit} numerical${m === null ? '' : ` ± ${text(m, 2)}${unit} model`}${open ? ', model part not known' : ''}`;
  if (better && !open) span.className = d * better > 0 ? 'better' : 'worse';
  return span;
}
// This design and the pinned ones side by side.
const compared = [['modulation, mean', 'mean_modulation', 1, ''], ['worst', 'worst', 1, ''], ['variation over humidity', 'variation', 1, ''], ['friction, drive off', 'mean_friction', 1e3, ' mN']];
function pinTable() {
  const known = state.answer ? pins().filter((pin) => state.answer.pinned[pin.number]) : [];
  if (!known.length) return [];
  const all = [state.answer.response, ...known.map((pin) => state.answer.pinned[pin.number])], frame = document.createElement('div'), body = document.createElement('table');
  frame.className = 'scroll';
  frame.tabIndex = 0;
  frame.setAttribute('role', 'region');
  frame.setAttribute('aria-label', 'Pinned designs side by side');
  frame.append(body);
  const rows = compared.filter(([, key]) => all.some((r) => r.summary[key] && (key !== 'variation' || varies(r)))).map(([name, key, scale, unit]) => [name, ...all.map((r) => of(r.summary[key], scale, unit, false))]);
  const both = all.some((r) => compared.some(([, key]) => r.summary[key] && r.summary[key].model !== null && r.summary[key].model !== undefined));
  table(body, [both ? '± numerical ± model' : '', 'this design', ...known.map((pin) => pin.name)], rows, all.map((_, i) => i + 1));
  return [frame];
}
function showPins() {
  const box = $('pins');
  const focused = document.activeElement && document.activeElement.dataset && document.activeElement.dataset.pin;
  box.textContent = '';
  pins().forEach((pin, i) => {
    const row = document.createElement('div'), top = document.createElement('div'), name = document.createElement('strong'), swatch = document.createElement('span'), tools = document.createElement('div'), line = document.createElement('p');
    row.className = 'pinned';
    top.className = 'top';
    tools.className = 'tools';
    swatch.className = 'swatch';
    swatch.style.borderColor = tint(i);
    swatch.style.borderTopStyle = i < 4 ? 'dashed' : 'dotted';
    name.textContent = pin.name;
    [['Open', 'take'], ['Unpin', 'unpin']].forEach(([text, what]) => {
      const b = document.createElement('button');
      b.textContent = text;
      b.setAttribute('aria-label', `${text} ${pin.name}`);
      b.dataset.pin = what + pin.number;
      b.addEventListener('click', () => ask(what, { pin: pin.number }));
      tools.append(b);
    });
    top.append(swatch, name, tools);
    const found = state.answer ? state.answer.comparisons.filter((c) => c.pin === pin.number && words[c.metric]) : [];
    const said = found.map((c) => sentence(c, state.answer.response.summary)), told = said.filter(Boolean), open = found.filter((c, k) => !said[k]).map((c) => words[c.metric][0]);
    if (!pin.readable) line.textContent = 'its file cannot be read any more';
    else if (!found.length) line.textContent = 'compared as soon as both are known at one level';
    else line.append('this design: ');
    told.forEach((span, k) => line.append(...(k ? [' · '] : []), span));
    if (open.length) line.append(`${told.length ? ' · ' : ''}${open.join(', ')} not told apart`);
    row.append(top, line);
    box.append(row);
  });
  box.append(...pinTable());
  if (focused) {
    const again = box.querySelector(`[data-pin="${focused}"]`);
    if (again) again.focus();
  }
}
export function showSessionPins(session) {
  state.session = session;
  showPins();
}

let model = '';
function showModel(plan) {
  const now = JSON.stringify(plan);
  if (now === model) return;
  model = now;
  const error = (v) => v ? round(100 * v, 2) + ' %' : '';
  table($('skipped'), ['Not modelled', 'Why', 'Of friction'], plan.skipped.map((s) => [s.piece, s.reason, s.bound ? (s.estimate ? 'about ' : 'at most ') + error(s.bound) : '']), [2]);
  table($('modelled'), ['Modelled', 'How', 'Error'], plan.steps.map((s) => [s.piece, s.method, error(s.error)]), [2]);
}

// What a search found so far: its designs, its front, what of it is confirmed. search: as the studio tells it.
import { colours, faint } from './look.js';
import { around, axis } from './charts.js';
import { entry, round } from './numbers.js';
const leading = (text) => { const m = /^-?[\d.]+(e[-+]?\d+)?(?=\s|$)/i.exec(text || ''); return m ? +m[0] : null; };
// { searched, confirmed, front, names, objectives }: points with x, y in the units that people read, the texts of their
// variables; names of the two axes, and those that are wanted, with their units. A single objective is shown over the first number that the search varies.
export function found(search) {
  const [first, other] = search.objectives, x = first.name, y = other && other.name, on = new Set(search.front);
  const called = (o) => o.name + (o.unit ? ` [${o.unit}]` : '');
  const place = search.variables.findIndex((v, i) => search.points.some((p) => leading(p.values[i]) !== null)), over = search.variables[place];
  const shown = over && over.path.replace(/^[a-z]+\./, '').replace(/[._]/g, ' ') + (over.unit ? ` [${over.unit.replace(/^um$/, 'µm').replace(/^deg$/, '°')}]` : '');
  const scaled = (value, o) => (value === null || value === undefined ? value : value * o.scale);
  const second = (p, i) => other ? scaled(p.objectives[1], other) : over ? leading(p.values[place]) : i + 1;
  const known = (p) => p.x !== null && p.x !== undefined && p.y !== null && p.y !== undefined;
  // In the unit of the worth.
  const regret = (si) => `${round(search.worth.scale * si, 2)}${search.worth.unit ? ' ' + search.worth.unit : ''}`;
  const searched = search.points.map((p, i) => ({ x: scaled(p.objectives[0], first), y: second(p, i), evaluation: i, ok: p.ok && p.feasible, values: p.values })).filter(known);
  const confirmed = search.confirmed.filter((r) => r['on front'] === 'yes' && r[x] !== '').map((r) => ({ x: r[x] * first.scale, y: other ? r[y] * other.scale : over ? leading(r[over.path + (over.unit ? ` [${over.unit}]` : '')]) : 0, ex: r[x + ' se'] * first.scale || 0, ey: other ? r[y + ' se'] * other.scale || 0 : 0, front: r.design, recommended: r.design === (search.recommended || {}).design, doubts: r['p(best)'] ? [round(100 * r['p(best)'], 3) + ' %', regret(r['expected regret']), round(100 * r['p(every limit)'], 3) + ' %'] : [], values: search.variables.map((v) => `${entry(r[v.path + (v.unit ? ` [${v.unit}]` : '')])} ${v.unit}`) }));
  // Best first, as a run numbers its front.
  const front = searched.filter((p) => on.has(p.evaluation)).sort((a, b) => (first.maximise ? b.x - a.x : a.x - b.x));
  return { searched, confirmed, front, names: [called(first), other ? called(other) : shown || 'evaluation'], objectives: search.objectives.slice(0, 2).map(called) };
}
// The chart of that: its datasets and its axes.
export function foundChart({ searched, confirmed, front, names, objectives }) {
  const line = { borderWidth: 1.5, pointHoverRadius: 8 }, on = new Set(front);
  // No line through what is confirmed: by belief a design stays that another beats by the numbers alone.
  const best = confirmed.length
    ? Object.assign({ label: 'front, confirmed', data: confirmed, bars: true, pointRadius: 6, borderColor: colours[1], backgroundColor: colours[1] }, line)
    : Object.assign({ label: 'front so far', data: front, showLine: objectives.length > 1, pointRadius: 5.5, borderColor: colours[0], backgroundColor: colours[0] }, line);
  const chosen = confirmed.filter((p) => p.recommended);
  const sets = [
    best,
    ...(chosen.length ? [Object.assign({ label: 'recommended', data: chosen, pointRadius: 10, borderColor: colours[0], backgroundColor: 'transparent' }, line, { borderWidth: 2.5 })] : []),
    { label: 'searched', data: searched.filter((p) => p.ok && (confirmed.length || !on.has(p))), pointRadius: 3, borderColor: faint.searched, backgroundColor: faint.searched },
    { label: 'keeps not every limit', data: searched.filter((p) => !p.ok), pointStyle: 'crossRot', pointRadius: 4, borderColor: faint.dominated, backgroundColor: faint.dominated },
  ];
  const all = confirmed.length ? confirmed : searched;
  return { sets, scales: { x: axis(names[0], around(all, 'x', 'ex')), y: axis(names[1], around(all, 'y', 'ey')) } };
}
// "front/03, recommended"
export const calledDesign = (p) => p.front + (p.recommended ? ', recommended' : '');
// Head and rows of the table of a front; value: how a variable is shown.
export function foundTable(list, objectives, variables, value) {
  // By belief, where the fingers name one.
  const doubts = list.some((p) => (p.doubts || []).length) ? ['p(best)', 'expected regret', 'p(every limit)'] : [];
  // By the names that its folders, its report and its lab have.
  const named = list.some((p) => p.front);
  return { head: (named ? ['design'] : []).concat(objectives, doubts, variables), rows: list.map((p) => (named ? [calledDesign(p)] : []).concat([p.x, p.y].slice(0, objectives.length).map((v) => round(v, 3)), doubts.length ? p.doubts : [], p.values.map(value))) };
}

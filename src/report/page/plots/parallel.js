// Designs as lines over all their numbers, an axis each. A range dragged along an axis keeps the designs that pass through it.
import { round } from './numbers.js';

const layout = { height: 250, top: 44, foot: 24, step: 104, side: 80, reach: 11 };  // px
const draggedAtLeast = 4;  // px: less is a click, which takes the range away
const stepped = 0.05;      // of an axis, by an arrow key
const ranges = new WeakMap();  // of each box: axis name -> [low, high] in shares of the axis, kept while designs arrive

function element(tag, attributes, text) {
  const e = document.createElementNS('http://www.w3.org/2000/svg', tag);
  Object.entries(attributes).forEach(([name, value]) => e.setAttribute(name, value));
  if (text !== undefined) e.textContent = text;
  return e;
}
const has = (v) => v !== undefined && v !== null && v !== '';

// Where a value lies, 0 at the foot; words at equal steps.
export function scaleOf(values) {
  const there = values.filter(has);
  if (there.length && there.every((v) => typeof v === 'number')) {
    const low = Math.min(...there), high = Math.max(...there);
    return { at: (v) => high > low ? (v - low) / (high - low) : 0.5, text: (share) => round(low + share * (high - low)), ends: [round(low), round(high)] };
  }
  const words = [...new Set(there.map(String))].sort();
  const share = (i) => words.length > 1 ? i / (words.length - 1) : 0.5;
  return {
    at: (v) => share(words.indexOf(String(v))),
    text: (at) => words[Math.round(at * (words.length - 1))] || '',
    ends: [words[0] || '', words.length > 1 ? words[words.length - 1] : ''],
  };
}
// Those whose values lie within all ranges; one without a value there is out. scales and ranges: by axis.
export const passing = (designs, scales, limits) => designs.filter((d) => limits.every((limit, i) => !limit || has(d.values[i]) && scales[i].at(d.values[i]) >= limit[0] - 1e-9 && scales[i].at(d.values[i]) <= limit[1] + 1e-9));

// axes: [{ name, unit }]; designs: [{ values, group, text }], group "front", "searched" or "broken"; open: what a click on one does.
export function parallel(box, axes, designs, open) {
  Object.assign(box, { $axes: axes, $designs: designs });  // for who takes the numbers along
  const limits = ranges.get(box) || {}, scales = axes.map((a, i) => scaleOf(designs.map((d) => d.values[i])));
  ranges.set(box, limits);
  const steps = axes.length - 1, width = Math.max(box.clientWidth, 2 * layout.side + layout.step * steps), tall = layout.height - layout.top - layout.foot;
  const x = (i) => layout.side + i * (width - 2 * layout.side) / steps, y = (share) => layout.top + (1 - share) * tall;
  const picture = element('svg', { viewBox: `0 0 ${width} ${layout.height}`, width, height: layout.height, role: 'group', 'aria-label': 'Designs over their numbers' }), said = document.createElement('p');
  said.className = 'note';
  said.setAttribute('aria-live', 'polite');
  const order = { broken: 0, searched: 1, front: 2 };
  const lines = [...designs].sort((a, b) => order[a.group] - order[b.group]).map((design) => {
    const points = design.values.map((v, i) => has(v) ? `${x(i)},${y(scales[i].at(v)).toFixed(1)}` : '').filter(Boolean);
    const line = element('polyline', { points: points.join(' '), class: `line ${design.group}` });
    line.append(element('title', {}, design.text));
    line.addEventListener('click', () => open(design));
    line.addEventListener('pointerenter', () => { said.textContent = design.text; });
    line.addEventListener('pointerleave', tell);
    picture.append(line);
    return { design, line };
  });
  function tell() {
    const asked = axes.map((a) => limits[a.name]), kept = new Set(passing(designs, scales, asked));
    lines.forEach(({ design, line }) => line.classList.toggle('out', !kept.has(design)));
    said.textContent = asked.some(Boolean)
      ? `${kept.size} of ${designs.length} designs pass: ` + axes.map((a, i) => asked[i] ? `${a.name} ${scales[i].text(asked[i][0])} to ${scales[i].text(asked[i][1])} ${a.unit}`.trim() : '').filter(Boolean).join('; ')
      : 'Drag along an axis (or focus it: arrow keys move the lower end, with Shift the upper one, Escape ends it) to keep the designs that pass there; select a line to open its design.';
    box.dataset.passing = kept.size;
  }
  axes.forEach((a, i) => {
    const group = element('g', { class: 'axis', tabindex: 0, role: 'slider', 'aria-label': `${a.name}${a.unit ? ' in ' + a.unit : ''}, range to keep`, 'aria-valuemin': 0, 'aria-valuemax': 100 });
    const range = element('rect', { class: 'range', x: x(i) - 6, width: 12, y: 0, height: 0 });
    const show = () => {
      const limit = limits[a.name];
      range.setAttribute('y', limit ? y(limit[1]) : 0);
      range.setAttribute('height', limit ? Math.max(2, (limit[1] - limit[0]) * tall) : 0);
      group.setAttribute('aria-valuenow', Math.round(100 * (limit ? limit[0] : 0)));
      group.setAttribute('aria-valuetext', limit ? `${scales[i].text(limit[0])} to ${scales[i].text(limit[1])}` : 'all');
      tell();
    };
    const keep = (limit) => { if (limit) limits[a.name] = limit; else delete limits[a.name]; show(); };
    const share = (event) => { const frame = picture.getBoundingClientRect(); return Math.min(1, Math.max(0, 1 - ((event.clientY - frame.top) * layout.height / frame.height - layout.top) / tall)); };
    const reach = element('rect', { class: 'reach', x: x(i) - layout.reach, width: 2 * layout.reach, y: layout.top - layout.reach, height: tall + 2 * layout.reach });
    let from = null;
    reach.addEventListener('pointerdown', (e) => { from = { share: share(e), y: e.clientY }; reach.setPointerCapture(e.pointerId); e.preventDefault(); group.focus(); });
    reach.addEventListener('pointermove', (e) => { if (from && Math.abs(e.clientY - from.y) >= draggedAtLeast) keep([from.share, share(e)].sort((p, q) => p - q)); });
    reach.addEventListener('pointerup', (e) => { if (from && Math.abs(e.clientY - from.y) < draggedAtLeast) keep(null); from = null; });
    reach.addEventListener('pointercancel', () => { from = null; });
    group.addEventListener('keydown', (e) => {
      const by = { ArrowUp: stepped, ArrowRight: stepped, ArrowDown: -stepped, ArrowLeft: -stepped }[e.key];
      if (e.key === 'Escape') keep(null);
      else if (by) {
        const [low, high] = limits[a.name] || [0, 1];
        keep(e.shiftKey ? [low, Math.min(1, Math.max(low, high + by))] : [Math.max(0, Math.min(high, low + by)), high]);
      } else return;
      e.preventDefault();
    });
    group.append(element('line', { x1: x(i), x2: x(i), y1: layout.top, y2: layout.top + tall }), range,
      element('text', { x: x(i), y: i % 2 ? 12 : 26, class: 'name' }, a.name + (a.unit ? ` [${a.unit}]` : '')),
      element('text', { x: x(i), y: layout.top - 5 }, scales[i].ends[1]), element('text', { x: x(i), y: layout.height - 8 }, scales[i].ends[0]), reach);
    picture.append(group);
    show();
  });
  const scroll = document.createElement('div');
  scroll.className = 'along';
  scroll.append(picture);
  box.replaceChildren(scroll, said);
}

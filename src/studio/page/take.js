// What is on the page, to take along: the numbers of a chart, a map or the designs as CSV, their picture as PNG or SVG, the
// page as one file.
import { charts } from '../plots/charts.js';
import { decode } from '../plots/maps.js';
import { svgOf, svgOfElement, svgOfMap } from './svg.js';

export function give(name, content, type) {
  const link = document.createElement('a');
  link.download = name;
  link.href = typeof content === 'string' && content.startsWith('data:') ? content : URL.createObjectURL(new Blob([content], { type }));
  link.click();
  if (link.href.startsWith('blob:')) setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
const cell = (text) => /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
const csv = (rows) => rows.map((row) => row.map((v) => cell(String(v))).join(',')).join('\n') + '\n';
// One row a point; bars and bands as standard errors, of points that have them.
export function csvOf(chart) {
  const axes = chart.options.scales, head = ['series', axes.x.title.text, axes.y.title.text, 'error of x', 'error of y'];
  const rows = chart.data.datasets.filter((set) => !set.band).flatMap((set) => set.data.map((p) => [set.label, p.x, p.y, p.ex || '', p.se || p.ey || '']));
  return csv([head, ...rows]);
}
// One row a pixel: its middle [um] and what is there, to half a step of the 255 that a map of the page has.
export function csvOfMap({ map, unit, scale }) {
  const values = decode(map), rows = [['x [um]', 'y [um]', `value${unit ? ` [${unit}]` : ''} ± ${+((map.high - map.low) / 510 * scale).toPrecision(2)}`]];
  values.forEach((v, i) => rows.push([((i % map.nx) + 0.5) * map.lx / map.nx, (Math.floor(i / map.nx) + 0.5) * map.ly / map.ny].map((x) => +(1e6 * x).toPrecision(9)).concat(+(v * scale).toPrecision(6))));
  return csv(rows);
}
const types = { CSV: 'text/csv', SVG: 'image/svg+xml', PNG: '' };
// Buttons before a place; name: of the files; kinds: what each of them holds, of what there is.
function buttons(place, name, there, kinds) {
  const box = document.createElement('div');
  box.className = 'take';
  Object.entries(kinds).forEach(([kind, content]) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = kind;
    button.setAttribute('aria-label', `${name} as ${kind}`);
    button.addEventListener('click', () => there() && give(`${name}.${kind.toLowerCase()}`, content(there()), types[kind]));
    box.append(button);
  });
  place.before(box);
}
// The chart of a canvas.
export const takeable = (canvas, name) => buttons(canvas.closest('figure'), name, () => charts[canvas.id], { CSV: csvOf, PNG: (chart) => chart.toBase64Image(), SVG: svgOf });
// The map of a canvas.
export const takeableMap = (canvas, name) => buttons(canvas, name, () => canvas.$map && canvas, { CSV: () => csvOfMap(canvas.$map), PNG: () => canvas.toDataURL(), SVG: svgOfMap });
// What is drawn in three dimensions.
export const takeableSolid = (box, name) => buttons(box, name, () => box.querySelector('canvas'), { PNG: (canvas) => canvas.toDataURL() });
// Designs as lines over their numbers.
export const takeableDesigns = (box, name) => buttons(box, name, () => box.querySelector('svg'), {
  CSV: () => csv([box.$axes.map((a) => a.name + (a.unit ? ` [${a.unit}]` : '')).concat('group'), ...box.$designs.map((d) => box.$axes.map((_, i) => d.values[i] ?? '').concat(d.group))]),
  SVG: svgOfElement,
});

// The page as it stands: pictures in place of canvases, its styles inside, nothing that acts.
export function pageNow(title) {
  const page = document.documentElement.cloneNode(true), all = (root, what) => [...root.querySelectorAll(what)];
  const live = all(document, 'canvas');
  all(page, 'canvas').forEach((canvas, i) => {
    const box = live[i].getBoundingClientRect(), image = document.createElement('img');
    if (!box.width || !live[i].width) return canvas.remove();
    image.src = live[i].toDataURL();
    image.alt = live[i].getAttribute('aria-label') || '';
    image.style.cssText = `width:${Math.round(box.width)}px;height:${Math.round(box.height)}px`;
    canvas.replaceWith(image);
  });
  const fields = all(document, 'input, select');
  all(page, 'input, select').forEach((field, i) => {
    const text = document.createElement('span'), now = fields[i];
    if (now.type === 'range') return field.remove();
    text.textContent = now.type === 'checkbox' ? (now.checked ? '☑' : '☐') : now.tagName === 'SELECT' ? (now.selectedOptions[0] || {}).text || '' : now.value;
    text.className = 'kept';
    field.replaceWith(text);
  });
  all(page, 'script, link, dialog, footer, button, .tools, .take, .skip, #meaning, #kinds, #notice, #status').forEach((e) => e.remove());
  const style = document.createElement('style'), head = page.querySelector('head');
  style.textContent = [...document.styleSheets].flatMap((sheet) => [...sheet.cssRules].map((rule) => rule.cssText)).join('\n');
  head.append(style);
  head.querySelector('title').textContent = title;
  return `<!DOCTYPE html>\n${page.outerHTML}\n`;
}
export const keepPage = (title) => give('papilla.html', pageNow(title), 'text/html');

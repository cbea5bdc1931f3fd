// What is on the page, to take along: a chart's numbers as CSV, its picture as PNG or SVG, the page as one file.
import { charts } from '../plots/charts.js';
import { svgOf } from './svg.js';

export function give(name, content, type) {
  const link = document.createElement('a');
  link.download = name;
  link.href = typeof content === 'string' && content.startsWith('data:') ? content : URL.createObjectURL(new Blob([content], { type }));
  link.click();
  if (link.href.startsWith('blob:')) setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
const cell = (text) => /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
// One row a point; bars and bands as standard errors, of points that have them.
export function csvOf(chart) {
  const axes = chart.options.scales, head = ['series', axes.x.title.text, axes.y.title.text, 'error of x', 'error of y'];
  const rows = chart.data.datasets.filter((set) => !set.band).flatMap((set) => set.data.map((p) => [set.label, p.x, p.y, p.ex || '', p.se || p.ey || '']));
  return [head, ...rows].map((row) => row.map((v) => cell(String(v))).join(',')).join('\n') + '\n';
}
// Buttons above the chart of a canvas; name: of the files.
export function takeable(canvas, name) {
  const id = canvas.id;
  const box = document.createElement('div');
  box.className = 'take';
  [['CSV', () => give(`${name}.csv`, csvOf(charts[id]), 'text/csv')], ['PNG', () => give(`${name}.png`, charts[id].toBase64Image(), '')], ['SVG', () => give(`${name}.svg`, svgOf(charts[id]), 'image/svg+xml')]].forEach(([text, work]) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = text;
    button.setAttribute('aria-label', `${name} as ${text}`);
    button.addEventListener('click', () => charts[id] && work());
    box.append(button);
  });
  canvas.closest('figure').before(box);
}

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

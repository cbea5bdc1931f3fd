// What is on a chart, to take along: its numbers as CSV, its picture as PNG.
import { charts } from '../plots/charts.js';

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
// Buttons above a chart; name: of the files.
export function takeable(id, name) {
  const box = document.createElement('div');
  box.className = 'take';
  [['CSV', () => give(`${name}.csv`, csvOf(charts[id]), 'text/csv')], ['PNG', () => give(`${name}.png`, charts[id].toBase64Image(), '')]].forEach(([text, work]) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = text;
    button.setAttribute('aria-label', `${name} as ${text}`);
    button.addEventListener('click', () => charts[id] && work());
    box.append(button);
  });
  document.getElementById(id).closest('figure').before(box);
}

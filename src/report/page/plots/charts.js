// What every chart has: axes, error bars, room for them.
import { $, ink } from './look.js';
import { round } from './numbers.js';
export const charts = {};
Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
Chart.defaults.font.size = 13;
function takeInks() {
  Chart.defaults.color = ink('soft');
  Chart.defaults.borderColor = ink('line');
}
takeInks();
// In other colours every chart is drawn anew.
export function dropCharts() {
  takeInks();
  Object.keys(charts).forEach((id) => { charts[id].destroy(); delete charts[id]; });
}
// Numbers of an axis as everywhere: Chart.js would say 0.0000000001.
const ticksOf = (scale) => Chart.defaults.scales[scale].ticks;
const logarithmic = ticksOf('logarithmic').callback;
ticksOf('linear').callback = (value) => round(value, 6);
ticksOf('logarithmic').callback = function (value, ...more) { return logarithmic.call(this, value, ...more) === '' ? '' : round(value, 6); };
Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;
export const axis = (text, more = {}) => Object.assign({ title: { display: true, text } }, more);
export function draw(id, config) {
  if (charts[id]) charts[id].destroy();
  charts[id] = new Chart($(id), config);
}
// Error bars of points with ex, ey.
export const errorBars = {
  id: 'errorBars',
  afterDatasetsDraw(chart) {
    const c = chart.ctx, { x, y } = chart.scales;
    chart.data.datasets.forEach((set, i) => {
      if (!set.bars || !chart.isDatasetVisible(i)) return;
      c.save();
      c.beginPath();
      c.rect(x.left, y.top, x.right - x.left, y.bottom - y.top);
      c.clip();
      c.strokeStyle = set.borderColor;
      set.data.forEach((p) => {
        c.beginPath();
        c.moveTo(x.getPixelForValue(p.x - p.ex), y.getPixelForValue(p.y));
        c.lineTo(x.getPixelForValue(p.x + p.ex), y.getPixelForValue(p.y));
        c.moveTo(x.getPixelForValue(p.x), y.getPixelForValue(p.y - p.ey));
        c.lineTo(x.getPixelForValue(p.x), y.getPixelForValue(p.y + p.ey));
        c.stroke();
      });
      c.restore();
    });
  },
};
// Intervals on bars or dots: the `interval` of a dataset holds [low, high] an item.
export const intervals = {
  id: 'intervals',
  afterDatasetsDraw(chart) {
    const c = chart.ctx, across = chart.options.indexAxis === 'y', scale = chart.scales[across ? 'x' : 'y'];
    chart.data.datasets.forEach((set, k) => {
      if (!set.interval || !chart.isDatasetVisible(k)) return;
      c.save();
      c.beginPath();
      c.strokeStyle = ink('ink');
      c.lineWidth = 1.5;
      chart.getDatasetMeta(k).data.forEach((item, i) => {
        if (!set.interval[i]) return;
        const [a, b] = set.interval[i].map((v) => Math.min(Math.max(scale.getPixelForValue(v), across ? scale.left : scale.top), across ? scale.right : scale.bottom));
        const line = (x1, y1, x2, y2) => { c.moveTo(across ? x1 : y1, across ? y1 : x1); c.lineTo(across ? x2 : y2, across ? y2 : x2); };
        const at = across ? item.y : item.x;
        line(a, at, b, at);
        line(a, at - 5, a, at + 5);
        line(b, at - 5, b, at + 5);
      });
      c.stroke();
      c.restore();
    });
  },
};
// Ends of an axis that hold the bars of points, `half` either way.
export function around(points, at, half) {
  const ends = points.filter((p) => isFinite(p[at])).flatMap((p) => [p[at] - (p[half] || 0), p[at] + (p[half] || 0)]);
  const low = Math.min(...ends), high = Math.max(...ends), gap = 0.04 * (high - low || Math.abs(high) || 1);
  return ends.length ? { suggestedMin: low - gap, suggestedMax: high + gap } : {};
}
// Room for the intervals of all datasets, and for the values `more`, on a value axis.
export function room(sets, more = []) {
  const all = sets.flatMap((s) => (s.interval || []).filter(Boolean).flat().concat(s.data.map((d) => typeof d === 'number' ? d : d.x))).concat(more).filter(isFinite);
  const low = Math.min(...all), high = Math.max(...all), gap = 0.04 * (high - low || 1);
  return { suggestedMin: low < 0 ? low - gap : Math.min(low, 0), suggestedMax: high + gap };
}
export function canvasIn(box, id, className, note) {
  const figure = document.createElement('figure'), frame = document.createElement('div'), canvas = document.createElement('canvas');
  frame.className = className;
  canvas.id = id;
  frame.appendChild(canvas);
  figure.appendChild(frame);
  if (note) {
    const caption = document.createElement('figcaption');
    caption.textContent = note;
    figure.appendChild(caption);
  }
  box.appendChild(figure);
  return canvas;
}

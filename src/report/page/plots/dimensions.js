// Dimension lines in a section, as a drawing has them: of the period, of the width of a feature, of the depth.
import { ink } from './look.js';
import { micrometres } from './numbers.js';
// The middle of the first feature that lies wholly on the line [µm]; nothing where there is none.
function middleOfFeature(line, raised) {
  const heights = line.map((p) => p.y), low = Math.min(...heights), high = Math.max(...heights), inside = (y) => raised === (y > (low + high) / 2);
  for (let i = 1, begin = -1; i < line.length; ++i) {
    const before = inside(heights[i - 1]), now = inside(heights[i]);
    if (!before && now) begin = i;
    if (before && !now && begin >= 0) return (line[begin].x + line[i - 1].x) / 2;
  }
  return null;
}
// measures: of the texture in m, each { name, value }, with `raised`; width: of a feature at its upper end. Lines lie along x
// at a row above the heights, or stand at x from the lowest to the highest.
export function dimensionLines(line, measures, end) {
  const at = measures ? middleOfFeature(line, measures.raised) : null;
  if (at === null) return [];
  const out = [], { period, width, depth } = measures, text = (m) => `${m.name.replace(/_/g, ' ')} ${micrometres(m.value)}`, step = 1e6 * period.value;
  const next = at + step <= end * 1.0001 ? at + step : at - step >= -0.0001 * end ? at - step : null;
  if (next !== null) out.push({ row: 0, from: Math.min(at, next), to: Math.max(at, next), text: text(period) });
  if (width) out.push({ row: 1, from: at - 0.5e6 * width.value, to: at + 0.5e6 * width.value, text: text(width) });
  const floor = measures.raised ? at + (at + step / 2 <= end ? step / 2 : -step / 2) : at;
  if (depth) out.push({ at: floor, text: text(depth) });
  return out;
}
// Room above the heights for the rows, as a share of their span.
export const roomForRows = 0.5;
export const dimensionPlugin = {
  id: 'dimensions',
  afterDatasetsDraw(chart) {
    const { lines, low, high } = chart.data.datasets[0].dimensions;
    const rowHeight = 19, tipLength = 5;  // px
    const c = chart.ctx, { x, y } = chart.scales;
    c.save();
    c.strokeStyle = c.fillStyle = ink('ink');
    c.lineWidth = 1;
    c.font = `12px ${Chart.defaults.font.family}`;
    c.textBaseline = 'middle';
    const stroke = (...points) => { c.beginPath(); points.forEach(([a, b], i) => i ? c.lineTo(a, b) : c.moveTo(a, b)); c.stroke(); };
    const tip = (a, b, da, db) => { c.beginPath(); c.moveTo(a, b); c.lineTo(a + tipLength * da - 0.5 * tipLength * db, b + tipLength * db + 0.5 * tipLength * da); c.lineTo(a + tipLength * da + 0.5 * tipLength * db, b + tipLength * db - 0.5 * tipLength * da); c.fill(); };
    const say = (text, a, b) => {
      const wide = c.measureText(text).width, left = Math.min(Math.max(a - wide / 2, chart.chartArea.left + 2), chart.chartArea.right - wide - 2);
      c.fillStyle = ink('paper');
      c.fillRect(left - 3, b - 8, wide + 6, 16);
      c.fillStyle = ink('ink');
      c.fillText(text, left, b);
    };
    lines.forEach((line) => {
      if (line.at !== undefined) {
        const a = x.getPixelForValue(line.at), top = y.getPixelForValue(high), bottom = y.getPixelForValue(low);
        stroke([a, top], [a, bottom]);
        tip(a, top, 0, 1);
        tip(a, bottom, 0, -1);
        say(line.text, a, (top + bottom) / 2);
      } else {
        const from = x.getPixelForValue(line.from), to = x.getPixelForValue(line.to), b = chart.chartArea.top + rowHeight * (line.row + 0.6);
        stroke([from, b], [to, b]);
        tip(from, b, 1, 0);
        tip(to, b, -1, 0);
        c.globalAlpha = 0.45;
        [from, to].forEach((a) => stroke([a, b], [a, y.getPixelForValue(high)]));
        c.globalAlpha = 1;
        say(line.text, (from + to) / 2, b);
      }
    });
    c.restore();
  },
};

// Curves over humidity with their bands, and heights along a line.
import { colours } from './look.js';
import { axis, errorBars } from './charts.js';
import { dimensionLines, dimensionPlugin, roomForRows } from './dimensions.js';
// Without the part of the finger's parameters, which moves all designs together.
export const ownError = (q) => Math.sqrt(Math.max(0, q.se * q.se - Math.pow(q.parts.parameters || 0, 2)));
// scale: of the quantity to the unit of its axis. Two standard errors either way: as a band, and of a single point, which has
// none, as a bar.
export function curve(name, points, tint, dash, quantity = 'modulation', scale = 1) {
  const at = points.filter((p) => p[quantity]).map((p) => {
    const se = scale * ownError(p[quantity]);
    return { x: 100 * p.relative_humidity, y: scale * p[quantity].value, se, ex: 0, ey: 2 * se };
  });
  const common = { borderColor: tint, backgroundColor: tint, pointRadius: 0, borderWidth: 0, tension: 0 };
  return [
    Object.assign({}, common, { label: name, data: at, bars: at.length === 1, borderWidth: 2.5, pointRadius: 3.5, borderDash: dash || [] }),
    Object.assign({}, common, { band: true, label: name + ' +', data: at.map((p) => ({ x: p.x, y: p.y + 2 * p.se })) }),
    Object.assign({}, common, { band: true, label: name + ' −', data: at.map((p) => ({ x: p.x, y: p.y - 2 * p.se })), fill: '-1', backgroundColor: tint + '2b' }),
  ];
}
// The chart of such curves; quantity: what the axis says.
export const overHumidity = (sets, quantity, more = {}) => ({
  type: 'line',
  data: { datasets: sets },
  plugins: [errorBars],
  options: {
    parsing: false,
    interaction: { mode: 'nearest', axis: 'x', intersect: false },
    scales: { x: axis('relative humidity [%]', { type: 'linear' }), y: axis(quantity, more) },
    plugins: {
      legend: { labels: { filter: (item, all) => !all.datasets[item.datasetIndex].band } },
      tooltip: {
        filter: (item) => !item.dataset.band,
        callbacks: {
          title: (items) => items.length ? items[0].parsed.x + ' % RH' : '',
          label: (item) => `${item.dataset.label}: ${item.raw.y.toFixed(3)} ± ${item.raw.se.toFixed(3)}`,
        },
      },
    },
  },
});
// Heights along a line [µm, nm]; measures: of the texture, drawn as dimension lines.
export function alongLine(line, length, measures) {
  const lines = dimensionLines(line, measures, length), heights = line.map((p) => p.y), low = Math.min(...heights), high = Math.max(...heights);
  return {
    type: 'line',
    data: { datasets: [{ label: 'height', data: line, dimensions: { lines, low, high }, borderColor: colours[0], backgroundColor: colours[0] + '22', fill: 'start', pointRadius: 0, borderWidth: 2 }] },
    plugins: [dimensionPlugin],
    options: {
      parsing: false,
      plugins: { legend: { display: false } },
      scales: { x: axis('along the section [µm]', { type: 'linear', max: length, min: 0 }), y: axis('height [nm]', lines.length ? { suggestedMax: high + roomForRows * (high - low) } : {}) },
    },
  };
}

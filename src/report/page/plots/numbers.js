// Numbers as people read them.
export const round = (v, digits = 3) => v === null || v === undefined || !isFinite(v) ? '–' : String(+v.toPrecision(digits) + 0);
// Zero but for rounding beside the most of a map.
export const level = (v, most) => Math.abs(v) < 1e-6 * most ? 0 : v;
// Of a table's cell; kinds of texture and other choices are words.
export const entry = (text) => text === '' || Number.isNaN(+text) ? text : round(+text);
// "640 ± 130": both as far as the second digit of the error.
export function withBar(value, error) {
  if (!(error > 0) || !isFinite(error) || !isFinite(value)) return `${round(value, 4)} ± ${round(error, 2)}`;
  const shown = +error.toPrecision(2), decimals = 1 - Math.floor(Math.log10(shown) + 1e-9), step = Math.pow(10, -decimals);
  const text = (v) => decimals < 0 ? String(Math.round(v / step) * step) : v.toFixed(Math.min(decimals, 12));
  return `${text(value)} ± ${text(shown)}`;
}
// A zero has no sign.
export const fixed = (v, decimals = 3) => v.toFixed(decimals).replace(/^-(0\.?0*)$/, '$1');
// As many as reach the first digit of an error; that of a look, which nothing scatters, is its last bits.
export const reaching = (decimals, error) => error > 1e-9 ? Math.max(decimals, Math.ceil(-Math.log10(error) - 1e-9)) : decimals;
// "0.612 ± 0.014 (0.051)", of a value in SI that people read as `scale` times it to so many decimals.
export function withError(q, { scale, decimals }) {
  const known = q.se !== undefined && q.se !== null, digits = known ? reaching(decimals, q.se * scale) : decimals, text = (v) => fixed(v * scale, digits);
  return text(q.value) + (known ? ' ± ' + text(q.se) : '') + (q.parameters ? ' (' + text(q.parameters) + ')' : '');
}
export function csv(text) {
  const rows = text.trim().split('\n').map((line) => line.split(','));
  const head = rows.shift();
  return rows.map((row) => Object.fromEntries(head.map((name, i) => [name, row[i]])));
}
export function roundLength(limit) {
  const power = Math.pow(10, Math.floor(Math.log10(limit)));
  return power * (limit >= 5 * power ? 5 : limit >= 2 * power ? 2 : 1);
}
export const micrometres = (m) => m >= 1e-6 ? round(m * 1e6) + ' µm' : round(m * 1e9) + ' nm';
// The largest of some SI values decides the prefix: { scale, unit }.
export function prefix(unit, values) {
  const largest = Math.max(...values.map(Math.abs).filter(isFinite), 0);
  if (unit === 'm/Pa') return { scale: 1e12, unit: 'µm/MPa' };
  if (!['N', 'm', 'Pa', 'V', 's', 'J', 'm/s'].includes(unit) || !largest) return { scale: 1, unit };
  const steps = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n']];
  const [size, letter] = steps.find(([s]) => largest >= s) || steps[steps.length - 1];
  return { scale: 1 / size, unit: letter + unit };
}

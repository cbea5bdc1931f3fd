// The page of `papilla calibrate`.
const fit = data.fit, parameters = fit.parameters;

function rowsChart(id, labels, sets, scale, more = {}) {
  $(id).parentElement.style.height = 110 + 30 * labels.length + 'px';
  draw(id, {
    type: 'bar',
    data: { labels, datasets: sets },
    plugins: [intervals],
    options: Object.assign({
      indexAxis: 'y',
      scales: { x: scale, y: { grid: { display: false } } },
      plugins: { legend: { display: sets.length > 1 }, tooltip: { callbacks: { label: (item) => item.dataset.text[item.dataIndex] } } },
    }, more),
  });
}

const shown = (p, si) => `${round(si / p.per_unit, 4)}${p.unit ? ' ' + p.unit.replace('um', 'µm').replace('deg', '°') : ''}`;
function priorText(p) {
  if (!p.prior) return 'none';
  return p.prior.factor ? `${shown(p, p.prior.value)} within a factor of ${round(p.prior.factor)}` : `${shown(p, p.prior.value)} ± ${shown(p, p.prior.sd)}`;
}
// In prior widths from the prior.
function width(p, v) {
  if (p.prior && p.prior.factor) return Math.log(v / p.prior.value) / Math.log(p.prior.factor);
  if (p.prior) return (v - p.prior.value) / p.prior.sd;
  return (v - (p.lowest + p.highest) / 2) / ((p.highest - p.lowest) / 4);
}

function showParameters() {
  const set = {
    type: 'line', showLine: false, pointRadius: 6, pointHoverRadius: 8, borderColor: colours[0], backgroundColor: colours[0],
    data: parameters.map((p) => width(p, p.value)), interval: parameters.map((p) => [width(p, p.low), width(p, p.high)]),
    text: parameters.map((p) => `${shown(p, p.value)}, 95 %: ${shown(p, p.low)} to ${shown(p, p.high)}`),
  };
  const prior = { data: parameters.map(() => [-1, 1]), backgroundColor: ink('line'), barPercentage: 0.9, label: 'prior ±1', text: parameters.map(priorText) };
  rowsChart('widths', parameters.map((p) => p.path), [Object.assign(set, { label: 'fitted, 95 % interval' }), prior], axis('prior widths from the prior', room([set], [-2, 2])));
  table($('values'), ['Parameter', 'Start', 'Fitted', '95 % interval', 'Prior', 'From the data [%]'], parameters.map((p) => [
    p.path, shown(p, p.start), shown(p, p.value), `${shown(p, p.low)}${p.low_open ? ' (bound)' : ''} to ${shown(p, p.high)}${p.high_open ? ' (bound)' : ''}`,
    priorText(p), round(100 * p.data_share, 2) + (p.at_bound ? '; at its bound' + (p.low_open && p.high_open ? '' : ', interval by profile') : ''),
  ]), [1, 2, 3, 4, 5]);
}

function showMatrix() {
  const n = parameters.length, names = parameters.map((p) => p.path);
  const body = table($('matrix'), [''].concat(names), names.map((name, i) => [name].concat(names.map((_, k) => fit.correlation[i * n + k].toFixed(2)))), names.map((_, i) => i + 1));
  for (let i = 0; i < n; ++i) {
    for (let k = 0; k < n; ++k) {
      const r = fit.correlation[i * n + k], c = body.rows[i].cells[k + 1];
      c.style.backgroundColor = `rgba(${r > 0 ? '31,111,159' : '194,87,26'},${i === k ? 0.12 : 0.5 * Math.abs(r)})`;
      c.title = `${names[i]}, ${names[k]}: ${r.toFixed(3)}`;
    }
  }
}

function showDirections() {
  const text = (d) => d.weights.map((w, i) => [w, parameters[i].path]).filter(([w]) => Math.abs(w) >= 0.2).map(([w, name]) => `${w > 0 ? '+' : '−'}${Math.abs(w).toFixed(2)} ${name}`).join(' ');
  const list = fit.directions, main = (d) => parameters[d.weights.reduce((m, w, i) => Math.abs(w) > Math.abs(d.weights[m]) ? i : m, 0)].path;
  rowsChart('directions', list.map((d) => main(d) + (d.weights.filter((w) => Math.abs(w) >= 0.2).length > 1 ? ' …' : '')), [{
    data: list.map((d) => d.singular_value), backgroundColor: list.map((d) => d.singular_value < 1 ? colours[1] : colours[0]), maxBarThickness: 18,
    text: list.map((d) => `${round(d.singular_value)}: ${text(d)}`),
  }], axis('standard deviations per prior width', { type: 'logarithmic' }));
  table($('directiontable'), ['Standard deviations per prior width', 'Direction', ''], list.map((d) => [round(d.singular_value), text(d), d.singular_value < 1 ? 'not identified: the prior decides' : '']), [0]);
}

function showResiduals() {
  const rows = fit.residuals, miss = (r, v) => (r.low !== null && v < r.low ? v - r.low : r.high !== null && v > r.high ? v - r.high : 0) / r.deviation;
  const among = (r) => rows.filter((o) => o.source === r.source).length, names = rows.map((r) => among(r) > 1 ? `${r.source}, ${r.what.split(' ')[0]}` : r.source), clip = (v) => Math.min(Math.max(v, -6), 6);
  const set = (label, key, tint) => ({ label, backgroundColor: tint, maxBarThickness: 9, data: rows.map((r) => clip(miss(r, r[key]))), text: rows.map((r) => `${label} the fit: ${r.what} ${round(r[key], 4)}, miss ${miss(r, r[key]).toFixed(2)} sd`) });
  rowsChart('misses', names, [set('before', 'before', faint.searched), set('after', 'after', colours[0])], axis('miss [standard deviations]', { min: -6, max: 6 }));
  const band = (r) => r.low === r.high ? round(r.low, 4) : r.high === null ? 'above ' + round(r.low) : r.low === null ? 'below ' + round(r.high) : `${round(r.low)} to ${round(r.high)}`;
  table($('residualtable'), ['Source', 'Quantity', 'Data', 'sd', 'Sampling of the model', 'Before', 'After', 'Miss [sd]'],
    rows.map((r) => [r.source, r.what, band(r), round(r.sd), round(r.sampling_sd, 2), round(r.before, 4), round(r.after, 4), r.residual.toFixed(2)]), [2, 3, 4, 5, 6, 7]);
}

function showClaims() {
  if (!fit.claims.length) {
    $('heldbox').textContent = 'The fit has a table of measurements alone: no published claim was held out.';
  } else {
    canvasIn($('heldbox'), 'held', 'chart low', `Published claims that the model keeps, before and after, on ${fit.check_skins} skins that the fit has not seen.`);
    const groups = [true, false].map((fitted) => fit.claims.filter((c) => c.fitted === fitted)), share = (list, key) => list.length ? 100 * list.filter((c) => c[key]).length / list.length : 0;
    const set = (label, key, tint) => ({ label, backgroundColor: tint, maxBarThickness: 22, data: groups.map((g) => share(g, key)), text: groups.map((g) => `${label}: ${g.filter((c) => c[key]).length} of ${g.length}`) });
    draw('held', {
      type: 'bar',
      data: { labels: groups.map((g, i) => `${i ? 'held out' : 'fitted'} (${g.length})`), datasets: [set('before', 'held_before', faint.searched), set('after', 'holds', colours[0])] },
      options: { indexAxis: 'y', scales: { x: axis('claims that hold [%]', { min: 0, max: 100 }), y: { grid: { display: false } } }, plugins: { tooltip: { callbacks: { label: (item) => item.dataset.text[item.dataIndex] } } } },
    });
    table($('claimtable'), ['', 'Claim', 'Fitted or held out', 'Before', 'After'],
      fit.claims.map((c) => [c.id, c.statement, c.fitted ? 'fitted' : 'held out', `${c.held_before ? 'holds' : 'differs'}: ${c.before}`, `${c.holds ? 'holds' : 'differs'}: ${c.after}`]));
  }
  const gap = fit.gap_by_capacitance, mu = fit.friction_coefficient;
  $('beside').textContent = `Gap by capacitance under the ridges at 1 N on 30 mm² (published 1.06 µm): ${round(1e6 * gap.before)} µm before, ${round(1e6 * gap.after)} µm after.`
    + (mu.length === 4 ? ` Friction coefficient on flat glass at 0.2 N: ${mu.map((v) => v.toFixed(2)).join(', ')} at 15, 35, 55, 75 % RH (published on screens at 1 N: 0.2 and 0.4).` : '');
}

$('lead').textContent = (fit.warning ? `Warning: ${fit.warning}. ` : '') + ((fit.verdicts || []).length ? `Verdict: ${fit.verdicts.join('; ')}. ` : '') + `${fit.residuals.length} numbers, ${parameters.length} parameters: χ² of the data ${round(fit.chi2_before)} before, ${round(fit.chi2)} after, of the priors ${round(fit.prior_chi2)}; ${fit.degrees_of_freedom} degrees of freedom. `
  + (fit.converged ? 'The fit converged' : 'The fit stopped early') + ` after ${fit.evaluations} evaluations of the model.`;
showParameters();
showMatrix();
showDirections();
showResiduals();
showClaims();
finish();

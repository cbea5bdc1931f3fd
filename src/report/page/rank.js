// The page of `papilla rank`.
const ranking = data.ranking;
// What each design meets more of where the order is open.
const met = ranking.felt ? 'skins' : 'arrangements';
const tints = colours.concat(dark ? ['#4fc4c4', '#e081b4'] : ['#1b8585', '#b0467d']);
// A candidate keeps its colour in every chart and state.
const tint = (c) => tints[c.index % tints.length];
const percent = (v) => round(100 * v, 3);
const likely = (p) => p > 0.999 ? '> 0.999' : p < 0.001 ? '< 0.001' : p.toFixed(3);
// Designs are called by their titles where these tell them apart.
{
  const first = ranking.states[0].candidates, titles = first.map((c) => c.title);
  const called = new Set(titles.filter(Boolean)).size === titles.length;
  ranking.states.forEach((s) => s.candidates.forEach((c) => { c.file = c.name; if (called) c.name = c.title; data.candidates[c.index].name = c.name; }));
}
// Beside a bar a long title gives way to the name of the file.
const brief = (c) => c.name.length > 22 && c.file ? c.file : c.name;
const listed = (names) => names.length > 1 ? names.slice(0, -1).join(', ') + ' and ' + names[names.length - 1] : names[0];

function rowsChart(id, list, set, title, ends = {}) {
  const canvas = $(id);
  canvas.parentElement.style.height = 90 + 34 * list.length + 'px';
  draw(id, {
    type: 'bar',
    data: { labels: list.map(brief), datasets: [Object.assign({ backgroundColor: list.map(tint), maxBarThickness: 18 }, set)] },
    plugins: [intervals],
    options: {
      indexAxis: 'y',
      scales: { x: axis(title, Object.assign(room([set]), ends)), y: { grid: { display: false } } },
      plugins: { legend: { display: false }, tooltip: { callbacks: { label: (item) => set.text[item.dataIndex] } } },
    },
  });
}

function criteriaColumns(list) {
  const scales = ranking.criteria.map((k) => prefix(k.unit, list.map((c) => c.metrics[k.metric].value)));
  const value = (c, k, m) => { const q = c.metrics[k.metric], s = scales[m].scale; return withBar(q.value * s, (q.high - q.low) / 2 * s); };
  return { head: ranking.criteria.map((k, i) => k.metric + ' (' + k.better + ')' + (scales[i].unit ? ' [' + scales[i].unit + ']' : '')), value };
}

function showScore(list) {
  $('dominance').style.display = 'none';
  rowsChart('score', list, { data: list.map((c) => c.score.value), interval: list.map((c) => [c.score.low, c.score.high]), text: list.map((c) => `${round(c.score.value)} [${round(c.score.low)}, ${round(c.score.high)}]`) }, 'score');
  rowsChart('best', list, { data: list.map((c) => 100 * c.p_best), text: list.map((c) => likely(c.p_best)) }, 'probability of being best [%]', { min: 0, max: 100 });
  const columns = criteriaColumns(list);
  const head = ['place', 'design'].concat(columns.head, ['ahead of the next [%]', 'p(ahead)', 'p(best)', met]);
  table($('places'), head, list.map((c, i) => [c.rank, c.name]
    .concat(ranking.criteria.map((k, m) => columns.value(c, k, m)))
    .concat(i + 1 < list.length ? [`${percent(c.ahead_of_next.value)} [${percent(c.ahead_of_next.low)}, ${percent(c.ahead_of_next.high)}]` + (c.tied_with_next ? ': tie' : ''), likely(c.p_ahead)] : ['–', '–'])
    .concat([likely(c.p_best), c.skins])), head.map((h, i) => i).slice(2));
}

function showDominance(list) {
  $('scored').style.display = $('leads').style.display = 'none';
  const columns = criteriaColumns(list);
  const head = ['place', 'design'].concat(ranking.criteria.flatMap((k, m) => [columns.head[m], 'p(best)']), [met]);
  table($('places'), head, list.map((c) => [c.rank, c.name].concat(ranking.criteria.flatMap((k, m) => [columns.value(c, k, m), likely(c.p_best_by[k.metric])]), [c.skins])), head.map((h, i) => i).slice(2));
  table($('pairs'), ['row against column'].concat(list.map((c) => c.name)), list.map((c) => [c.name].concat(list.map((o) => o === c ? '–' : c.over[o.index]))));
}

function showCriteria(list) {
  const box = $('criteria');
  ranking.criteria.forEach((k, i) => {
    const id = 'criterion' + i;
    if (!$(id)) canvasIn(box, id, 'chart rows', k.metric + ': ' + (k.better === 'high' ? 'higher' : 'lower') + ' is better');
    const p = prefix(k.unit, list.map((c) => c.metrics[k.metric].value)), q = list.map((c) => c.metrics[k.metric]);
    rowsChart(id, list, {
      data: q.map((m) => m.value * p.scale), interval: q.map((m) => [m.low * p.scale, m.high * p.scale]),
      text: q.map((m) => `${withBar(m.value * p.scale, (m.high - m.low) / 2 * p.scale)} ${p.unit}`),
    }, k.metric + (p.unit ? ' [' + p.unit + ']' : ''));
  });
  if (ranking.criteria.length === 1) {
    $('togetherfigure').style.display = 'none';
    return;
  }
  if (ranking.criteria.length === 2) {
    const [a, b] = ranking.criteria, pa = prefix(a.unit, list.map((c) => c.metrics[a.metric].value)), pb = prefix(b.unit, list.map((c) => c.metrics[b.metric].value));
    const point = (c) => { const x = c.metrics[a.metric], y = c.metrics[b.metric]; return { x: x.value * pa.scale, y: y.value * pb.scale, ex: (x.high - x.low) / 2 * pa.scale, ey: (y.high - y.low) / 2 * pb.scale }; };
    $('togethernote').textContent = `Both criteria at once, 95 % intervals; ${a.better} and ${b.better} is better.`;
    draw('together', {
      type: 'scatter',
      data: { datasets: list.map((c) => ({ label: c.name, data: [point(c)], bars: true, pointRadius: 6, pointHoverRadius: 8, borderColor: tint(c), backgroundColor: tint(c) })) },
      plugins: [errorBars],
      options: {
        scales: { x: axis(a.metric + (pa.unit ? ' [' + pa.unit + ']' : ''), around(list.map(point), 'x', 'ex')), y: axis(b.metric + (pb.unit ? ' [' + pb.unit + ']' : ''), around(list.map(point), 'y', 'ey')) },
        plugins: { legend: { labels: { usePointStyle: true, boxHeight: 7 } }, tooltip: { callbacks: { label: (item) => `${item.dataset.label}: ${withBar(item.raw.x, item.raw.ex)}, ${withBar(item.raw.y, item.raw.ey)}` } } },
      },
    });
    return;
  }
  $('togethernote').textContent = 'On each axis the best candidate reaches the rim, the others their ratio to it: larger is better everywhere.';
  const share = (c, k) => {
    const all = list.map((o) => Math.abs(o.metrics[k.metric].value)), v = Math.abs(c.metrics[k.metric].value);
    return k.better === 'high' ? v / (Math.max(...all) || 1) : v > 0 ? Math.min(...all) / v : 1;
  };
  draw('together', {
    type: 'radar',
    data: { labels: ranking.criteria.map((k) => k.metric), datasets: list.map((c) => ({ label: c.name, data: ranking.criteria.map((k) => share(c, k)), borderColor: tint(c), backgroundColor: tint(c) + '1c', borderWidth: 2, pointRadius: 3 })) },
    options: { scales: { r: { min: 0, max: 1, ticks: { backdropColor: 'transparent' } } }, plugins: { tooltip: { callbacks: { label: (item) => `${item.dataset.label}: ${percent(item.raw)} % of the best` } } } },
  });
}

function showSure(state) {
  const list = state.candidates.slice(0, -1), whole = state.end.charAt(0).toUpperCase() + state.end.slice(1) + '.';
  if (ranking.scored) {
    rowsChart('ahead', list.map((c, i) => Object.assign({}, c, { name: `${brief(c)} over ${brief(state.candidates[i + 1])}`, file: '' })), {
      data: list.map((c) => 100 * c.ahead_of_next.value), interval: list.map((c) => [100 * c.ahead_of_next.low, 100 * c.ahead_of_next.high]),
      text: list.map((c) => `${percent(c.ahead_of_next.value)} % [${percent(c.ahead_of_next.low)}, ${percent(c.ahead_of_next.high)}], p(ahead) ${likely(c.p_ahead)}` + (c.tied_with_next ? ': tie' : '')),
    }, 'lead over the next [% of the score]');
  }
  $('skins').textContent = `${whole} ${state.skins} ${ranking.felt ? 'patches of skin' : 'arrangements'} were tried` + (state.skins < state.equal_skins ? `, more where two candidates are close; ${state.equal_skins} with as many for every candidate.` : '.')
    + (!ranking.felt ? ' What is ranked is seen and not felt: neither the finger nor belief about it is in it.'
      : !ranking.parameters ? ' What is not known of finger and model is in no interval and no probability.'
      : ' Every interval and probability holds the model part, what ' + (ranking.parameters.members ? 'belief about finger and model' : 'the fit of the finger') + ' leaves open, which moves candidates together as far as they are alike' + (ranking.scored ? ': of the leads ' + list.map((c) => '±' + percent(1.96 * c.ahead_of_next.parameters)).join(', ') + ' %.' : '.'));
}

function showCompared() {
  const box = $('pictures'), designs = data.candidates;
  designs.forEach((d, i) => {
    const figure = document.createElement('figure'), canvas = document.createElement('canvas'), caption = document.createElement('figcaption');
    canvas.className = 'map';
    caption.textContent = d.name + ': height' + (d.shown ? ', ' + d.shown : '');
    figure.append(canvas, caption);
    box.appendChild(figure);
    drawMap(canvas, d.heights, 'nm', 1e9);
  });
  const values = designs.map((d) => new Map(['texture', 'surface', 'environment', 'drive', 'finger'].flatMap((s) => sectionOf(d.toml, s).map(([k, v]) => [s + ': ' + k, v]))));
  const keys = [...new Set(values.flatMap((m) => [...m.keys()]))];
  const differ = keys.filter((k) => new Set(values.map((m) => m.get(k))).size > 1);
  table($('differences'), ['differs'].concat(designs.map((d) => d.name)), differ.map((k) => [k].concat(values.map((m) => m.get(k) || '–'))));
  const alike = ['finger: load', 'finger: state', 'surface: contact angle', 'surface: modulus', 'environment: relative humidity', 'drive: amplitude', 'texture: patch'].filter((k) => keys.includes(k) && !differ.includes(k));
  $('common').textContent = (alike.length ? `The same in all: ${alike.map((k) => k.split(': ')[1] + ' ' + values[0].get(k)).join(', ')}, and ` : '') + `${keys.length - differ.length - alike.length} more values of texture, surface, finger, environment and drive; the folder designs/ holds them.`;
  (ranking.scans || []).forEach((scan) => { $('scans').appendChild(document.createElement('li')).textContent = scan + '.'; });
}

function select(index) {
  const state = ranking.states[+index], list = state.candidates, first = list.filter((c) => c.rank === 1), names = first.map((c) => c.name);
  document.documentElement.dataset.state = state.state;
  const who = ranking.felt ? `On the ${state.state} finger ` : 'By looks alone ';
  if (!ranking.scored) {
    const bests = ranking.criteria.map((k) => { const c = list.reduce((a, o) => o.p_best_by[k.metric] > a.p_best_by[k.metric] ? o : a); return `${c.name} in ${k.metric} (probability ${likely(c.p_best_by[k.metric])})`; });
    $('lead').textContent = who + (names.length > 1 ? `no weights settle the trade-off: nobody beats ${listed(names)}.` : `${names[0]} is beaten by nobody, and all others are.`) + ' Best: ' + listed(bests) + '.';
  } else if (names.length > 1) {
    $('lead').textContent = who + `nobody is ahead of ${listed(names)} beyond doubt; ${names[0]} is best with a probability of ${likely(first[0].p_best)}.`;
  } else {
    $('lead').textContent = who + `${names[0]} is best, with a probability of ${likely(first[0].p_best)}; it leads ${list[1].name} by ${percent(first[0].ahead_of_next.value)} % [${percent(first[0].ahead_of_next.low)}, ${percent(first[0].ahead_of_next.high)}] of the score.`;
  }
  (ranking.scored ? showScore : showDominance)(list);
  showCriteria(list);
  showSure(state);
}

if ((ranking.conditions_differ || []).length) $('conditions').textContent = 'Warning: the candidates are not judged under the same conditions, and the order is that of surface and conditions together: ' + ranking.conditions_differ.map((d) => `${d.key} (${d.designs.map((name, i) => `${name}: ${d.values[i]}`).join(', ')})`).join('; ') + '.';
(ranking.notes || []).forEach((note) => { $('remarks').appendChild(document.createElement('li')).textContent = note.charAt(0).toUpperCase() + note.slice(1) + '.'; });
options($('finger'), ranking.states.map((s, i) => [i, s.state]), select);
select(0);
showCompared();
finish({ select });

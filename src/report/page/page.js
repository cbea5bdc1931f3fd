// What every page has: numbers, tables, maps, charts, the list of files.
const data = JSON.parse(document.getElementById('data').textContent);
const $ = (id) => document.getElementById(id);
// Colours of the page in the light or the dark that the reader has chosen.
const dark = matchMedia('(prefers-color-scheme: dark)').matches && !matchMedia('print').matches;
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const colours = dark ? ['#5fb0e0', '#f0955b', '#7cc488', '#bb9bdf', '#dfbc58', '#a9b0ba'] : ['#1f6f9f', '#c2571a', '#3a7d44', '#7a4fa3', '#8f6d0c', '#6f757e'];
const faint = dark ? { flat: '#c3c9d2', dominated: '#9a86b3', searched: '#77808d' } : { flat: '#565c66', dominated: '#9a7fb5', searched: '#8a94a3' };
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => location.reload());
const charts = {};

// ---- numbers and tables ----
const round = (v, digits = 3) => v === null || v === undefined || !isFinite(v) ? '–' : String(+v.toPrecision(digits) + 0);
// "640 ± 130": both as far as the second digit of the error.
function withBar(value, error) {
  if (!(error > 0) || !isFinite(error) || !isFinite(value)) return `${round(value, 4)} ± ${round(error, 2)}`;
  const shown = +error.toPrecision(2), decimals = 1 - Math.floor(Math.log10(shown) + 1e-9), step = Math.pow(10, -decimals);
  const text = (v) => decimals < 0 ? String(Math.round(v / step) * step) : v.toFixed(Math.min(decimals, 12));
  return `${text(value)} ± ${text(shown)}`;
}
// Three decimals; a zero has no sign.
const fixed = (v) => v.toFixed(3).replace(/^-(0\.000)$/, '$1');
const withError = (q) => q ? fixed(q.value) + (q.se !== undefined && q.se !== null ? ' ± ' + q.se.toFixed(3) : '') + (q.parameters ? ' (' + q.parameters.toFixed(3) + ')' : '') : '–';
function csv(text) {
  const rows = text.trim().split('\n').map((line) => line.split(','));
  const head = rows.shift();
  return rows.map((row) => Object.fromEntries(head.map((name, i) => [name, row[i]])));
}
function cell(row, tag, text, number) {
  const c = document.createElement(tag);
  c.textContent = text;
  if (number) c.className = 'number';
  row.appendChild(c);
}
function table(element, head, rows, numeric = []) {
  element.textContent = '';
  if (head) {
    const row = element.createTHead().insertRow();
    head.forEach((text, i) => cell(row, 'th', text, numeric.includes(i)));
  }
  element.classList.toggle('folds', Boolean(head));
  const body = element.createTBody();
  rows.forEach((values) => {
    const row = body.insertRow();
    values.forEach((text, i) => {
      cell(row, 'td', text, numeric.includes(i));
      // Where a heading may break beside a card's cell.
      if (head) row.lastChild.dataset.label = head[i].replace(/([(._])/g, '$1\u200b');
    });
  });
  return body;
}
function options(select, names, change) {
  names.forEach(([value, text]) => select.add(new Option(text, value)));
  select.addEventListener('change', () => change(select.value));
}

// ---- pictures of maps: colours, scale bar, range ----
// Five anchors of a perceptually even scale, dark to bright.
const anchors = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
function colour(t) {
  const x = Math.min(Math.max(t, 0), 1) * 4, i = Math.min(Math.floor(x), 3), f = x - i;
  return anchors[i].map((a, k) => Math.round(a + f * (anchors[i + 1][k] - a)));
}
function decode(map) {
  if (!map.values) {
    const bytes = atob(map.bytes), span = (map.high - map.low) / 255;
    map.values = new Float64Array(map.nx * map.ny);
    for (let i = 0; i < map.values.length; ++i) map.values[i] = map.low + bytes.charCodeAt(i) * span;
  }
  return map.values;
}
function roundLength(limit) {
  const power = Math.pow(10, Math.floor(Math.log10(limit)));
  return power * (limit >= 5 * power ? 5 : limit >= 2 * power ? 2 : 1);
}
const micrometres = (m) => m >= 1e-6 ? round(m * 1e6) + ' µm' : round(m * 1e9) + ' nm';
// root: colours by the square root above the least value, for maps that are nearly all zero.
function drawMap(canvas, map, unit, scale, line, root) {
  const values = decode(map), side = 480, height = Math.round(side * map.ly / map.lx);
  canvas.width = side;
  canvas.height = height + 46;
  const pixels = document.createElement('canvas');
  pixels.width = map.nx;
  pixels.height = map.ny;
  const image = new ImageData(map.nx, map.ny), span = map.high - map.low;
  for (let i = 0; i < values.length; ++i) {
    const share = span > 0 ? (values[i] - map.low) / span : map.low === 0 ? 0 : 0.5, rgb = colour(root ? Math.sqrt(share) : share);
    image.data.set([rgb[0], rgb[1], rgb[2], 255], 4 * i);
  }
  pixels.getContext('2d').putImageData(image, 0, 0);
  const c = canvas.getContext('2d');
  c.fillStyle = ink('paper');
  c.fillRect(0, 0, canvas.width, canvas.height);
  c.imageSmoothingEnabled = false;
  c.drawImage(pixels, 0, 0, side, height);
  if (line !== undefined) {
    c.strokeStyle = '#fff';
    c.setLineDash([8, 6]);
    c.beginPath();
    c.moveTo(0, (line + 0.5) / map.ny * height);
    c.lineTo(side, (line + 0.5) / map.ny * height);
    c.stroke();
    c.setLineDash([]);
  }
  const bar = roundLength(map.lx / 3), width = bar / map.lx * side;
  c.fillStyle = ink('ink');
  c.fillRect(2, height + 12, width, 5);
  c.font = '17px sans-serif';
  c.textBaseline = 'alphabetic';
  c.fillText(micrometres(bar), 2, height + 38);
  for (let x = 0; x < 170; ++x) {
    const rgb = colour(root ? Math.sqrt(x / 169) : x / 169);
    c.fillStyle = `rgb(${rgb.join()})`;
    c.fillRect(side - 172 + x, height + 9, 1, 10);
  }
  c.fillStyle = ink('ink');
  c.textAlign = 'left';
  c.fillText(round(map.low * scale), side - 172, height + 38);
  c.textAlign = 'right';
  c.fillText(round(map.high * scale) + ' ' + unit, side - 2, height + 38);
  c.textAlign = 'left';
  canvas.onmousemove = (event) => {
    const x = Math.floor(event.offsetX / canvas.clientWidth * map.nx);
    const y = Math.floor(event.offsetY / canvas.clientHeight * canvas.height / height * map.ny);
    canvas.title = x >= 0 && x < map.nx && y >= 0 && y < map.ny
      ? `${round(values[y * map.nx + x] * scale)} ${unit} at ${micrometres((x + 0.5) * map.lx / map.nx)}, ${micrometres((y + 0.5) * map.ly / map.ny)}` : '';
  };
}

// ---- charts ----
Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
Chart.defaults.font.size = 13;
Chart.defaults.color = ink('soft');
Chart.defaults.borderColor = ink('line');
Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;
const axis = (text, more = {}) => Object.assign({ title: { display: true, text } }, more);
function draw(id, config) {
  if (charts[id]) charts[id].destroy();
  charts[id] = new Chart($(id), config);
}
// Error bars of points with ex, ey.
const errorBars = {
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
const intervals = {
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
function around(points, at, half) {
  const ends = points.filter((p) => isFinite(p[at])).flatMap((p) => [p[at] - (p[half] || 0), p[at] + (p[half] || 0)]);
  const low = Math.min(...ends), high = Math.max(...ends), gap = 0.04 * (high - low || Math.abs(high) || 1);
  return ends.length ? { suggestedMin: low - gap, suggestedMax: high + gap } : {};
}
// Room for the intervals of all datasets, and for the values `more`, on a value axis.
function room(sets, more = []) {
  const all = sets.flatMap((s) => (s.interval || []).filter(Boolean).flat().concat(s.data.map((d) => typeof d === 'number' ? d : d.x))).concat(more).filter(isFinite);
  const low = Math.min(...all), high = Math.max(...all), gap = 0.04 * (high - low || 1);
  return { suggestedMin: low < 0 ? low - gap : Math.min(low, 0), suggestedMax: high + gap };
}
function canvasIn(box, id, className, note) {
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

// ---- texts of design files ----
// "um" as people write it; keys and values of one section.
function sectionOf(toml, name) {
  const text = ('\n' + toml).split(`\n[${name}]`)[1] || '';
  return text.split(/\n\[/)[0].split('\n').map((l) => /^(\w+) = (.*)$/.exec(l)).filter(Boolean).map((m) => {
    const value = m[2].replace(/"/g, ''), q = /^(-?[\d.e+-]+) (.*)$/.exec(value);
    return [m[1].replace(/_/g, ' '), q ? round(+q[1], 4) + ' ' + q[2].replace('um', 'µm').replace('deg', '°') : value];
  });
}
// The largest of some SI values decides the prefix: { scale, unit }.
function prefix(unit, values) {
  const largest = Math.max(...values.map(Math.abs).filter(isFinite), 0);
  if (unit === 'm/Pa') return { scale: 1e12, unit: 'µm/MPa' };
  if (!['N', 'm', 'Pa', 'V', 's', 'J', 'm/s'].includes(unit) || !largest) return { scale: 1, unit };
  const steps = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n']];
  const [size, letter] = steps.find(([s]) => largest >= s) || steps[steps.length - 1];
  return { scale: 1 / size, unit: letter + unit };
}

// ---- the end of every page ----
// Names for those who hear the page or walk it by keys.
function nameParts() {
  document.querySelectorAll('canvas').forEach((canvas) => {
    const figure = canvas.closest('figure'), caption = figure && figure.querySelector('figcaption'), heading = canvas.closest('section') && canvas.closest('section').querySelector('h2');
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', (caption && caption.textContent) || (heading && heading.textContent) || 'chart');
  });
  document.querySelectorAll('.scroll').forEach((box) => {
    const heading = box.closest('section') && box.closest('section').querySelector('h2');
    box.tabIndex = 0;
    box.setAttribute('role', 'region');
    box.setAttribute('aria-label', heading ? heading.textContent : 'table');
  });
}
function finish(more = {}) {
  nameParts();
  $('version').textContent = data.version;
  table($('filelist'), ['File', 'Bytes', 'SHA-256'], data.files.map((f) => [f.name, f.bytes.toLocaleString('en'), f.sha256]), [1]);
  window.addEventListener('beforeprint', () => { Object.values(charts).forEach((c) => c.resize()); });
  window.papilla = Object.assign({ charts }, more);
  document.documentElement.dataset.charts = Object.keys(charts).length;
}

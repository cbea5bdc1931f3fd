// The texture at hand: in three dimensions, from above, in section, and inside its contact.
import { $ } from '../plots/look.js';
import { charts, draw } from '../plots/charts.js';
import { alongLine } from '../plots/curves.js';
import { drawMap, heightLine, mapFigures, sectionRow } from '../plots/maps.js';
import { level, micrometres, round } from '../plots/numbers.js';
import { showSolid, startSolid } from '../plots/solid.js';
import { called, people, unanswered } from './form.js';
import { post } from './server.js';
import { takeableMap } from './take.js';

const state = { revision: 0, look: 0, shown: { revision: -1, humidity: '' }, timer: 0, busy: false };

export function startScene() {
  startSolid();
  $('inside').addEventListener('toggle', fetchMaps);
  $('rh').addEventListener('change', fetchMaps);
}

// Curves come first: the picture of a texture that moves waits until no answer is waited for, though not for long; where
// drawing is slow (no graphics processor), so long that it takes a thirtieth of the time.
const waiting = { shape: null, timer: 0, since: 0, drawing: 0 }, still = 120;
export function showShape(shape) {
  if (!waiting.shape) waiting.since = performance.now();
  waiting.shape = shape;
  clearTimeout(waiting.timer);
  waiting.timer = setTimeout(drawWhenStill, still);
}
function drawWhenStill() {
  if (unanswered() && performance.now() < waiting.since + Math.max(400, 30 * waiting.drawing)) waiting.timer = setTimeout(drawWhenStill, still);
  else drawShape();
}
function drawShape() {
  const begun = performance.now();
  requestAnimationFrame(() => setTimeout(() => { waiting.drawing = performance.now() - begun; }));
  const shape = waiting.shape, map = shape.heights, row = sectionRow(map, shape.section), line = heightLine(map, shape.section, row);
  waiting.shape = null;
  showSolid(map);
  drawMap($('top'), map, 'nm', 1e9, row);
  showMargins(shape.margins);
  const config = alongLine(line, map.lx * 1e6, shape.measures);
  if (charts.section) {
    Object.assign(charts.section, { data: config.data, options: config.options });
    charts.section.update('none');
  } else {
    draw('section', config);
  }
  document.documentElement.dataset.shape = shape.revision;
}

function facts(box, rows) {
  const now = JSON.stringify(rows);
  if (box.dataset.facts === now) return;
  box.dataset.facts = now;
  box.textContent = '';
  rows.filter(Boolean).forEach(([name, value, over]) => {
    const item = document.createElement('li'), key = document.createElement('span');
    key.textContent = name;
    item.append(key, value);
    if (over) item.className = 'over';
    box.append(item);
  });
}

export function showDimensions(session) {
  facts($('dimensions'), session.keys.filter((k) => k.path.startsWith('texture.') && k.type === 'number').map((k) => [called(k.path), people(k.value)]));
  const humidities = (session.keys.find((k) => k.path === 'environment.relative_humidity') || { value: '' }).value.split(',').map((t) => parseFloat(t)).filter(isFinite);
  const select = $('rh'), now = humidities.join();
  if (select.dataset.list !== now) {
    select.dataset.list = now;
    select.textContent = '';
    humidities.forEach((h) => select.add(new Option(`${round(h)} %`, h / 100)));
    if (humidities.length > 1) select.selectedIndex = Math.floor(humidities.length / 2);
  }
  state.revision = session.revision;
  markLook();
  fetchWhenStill();
}

// The maps may be of an earlier design, or of another humidity than is chosen.
const mapsAtHand = () => state.shown.revision >= state.revision && state.shown.humidity === $('rh').value;
const markMaps = () => $('maps').classList.toggle('stale', !mapsAtHand());
function fetchWhenStill() {
  markMaps();
  clearTimeout(state.timer);
  state.timer = setTimeout(fetchMaps, 700);
}
// One patch with its fields, when the hand rests and somebody looks.
async function fetchMaps() {
  markMaps();
  if (!$('inside').open || state.busy || mapsAtHand()) return;
  const revision = state.revision, humidity = $('rh').value;
  state.busy = true;
  try {
    const answer = await post('maps', { humidity: +humidity });
    mapFigures($('maps'), answer.maps);
    $('maps').querySelectorAll('canvas').forEach((c) => {
      c.setAttribute('role', 'img');
      c.setAttribute('aria-label', c.nextSibling.textContent);
      takeableMap(c, c.nextSibling.textContent.replace(/ *[[,].*/, ''));
    });
    state.shown = { revision: answer.revision, humidity };
  } catch (error) {
    $('maps').textContent = error.message;
    state.shown.revision = -1;
  }
  state.busy = false;
  const moved = revision !== state.revision || humidity !== $('rh').value;  // meanwhile
  if (moved && !mapsAtHand()) fetchWhenStill();
  else $('maps').classList.remove('stale');
}

// The look is worked out while nothing moves: until then it is of an earlier design.
const markLook = () => $('look').classList.toggle('stale', state.look < state.revision);
export function showLook(look) {
  const share = (v) => v === null ? '–' : round(100 * v, 3) + ' %';
  state.look = look.revision;
  markLook();
  facts($('look'), [
    ['haze', share(look.haze)],
    ['transmittance', share(look.transmittance) + ', ' + share(look.total_transmittance) + ' in all'],
    ['gloss 60°', look.gloss === null ? '–' : round(look.gloss, 3) + ' GU'],
    ['distinctness of image', share(look.distinctness)],
    look.sparkle ? ['sparkle', share(look.sparkle)] : null,
    look.colour_shift === null ? null : ['colour shift', round(level(look.colour_shift, 1), 2)],
    look.warning ? ['', people(look.warning), true] : null,
  ]);
}
// What has to be made of the shape; of a stack each part alone.
export function showMargins(margins) {
  const whose = margins.of_parts ? ' of a part' : '';
  facts($('making'), [
    margins.min_hole === null ? null : [`smallest hole${whose}`, micrometres(margins.min_hole)],
    margins.min_wall === null ? null : [`smallest wall${whose}`, micrometres(margins.min_wall)],
    margins.aspect_ratio ? [`aspect ratio${whose}`, round(margins.aspect_ratio, 3)] : null,
  ]);
}

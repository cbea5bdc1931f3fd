// Pictures of maps: colours, scale bar, range.
import { ink } from './look.js';
import { level, micrometres, round, roundLength } from './numbers.js';
// Five anchors of a perceptually even scale, dark to bright.
export const anchors = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
export function colour(t) {
  const x = Math.min(Math.max(t, 0), 1) * 4, i = Math.min(Math.floor(x), 3), f = x - i;
  return anchors[i].map((a, k) => Math.round(a + f * (anchors[i + 1][k] - a)));
}
export function decode(map) {
  if (!map.values) {
    const bytes = atob(map.bytes), span = (map.high - map.low) / 255;
    map.values = new Float64Array(map.nx * map.ny);
    for (let i = 0; i < map.values.length; ++i) map.values[i] = map.low + bytes.charCodeAt(i) * span;
  }
  return map.values;
}
// Rows of a map go up from the lowest y, those of a picture down from its top.
const topDown = (map, y) => map.ny - 1 - y;
// Its pixels, one each, coloured by `share` of a value: 0 to 1.
export function pixelsOf(map, share) {
  const values = decode(map), image = new ImageData(map.nx, map.ny);
  for (let y = 0; y < map.ny; ++y) {
    for (let x = 0; x < map.nx; ++x) image.data.set([...colour(share(values[topDown(map, y) * map.nx + x])), 255], 4 * (y * map.nx + x));
  }
  return image;
}
// root: colours by the square root above the least value, for maps that are nearly all zero. The canvas keeps how it is
// painted, for another kind of picture, and the map, for its numbers.
export function drawMap(canvas, map, unit, scale, line, root) {
  const side = 480, height = Math.round(side * map.ly / map.lx);
  canvas.width = side;
  canvas.height = height + 46;
  const most = Math.max(Math.abs(map.low), Math.abs(map.high)), values = decode(map), said = (v) => round(level(v, most) * scale);
  canvas.$map = { map, unit, scale };
  canvas.$paint = (c) => paint(c, { map, unit, line, root, side, height, said });
  canvas.$paint(canvas.getContext('2d'));
  canvas.onmousemove = (event) => {
    const x = Math.floor(event.offsetX / canvas.clientWidth * map.nx);
    const y = topDown(map, Math.floor(event.offsetY / canvas.clientHeight * canvas.height / height * map.ny));
    canvas.title = x >= 0 && x < map.nx && y >= 0 && y < map.ny
      ? `${said(values[y * map.nx + x])} ${unit} at ${micrometres((x + 0.5) * map.lx / map.nx)}, ${micrometres((y + 0.5) * map.ly / map.ny)}` : '';
  };
}
function paint(c, { map, unit, line, root, side, height, said }) {
  const pixels = document.createElement('canvas');
  pixels.width = map.nx;
  pixels.height = map.ny;
  const span = map.high - map.low, eased = (share) => (root ? Math.sqrt(share) : share);
  pixels.getContext('2d').putImageData(pixelsOf(map, (v) => eased(span > 0 ? (v - map.low) / span : map.low === 0 ? 0 : 0.5)), 0, 0);
  c.fillStyle = ink('paper');
  c.fillRect(0, 0, side, height + 46);
  c.imageSmoothingEnabled = false;
  c.drawImage(pixels, 0, 0, side, height);
  if (line !== undefined) {
    c.strokeStyle = '#fff';
    c.setLineDash([8, 6]);
    c.beginPath();
    const down = (topDown(map, line) + 0.5) / map.ny * height;
    c.moveTo(0, down);
    c.lineTo(side, down);
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
    const rgb = colour(eased(x / 169));
    c.fillStyle = `rgb(${rgb.join()})`;
    c.fillRect(side - 172 + x, height + 9, 1, 10);
  }
  c.fillStyle = ink('ink');
  c.textAlign = 'left';
  c.fillText(said(map.low), side - 172, height + 38);
  c.textAlign = 'right';
  c.fillText(said(map.high) + ' ' + unit, side - 2, height + 38);
  c.textAlign = 'left';
}
// Each map as a figure with its name.
export function mapFigures(box, maps) {
  box.textContent = '';
  maps.forEach((map) => {
    const figure = document.createElement('figure'), canvas = document.createElement('canvas'), caption = document.createElement('figcaption');
    canvas.className = 'map';
    caption.textContent = map.name + (map.unit ? ' [' + map.unit + ']' : '');
    figure.append(canvas, caption);
    box.appendChild(figure);
    const root = map.name.includes('pressure');
    if (root) caption.textContent += ', colours by the square root';
    drawMap(canvas, map, map.unit, 1, undefined, root);
  });
}
// The row of a map of heights that a section is of; without one, of the rows that reach over nearly all the heights that some
// row does, the one that is farthest from the level ground of the flattest row: through the middle of holes and of particles.
export function sectionRow(map, section) {
  if (section) return Math.min(map.ny - 1, Math.floor(section.at * map.ny));
  const values = decode(map), rows = Array.from({ length: map.ny }, (_, y) => values.subarray(y * map.nx, (y + 1) * map.nx));
  const spans = rows.map((row) => Math.max(...row) - Math.min(...row)), nearly = 0.9 * Math.max(...spans);
  const ground = rows[spans.indexOf(Math.min(...spans))].slice().sort()[map.nx >> 1];
  const away = rows.map((row, y) => spans[y] < nearly ? -1 : row.reduce((sum, v) => sum + Math.abs(v - ground), 0));
  // Rows through like features are equal but for rounding: the first of them, so that the line stays as the design moves.
  const most = Math.max(...away) - 1e-6 * map.nx * (map.high - map.low);
  return away.findIndex((v) => v >= most);
}
// Heights along a line [µm, nm]: through the middle of a feature on its own fine pixels where there is such a section, else
// along a row of the map.
export function heightLine(map, section, row) {
  const fine = section && decode(section), values = decode(map), n = fine ? section.nx : map.nx, line = [];
  for (let x = 0; x < n; ++x) line.push({ x: (x + 0.5) * map.lx / n * 1e6, y: (fine ? fine[x] : values[row * map.nx + x]) * 1e9 });
  return line;
}

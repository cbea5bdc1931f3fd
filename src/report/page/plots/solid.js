// The turnable texture.
import { $, ink } from './look.js';
import { colour, decode } from './maps.js';
import { micrometres, round, roundLength } from './numbers.js';
export const solid = { ready: false, radius: 1.13, zoom: 1, stretch: 0, section: 0 };  // stretch 0: as the heights ask for; section: what of the width is cut away
export function startSolid() {
  const box = $('solid');
  const draws = (how) => document.createElement('canvas').getContext('webgl', how);
  if (!draws()) {
    const p = document.createElement('p');
    p.textContent = 'This browser draws no 3-D graphics; the picture from above shows the same heights.';
    box.appendChild(p);
    return;
  }
  // Without a graphics processor smooth edges take longer than all the rest.
  const antialias = Boolean(draws({ failIfMajorPerformanceCaveat: true }));
  solid.renderer = new THREE.WebGLRenderer({ antialias, preserveDrawingBuffer: true });
  solid.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  solid.renderer.domElement.setAttribute('aria-hidden', 'true');
  box.appendChild(solid.renderer.domElement);
  solid.scene = new THREE.Scene();
  solid.camera = new THREE.PerspectiveCamera(32, 1, 0.1, 20);
  solid.scene.add(new THREE.AmbientLight(0xffffff, 0.45));
  const light = new THREE.DirectionalLight(0xffffff, 0.75);
  light.position.set(1.2, 2, 0.6);
  solid.scene.add(light);
  solid.turn = new THREE.Group();
  solid.tilt = new THREE.Group();
  solid.tilt.add(solid.turn);
  solid.scene.add(solid.tilt);
  solid.turn.rotation.y = 0.5;
  let from = null;
  box.addEventListener('pointerdown', (e) => { from = [e.clientX, e.clientY]; box.setPointerCapture(e.pointerId); });
  box.addEventListener('pointermove', (e) => {
    if (!from) return;
    turnBy((e.clientX - from[0]) * 0.01, (e.clientY - from[1]) * 0.006);
    from = [e.clientX, e.clientY];
  });
  ['pointerup', 'pointercancel'].forEach((name) => box.addEventListener(name, () => { from = null; }));
  box.tabIndex = 0;
  box.setAttribute('role', 'img');
  box.setAttribute('aria-label', 'The texture in three dimensions; arrow keys turn it, plus and minus bring it nearer');
  box.addEventListener('keydown', (e) => {
    if (e.key === '+' || e.key === '-') { e.preventDefault(); zoomBy(e.key === '+' ? 1.25 : 0.8); return; }
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[e.key];
    if (!turn) return;
    e.preventDefault();
    turnBy(...turn);
  });
  // The page scrolls under the wheel, unless Control is held or the solid has been selected.
  box.addEventListener('wheel', (e) => { if (e.ctrlKey || document.activeElement === box) { e.preventDefault(); zoomBy(Math.exp(-0.002 * e.deltaY)); } }, { passive: false });
  window.addEventListener('resize', render);
  solid.tools = tools(box);
  solid.ready = true;
}
// Stretch, section and the step of the ticks below the picture.
function tools(box) {
  const row = document.createElement('div'), ticks = document.createElement('span');
  row.className = 'solidtools';
  const slider = (text, max, work) => {
    const label = document.createElement('label'), range = document.createElement('input');
    Object.assign(range, { type: 'range', min: 0, max, value: 0 });
    range.addEventListener('input', () => { work(+range.value); if (solid.map) showSolid(solid.map); });
    label.append(text, range);
    row.append(label);
    return range;
  };
  const stretch = slider('stretch', 300, (v) => { solid.stretch = Math.max(1, +Math.pow(10, v / 100).toPrecision(2)); });
  slider('section', 95, (v) => { solid.section = v / 100; });
  row.append(ticks);
  box.after(row);
  return { stretch, ticks };
}
function zoomBy(factor) {
  solid.zoom = Math.min(8, Math.max(0.5, solid.zoom * factor));
  render();
}
function turnBy(around, over) {
  solid.turn.rotation.y += around;
  solid.tilt.rotation.x = Math.min(0.7, Math.max(-0.7, solid.tilt.rotation.x + over));
  render();
}
export function render() {
  if (!solid.ready) return;
  const box = $('solid'), w = box.clientWidth, h = box.clientHeight;
  const drawn = solid.renderer.getSize(new THREE.Vector2());
  if (drawn.x !== w || drawn.y !== h) solid.renderer.setSize(w, h);  // which clears its buffers
  solid.camera.aspect = w / h;
  // As far off as the texture fits in, however it is turned: its corners go round in a circle.
  const away = solid.radius / solid.zoom / (Math.tan(solid.camera.fov / 2 * Math.PI / 180) * Math.min(1, w / h));
  solid.camera.position.set(0, 0.614 * away, 0.789 * away);
  solid.camera.lookAt(0, -0.05, 0);
  solid.camera.updateProjectionMatrix();
  solid.renderer.render(solid.scene, solid.camera);
}
// The stretch that a hand has set stays; otherwise heights are made an eighth of the width.
const chosenStretch = (map, span) => solid.stretch || (span > 0 ? Math.min(Math.max(roundLength(0.12 * map.lx / span), 1), 1000) : 1);
function clear() {
  while (solid.turn.children.length) {
    const old = solid.turn.children[0];
    solid.turn.remove(old);
    if (old.isSprite) continue;  // words are kept
    old.geometry.dispose();
    old.material.dispose();
  }
}
// Words that face the eye; each is painted once a colour.
const written = new Map();
function write(text, at) {
  const tint = ink('ink'), key = `${tint} ${text}`;
  if (!written.has(key)) {
    const canvas = document.createElement('canvas'), c = canvas.getContext('2d');
    [canvas.width, canvas.height] = [256, 64];
    Object.assign(c, { font: '36px sans-serif', textAlign: 'center', textBaseline: 'middle', fillStyle: tint });
    c.fillText(text, 128, 32);
    written.set(key, new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false }));
  }
  const word = new THREE.Sprite(written.get(key));
  word.position.set(...at);
  word.scale.set(0.56, 0.14, 1);
  solid.turn.add(word);
}
// Along the front, which the section moves, and the left side, ticks at a round length; at the right corner the whole
// height, which is stretched.
function axes(map, unit, tick, base, front, span, stretch) {
  const [right, lowest] = [map.lx * unit / 2, map.ly * unit / 2], back = -lowest, out = 0.05, lines = [[-right, base, front, right, base, front], [-right, base, back, -right, base, front]];
  for (let at = 0; at <= map.lx * (1 + 1e-9); at += tick) {
    lines.push([at * unit - right, base, front, at * unit - right, base, front + out]);
    write(at ? micrometres(at) : '0', [at * unit - right, base, front + 0.16]);
  }
  for (let at = tick; at <= map.ly * (1 + 1e-9); at += tick) {
    const z = lowest - at * unit;
    if (z > front + 1e-9) continue;  // cut away
    lines.push([-right, base, z, -right - out, base, z]);
    write(micrometres(at), [-right - 0.22, base, z]);
  }
  if (span > 0) {
    const low = -span * stretch * unit;
    lines.push([right, low, front, right, 0, front], [right + out, low, front, right, low, front], [right + out, 0, front, right, 0, front]);
    write(micrometres(span), [right + 0.24, low / 2, front]);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(lines.flat(), 3));
  solid.turn.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: new THREE.Color(ink('ink')) })));
}
function mesh(positions, tints, index, sides) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute('color', new THREE.Float32BufferAttribute(tints, 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(index), 1));
  geometry.computeVertexNormals();
  solid.turn.add(new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide, flatShading: sides })));
}
// A block with the texture on top, its lowest y in front, where the section cuts; its sides go down to below the deepest place.
export function showSolid(map) {
  const values = decode(map), span = map.high - map.low, stretch = chosenStretch(map, span);
  solid.map = map;
  $('stretch').textContent = round(stretch);
  if (!solid.ready) return;
  solid.tools.stretch.value = Math.round(100 * Math.log10(stretch));
  solid.renderer.setClearColor(ink('tint'));  // of the light or the dark of now
  clear();
  const { nx, ny } = map, unit = 1.6 / Math.max(map.lx, map.ly), first = Math.min(ny - 2, Math.round(solid.section * (ny - 1)));
  const at = (x, y, z) => [((x + 0.5) / nx - 0.5) * map.lx * unit, z, (0.5 - (y + 0.5) / ny) * map.ly * unit];
  const height = (x, y) => (values[y * nx + x] - map.high) * stretch * unit, base = -(span * stretch * unit + 0.12);
  const positions = [], tints = [], index = [];
  for (let y = first; y < ny; ++y) {
    for (let x = 0; x < nx; ++x) {
      positions.push(...at(x, y, height(x, y)));
      colour(span > 0 ? (values[y * nx + x] - map.low) / span : 0.5).forEach((v) => tints.push(v / 255));
      if (x + 1 < nx && y + 1 < ny) {
        const a = (y - first) * nx + x;
        index.push(a, a + 1, a + nx, a + 1, a + nx + 1, a + nx);
      }
    }
  }
  mesh(positions, tints, index, false);
  const wall = { positions: [], tints: [], index: [] };
  const side = (places) => {
    const from = wall.positions.length / 3;
    places.forEach(([x, y], i) => {
      wall.positions.push(...at(x, y, height(x, y)), ...at(x, y, base));
      wall.tints.push(0.62, 0.65, 0.7, 0.5, 0.53, 0.58);
      if (i) { const a = from + 2 * i; wall.index.push(a - 2, a - 1, a, a, a - 1, a + 1); }
    });
  };
  const across = [...Array(nx).keys()], along = [...Array(ny - first).keys()].map((y) => y + first);
  side(across.map((x) => [x, first]));
  side(across.map((x) => [x, ny - 1]));
  side(along.map((y) => [0, y]));
  side(along.map((y) => [nx - 1, y]));
  mesh(wall.positions, wall.tints, wall.index, true);
  const tick = roundLength(map.lx / 2);
  axes(map, unit, tick, base, at(0, first, 0)[2], span, stretch);
  solid.tools.ticks.textContent = `ticks ${micrometres(tick)}`;
  solid.radius = 0.5 * unit * Math.hypot(map.lx, map.ly) + 0.2;  // with the words beside it
  render();
}

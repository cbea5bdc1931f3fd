// The turnable texture.
import { $, ink } from './look.js';
import { colour, decode } from './maps.js';
import { roundLength } from './numbers.js';
export const solid = { ready: false, radius: 1.13 };
export function startSolid() {
  const box = $('solid');
  const probe = document.createElement('canvas');
  if (!(probe.getContext('webgl') || probe.getContext('experimental-webgl'))) {
    const p = document.createElement('p');
    p.textContent = 'This browser draws no 3-D graphics; the picture from above shows the same heights.';
    box.appendChild(p);
    return;
  }
  solid.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  solid.renderer.setClearColor(ink('tint'));
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
  box.setAttribute('aria-label', 'The texture in three dimensions; arrow keys turn it');
  box.addEventListener('keydown', (e) => {
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[e.key];
    if (!turn) return;
    e.preventDefault();
    turnBy(...turn);
  });
  window.addEventListener('resize', render);
  solid.ready = true;
}
function turnBy(around, over) {
  solid.turn.rotation.y += around;
  solid.tilt.rotation.x = Math.min(0.7, Math.max(-0.7, solid.tilt.rotation.x + over));
  render();
}
export function render() {
  if (!solid.ready) return;
  const box = $('solid'), w = box.clientWidth, h = box.clientHeight;
  solid.renderer.setSize(w, h);
  solid.camera.aspect = w / h;
  // As far off as the texture fits in, however it is turned: its corners go round in a circle.
  const away = solid.radius / (Math.tan(solid.camera.fov / 2 * Math.PI / 180) * Math.min(1, w / h));
  solid.camera.position.set(0, 0.614 * away, 0.789 * away);
  solid.camera.lookAt(0, -0.05, 0);
  solid.camera.updateProjectionMatrix();
  solid.renderer.render(solid.scene, solid.camera);
}
export function showSolid(map) {
  const values = decode(map), span = map.high - map.low;
  const stretch = span > 0 ? Math.min(Math.max(roundLength(0.12 * map.lx / span), 1), 1000) : 1;
  $('stretch').textContent = stretch;
  if (!solid.ready) return;
  while (solid.turn.children.length) {
    const old = solid.turn.children[0];
    solid.turn.remove(old);
    old.geometry.dispose();
    old.material.dispose();
  }
  const { nx, ny } = map, unit = 1.6 / Math.max(map.lx, map.ly), positions = [], tints = [], index = [];
  for (let y = 0; y < ny; ++y) {
    for (let x = 0; x < nx; ++x) {
      const z = values[y * nx + x];
      positions.push(((x + 0.5) / nx - 0.5) * map.lx * unit, (z - map.high) * stretch * unit, ((y + 0.5) / ny - 0.5) * map.ly * unit);
      colour(span > 0 ? (z - map.low) / span : 0.5).forEach((v) => tints.push(v / 255));
      if (x + 1 < nx && y + 1 < ny) {
        const a = y * nx + x;
        index.push(a, a + nx, a + 1, a + 1, a + nx, a + nx + 1);
      }
    }
  }
  solid.radius = 0.5 * unit * Math.hypot(map.lx, map.ly);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute('color', new THREE.Float32BufferAttribute(tints, 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(index), 1));
  geometry.computeVertexNormals();
  solid.turn.add(new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide })));
  render();
}

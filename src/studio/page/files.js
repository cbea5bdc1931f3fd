// Files: open, save, export with its verdict, and the import view of a dropped map.
import { $, colours } from '../plots/look.js';
import { axis, charts, draw } from '../plots/charts.js';
import { drawMap } from '../plots/maps.js';
import { micrometres, round } from '../plots/numbers.js';
import { table } from '../plots/tables.js';
import { called, machine, people } from './form.js';
import { get, notice, post, upload } from './server.js';
import { takeable } from './take.js';

const make = (tag, more = {}, ...children) => { const e = Object.assign(document.createElement(tag), more); e.append(...children); return e; };
const field = (label, input) => make('label', {}, label, input);
const check = (label, on = false) => { const input = make('input', { type: 'checkbox', checked: on }); return [input, make('label', { className: 'check' }, input, label)]; };

// buttons: [text, work, main]; work returns true to close.
function dialog(heading, body, buttons) {
  $('dialoghead').textContent = heading;
  $('dialogbody').replaceChildren(...body);
  const said = make('p', { className: 'note' });
  said.setAttribute('role', 'alert');
  $('dialogbody').append(said);
  const all = [['Close', () => true], ...buttons].map(([text, work, main]) => {
    const b = make('button', { type: 'button', textContent: text, className: main ? 'main' : '' });
    b.addEventListener('click', async () => {
      b.disabled = true;
      said.textContent = main ? 'working …' : '';
      try {
        if (await work(said)) $('dialog').close();
        else if (said.textContent === 'working …') said.textContent = '';
      } catch (error) {
        said.textContent = error.message;
      }
      b.disabled = false;
    });
    return b;
  });
  $('dialogtools').replaceChildren(...all);
  if (!$('dialog').open) $('dialog').showModal();
  const enter = all[all.length - 1];
  $('dialogbody').querySelectorAll('input[type=text]').forEach((i) => i.addEventListener('keydown', (e) => { if (e.key === 'Enter') { e.preventDefault(); enter.click(); } }));
  return said;
}

export async function openDialog() {
  const files = await post('files').catch((e) => { notice(e.message); return null; });
  if (!files) return;
  const list = make('select', { size: Math.min(12, Math.max(4, files.designs.length)) });
  files.designs.forEach((name) => list.add(new Option(name, name)));
  list.selectedIndex = 0;
  dialog(`Designs in ${files.folder}`, [files.designs.length ? field('Design', list) : make('p', { textContent: 'There is no design in this folder yet: save one.' })], files.designs.length ? [['Open', async () => { await post('open', { name: list.value }); return true; }, true]] : []);
}

// Every step since the file was opened, the newest on top; the one at hand is marked.
export function historyDialog(session) {
  if (!session || !session.steps.length) return;
  const list = make('select', { size: Math.min(14, session.steps.length + 1) });
  ['as it was opened', ...session.steps].forEach((text, done) => list.add(new Option(`${done === session.done ? '● ' : ''}${done}  ${people(text)}`, done), 0));
  list.value = session.done;
  dialog('History', [field('Step', list)], [['Go there', async () => { await post('history', { done: +list.value }); return true; }, true]]);
}

export const saving = { name: '' };  // under which the design at hand goes on
export function saveDialog(session) {
  const suggestion = session.in_folder ? session.file : session.file.replace(/^study/, 'design');
  const name = make('input', { type: 'text', value: suggestion, autocomplete: 'off' }), [over, overLabel] = check('overwrite a file of that name', session.in_folder);
  const changed = session.changes.map(([path, text]) => [called(path), people(text)]);
  const rows = make('table');
  table(rows, ['Changed', 'Value'], changed.length ? changed : [['nothing', '']]);
  dialog('Save the design', [field('Name', name), overLabel, rows, make('p', { className: 'note', textContent: session.in_folder ? 'The file keeps its comments; only these values change. Below its folder the new file has every value.' : 'The new file stands on the shipped one and holds the changed keys alone.' })],
    [['Save', async () => { saving.name = name.value; const { file } = await post('save', { name: name.value, overwrite: over.checked }); notice(''); document.documentElement.dataset.saved = file; return true; }, true]]);
}

export async function exportDialog(session) {
  const preview = await post('export/preview').catch((e) => { notice(e.message); return null; });
  if (!preview) return;
  const margins = make('table'), formats = make('table'), name = make('input', { type: 'text', value: `export/${session.file.replace(/\.toml$/, '').split('/').pop()}`, autocomplete: 'off' }), [over, overLabel] = check('overwrite files of that folder');
  const ratio = preview.aspect_ratio;
  table(margins, ['Margin', 'Design', 'Limit'], preview.margins.map((m) => [m.name, m.value === null ? 'none' : micrometres(m.value), m.limit === null ? '–' : micrometres(m.limit)]).concat([['aspect ratio', round(ratio.value, 3), ratio.limit === null ? '–' : round(ratio.limit, 3)]]), [1, 2]);
  table(formats, ['File', 'Holds'], preview.formats.map((f) => [f.file, f.holds]));
  dialog('Export masks and heights', [margins, field('Folder', name), overLabel, make('details', {}, make('summary', { textContent: `${preview.formats.length} files` }), formats)],
    [['Export and verify', async (said) => {
      const done = await post('export', { name: name.value, overwrite: over.checked });
      const verdict = make('p', { className: 'verdict ' + (done.sound ? 'better' : 'worse'), textContent: done.sound ? `Sound: every file of ${done.folder} agrees with the design.` : 'Not sound: read what follows.' });
      $('dialogbody').querySelectorAll('.verdict, pre').forEach((e) => e.remove());
      said.before(verdict, make('pre', { textContent: done.words }));
      document.documentElement.dataset.exported = done.sound;
      return false;
    }, true]]);
}

// ---- a map of heights ----
export async function takeScan(file) {
  try {
    const kept = await upload('scan', file.name, await file.arrayBuffer());
    await scanDialog(kept.name);
  } catch (error) {
    notice(`${file.name}: ${error.message}`);
  }
}
async function scanDialog(name) {
  const size = make('input', { type: 'text', placeholder: 'as the file says, or 12 um', autocomplete: 'off' }), channel = make('input', { type: 'text', placeholder: 'the one that holds heights', autocomplete: 'off' }), [fill, fillLabel] = check('heights that are no numbers get the mean of those around them'), [asIs, asIsLabel] = check('known, not measured: take no plane away, replace no pixel');
  const view = make('div'), asked = () => ({ name: name + (channel.value.trim() ? `::${channel.value.trim()}` : ''), size: machine(size.value), fill: fill.checked, as_is: asIs.checked });
  const look = async () => showScan(view, await post('scan/view', asked()));
  const said = dialog('A measured map', [view, field('Width', size), ...(/\.(gwy|sur)$/i.test(name) ? [field('Channel', channel)] : []), fillLabel, asIsLabel], [['Look again', async () => { await look(); return false; }], ['Use as the texture', async () => { await post('scan/use', asked()); return true; }, true]]);
  try { await look(); } catch (error) { said.textContent = error.message; }
}
function showScan(box, scan) {
  const top = make('canvas', { className: 'map' }), spectrum = make('canvas', { id: 'spectrum' }), a = scan.areal, facts = make('table'), nm = (v) => round(1e9 * v, 4) + ' nm';
  top.setAttribute('role', 'img');
  top.setAttribute('aria-label', 'The map as it is taken');
  spectrum.setAttribute('role', 'img');
  spectrum.setAttribute('aria-label', 'Spectrum of the map');
  const chart = make('figure', { className: 'chart low' }, spectrum);
  box.replaceChildren(make('p', { textContent: scan.words }), make('div', { className: 'pair' }, make('figure', {}, top), make('div', {}, facts)), chart);
  drawMap(top, scan.heights, 'nm', 1e9);
  table(facts, null, [['size', `${round(1e6 * scan.size[0], 4)} × ${round(1e6 * scan.size[1], 4)} µm`], ['pixels', scan.pixels.join(' × ')], ['tilt taken away', round(180 / Math.PI * scan.scan.tilt, 3) + ' °'], ['outliers replaced', String(scan.scan.replaced)], ['filled', String(scan.scan.filled)], ['rms height Sq', nm(a.Sq)], ['mean height Sa', nm(a.Sa)], ['rms slope Sdq', round(a.Sdq, 3)], ['known wavelengths', `${micrometres(scan.band.shortest)} to ${micrometres(scan.band.longest)}`]], [1]);
  const known = (p) => p.x >= 1e6 * scan.band.shortest * 0.999 && p.x <= 1e6 * scan.band.longest * 1.001, points = scan.spectrum.map((p) => ({ x: 1e6 * p.wavelength, y: 1e24 * p.density })).filter((p) => p.y > 0);
  delete charts.spectrum;
  takeable(spectrum, 'spectrum');
  draw('spectrum', { type: 'line', data: { datasets: [{ label: 'known', data: points.filter(known), borderColor: colours[0], backgroundColor: colours[0], pointRadius: 2 }, { label: 'beyond what the map can know', data: points.filter((p) => !known(p)), showLine: false, borderColor: colours[5], backgroundColor: colours[5], pointRadius: 2 }] }, options: { parsing: false, scales: { x: axis('wavelength [µm]', { type: 'logarithmic' }), y: axis('C(q) [µm⁴]', { type: 'logarithmic' }) } } });
}
export function startFiles() {
  $('scanfile').addEventListener('change', () => { if ($('scanfile').files[0]) takeScan($('scanfile').files[0]); $('scanfile').value = ''; });
  let depth = 0;
  const over = (on) => document.body.classList.toggle('drop', on);
  document.addEventListener('dragenter', (e) => { e.preventDefault(); ++depth; over(true); });
  document.addEventListener('dragover', (e) => e.preventDefault());
  document.addEventListener('dragleave', () => { if (--depth <= 0) over(false); });
  document.addEventListener('drop', (e) => { e.preventDefault(); depth = 0; over(false); if (e.dataTransfer.files[0]) takeScan(e.dataTransfer.files[0]); });
}
export const state = () => get('state');

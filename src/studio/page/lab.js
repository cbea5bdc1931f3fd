// The lab of the search: which measurements settle what to build, and what those that were made changed.
import { $, colours } from '../plots/look.js';
import { axis, draw } from '../plots/charts.js';
import { round } from '../plots/numbers.js';
import { table } from '../plots/tables.js';
import { post, upload } from './server.js';
import { give } from './take.js';

let plan = null;  // the newest, as a table: its name and text

function said(text) {
  $('labnotice').textContent = text || '';
  $('labnotice').hidden = !text;
}
async function work(ask) {
  try {
    const lab = await ask();
    if (lab.folder !== undefined) showLab(lab);
  } catch (error) {
    said(error.message);
  }
}
export function startLab() {
  $('labplan').addEventListener('click', () => work(() => post('lab/plan', { touches: Math.round(+$('labtouches').value) || 0 })));
  $('labstop').addEventListener('click', () => work(() => post('lab/stop')));
  $('labtable').addEventListener('click', () => plan && give(plan.name, plan.text, 'text/csv'));
  $('labfiles').addEventListener('change', () => work(async () => {
    const files = [...$('labfiles').files];
    for (const file of files) await upload('lab/keep', file.name, await file.arrayBuffer());
    $('labfiles').value = '';  // the same file again is a choice too
    return post('lab/tell', { files: files.map((f) => f.name), replace: $('labreplace').checked });
  }));
}

const milli = (force) => round(1000 * force, 3);
// Of a planned force: median and 95 % interval by belief.
const expected = (f) => f.length > 2 ? `${milli(f[0])} (${milli(f[1])} to ${milli(f[2])})` : '';
function showPlan(lab) {
  const newest = lab.plans[lab.plans.length - 1], done = {};
  lab.told.forEach((t) => t.readings.forEach((r) => { done[r.experiment] = (done[r.experiment] || 0) + 1; }));
  $('labbatch').parentElement.hidden = !newest || !newest.experiments.length;
  $('labwhy').hidden = $('labbatch').parentElement.hidden || !lab.why;
  $('labwhy').textContent = lab.why || '';
  if ($('labbatch').parentElement.hidden) return;
  table($('labbatch'), ['', 'design', 'humidity', 'load', 'voltage', 'finger', 'touches', 'told', 'F off expected [mN]', 'F on expected [mN]'], newest.experiments.map((e) => {
    const c = e.conditions;
    return [e.id + (e.field ? ` ${e.field}` : ''), e.design, `${round(100 * c.relative_humidity, 3)} %`, `${round(c.load, 3)} N`, `${round(c.voltage, 3)} V`, c.state, e.repeats, done[e.id] || 0, expected(e.F_off), expected(e.F_on)];
  }), [2, 3, 4, 6, 7, 8, 9]);
}
function showDecisions(lab) {
  // Designs by their names: which of them are choices may have changed since.
  const all = lab.decisions, choices = lab.standing.designs.map((d) => d.name);
  const names = [...new Set([...choices, ...all.flatMap((d) => d.designs)])];
  const curve = (name) => all.filter((d) => d.designs.includes(name)).map((d) => ({ x: d.readings, y: 100 * d.p_designs[d.designs.indexOf(name)] }));
  $('decisionsbox').hidden = all.length < 2;
  if ($('decisionsbox').hidden) return;
  draw('decisions', {
    type: 'line',
    data: { datasets: names.map((name, k) => ({ label: choices.includes(name) ? name : `${name}, no longer a choice`, data: curve(name), borderColor: colours[k % colours.length], backgroundColor: colours[k % colours.length], borderWidth: 2, pointRadius: 3 })) },
    options: { scales: { x: axis('readings told', { type: 'linear' }), y: axis('probability of being best [%]', { min: 0, max: 100 }) } },
  });
}

export function showLab(now) {
  const busy = Boolean(now.doing), lab = now.lab;
  $('lab').hidden = !now.folder;
  $('labstate').textContent = { plan: 'planning', tell: 'weighing what was told' }[now.doing] || '';
  $('labstate').classList.toggle('live', busy);
  ['labplan', 'labfiles', 'labtouches'].forEach((id) => { $(id).disabled = busy; });
  $('labfiles').disabled = busy || !lab;
  $('labstop').disabled = !busy;
  plan = now.table && now.table.text ? now.table : null;
  $('labtable').disabled = !plan;
  said(busy ? '' : now.trouble);
  $('labstanding').textContent = busy ? now.noted || '' : lab ? lab.summary || 'Where this lab stands is not in its files, which an earlier version wrote: plan or tell once to see it.' : 'What keeps this recommendation from being sure is what nobody has measured. A plan says which few touches settle it; tables and records of a tribometer are told back.';
  $('labsaid').textContent = now.said || '';
  // Of files that were told what came of each: it stands before the first heading. A plan begins with one, and is shown as a table.
  const told = (now.said || '').split(/^# /m)[0].trim();
  $('labtold').textContent = told;
  $('labtold').hidden = !told;
  $('labwords').hidden = !now.said;
  if (lab) {
    showPlan(lab);
    showDecisions(lab);
  } else {
    $('labbatch').parentElement.hidden = $('labwhy').hidden = $('decisionsbox').hidden = true;
  }
}

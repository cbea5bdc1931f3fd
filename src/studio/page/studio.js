// The studio: what the server tells goes to the parts of the page, what the hand does goes back.
import { $, onLook, setText } from '../plots/look.js';
import { charts, dropCharts } from '../plots/charts.js';
import { answered, drawn, latency, showForm, showKinds, showSlopes, startFilter, startSlopes, titled } from './form.js';
import { showAnswer, showAnswerAgain, showSessionPins, showUnanswered } from './answer.js';
import { exportDialog, historyDialog, openDialog, saveDialog, saving, startFiles, state } from './files.js';
import { showDimensions, showLook, showShape, startScene } from './scene.js';
import { showLab, startLab } from './lab.js';
import { showSearch, showWish, startSearch } from './search.js';
import { ask, listen, notice, post } from './server.js';
import { keepPage, takeable, takeableDesigns, takeableMap, takeableSolid } from './take.js';
import { startWords } from './words.js';

let session = null, file = '', kind = '';

// The form is told when its rows or their words change, a session with what is another than in its form.
let told = { form: 0, keys: [] };
function showRows(form) {
  told = form;
}
function showSession(news) {
  if (session && news.revision < session.revision) return;
  if (news.form !== told.form) return;  // one of the form at hand follows
  const moved = new Map(news.keys.map((k) => [k.path, k])), now = { ...news, keys: told.keys.map((k) => ({ ...k, ...moved.get(k.path), form: told.form })) };
  session = now;
  const title = titled(now.title);
  setText($('title'), title || 'Papilla studio');
  setText($('file'), now.file + (now.changes.length ? ` · ${now.changes.length} changed` : ''));
  document.title = `${title || now.file} · Papilla studio`;
  $('undo').disabled = !now.undo;
  $('redo').disabled = !now.redo;
  $('history').disabled = !now.steps.length;
  showForm(now);
  showDimensions(now);
  showSessionPins(now);
  // Other numbers may vary now; a design that was saved is the same.
  if (file && (file !== now.file && now.file !== saving.name || kind !== now.kind)) post('search/propose').then(showWish);
  [file, kind] = [now.file, now.kind];
}

// The newest design that has no answer: those of designs before it come too late. What fails after its answer leaves that.
let unanswered = 0;
function showFailure(told) {
  if (session && told.revision < session.revision) return;  // not of the design at hand
  notice(told.error);
  if (document.documentElement.dataset.revision === String(told.revision)) return;
  unanswered = told.revision;
  showUnanswered(told.error);
}

function showResponse(answer) {
  if (answer.revision < unanswered) return;
  if (session && answer.revision < session.revision && answer.step !== 'first') return;
  answered(answer.revision);
  showAnswer(answer);
  requestAnimationFrame(() => setTimeout(() => drawn(answer.revision)));
}

function toolbar() {
  $('undo').addEventListener('click', () => ask('undo'));
  $('redo').addEventListener('click', () => ask('redo'));
  $('history').addEventListener('click', () => historyDialog(session));
  $('pin').addEventListener('click', () => ask('pin'));
  $('open').addEventListener('click', openDialog);
  $('save').addEventListener('click', () => saveDialog(session));
  $('export').addEventListener('click', () => exportDialog(session));
  $('keep').addEventListener('click', () => keepPage(titled(session.title) || session.file));
  document.addEventListener('keydown', (e) => {
    const typing = ['INPUT', 'SELECT', 'TEXTAREA'].includes(e.target.tagName) && e.target.type !== 'range' && e.target.type !== 'checkbox';
    if ($('dialog').open) return;
    if ((e.ctrlKey || e.metaKey) && e.key.toLowerCase() === 'z' && !typing) { e.preventDefault(); ask(e.shiftKey ? 'redo' : 'undo'); }
    else if ((e.ctrlKey || e.metaKey) && e.key.toLowerCase() === 's') { e.preventDefault(); saveDialog(session); }
    else if (e.key.toLowerCase() === 'h' && !typing && !e.ctrlKey && !e.metaKey && !e.altKey) historyDialog(session);
    else if (e.key.toLowerCase() === 'p' && !typing && !e.ctrlKey && !e.metaKey && !e.altKey) ask('pin');
  });
  const choose = document.querySelector('.link');
  choose.addEventListener('keydown', (e) => { if (e.key === 'Enter' || e.key === ' ') { e.preventDefault(); $('scanfile').click(); } });
}

function refinement({ revision, what }) {
  if (!session || revision < session.revision) return;
  $('status').textContent = what ? `refining: ${what}` : '';
  document.documentElement.dataset.idle = what ? 'no' : 'yes';
}

async function begin() {
  startScene();
  startSearch();
  startLab();
  startFiles();
  startFilter();
  startSlopes();
  toolbar();
  [['modulation', 'modulation'], ['friction', 'friction'], ['section', 'section'], ['pareto', 'designs'], ['decisions', 'decisions']].forEach(([id, name]) => takeable($(id), name));
  takeableSolid($('solid'), 'texture');
  takeableMap($('top'), 'heights');
  takeableDesigns($('all'), 'all designs');
  const all = await state();
  $('version').textContent = all.version;
  startWords(all.words);
  showKinds(all.kinds);
  showRows({ form: 0, keys: all.session.keys });
  showSession({ ...all.session, form: 0 });
  showWish(all.wish);
  showSearch(all.search);
  showLab(all.lab);
  // What has charts is kept, to be drawn again in other colours.
  const last = {}, kept = (topic, show) => (what) => { last[topic] = () => show(what); show(what); };
  onLook(() => { dropCharts(); Object.values(last).forEach((again) => again()); showAnswerAgain(); });
  listen({
    form: showRows,
    session: kept('session', showSession),
    shape: kept('shape', showShape),
    response: showResponse,
    look: showLook,
    refinement,
    slopes: showSlopes,
    search: kept('search', showSearch),
    lab: kept('lab', showLab),
    notice: showFailure,
  }, (on) => {
    document.documentElement.dataset.connected = on;
    if (!on) $('status').textContent = 'the studio does not answer; trying again …';
    else if ($('status').textContent.startsWith('the studio')) $('status').textContent = '';
  });
  window.papilla = { charts, latency, session: () => session };
  document.documentElement.dataset.ready = 'yes';
}
begin().catch((error) => notice(error.message));

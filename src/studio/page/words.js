// What the words of the page mean: a "?" beside each, its meaning below it until another is asked for.
import { $ } from '../plots/look.js';

// Beside the metrics, whose words are the program's own.
const own = {
  'modulation, mean': 'modulation: (F_on − F_off)/F_off, what the drive adds to friction; the mean over the humidities',
  worst: 'the modulation at the humidity where it is least',
  'variation over humidity': 'standard deviation of the modulation over the humidities, over its mean: 0 is the same on a dry day and on a damp one',
  'friction, drive off, mean': 'friction of the finger without the drive, the mean over the humidities',
  'friction, drive off': 'friction of the finger without the drive, the mean over the humidities',
  'breakdown margin': 'strength of the film over the largest field in it, where a bridge or a contact puts the whole voltage on its thinnest place, or by the field that was solved, whichever leaves less: what a limit on oxide_breakdown_margin and pareto.csv count. Below 1 the film is at risk; where the solved field alone is beyond its strength, it breaks down',
  'model part of ±': 'what is not known of the finger and of the model: the spread of the answer over the members of its belief; the numerical part is of skins, pixels and methods',
  'p(best)': 'probability that this design is the best of the finalists, over what is not known of finger and model',
  'expected regret': 'what this design is worth less than the best there, in the mean over what is not known of finger and model',
  'p(every limit)': 'probability that the design keeps every limit, over what is not known of finger and model',
  'smallest hole': 'width of the narrowest place that is cut away: what a process has to open',
  'smallest wall': 'width of the narrowest place that stands: what a process has to leave',
  'aspect ratio': 'depth over the narrowest hole or wall',
  'smallest hole of a part': 'of each part of the stack by itself: width of the narrowest place that it cuts away; where parts cross, narrower places may be left',
  'smallest wall of a part': 'of each part of the stack by itself: width of the narrowest place that it leaves; where parts cross, narrower places may be left',
  'aspect ratio of a part': 'depth over the narrowest hole or wall, of each part of the stack by itself',
};
let words = {};
const meaning = (text) => own[text] || words[text.replace(/ /g, '_')] || (text.match(/^(\w+)\((\w+)\)$/) && words[RegExp.$2]);

function close() {
  $('meaning').hidden = true;
  document.querySelectorAll('.what[aria-expanded=true]').forEach((b) => b.setAttribute('aria-expanded', 'false'));
}
function open(button, text) {
  const was = button.getAttribute('aria-expanded') === 'true', note = $('meaning');
  close();
  if (was) return;
  button.setAttribute('aria-expanded', 'true');
  note.textContent = text;
  note.hidden = false;
  const at = button.getBoundingClientRect(), width = Math.min(360, innerWidth - 24);
  note.style.width = `${width}px`;
  note.style.left = `${scrollX + Math.max(12, Math.min(at.left, innerWidth - width - 12))}px`;
  note.style.top = `${scrollY + at.bottom + 6}px`;
}
// A "?" that says what a word means. of: the word and its meaning, asked for anew, since a choice may change.
export function question(of) {
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'what';
  button.textContent = '?';
  button.setAttribute('aria-expanded', 'false');
  button.setAttribute('aria-controls', 'meaning');
  const name = () => button.setAttribute('aria-label', `What is ${of().word}?`);
  name();
  button.addEventListener('focus', name);
  button.addEventListener('click', (e) => { e.preventDefault(); e.stopPropagation(); name(); open(button, of().text); });
  return button;
}
// One for each word in a place that has a meaning and none yet.
function ask(place) {
  if (place.querySelector(':scope > .what')) return;
  const word = place.firstChild && place.firstChild.nodeType === Node.TEXT_NODE ? place.firstChild.textContent.trim() : place.textContent.trim();
  const text = meaning(word);
  if (text) place.append(question(() => ({ word, text })));
}
const places = '#numbers th, #numbers td:first-child, #look li > span:first-child, #making li > span:first-child, #frontlist th, #pins tbody td:first-child, #pins tbody th';
export function startWords(of) {
  words = of;
  const all = () => document.querySelectorAll(places).forEach(ask);
  ['numbers', 'look', 'making', 'frontlist', 'pins'].forEach((id) => new MutationObserver(all).observe($(id), { childList: true, subtree: true }));
  all();
  document.addEventListener('keydown', (e) => { if (e.key === 'Escape') close(); });
  document.addEventListener('click', (e) => { if (!e.target.closest('#meaning')) close(); });
}

// What the page asks of its server, and what it is told.
import { $ } from '../plots/look.js';

export function notice(text) {
  $('notice').textContent = text || '';
  $('notice').hidden = !text;
}

// A request that changes something, or that computes. Throws what the server refuses, in its words.
export async function post(path, body = {}) {
  const answer = await fetch(path, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(body) });
  return read(answer);
}
export async function upload(path, name, bytes) {
  return read(await fetch(`${path}?name=${encodeURIComponent(name)}`, { method: 'POST', body: bytes }));
}
export async function get(path) {
  return read(await fetch(path));
}
async function read(answer) {
  const text = await answer.text();
  let data = {};
  try { data = JSON.parse(text); } catch (e) { data = { error: text }; }
  if (answer.ok && !data.error) return data;
  throw refused(data, answer.status);
}

// The server's words; `key`: of the first mistake.
function refused(data, status) {
  const told = data.problems && data.problems.length ? data.problems : [{ key: '', message: data.error || `refused (${status})` }];
  return Object.assign(new Error(told.map((p) => p.message).join('; ')), { key: told[0].key, problems: told });
}

// A change that the server may refuse: its words are shown, the page stays as it was.
export async function ask(path, body) {
  try {
    const answer = await post(path, body);
    notice('');
    return answer;
  } catch (error) {
    notice(error.message);
    return null;
  }
}

// handlers: by topic. The browser comes back by itself; the server then tells all that is.
export function listen(handlers, connected) {
  const source = new EventSource('events');
  Object.entries(handlers).forEach(([topic, handler]) => source.addEventListener(topic, (e) => handler(JSON.parse(e.data))));
  source.onopen = () => connected(true);
  source.onerror = () => connected(false);
}

// The page's own look: its elements by name, its colours in the light or the dark that the reader has chosen.
export const $ = (id) => document.getElementById(id);
// Only where it is another: the same text again would be laid out again.
export const setText = (element, text) => { if (element.textContent !== text) element.textContent = text; };
const scheme = matchMedia('(prefers-color-scheme: dark)');
export let dark;
export const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
export const colours = [], faint = {};
function takeColours() {
  dark = scheme.matches && !matchMedia('print').matches;
  colours.splice(0, colours.length, ...(dark ? ['#5fb0e0', '#f0955b', '#7cc488', '#bb9bdf', '#dfbc58', '#a9b0ba'] : ['#1f6f9f', '#c2571a', '#3a7d44', '#7a4fa3', '#8f6d0c', '#6f757e']));
  Object.assign(faint, dark ? { flat: '#c3c9d2', dominated: '#9a86b3', searched: '#77808d' } : { flat: '#565c66', dominated: '#9a7fb5', searched: '#8a94a3' });
}
takeColours();
// What was drawn has the colours of before: `again` draws it.
export const onLook = (again) => scheme.addEventListener('change', () => { takeColours(); again(); });

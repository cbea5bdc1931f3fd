// The page's own look: its elements by name, its colours in the light or the dark that the reader has chosen.
export const $ = (id) => document.getElementById(id);
export const dark = matchMedia('(prefers-color-scheme: dark)').matches && !matchMedia('print').matches;
export const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
export const colours = dark ? ['#5fb0e0', '#f0955b', '#7cc488', '#bb9bdf', '#dfbc58', '#a9b0ba'] : ['#1f6f9f', '#c2571a', '#3a7d44', '#7a4fa3', '#8f6d0c', '#6f757e'];
export const faint = dark ? { flat: '#c3c9d2', dominated: '#9a86b3', searched: '#77808d' } : { flat: '#565c66', dominated: '#9a7fb5', searched: '#8a94a3' };
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => location.reload());

// What every page has beside its plots: its data, texts of design files, names of parts, the list of files.
const data = JSON.parse(document.getElementById('data').textContent);

// ---- texts of design files ----
// "um" as people write it; keys and values of one section.
function sectionOf(toml, name) {
  const text = ('\n' + toml).split(`\n[${name}]`)[1] || '';
  return text.split(/\n\[/)[0].split('\n').map((l) => /^(\w+) = (.*)$/.exec(l)).filter(Boolean).map((m) => {
    const value = m[2].replace(/"/g, ''), q = /^(-?[\d.e+-]+) (.*)$/.exec(value);
    return [m[1].replace(/_/g, ' '), q ? round(+q[1], 4) + ' ' + q[2].replace('um', 'µm').replace('deg', '°') : value];
  });
}

onLook(() => location.reload());

// ---- the end of every page ----
// Names for those who hear the page or walk it by keys.
function nameParts() {
  document.querySelectorAll('canvas').forEach((canvas) => {
    const figure = canvas.closest('figure'), caption = figure && figure.querySelector('figcaption'), heading = canvas.closest('section') && canvas.closest('section').querySelector('h2');
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', (caption && caption.textContent) || (heading && heading.textContent) || 'chart');
  });
  document.querySelectorAll('.scroll').forEach((box) => {
    const heading = box.closest('section') && box.closest('section').querySelector('h2');
    box.tabIndex = 0;
    box.setAttribute('role', 'region');
    box.setAttribute('aria-label', heading ? heading.textContent : 'table');
  });
}
function finish(more = {}) {
  nameParts();
  $('version').textContent = data.version;
  table($('filelist'), ['File', 'Bytes', 'SHA-256'], data.files.map((f) => [f.name, f.bytes.toLocaleString('en'), f.sha256]), [1]);
  window.addEventListener('beforeprint', () => { Object.values(charts).forEach((c) => c.resize()); });
  window.papilla = Object.assign({ charts }, more);
  document.documentElement.dataset.charts = Object.keys(charts).length;
}

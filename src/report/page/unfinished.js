// The page of a search that is not finished.
const search = data.search, all = found(search), { sets, scales } = foundChart(all);
$('lead').textContent = data.progress;
$('level').textContent = data.level;
draw('pareto', { type: 'scatter', data: { datasets: sets }, options: { scales, plugins: { legend: { labels: { usePointStyle: true, boxHeight: 7 } } } } });
const shown = foundTable(all.front, all.objectives, search.variables.map((v) => v.path.replace(/^[a-z]+\./, '').replace(/[._]/g, ' ')), (text) => text.replace(/um\b/, 'µm').replace(/ deg\b/, '°'));
table($('frontlist'), shown.head, shown.rows);
$('study').textContent = '[design_space]' + data.study.split('\n[design_space]')[1];
$('command').textContent = `papilla optimize ${search.folder}/study.toml --out ${search.folder} --resume`;
finish();

// The page of a search that is not finished.
const search = data.search, all = found(search), { sets, scales } = foundChart(all);
const states = { running: 'It is running', paused: 'It is paused', failed: 'It failed', finished: 'It is finished' };
$('lead').textContent = `Not finished: ${search.done} of ${search.total} designs were judged. ${states[search.state]}${search.trouble ? ': ' + search.trouble : ''}. No design here is confirmed, none was compared with the surface without texture, and none has its tolerances yet: the report of the finished search has that.`;
$('level').textContent = all.searched.length ? 'Designs at the cheap level of the search: compare them with each other only; the best look better than they are.' : 'No design was judged yet.';
draw('pareto', { type: 'scatter', data: { datasets: sets }, options: { scales, plugins: { legend: { labels: { usePointStyle: true, boxHeight: 7 } } } } });
const shown = foundTable(all.front, all.objectives, search.variables.map((v) => v.path.replace(/^[a-z]+\./, '').replace(/[._]/g, ' ')), (text) => text.replace(/um\b/, 'µm').replace(/ deg\b/, '°'));
table($('frontlist'), shown.head, shown.rows);
$('study').textContent = '[design_space]' + data.study.split('\n[design_space]')[1];
$('command').textContent = `papilla optimize ${search.folder}/study.toml --out ${search.folder} --resume`;
finish();

// Tables and choices.
export function cell(row, tag, text, number) {
  const c = document.createElement(tag);
  c.textContent = text;
  if (number) c.className = 'number';
  row.appendChild(c);
}
export function table(element, head, rows, numeric = []) {
  element.textContent = '';
  if (head) {
    const row = element.createTHead().insertRow();
    head.forEach((text, i) => cell(row, 'th', text, numeric.includes(i)));
  }
  element.classList.toggle('folds', Boolean(head));
  const body = element.createTBody();
  rows.forEach((values) => {
    const row = body.insertRow();
    values.forEach((text, i) => {
      cell(row, 'td', text, numeric.includes(i));
      // Where a heading may break beside a card's cell.
      if (head) row.lastChild.dataset.label = head[i].replace(/([(._])/g, '$1\u200b');
    });
  });
  return body;
}
// A table that is told again and again: where its rows, by their first cells, and columns are those of before, texts are exchanged alone.
export function refreshTable(element, head, rows, numeric = []) {
  const shape = JSON.stringify([head, numeric, rows.map((values) => [values[0], values.length])]);
  if (element.dataset.shape !== shape) {
    element.dataset.shape = shape;
    table(element, head, rows, numeric);
    return;
  }
  [...element.tBodies[0].rows].forEach((row, i) => [...row.cells].forEach((c, k) => {
    if (c.firstChild && c.firstChild.nodeValue !== rows[i][k]) c.firstChild.nodeValue = rows[i][k];  // what stands behind the text stays
    else if (!c.firstChild && rows[i][k]) c.textContent = rows[i][k];
  }));
}
export function options(select, names, change) {
  names.forEach(([value, text]) => select.add(new Option(text, value)));
  select.addEventListener('change', () => change(select.value));
}

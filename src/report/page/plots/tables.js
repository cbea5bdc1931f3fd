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
export function options(select, names, change) {
  names.forEach(([value, text]) => select.add(new Option(text, value)));
  select.addEventListener('change', () => change(select.value));
}

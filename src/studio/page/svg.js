// A chart or a map as SVG: what it draws on its canvas, written down in place of it.
const number = (v) => +v.toFixed(2);
const escaped = (text) => String(text).replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/"/g, '&quot;');

// The part of a canvas' context that charts draw with. Paths are kept in the canvas' own pixels.
class Drawing {
  constructor(real) {
    this.real = real;
    this.out = [];
    this.clips = 0;
    this.stack = [];
    this.path = '';
    this.dash = [];
    this.to = [1, 0, 0, 1, 0, 0];
    this.clipped = '';
    Object.assign(this, { fillStyle: '#000', strokeStyle: '#000', lineWidth: 1, lineCap: 'butt', lineJoin: 'miter', globalAlpha: 1, font: '13px sans-serif', textAlign: 'start', textBaseline: 'alphabetic', lineDashOffset: 0 });
  }
  // ---- state ----
  save() { this.stack.push(Object.fromEntries(['fillStyle', 'strokeStyle', 'lineWidth', 'lineCap', 'lineJoin', 'globalAlpha', 'font', 'textAlign', 'textBaseline', 'lineDashOffset', 'dash', 'to', 'clipped'].map((k) => [k, this[k]]))); }
  restore() { Object.assign(this, this.stack.pop() || {}); }
  transform(a, b, c, d, e, f) {
    const [A, B, C, D, E, F] = this.to;
    this.to = [A * a + C * b, B * a + D * b, A * c + C * d, B * c + D * d, A * e + C * f + E, B * e + D * f + F];
  }
  translate(x, y) { this.transform(1, 0, 0, 1, x, y); }
  scale(x, y) { this.transform(x, 0, 0, y, 0, 0); }
  rotate(angle) { this.transform(Math.cos(angle), Math.sin(angle), -Math.sin(angle), Math.cos(angle), 0, 0); }
  setTransform(a, b, c, d, e, f) { this.to = [a, b, c, d, e, f]; }
  resetTransform() { this.to = [1, 0, 0, 1, 0, 0]; }
  setLineDash(dash) { this.dash = dash; }
  getLineDash() { return this.dash; }
  // ---- paths ----
  at(x, y) {
    const [a, b, c, d, e, f] = this.to;
    return `${number(a * x + c * y + e)} ${number(b * x + d * y + f)}`;
  }
  beginPath() { this.path = ''; }
  moveTo(x, y) { this.path += `M${this.at(x, y)}`; }
  lineTo(x, y) { this.path += `${this.path ? 'L' : 'M'}${this.at(x, y)}`; }
  bezierCurveTo(a, b, c, d, x, y) { this.path += `C${this.at(a, b)} ${this.at(c, d)} ${this.at(x, y)}`; }
  quadraticCurveTo(a, b, x, y) { this.path += `Q${this.at(a, b)} ${this.at(x, y)}`; }
  closePath() { this.path += 'Z'; }
  rect(x, y, w, h) { this.path += `M${this.at(x, y)}L${this.at(x + w, y)}L${this.at(x + w, y + h)}L${this.at(x, y + h)}Z`; }
  arc(x, y, r, from, to, back) { this.ellipse(x, y, r, r, 0, from, to, back); }
  // By chords of 6 degrees: points of charts have some pixels.
  ellipse(x, y, rx, ry, turn, from, to, back) {
    let way = to - from;
    if (!back && way < 0) way += 2 * Math.PI;
    if (back && way > 0) way -= 2 * Math.PI;
    const steps = Math.max(1, Math.ceil(Math.abs(way) / 0.105));
    for (let i = 0; i <= steps; ++i) {
      const t = from + way * i / steps, u = rx * Math.cos(t), v = ry * Math.sin(t);
      this.lineTo(x + u * Math.cos(turn) - v * Math.sin(turn), y + u * Math.sin(turn) + v * Math.cos(turn));
    }
  }
  clip() {
    this.clipped = ` clip-path="url(#clip${++this.clips})"`;
    this.out.push(`<clipPath id="clip${this.clips}"><path d="${this.path}"/></clipPath>`);
  }
  opacity() { return this.globalAlpha === 1 ? '' : ` opacity="${this.globalAlpha}"`; }
  // of: a drawing whose path is meant, as lines keep theirs.
  fill(of) { const path = of && of.path || this.path; if (path) this.out.push(`<path d="${path}" fill="${escaped(this.fillStyle)}"${this.opacity()}${this.clipped}/>`); }
  stroke(of) {
    const path = of && of.path || this.path;
    if (!path || !(this.lineWidth > 0)) return;
    const dash = this.dash.length ? ` stroke-dasharray="${this.dash.join(' ')}" stroke-dashoffset="${this.lineDashOffset}"` : '';
    this.out.push(`<path d="${path}" fill="none" stroke="${escaped(this.strokeStyle)}" stroke-width="${this.lineWidth}" stroke-linecap="${this.lineCap}" stroke-linejoin="${this.lineJoin}"${dash}${this.opacity()}${this.clipped}/>`);
  }
  fillRect(x, y, w, h) { this.beginPath(); this.rect(x, y, w, h); this.fill(); }
  strokeRect(x, y, w, h) { this.beginPath(); this.rect(x, y, w, h); this.stroke(); }
  clearRect() {}
  drawImage(image, x, y, w, h) { this.out.push(`<image href="${image.toDataURL()}" x="${number(x)}" y="${number(y)}" width="${number(w)}" height="${number(h)}" preserveAspectRatio="none" style="image-rendering:pixelated"${this.clipped}/>`); }
  // ---- words ----
  measureText(text) {
    this.real.save();
    this.real.font = this.font;
    const out = this.real.measureText(text);
    this.real.restore();
    return out;
  }
  fillText(text, x, y) {
    const anchor = { center: 'middle', right: 'end', end: 'end' }[this.textAlign] || 'start';
    const base = { middle: 'central', top: 'text-before-edge', hanging: 'text-before-edge', bottom: 'text-after-edge' }[this.textBaseline] || 'alphabetic';
    this.out.push(`<text transform="matrix(${this.to.map(number).join(' ')})" x="${number(x)}" y="${number(y)}" style="font:${escaped(this.font)}" text-anchor="${anchor}" dominant-baseline="${base}" fill="${escaped(this.fillStyle)}"${this.opacity()}>${escaped(text)}</text>`);
  }
  strokeText() {}
}

// All that hold the context of a chart.
const holders = (chart) => [[chart, 'ctx'], ...Object.values(chart.scales).map((s) => [s, 'ctx']), ...[chart.legend, chart.titleBlock].filter(Boolean).map((b) => [b, 'ctx']), ...chart.data.datasets.map((_, i) => [chart.getDatasetMeta(i).controller, '_ctx'])].filter(([o]) => o);

export function svgOf(chart) {
  const drawing = new Drawing(chart.ctx), had = holders(chart).map(([o, k]) => [o, k, o[k]]);
  const lines = chart.data.datasets.map((_, i) => chart.getDatasetMeta(i).dataset).filter((line) => line && line.path);
  had.forEach(([o, k]) => { o[k] = drawing; });
  // A line keeps its path, which a canvas alone can read: it gets one of ours.
  lines.forEach((line) => {
    const own = new Drawing(chart.canvas.getContext('2d'));
    if (line.path(own, 0, line.points.length)) own.closePath();
    line._path = own;
  });
  try {
    chart.draw();
  } finally {
    had.forEach(([o, k, was]) => { o[k] = was; });
    lines.forEach((line) => { line._path = undefined; });
    chart.draw();
  }
  const back = getComputedStyle(document.body).backgroundColor;
  return picture(chart.width, chart.height, `<rect width="100%" height="100%" fill="${back}"/>${drawing.out.join('\n')}`);
}
const picture = (width, height, what) => `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">${what}</svg>\n`;
// Its pixels are an image; scale bar, colours and words are drawn.
export function svgOfMap(canvas) {
  const drawing = new Drawing(canvas.getContext('2d'));
  canvas.$paint(drawing);
  return picture(canvas.width, canvas.height, drawing.out.join('\n'));
}
// A picture of the page that is one already, with the rules of the page that it is drawn by.
export function svgOfElement(svg) {
  const copy = svg.cloneNode(true), style = document.createElementNS('http://www.w3.org/2000/svg', 'style'), look = getComputedStyle(document.documentElement);
  const rules = [...document.styleSheets].flatMap((sheet) => [...sheet.cssRules]).filter((rule) => rule.selectorText && rule.selectorText.includes('.parallel')).map((rule) => rule.cssText.replace(/\.parallel\s*/g, ''));
  style.textContent = [`svg { background: ${getComputedStyle(document.body).backgroundColor}; font: 13px sans-serif; }`, ...rules].join('\n').replace(/var\((--[\w-]+)\)/g, (_, name) => look.getPropertyValue(name).trim());
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  copy.prepend(style);
  return `${copy.outerHTML}\n`;
}

// Charts as inline SVG.

const kColors = ['#a8b0ba', '#f2a541', '#56b4e9', '#5ec48f', '#e58fc0', '#e8e06a', '#e0704f', '#8e8cf0'];
const kReferenceColor = '#ffffff';

function escapeHtml(text) {
  return String(text).replace(/[&<>"']/g, c => ({'&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;', "'": '&#39;'}[c]));
}

// Three digits, as short as it goes.
function number(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  return Number(value.toPrecision(3)).toString();
}

// The same with zeros at the end, for columns that should line up.
function figure(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  return Math.abs(value) >= 0.001 && Math.abs(value) < 1000 ? value.toPrecision(3) : number(value);
}

// Ends and ticks of a logarithmic axis that holds all values. As many ticks as are still easy to read.
function logAxis(values) {
  const good = values.filter(v => Number.isFinite(v) && v > 0);
  if (good.length === 0) return {low: 1, high: 10, ticks: [1, 10]};
  const low = Math.min(...good) / 1.12, high = Math.max(...good) * 1.12;
  const ticksOf = digits => {
    const ticks = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power)
      for (const digit of digits) ticks.push(Number((digit * Math.pow(10, power)).toPrecision(3)));
    return ticks.filter(t => t >= low && t <= high);
  };
  const tenths = Array.from({length: 90}, (_, i) => 1 + i / 10);
  const choices = [tenths, [1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9], [1, 1.5, 2, 3, 4, 5, 7], [1, 2, 5], [1]].map(ticksOf);
  return {low, high, ticks: choices.find(ticks => ticks.length <= 8) || choices[choices.length - 1]};
}

function scaleOf(axis, from, to) {
  return value => from + (to - from) * Math.log(value / axis.low) / Math.log(axis.high / axis.low);
}

// Curves of {name, color, points: [{x, y, low, high, hollow, title}]}; lines join all but the hollow points.
// levels: [{y, label}] are dashed lines; xTicks replaces the ticks of the axis.
function drawCurves(element, series, xLabel, yLabel, levels = [], xTicks = null) {
  const width = 640, height = 330, left = 58, right = 96, top = 12, bottom = 40;
  const points = series.flatMap(s => s.points).filter(p => p.x > 0 && p.y > 0);
  const xAxis = logAxis(points.map(p => p.x));
  if (xTicks) xAxis.ticks = xTicks.filter(t => t >= xAxis.low && t <= xAxis.high);
  const yAxis = logAxis(points.flatMap(p => [p.y, p.low, p.high]).concat(levels.map(l => l.y)));
  const x = scaleOf(xAxis, left, width - right), y = scaleOf(yAxis, height - bottom, top);
  let svg = `<svg viewBox="0 0 ${width} ${height}" role="img" aria-label="${escapeHtml(yLabel)} against ${escapeHtml(xLabel)}">`;
  for (const t of xAxis.ticks)
    svg += `<path class="grid" d="M${x(t)} ${top}V${height - bottom}"/><text x="${x(t)}" y="${height - bottom + 16}" text-anchor="middle">${number(t)}</text>`;
  for (const t of yAxis.ticks)
    svg += `<path class="grid" d="M${left} ${y(t)}H${width - right}"/><text x="${left - 6}" y="${y(t) + 4}" text-anchor="end">${number(t)}</text>`;
  svg += `<path class="axis" fill="none" d="M${left} ${top}V${height - bottom}H${width - right}"/>`;
  svg += `<text x="${(left + width - right) / 2}" y="${height - 6}" text-anchor="middle">${escapeHtml(xLabel)}</text>`;
  svg += `<text transform="translate(12 ${(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">${escapeHtml(yLabel)}</text>`;
  for (const level of levels.filter(l => l.y > 0))
    svg += `<path class="dashed" d="M${left} ${y(level.y)}H${width - right}"/><text x="${width - right + 6}" y="${y(level.y) + 4}">${escapeHtml(level.label)}</text>`;

  const names = [];  // at the ends of the curves, moved apart
  for (const s of series) {
    const good = s.points.filter(p => p.x > 0 && p.y > 0).sort((a, b) => a.x - b.x);
    const line = good.filter(p => !p.hollow);
    svg += `<path fill="none" stroke="${s.color}" stroke-width="2" d="${line.map((p, i) => `${i ? 'L' : 'M'}${x(p.x)} ${y(p.y)}`).join('')}"/>`;
    for (const p of good) {
      if (p.low > 0 && p.high > p.low) svg += `<path stroke="${s.color}" stroke-opacity="0.6" d="M${x(p.x)} ${y(p.low)}V${y(p.high)}"/>`;
      svg += `<circle cx="${x(p.x)}" cy="${y(p.y)}" r="4" fill="${p.hollow ? 'var(--panel)' : s.color}" stroke="${s.color}" stroke-width="2"><title>${escapeHtml(p.title)}</title></circle>`;
    }
    if (line.length > 0) names.push({text: s.name, color: s.color, y: y(line[line.length - 1].y), x: x(line[line.length - 1].x)});
  }
  names.sort((a, b) => a.y - b.y);
  for (let i = 0; i < names.length; ++i) {
    if (i > 0) names[i].y = Math.max(names[i].y, names[i - 1].y + 14);
    svg += `<text class="name" style="fill:${names[i].color}" x="${names[i].x + 9}" y="${names[i].y + 4}">${escapeHtml(names[i].text)}</text>`;
  }
  element.innerHTML = svg + '</svg>';
}

// A line for each of rows {name, strong, marks: [{color, value, low, high, title}]}, around the ratio 1.
function drawForest(element, rows) {
  const marks = rows.flatMap(r => r.marks), step = 11;
  const heights = rows.map(r => Math.max(1, r.marks.length) * step + 10);
  const left = 170, right = 20, width = 640, top = 6, bottom = 24;
  const height = top + bottom + heights.reduce((a, b) => a + b, 0);
  const axis = logAxis(marks.flatMap(m => [m.value, m.low, m.high]).concat([1]));
  const x = scaleOf(axis, left, width - right);
  let svg = `<svg viewBox="0 0 ${width} ${height}" role="img" aria-label="ratios by scene">`;
  for (const t of axis.ticks)
    svg += `<path class="grid" d="M${x(t)} ${top}V${height - bottom}"/><text x="${x(t)}" y="${height - 8}" text-anchor="middle">${number(t)}</text>`;
  svg += `<path class="one" d="M${x(1)} ${top}V${height - bottom}"/>`;
  let y = top;
  rows.forEach((row, r) => {
    svg += `<text class="name" x="${left - 10}" y="${y + heights[r] / 2 + 4}" text-anchor="end" ${row.strong ? 'font-weight="700"' : ''}>${escapeHtml(row.name)}</text>`;
    if (r > 0) svg += `<path class="grid" d="M0 ${y}H${width - right}"/>`;
    row.marks.forEach((mark, i) => {
      const at = y + 5 + step * (i + 0.5);
      if (!(mark.value > 0)) return;
      if (mark.low > 0 && mark.high > mark.low) svg += `<path stroke="${mark.color}" stroke-width="2" d="M${x(mark.low)} ${at}H${x(mark.high)}"/>`;
      svg += `<circle cx="${x(mark.value)}" cy="${at}" r="${row.strong ? 5 : 4}" fill="${mark.color}"><title>${escapeHtml(mark.title)}</title></circle>`;
    });
    y += heights[r];
  });
  element.innerHTML = svg + '</svg>';
}

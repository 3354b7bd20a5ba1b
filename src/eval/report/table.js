// Tables that sort by a click on a header.

// columns: [{title, help, text, value(row), html(row)}]; values are sorted by, numbers before what is none.
function drawTable(element, columns, rows) {
  let sorted = null, ascending = true;
  const draw = () => {
    const order = rows.map((row, i) => ({row, i}));
    if (sorted !== null)
      order.sort((a, b) => compareValues(columns[sorted].value(a.row), columns[sorted].value(b.row), ascending) || a.i - b.i);
    const head = columns.map((column, i) => {
      const direction = i === sorted ? ` aria-sort="${ascending ? 'ascending' : 'descending'}"` : '';
      return `<th tabindex="0" data-column="${i}" class="${column.text ? 'text' : ''}" title="${escapeHtml(column.help || '')}"${direction}>${escapeHtml(column.title)}</th>`;
    });
    const body = order.map(({row}) =>
      `<tr>${columns.map(c => `<td class="${c.text ? 'text' : ''}">${c.html ? c.html(row) : escapeHtml(c.text ? c.value(row) : figure(c.value(row)))}</td>`).join('')}</tr>`);
    element.innerHTML = `<table><thead><tr>${head.join('')}</tr></thead><tbody>${body.join('')}</tbody></table>`;
  };
  const choose = event => {
    const header = event.target.closest('th');
    if (!header || (event.type === 'keydown' && event.key !== 'Enter')) return;
    const column = Number(header.dataset.column);
    ascending = column === sorted ? !ascending : true;
    sorted = column;
    draw();
    element.querySelector(`th[data-column="${column}"]`).focus();
  };
  element.onclick = choose;
  element.onkeydown = choose;
  draw();
}

function compareValues(a, b, ascending) {
  const known = v => typeof v === 'string' || Number.isFinite(v);
  if (!known(a) || !known(b)) return known(b) - known(a);  // unknown last, either way
  const order = typeof a === 'string' ? a.localeCompare(b, undefined, {numeric: true}) : a - b;
  return ascending ? order : -order;
}

function methodHtml(name) {
  return `<span class="swatch" style="--color:${colorOf(name)}"></span>${escapeHtml(name)}`;
}

// A ratio [value, low, high], marked where 1 is outside of the interval.
function ratioHtml([value, low, high]) {
  const digits = x => Number.isFinite(x) && x !== null ? x.toFixed(3) : '–';
  const kind = !Number.isFinite(value) ? '' : high < 1 ? 'better' : low > 1 ? 'worse' : '';
  const interval = high > low ? `<small>${digits(low)} – ${digits(high)}</small>` : '';
  return `<span class="${kind}">${digits(value)}</span>${interval}`;
}

// A mean [value, low, high]: neither side of 1 is better.
function meanHtml([value, low, high]) {
  const interval = high > low ? `<small>${low.toFixed(3)} – ${high.toFixed(3)}</small>` : '';
  return `<span>${Number.isFinite(value) ? value.toFixed(3) : '–'}</span>${interval}`;
}

function samplesText(row) {
  return row.equalTime ? `${number(row.samples)} in time of ${row.spp}` : String(row.spp);
}

function neededText(row) {
  const words = {below: 'under ', beyond: 'beyond ', within: ''};
  return row.needed.where in words ? words[row.needed.where] + number(row.needed.samples) : '–';
}

// Columns that rows of scenes and means have in common, and those that only scenes have.
function columnsOf({scene, figures}) {
  const first = data.methods[0].name;
  const column = (title, key, help) => ({title, help, value: r => r[key]});
  const ratio = (title, key, help) => ({title, help, value: r => r[key][0], html: r => ratioHtml(r[key])});
  return [
    ...(scene ? [{title: 'scene', text: true, value: r => r.scene}] : []),
    {title: 'method', text: true, value: r => r.method, html: r => methodHtml(r.method)},
    {title: 'samples', help: 'per pixel', value: r => r.spp + (r.equalTime ? 0.5 : 0), html: r => escapeHtml(samplesText(r))},
    ...(figures ? [
      column('error', 'trimmedRelMse', 'relMSE without the worst 0.1 % of the pixels'), column('relMSE', 'relMse'),
      column('SMAPE', 'smape'), column('FLIP', 'flip'), column('SSIM', 'ssim'),
      {title: 'mean', help: 'luminance of the image over the reference\'s, mean over seeds', value: r => r.mean[0], html: r => meanHtml(r.mean)},
      column('seconds', 'seconds', 'wall clock'),
      column('CPU s', 'cpuSeconds', 'of the process on all cores'),
      {title: 'Mrays', help: 'shadow rays included', value: r => r.rays * 1e-6}] : []),
    ratio('error ratio', 'errorRatio', `to ${first} with as many samples`),
    ratio('untrimmed', 'untrimmedRatio', `relMSE of all pixels, mean over seeds, to ${first} with as many samples`),
    ratio('error × time', 'errorTimeRatio', `to ${first} with as many samples`),
    ratio('error × rays', 'errorRaysRatio', `to ${first} with as many samples`),
    {title: `${first} needs`, help: 'samples per pixel for the same error',
      value: r => r.needed.where === 'unknown' ? NaN : r.needed.samples * ({below: 0.999, beyond: 1.001}[r.needed.where] || 1),
      html: r => escapeHtml(neededText(r))},
  ];
}

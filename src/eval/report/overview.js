// What the comparison says as a whole, and how it was made.

const overview = {quantity: 'errorRatio', samples: 0};

function markOf(row, key) {
  const [value, low, high] = row[key];
  return {color: colorOf(row.method), value, low, high, title: `${row.method}, ${samplesText(row)} spp: ${number(value)} (${number(low)} to ${number(high)})`};
}

function drawOverview() {
  const means = rowsShown().filter(isMean), several = means.length > 0;
  const base = several ? means : rowsOf(data.scenes[0]);
  const sets = [];
  for (const row of rowsShown())
    if (!sets.some(s => s.spp === row.spp && s.equalTime === row.equalTime)) sets.push({spp: row.spp, equalTime: row.equalTime});
  sets.sort((a, b) => a.equalTime - b.equalTime || a.spp - b.spp);
  const set = sets[overview.samples] || sets[0];
  const redraw = key => value => { overview[key] = value; drawOverview(); };
  drawButtons(byId('forest-quantity'), [['errorRatio', 'error'], ['errorTimeRatio', 'error × time'], ['errorRaysRatio', 'error × rays']]
    .map(([value, text]) => ({value, text})), overview.quantity, redraw('quantity'));
  drawButtons(byId('forest-samples'), sets.map((s, i) => ({value: i, text: s.equalTime ? `time of ${s.spp}` : `${s.spp} spp`})), sets.indexOf(set), redraw('samples'));
  const others = data.methods.slice(1).map(m => m.name);
  const marks = rows => rows.filter(r => r.spp === set.spp && r.equalTime === set.equalTime && others.includes(r.method)).map(r => markOf(r, overview.quantity));
  const lines = data.scenes.map(scene => ({name: scene.name, marks: marks(rowsOf(scene))}));
  if (several) lines.push({name: 'geometric mean', strong: true, marks: marks(means)});
  drawForest(byId('forest'), lines);

  const names = {errorRatio: 'error ratio', errorTimeRatio: 'error × time, ratio', errorRaysRatio: 'error × rays, ratio'};
  drawCurves(byId('mean-chart'), others.map(name => ({
    name, color: colorOf(name),
    points: base.filter(r => r.method === name).map(r => ({x: r.spp, y: r[overview.quantity][0], low: r[overview.quantity][1], high: r[overview.quantity][2],
      hollow: r.equalTime, title: markOf(r, overview.quantity).title})),
  })), 'samples per pixel of ' + data.methods[0].name, names[overview.quantity], [{y: 1, label: data.methods[0].name}],
  [...new Set(base.map(r => r.spp))]);
  if (!several) byId('mean-title').textContent = data.scenes[0].name;
  drawTable(byId('mean-table'), columnsOf({}), base);
}

function drawProvenance() {
  const smallest = scene => Math.min(...data.rows.filter(r => r.scene === scene.name && !r.denoised).map(r => r.trimmedRelMse).filter(Number.isFinite));
  byId('provenance').innerHTML =
    `<p>odis ${escapeHtml(data.version)}${data.denoiser ? `, ${escapeHtml(data.denoiser)}` : ''}; times of ${escapeHtml(data.machine)}</p><pre>${escapeHtml(data.command)}</pre>` +
    `<dl>${data.methods.map(m => `<dt>${methodHtml(m.name)}</dt><dd><code>odis render ${escapeHtml(m.options)}</code></dd>`).join('')}</dl>` +
    (data.leftOut.length ? `<p class="note">To keep the page small, pictures at ${data.leftOut.map(n => `${n} spp`).join(', ')} are not in it; they lie beside it as EXR.</p>` : '');
  drawTable(byId('reference-table'), [
    {title: 'scene', text: true, value: s => s.name},
    {title: 'own error', help: 'trimmed relMSE', value: s => s.referenceError ? s.referenceError.trimmedRelMse : NaN},
    {title: 'of the smallest error', value: s => s.referenceError ? s.referenceError.trimmedRelMse / smallest(s) : NaN,
      html: s => s.referenceError ? `${number(100 * s.referenceError.trimmedRelMse / smallest(s))} %` : 'not known'},
    {title: 'settings', text: true, value: s => s.referenceSettings},
    {title: 'scene file', text: true, value: s => s.file},
  ], data.scenes);
}

